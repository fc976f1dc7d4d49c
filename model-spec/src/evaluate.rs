//! Evaluates expressions of parameters in double precision, with the functions of the standard
//! library. Compiled models evaluate everything that depends on the motion.

use crate::ast::BinaryOperator;
use crate::function::call;
use crate::interval::Interval;
use crate::model::{Expr, ExprKind, Model};

/// Evaluates an expression of parameters at their values in SI. Returns NaN if it contains other quantities; a
/// checked model has no such expressions of parameters.
pub fn evaluate(expr: &Expr, parameters: &[f64]) -> f64 {
    evaluate_with(expr, &|leaf| parameter(leaf, parameters))
}

/// Evaluates a function of time at `t` (s) and the values of the parameters in SI; see
/// [`Model::is_function_of_time`].
pub fn evaluate_at_time(model: &Model, expr: &Expr, parameters: &[f64], t: f64) -> f64 {
    evaluate_with(expr, &|leaf| match leaf {
        ExprKind::Time => t,
        ExprKind::Definition(index) => {
            evaluate_at_time(model, &model.definitions[*index].value, parameters, t)
        }
        _ => parameter(leaf, parameters),
    })
}

/// Returns the value of a parameter; NaN for other leaves.
fn parameter(leaf: &ExprKind, parameters: &[f64]) -> f64 {
    match leaf {
        ExprKind::Parameter(index) => parameters.get(index.index()).copied().unwrap_or(f64::NAN),
        _ => f64::NAN,
    }
}

/// Evaluates an expression. `leaf` returns the values of leaves other than numbers, in SI. Rates, integrals and
/// values of fields are leaves, too.
pub fn evaluate_with(expr: &Expr, leaf: &dyn Fn(&ExprKind) -> f64) -> f64 {
    match &expr.kind {
        ExprKind::Number(value) => *value,
        ExprKind::Pi => std::f64::consts::PI,
        ExprKind::Negate(operand) => -evaluate_with(operand, leaf),
        ExprKind::Binary(operator, left, right) => {
            let (left, right) = (evaluate_with(left, leaf), evaluate_with(right, leaf));
            apply_binary(*operator, left, right)
        }
        ExprKind::Call(function, arguments) => {
            let argument = |index: usize| {
                let found = arguments.get(index);
                found.map_or(f64::NAN, |expr| evaluate_with(expr, leaf))
            };
            call(*function, argument(0), argument(1))
        }
        other => leaf(other),
    }
}

/// Returns the bounds of an expression. `leaf` returns the bounds of leaves other than numbers, in SI.
pub fn enclose_with(expr: &Expr, leaf: &dyn Fn(&ExprKind) -> Interval) -> Interval {
    let number = |value: f64| Interval {
        low: value,
        high: value,
    };
    match &expr.kind {
        ExprKind::Number(value) => number(*value),
        ExprKind::Pi => number(std::f64::consts::PI),
        ExprKind::Negate(operand) => enclose_with(operand, leaf).negate(),
        ExprKind::Binary(operator, left, right) => {
            let (left, right) = (enclose_with(left, leaf), enclose_with(right, leaf));
            match operator {
                BinaryOperator::Add => left.add_interval(right),
                BinaryOperator::Subtract => left.subtract(right),
                BinaryOperator::Multiply => left.multiply(right),
                BinaryOperator::Divide => left.multiply(right.reciprocal()),
                BinaryOperator::Power if right.low == right.high => left.raise(right.low),
                BinaryOperator::Power => Interval::ALL,
            }
        }
        ExprKind::Call(function, arguments) => {
            let bounds: Vec<Interval> = arguments
                .iter()
                .map(|part| enclose_with(part, leaf))
                .collect();
            Interval::apply_function(*function, &bounds)
        }
        other => leaf(other),
    }
}

/// Evaluates a binary operation.
pub(crate) fn apply_binary(operator: BinaryOperator, left: f64, right: f64) -> f64 {
    match operator {
        BinaryOperator::Add => left + right,
        BinaryOperator::Subtract => left - right,
        BinaryOperator::Multiply => left * right,
        BinaryOperator::Divide => left / right,
        BinaryOperator::Power if right == 2.0 => left * left,
        BinaryOperator::Power => left.powf(right),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Function;
    use crate::span::Span;

    fn number(value: f64) -> Expr {
        Expr {
            kind: ExprKind::Number(value),
            span: Span::default(),
        }
    }

    fn called(function: Function, x: f64, second: f64) -> f64 {
        let arguments = vec![number(x), number(second)];
        let kind = ExprKind::Call(function, arguments);
        evaluate(
            &Expr {
                kind,
                span: Span::default(),
            },
            &[],
        )
    }

    #[test]
    fn piecewise_functions_follow_their_definitions() {
        assert_eq!(called(Function::Deadzone, 3.0, 1.0), 2.0);
        assert_eq!(called(Function::Deadzone, -3.0, 1.0), -2.0);
        assert_eq!(called(Function::Deadzone, 1.0, 1.0), 0.0);
        assert_eq!(called(Function::Contact, -3.0, 1.0), 1.0);
        assert_eq!(called(Function::Contact, 1.0, 1.0), 0.0);
        assert_eq!(called(Function::Sign, -0.5, 0.0), -1.0);
        assert_eq!(called(Function::Sign, 0.0, 0.0), 0.0);
        assert_eq!(called(Function::Above, 2.0, 0.0), 1.0);
        assert_eq!(called(Function::Above, 0.0, 0.0), 0.0);
        assert_eq!(called(Function::Above, -2.0, 0.0), 0.0);
        assert_eq!(
            called(Function::Atan2, 1.0, 0.0),
            std::f64::consts::FRAC_PI_2
        );
    }

    #[test]
    fn piecewise_functions_propagate_nan() {
        for function in [
            Function::Sign,
            Function::Deadzone,
            Function::Contact,
            Function::Above,
        ] {
            assert!(called(function, f64::NAN, 1.0).is_nan(), "{function:?}");
        }
    }
}
