//! Pairs of statements that define the sine and the cosine of one argument; both are computed by one call.

use crate::statements::{Expression, Statement};

/// Names of the sine and the cosine of an argument.
pub(super) struct SineAndCosine<'s> {
    pub(super) sine: &'s str,
    pub(super) cosine: &'s str,
    pub(super) argument: &'s Expression,
}

/// If the first statement defines a sine or a cosine, returns the distance to the statement that defines the other
/// function of the same argument.
pub(super) fn find_pair(statements: &[Statement]) -> Option<(usize, SineAndCosine<'_>)> {
    let (first, rest) = statements.split_first()?;
    let (function, name, argument) = sine_or_cosine(first)?;
    let mut rest = rest.iter().enumerate();
    rest.find_map(|(place, statement)| {
        let (other, other_name, other_argument) = sine_or_cosine(statement)?;
        if other == function || other_argument != argument {
            return None;
        }
        let (sine, cosine) = match function {
            "sin" => (name, other_name),
            _ => (other_name, name),
        };
        let both = SineAndCosine {
            sine,
            cosine,
            argument,
        };
        Some((place + 1, both))
    })
}

/// Returns function, variable and argument of a statement that defines a sine or a cosine.
fn sine_or_cosine(statement: &Statement) -> Option<(&'static str, &str, &Expression)> {
    match statement {
        Statement::Let(name, Expression::Call(function @ ("sin" | "cos"), arguments)) => {
            Some((*function, name, arguments.first()?))
        }
        _ => None,
    }
}
