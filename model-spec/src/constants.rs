//! Checks the constant subexpressions, which contain only numbers and parameters: each value is finite, each argument
//! is in the domain of its function, and no divisor is 0.

use crate::ast::BinaryOperator;
use crate::checks::for_each_expression;
use crate::evaluate::apply_binary;
use crate::function::call;
use crate::model::{CoefficientKind, Expr, ExprKind, Function, Model};
use crate::span::Span;

/// Error of a constant that is infinite, not a number, or outside the domain of a function.
pub struct ConstantError {
    pub message: String,
    pub help: &'static str,
    pub span: Span,
}

/// Finite value of an expression; `None` if it is not constant.
type Constant = Result<Option<f64>, ConstantError>;

pub fn check(model: &Model, parameters: &[f64]) -> Result<(), ConstantError> {
    let mut known = Constants {
        parameters,
        definitions: vec![None; model.definitions.len()],
        coefficients: Vec::with_capacity(model.coefficients.len()),
    };
    for &index in &model.definition_order {
        known.definitions[index] = known.value(&model.definitions[index].value)?;
    }
    for coefficient in &model.coefficients {
        let value = match &coefficient.kind {
            CoefficientKind::Value(value) => known.value(value)?,
            CoefficientKind::Factor { .. } => None,
        };
        known.coefficients.push(value);
    }
    let mut first = Ok(());
    for_each_expression(model, &mut |expr| {
        if first.is_ok() {
            first = known.value(expr).map(|_| ());
        }
    });
    first
}

struct Constants<'p> {
    parameters: &'p [f64],
    definitions: Vec<Option<f64>>,
    coefficients: Vec<Option<f64>>,
}

impl Constants<'_> {
    fn value(&self, expr: &Expr) -> Constant {
        let value = match &expr.kind {
            ExprKind::Number(value) => Some(*value),
            ExprKind::Pi => Some(std::f64::consts::PI),
            ExprKind::Parameter(index) => self.parameters.get(index.index()).copied(),
            ExprKind::Definition(index) => self.definitions[*index],
            ExprKind::Coefficient(index) => self.coefficients.get(index.index()).copied().flatten(),
            ExprKind::Time
            | ExprKind::Position(_)
            | ExprKind::Coordinate(_)
            | ExprKind::Input(_)
            | ExprKind::State(_)
            | ExprKind::Multiplier(_)
            | ExprKind::Residual(_)
            | ExprKind::Field(_)
            | ExprKind::ModeCoordinate(_)
            | ExprKind::ModeShape(_)
            | ExprKind::SingleMode { .. } => None,
            ExprKind::Dot(part)
            | ExprKind::Diff(part, _)
            | ExprKind::Integral {
                integrand: part, ..
            }
            | ExprKind::Sum { summand: part, .. } => {
                self.value(part)?;
                None
            }
            ExprKind::At {
                value, position, ..
            } => {
                self.value(position)?;
                self.value(value)?
            }
            ExprKind::Negate(operand) => self.value(operand)?.map(|value| -value),
            ExprKind::Binary(operator, left, right) => self.operation(*operator, left, right)?,
            ExprKind::Call(function, arguments) => self.call(*function, arguments, expr)?,
        };
        match value {
            Some(value) if !value.is_finite() => Err(not_finite_error(value, expr)),
            value => Ok(value),
        }
    }

    fn operation(&self, operator: BinaryOperator, left: &Expr, right: &Expr) -> Constant {
        let (one, other) = (self.value(left)?, self.value(right)?);
        if operator == BinaryOperator::Divide && other == Some(0.0) {
            return Err(ConstantError {
                message: "division by 0: this divisor is 0".to_owned(),
                help: "divide by a quantity that is not 0, or remove the term",
                span: right.span,
            });
        }
        Ok(one.zip(other).map(|(x, y)| apply_binary(operator, x, y)))
    }

    fn call(&self, function: Function, arguments: &[Expr], whole: &Expr) -> Constant {
        let values: Result<Vec<_>, _> = arguments.iter().map(|part| self.value(part)).collect();
        let values = values?;
        if let ([_, half_width], [_, Some(value)]) = (arguments, &values[..])
            && matches!(function, Function::Deadzone | Function::Contact)
            && *value < 0.0
        {
            return Err(ConstantError {
                message: format!(
                    "the half-width b of `{}` is negative: {value}",
                    function.name()
                ),
                help: "give a half-width of at least 0",
                span: half_width.span,
            });
        }
        let Some(values) = values.into_iter().collect::<Option<Vec<f64>>>() else {
            return Ok(None);
        };
        let argument = |place: usize| values.get(place).copied().unwrap_or(f64::NAN);
        let (x, value) = (argument(0), call(function, argument(0), argument(1)));
        if is_periodic(function) && x.abs() > MAX_ANGLE {
            return Err(ConstantError {
                message: format!("`{}` of {x} is outside its domain", function.name()),
                help: "give an angle between -1e9 and 1e9 rad",
                span: whole.span,
            });
        }
        if value.is_finite() {
            return Ok(Some(value));
        }
        Err(ConstantError {
            message: format!("`{}` of {x} evaluates to {value}", function.name()),
            help: domain_help(function),
            span: whole.span,
        })
    }
}

fn not_finite_error(value: f64, expr: &Expr) -> ConstantError {
    ConstantError {
        message: format!("this expression evaluates to {value}"),
        help: match value.is_nan() {
            true => "a negative base needs an integer exponent",
            false => {
                "the value exceeds 1.8e308: check for a negative power of 0, or for a number that is too large"
            }
        },
        span: expr.span,
    }
}

/// Largest angle of a sine, cosine or tangent, rad; beyond it the emitted functions return NaN.
const MAX_ANGLE: f64 = 1e9;

fn is_periodic(function: Function) -> bool {
    matches!(function, Function::Sin | Function::Cos | Function::Tan)
}

fn domain_help(function: Function) -> &'static str {
    match function {
        Function::Sqrt => "give `sqrt` an argument of at least 0",
        Function::Ln => "give `ln` an argument greater than 0",
        Function::Asin | Function::Acos => "give an argument between -1 and 1",
        _ => "the value exceeds 1.8e308: give a smaller argument",
    }
}
