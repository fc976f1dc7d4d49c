//! Formulas of program values for the documentation of emitted code, in terms of named quantities.

use super::content::leaf_name;
use crate::program::{Op, Program, ValueId};

/// Largest length in characters of a formula without names of intermediate values.
const MAX_FORMULA_LENGTH: usize = 160;

/// Largest depth of a formula without names of intermediate values. The limit is necessary because a tree can be
/// exponentially larger than its graph.
const MAX_DEPTH: usize = 8;

/// Returns the formula of a value on one line, in terms of named quantities. In a long formula, intermediate values
/// of `prepare` appear by the names that `intermediate` returns.
pub fn describe_value<'n>(
    program: &Program,
    id: ValueId,
    intermediate: &dyn Fn(ValueId) -> Option<&'n str>,
) -> String {
    let quantities = |id: ValueId| program.value(id).name.clone();
    let whole = Formula {
        program,
        name: &quantities,
        depth: MAX_DEPTH,
    };
    if let Some(text) = whole
        .write(id, 0)
        .filter(|text| text.len() <= MAX_FORMULA_LENGTH)
    {
        return format!("`{text}`");
    }
    let named = |id: ValueId| {
        let known = intermediate(id).map(str::to_owned);
        known.or_else(|| program.value(id).name.clone())
    };
    let parts = Formula {
        program,
        name: &named,
        depth: usize::MAX,
    };
    match parts.write(id, 0) {
        Some(text) => format!("`{text}` with prepared intermediate values"),
        None => "`prepared intermediate value`".to_owned(),
    }
}

/// Writer of the formulas of a program.
struct Formula<'f> {
    program: &'f Program,
    /// Function that returns the name to print in place of a value's formula, if there is one.
    name: &'f dyn Fn(ValueId) -> Option<String>,
    /// Largest depth of the formula.
    depth: usize,
}

impl Formula<'_> {
    /// Returns the formula of a value; `None` if it exceeds the largest depth.
    fn write(&self, id: ValueId, depth: usize) -> Option<String> {
        if depth > self.depth {
            return None;
        }
        if depth > 0
            && let Some(name) = (self.name)(id)
        {
            return Some(name);
        }
        let program = self.program;
        let op = &program.value(id).op;
        if let Some(leaf) = leaf_name(program, op) {
            return Some(leaf);
        }
        let part = |id: &ValueId| self.write(*id, depth + 1);
        let atom = |id: &ValueId| {
            let text = part(id)?;
            let simple = text
                .chars()
                .all(|c| c.is_ascii_alphanumeric() || "_.'".contains(c));
            Some(if simple { text } else { format!("({text})") })
        };
        let factor = |id: &ValueId| {
            let text = part(id)?;
            let is_sum = matches!(
                program.value(*id).op,
                Op::Add(..) | Op::Subtract(..) | Op::Negate(_)
            );
            let compound = (self.name)(*id).is_none() && is_sum;
            Some(if compound { format!("({text})") } else { text })
        };
        Some(match op {
            Op::Constant(number) => format!("{number:?}"),
            Op::Negate(a) => format!("-{}", atom(a)?),
            Op::Add(a, b) => format!("{} + {}", part(a)?, part(b)?),
            Op::Subtract(a, b) => format!("{} - {}", part(a)?, atom(b)?),
            Op::Multiply(a, b) => format!("{}*{}", factor(a)?, factor(b)?),
            Op::Divide(a, b) => format!("{}/{}", factor(a)?, atom(b)?),
            Op::Power(a, b) => format!("{}^{}", atom(a)?, atom(b)?),
            Op::Call(function, arguments) => {
                let arguments: Option<Vec<String>> = arguments.iter().map(part).collect();
                format!("{}({})", function.name(), arguments?.join(", "))
            }
            Op::Select {
                a,
                b,
                then,
                otherwise,
            } => format!(
                "({} if {} > {} else {})",
                part(then)?,
                part(a)?,
                part(b)?,
                part(otherwise)?
            ),
            Op::PivotReciprocal(a) => format!("1/{}", atom(a)?),
            Op::Total(a) => format!("sum_i({})", part(a)?),
            Op::Cholesky(a) => format!("cholesky({})", part(a)?),
            Op::CholeskySolve(a, b) => format!("solve({}, {})", part(a)?, part(b)?),
            Op::Apply { matrix, vector, .. } => format!("{} . {}", atom(matrix)?, atom(vector)?),
            Op::Gram { .. } | Op::GramDiagonal { .. } => {
                "weighted integral of mode shapes".to_owned()
            }
            Op::Assemble { .. } => "block of the mass matrix".to_owned(),
            _ => return None,
        })
    }
}
