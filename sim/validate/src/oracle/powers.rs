//! Largest number of field values that an integrand of a model multiplies.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

/// Returns the largest number of field values in a product of an integrand.
pub(super) fn highest_power(model: &Model) -> usize {
    let mut highest = 0;
    model.for_each_expression(&mut |expr| {
        expr.visit(&mut |part| {
            if let ExprKind::Integral { integrand, .. } = &part.kind {
                highest = highest.max(power(integrand));
            }
        });
    });
    highest
}

fn power(expr: &Expr) -> usize {
    match &expr.kind {
        ExprKind::Field(_) | ExprKind::ModeShape(_) => 1,
        ExprKind::Dot(operand) | ExprKind::Diff(operand, _) | ExprKind::Negate(operand) => {
            power(operand)
        }
        ExprKind::Binary(operator, left, right) => match operator {
            BinaryOperator::Multiply => power(left) + power(right),
            BinaryOperator::Power => match right.kind {
                ExprKind::Number(exponent) if (0.0..=32.0).contains(&exponent) => {
                    power(left) * exponent.ceil() as usize
                }
                _ => power(left),
            },
            BinaryOperator::Add | BinaryOperator::Subtract | BinaryOperator::Divide => {
                power(left).max(power(right))
            }
        },
        ExprKind::Call(_, arguments) => arguments.iter().map(power).max().unwrap_or(0),
        _ => 0,
    }
}
