//! Formulas of program values for the documentation of emitted code, in terms of named quantities.

use crate::program::{Op, Program, ValueId};

/// Largest length of a formula in characters; longer ones are cut.
const MAX_FORMULA_LENGTH: usize = 160;

/// Returns the formula of a value on one line.
pub fn describe_value(program: &Program, id: ValueId) -> String {
    let text = formula(program, id, true, 0);
    if text.len() <= MAX_FORMULA_LENGTH {
        return format!("`{text}`");
    }
    let cut: String = text.chars().take(MAX_FORMULA_LENGTH).collect();
    format!("`{cut}...`")
}

/// Largest depth of a formula; deeper parts are omitted, because shared nodes make a tree exponentially
/// larger than its graph.
const MAX_DEPTH: usize = 8;

fn formula(program: &Program, id: ValueId, root: bool, depth: usize) -> String {
    let value = program.value(id);
    if let (Some(name), false) = (&value.name, root) {
        return name.clone();
    }
    if depth > MAX_DEPTH {
        return "...".to_owned();
    }
    let part = |id: ValueId| formula(program, id, false, depth + 1);
    let atom = |id: ValueId| {
        let text = part(id);
        let simple = text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || "_.'".contains(c));
        if simple { text } else { format!("({text})") }
    };
    match &value.op {
        Op::Constant(number) => format!("{number:?}"),
        Op::Table(place) => program.tables[*place].name.clone(),
        Op::Parameter(place) => program.parameters[*place].quantity.name.clone(),
        Op::Negate(a) => format!("-{}", atom(*a)),
        Op::Add(a, b) => format!("{} + {}", part(*a), part(*b)),
        Op::Subtract(a, b) => format!("{} - {}", part(*a), atom(*b)),
        Op::Multiply(a, b) => format!(
            "{}*{}",
            factor(program, *a, depth),
            factor(program, *b, depth)
        ),
        Op::Divide(a, b) => format!("{}/{}", factor(program, *a, depth), atom(*b)),
        Op::Power(a, b) => format!("{}^{}", atom(*a), atom(*b)),
        Op::Call(function, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(|a| part(*a)).collect();
            format!("{}({})", function.name(), arguments.join(", "))
        }
        Op::PivotReciprocal(a) => format!("1/{}", atom(*a)),
        Op::Total(a) => format!("sum_i({})", part(*a)),
        Op::Cholesky(a) => format!("cholesky({})", part(*a)),
        Op::CholeskySolve(a, b) => format!("solve({}, {})", part(*a), part(*b)),
        Op::Apply { matrix, vector, .. } => format!("{} . {}", atom(*matrix), atom(*vector)),
        Op::Gram { .. } | Op::GramDiagonal { .. } => "weighted integral of mode shapes".to_owned(),
        Op::Assemble { .. } => "block of the mass matrix".to_owned(),
        _ => "...".to_owned(),
    }
}

/// Returns a factor of a product; products inside products need no parentheses.
fn factor(program: &Program, id: ValueId, depth: usize) -> String {
    let text = formula(program, id, false, depth + 1);
    let compound = program.value(id).name.is_none()
        && matches!(
            program.value(id).op,
            Op::Add(..) | Op::Subtract(..) | Op::Negate(_)
        );
    if compound { format!("({text})") } else { text }
}
