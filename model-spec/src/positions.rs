//! Checks that the positions of `at` are inside the domain of their field.

use crate::evaluate::evaluate;
use crate::model::{Expr, ExprKind, Model};
use crate::span::Span;

/// Largest rounding error in the value of a position, relative to the largest of position and ends. It covers about a
/// dozen operations.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Position outside the domain of its field.
pub struct PositionError {
    pub message: String,
    pub span: Span,
}

/// Returns an error for the first position outside the domain of its field; `parameters` are in SI.
pub fn check(model: &Model, parameters: &[f64]) -> Result<(), PositionError> {
    let mut first = Ok(());
    if model.fields.is_empty() {
        return first;
    }
    model.for_each_expression(&mut |expr| {
        expr.visit(&mut |part| {
            if first.is_ok() {
                first = check_part(model, part, parameters);
            }
        });
    });
    first
}

fn check_part(model: &Model, part: &Expr, parameters: &[f64]) -> Result<(), PositionError> {
    let ExprKind::At {
        field, position, ..
    } = &part.kind
    else {
        return Ok(());
    };
    let field = &model.fields[*field];
    let value = |expr: &Expr| evaluate(expr, parameters);
    let (from, to, x) = (value(&field.from), value(&field.to), value(position));
    let slack = ROUNDING * from.abs().max(to.abs()).max(x.abs());
    // A position that is NaN is reported by another check.
    if x.is_nan() || (from - slack..=to + slack).contains(&x) {
        return Ok(());
    }
    let message = format!(
        "the position {x} m is outside the field `{}`, which has {} from {from} m to {to} m",
        field.name, field.along
    );
    Err(PositionError {
        message,
        span: position.span,
    })
}
