//! Polynomial degree of an integrand in its field.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

/// Largest exponent of a power that is treated as a polynomial.
const MAX_EXPONENT: f64 = 32.0;

/// Degree of a product of two shapes, as in the energies of a linear beam.
const QUADRATIC_DEGREE: u32 = 2;

/// Returns the highest degree in the mode shapes of all integrands over a field, at least 2. Integrands that are not
/// polynomials of the field are ignored.
pub(crate) fn find_highest_degree(model: &Model, of: FieldId) -> u32 {
    let mut highest = QUADRATIC_DEGREE;
    model.for_each_expression(&mut |expr| {
        expr.visit(&mut |part| match &part.kind {
            ExprKind::Integral { field, integrand } if *field == of => {
                highest = highest.max(find_degree(integrand).unwrap_or(QUADRATIC_DEGREE));
            }
            _ => {}
        });
    });
    highest
}

/// Returns the degree of an expression in the mode shapes of the field; `None` if the expression is not a polynomial
/// in them.
fn find_degree(expr: &Expr) -> Option<u32> {
    match &expr.kind {
        ExprKind::Field(_) | ExprKind::ModeShape(_) => Some(1),
        ExprKind::Dot(operand) | ExprKind::Diff(operand, _) | ExprKind::Negate(operand) => {
            find_degree(operand)
        }
        ExprKind::Binary(operator, left, right) => {
            let (one, other) = (find_degree(left)?, find_degree(right)?);
            match operator {
                BinaryOperator::Add | BinaryOperator::Subtract => Some(one.max(other)),
                BinaryOperator::Multiply => Some(one + other),
                BinaryOperator::Divide => (other == 0).then_some(one),
                BinaryOperator::Power if one == 0 && other == 0 => Some(0),
                BinaryOperator::Power => Some(one * read_integer_exponent(right)?),
            }
        }
        ExprKind::Call(_, arguments) => arguments
            .iter()
            .all(|part| find_degree(part) == Some(0))
            .then_some(0),
        _ => Some(0),
    }
}

/// Returns the exponent if it is a whole number of at least 0.
pub(crate) fn read_integer_exponent(exponent: &Expr) -> Option<u32> {
    match exponent.kind {
        ExprKind::Number(n) if n == n.round() && (0.0..=MAX_EXPONENT).contains(&n) => {
            Some(n as u32)
        }
        _ => None,
    }
}
