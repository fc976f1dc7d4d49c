//! Constant parts of expressions, made of numbers and parameters alone: each has a finite value and lies in the domain
//! of the function that it is an argument of, and none that is 0 divides anything.

use crate::ast::BinaryOperator;
use crate::checks::for_each_expression;
use crate::evaluate::{binary, call};
use crate::model::{CoefficientKind, Expr, ExprKind, Function, Model};
use crate::span::Span;

/// A constant that is infinite, not a number or outside the domain of a function.
pub struct NotFinite {
    /// What is wrong.
    pub message: String,
    /// The values that the function takes.
    pub help: &'static str,
    /// Where it stands.
    pub span: Span,
}

/// The finite value of an expression, or None if it moves.
type Constant = Result<Option<f64>, NotFinite>;

/// Checks the constant parts of all expressions at these values of the parameters, in SI.
///
/// # Errors
/// The first that is infinite or not a number, with its place.
pub fn check(model: &Model, parameters: &[f64]) -> Result<(), NotFinite> {
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
            | ExprKind::ModeShape(_) => None,
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
            Some(value) if !value.is_finite() => Err(not_finite(value, expr)),
            value => Ok(value),
        }
    }

    fn operation(&self, operator: BinaryOperator, left: &Expr, right: &Expr) -> Constant {
        let (one, other) = (self.value(left)?, self.value(right)?);
        if operator == BinaryOperator::Divide && other == Some(0.0) {
            return Err(NotFinite {
                message: "division by 0: this is 0".to_owned(),
                help: "divide by a quantity that is not 0, or leave the term out",
                span: right.span,
            });
        }
        Ok(one.zip(other).map(|(x, y)| binary(operator, x, y)))
    }

    fn call(&self, function: Function, arguments: &[Expr], whole: &Expr) -> Constant {
        let values: Result<Vec<_>, _> = arguments.iter().map(|part| self.value(part)).collect();
        let values = values?;
        if let ([_, half_width], [_, Some(value)]) = (arguments, &values[..])
            && matches!(function, Function::Deadzone | Function::Contact)
            && *value < 0.0
        {
            return Err(NotFinite {
                message: format!(
                    "the half-width of `{}` is negative: {value}",
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
            return Err(NotFinite {
                message: format!("`{}` of {x} is outside its domain", function.name()),
                help: "the angle is at most 1e9 rad, forward or backward",
                span: whole.span,
            });
        }
        if value.is_finite() {
            return Ok(Some(value));
        }
        Err(NotFinite {
            message: format!("`{}` of {x} comes out as {value}", function.name()),
            help: domain(function),
            span: whole.span,
        })
    }
}

fn not_finite(value: f64, expr: &Expr) -> NotFinite {
    NotFinite {
        message: format!("this expression comes out as {value}"),
        help: match value.is_nan() {
            true => "a negative number has only powers with a whole exponent",
            false => {
                "the value exceeds 1.8e308: look for a power of 0 or a number that is too large"
            }
        },
        span: expr.span,
    }
}

/// Largest angle of a sine, a cosine and a tangent, rad: the emitted functions are NaN beyond.
const MAX_ANGLE: f64 = 1e9;

fn is_periodic(function: Function) -> bool {
    matches!(function, Function::Sin | Function::Cos | Function::Tan)
}

/// Values for which a function is finite.
fn domain(function: Function) -> &'static str {
    match function {
        Function::Sqrt => "the argument of `sqrt` is at least 0",
        Function::Ln => "the argument of `ln` is greater than 0",
        Function::Asin | Function::Acos => "the argument is between -1 and 1",
        _ => "the value exceeds 1.8e308: give a smaller argument",
    }
}
