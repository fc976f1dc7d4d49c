//! Infers the unit of an expression. Literals are dimensionless, except that 0 has any unit. A product with the
//! factor 0 has the unit of the other factors. Summands and compared quantities must have equal units; functions such
//! as sin need pure numbers.

use num_rational::Ratio;

use crate::ast::BinaryOperator;
use crate::diagnostic::Diagnostic;
use crate::dimension::{Dimension, Exponent};
use crate::model::{Expr, ExprKind, Function, Model};
use crate::span::Span;

/// Unit of an expression; `None` for 0, which has any unit.
pub type InferredUnit = Option<Dimension>;

pub struct Inference<'m> {
    /// Units of parameters, coordinates, inputs, states and fields.
    pub model: &'m Model,
    pub definitions: Vec<InferredUnit>,
    pub coefficients: Vec<InferredUnit>,
}

impl Inference<'_> {
    /// Returns the unit of a coefficient: the factor of `by` in the acceleration of `of`, multiplied by `times`.
    pub fn factor(
        &self,
        of: &Expr,
        by: &Expr,
        times: Option<&Expr>,
    ) -> Result<InferredUnit, Diagnostic> {
        let known = |expr: &Expr| Ok(self.infer(expr)?.unwrap_or(Dimension::DIMENSIONLESS));
        let (of_unit, by_unit) = (known(of)?, known(by)?);
        let times_unit = times.map_or(Ok(Dimension::DIMENSIONLESS), known)?;
        let acceleration = of_unit
            .divide(Dimension::TIME)
            .and_then(|r| r.divide(Dimension::TIME));
        let factor = acceleration.and_then(|a| a.divide(by_unit)?.multiply(times_unit));
        factor.map(Some).ok_or_else(|| unit_overflow_error(by.span))
    }

    pub fn infer(&self, expr: &Expr) -> Result<InferredUnit, Diagnostic> {
        let model = self.model;
        let out_of_range = || unit_overflow_error(expr.span);
        match &expr.kind {
            ExprKind::Number(0.0) => Ok(None),
            ExprKind::Number(_) | ExprKind::Pi | ExprKind::ModeShape(_) => {
                Ok(Some(Dimension::DIMENSIONLESS))
            }
            ExprKind::Time => Ok(Some(Dimension::TIME)),
            ExprKind::Position(_) => Ok(Some(Dimension::LENGTH)),
            ExprKind::Parameter(index) => Ok(Some(model.parameters[*index].unit.dimension)),
            ExprKind::Coordinate(index) => Ok(Some(model.coordinates[*index].unit.dimension)),
            ExprKind::Input(index) => Ok(Some(model.inputs[*index].unit.dimension)),
            ExprKind::State(index) => Ok(Some(model.states[*index].unit.dimension)),
            ExprKind::Definition(index) => Ok(self.definitions[*index]),
            ExprKind::Residual(index) => self.infer(&model.constraints[*index].zero),
            ExprKind::Multiplier(index) => {
                let constraint = &model.constraints[*index];
                let own = self.infer(&constraint.zero)?;
                let whole = match constraint.is_nonholonomic {
                    true => Dimension::POWER,
                    false => Dimension::ENERGY,
                };
                combine_units(Some(whole), own, Dimension::divide).ok_or_else(out_of_range)
            }
            ExprKind::Coefficient(index) => {
                Ok(self.coefficients.get(index.index()).copied().flatten())
            }
            ExprKind::Field(field)
            | ExprKind::ModeCoordinate(field)
            | ExprKind::SingleMode { field, .. } => Ok(Some(model.fields[*field].unit.dimension)),
            ExprKind::Dot(operand) => {
                let per = Some(Dimension::TIME);
                scale_unit(self.infer(operand)?, per, Dimension::divide).ok_or_else(out_of_range)
            }
            ExprKind::Diff(operand, times) => {
                let per = Dimension::LENGTH.raise(Ratio::from_integer(i32::from(*times)));
                scale_unit(self.infer(operand)?, per, Dimension::divide).ok_or_else(out_of_range)
            }
            ExprKind::At {
                value, position, ..
            } => self.infer_at(value, position),
            ExprKind::Integral { integrand, .. } => {
                let along = Some(Dimension::LENGTH);
                scale_unit(self.infer(integrand)?, along, Dimension::multiply)
                    .ok_or_else(out_of_range)
            }
            ExprKind::Sum { summand, .. } => self.infer(summand),
            ExprKind::Negate(operand) => self.infer(operand),
            ExprKind::Binary(operator, left, right) => {
                self.infer_binary(expr, *operator, left, right)
            }
            ExprKind::Call(function, arguments) => self.infer_call(expr, *function, arguments),
        }
    }

    fn infer_at(&self, value: &Expr, position: &Expr) -> Result<InferredUnit, Diagnostic> {
        let place = self.infer(position)?;
        match place {
            Some(place) if place != Dimension::LENGTH => {
                let message = format!(
                    "the position along a field is {}, expected m",
                    UnitPhrase(place)
                );
                Err(Diagnostic::error(message)
                    .with_span(position.span, UnitPhrase(place).to_string())
                    .with_help("declare the length as a parameter with a unit"))
            }
            _ => self.infer(value),
        }
    }

    fn infer_binary(
        &self,
        whole: &Expr,
        operator: BinaryOperator,
        left: &Expr,
        right: &Expr,
    ) -> Result<InferredUnit, Diagnostic> {
        let inferred = self.infer(left)?;
        match operator {
            BinaryOperator::Add => self.expect_same_unit(inferred, left, right, "added to"),
            BinaryOperator::Subtract => {
                self.expect_same_unit(inferred, left, right, "subtracted from")
            }
            BinaryOperator::Multiply => {
                combine_units(inferred, self.infer(right)?, Dimension::multiply)
                    .ok_or_else(|| unit_overflow_error(whole.span))
            }
            BinaryOperator::Divide => match self.infer(right)? {
                // The module `constants` reports a division by 0.
                None => Ok(None),
                by => combine_units(inferred, by, Dimension::divide)
                    .ok_or_else(|| unit_overflow_error(whole.span)),
            },
            BinaryOperator::Power => self.infer_power(inferred, left, right),
        }
    }

    /// Proposes a factor that would correct the unit of expressions, and names parameters in them that have no unit.
    pub fn describe_cure(
        &self,
        wrong: &[&Expr],
        inferred: Dimension,
        expected: Dimension,
    ) -> Option<String> {
        let missing = expected.divide(inferred)?;
        let factor = format!("a factor in {missing} would correct the unit");
        let mut found = Vec::new();
        let with_unit = || wrong.iter().filter(|_| !expected.is_dimensionless());
        for expr in with_unit() {
            self.list_without_unit(expr, &mut found);
        }
        let is_number = inferred.is_dimensionless();
        let number = with_unit().find_map(|expr| find_measured_number(expr, is_number));
        Some(match &found[..] {
            [] => match number {
                Some(number) => format!(
                    "{factor}; {number} has no unit: declare it in [parameters] with a unit"
                ),
                None => factor,
            },
            [name] => format!("{factor}; `{name}` has no unit"),
            several => format!("{factor}; `{}` have no unit", several.join("`, `")),
        })
    }

    /// Adds the parameters without a unit in an expression and in the definitions that it contains.
    fn list_without_unit<'s>(&'s self, expr: &Expr, found: &mut Vec<&'s str>) {
        let mut definitions = Vec::new();
        expr.visit(&mut |part| match &part.kind {
            ExprKind::Parameter(index) => {
                let parameter = &self.model.parameters[*index];
                let name = parameter.name.as_str();
                let has_no_unit = ["", "1"].contains(&parameter.unit.text.as_str());
                // Measured quantities of a controller other than parameters have no name here.
                if has_no_unit && !name.is_empty() && !found.contains(&name) {
                    found.push(name);
                }
            }
            ExprKind::Definition(index) => definitions.push(*index),
            _ => {}
        });
        for index in definitions {
            self.list_without_unit(&self.model.definitions[index].value, found);
        }
    }

    /// Checks that two expressions have one unit, and returns it.
    fn expect_same_unit(
        &self,
        first: InferredUnit,
        left: &Expr,
        right: &Expr,
        verb: &str,
    ) -> Result<InferredUnit, Diagnostic> {
        match (first, self.infer(right)?) {
            (Some(one), Some(other)) if one != other => {
                let message = format!("{} is {verb} {}", quantity(other), quantity(one));
                Err(Diagnostic::error(message)
                    .with_span(right.span, UnitPhrase(other).to_string())
                    .with_related_span(left.span, UnitPhrase(one).to_string())
                    .with_optional_help(self.describe_cure(&[left, right], other, one)))
            }
            (one, other) => Ok(one.or(other)),
        }
    }

    fn infer_power(
        &self,
        base: InferredUnit,
        left: &Expr,
        right: &Expr,
    ) -> Result<InferredUnit, Diagnostic> {
        self.expect_dimensionless(right, "an exponent")?;
        let Some(dimension) = base.filter(|dimension| !dimension.is_dimensionless()) else {
            return Ok(base.and(Some(Dimension::DIMENSIONLESS)));
        };
        let Some(exponent) = rational_exponent(right) else {
            return Err(Diagnostic::error(format!(
                "the exponent of a quantity in {dimension} must be written as a number"
            ))
            .with_span(right.span, "the unit would depend on this value")
            .with_related_span(left.span, format!("in {dimension}"))
            .with_help("write a number or a fraction such as ^2 or ^(1/2)"));
        };
        let raised = dimension.raise(exponent);
        raised
            .map(Some)
            .ok_or_else(|| unit_overflow_error(left.span))
    }

    fn expect_dimensionless(&self, expr: &Expr, what: &str) -> Result<(), Diagnostic> {
        match self.infer(expr)? {
            Some(dimension) if !dimension.is_dimensionless() => Err(Diagnostic::error(format!(
                "{what} is in {dimension}, expected a pure number"
            ))
            .with_span(expr.span, format!("in {dimension}"))
            .with_help("divide it by a quantity of the same unit")),
            _ => Ok(()),
        }
    }

    fn infer_call(
        &self,
        whole: &Expr,
        function: Function,
        arguments: &[Expr],
    ) -> Result<InferredUnit, Diagnostic> {
        let name = function.name();
        match (function, arguments) {
            (Function::Abs, [argument]) => self.infer(argument),
            (Function::Sign | Function::Above, [argument]) => {
                self.infer(argument).map(|_| Some(Dimension::DIMENSIONLESS))
            }
            (Function::Sqrt, [argument]) => match self.infer(argument)? {
                Some(dimension) => dimension
                    .raise(Ratio::new(1, 2))
                    .map(Some)
                    .ok_or_else(|| unit_overflow_error(whole.span)),
                None => Ok(None),
            },
            (Function::Min | Function::Max | Function::Deadzone, [first, second]) => self
                .expect_same_unit(
                    self.infer(first)?,
                    first,
                    second,
                    "compared in one call with",
                ),
            (Function::Atan2 | Function::Contact, [first, second]) => {
                self.expect_same_unit(
                    self.infer(first)?,
                    first,
                    second,
                    "compared in one call with",
                )?;
                Ok(Some(Dimension::DIMENSIONLESS))
            }
            _ => {
                for argument in arguments {
                    self.expect_dimensionless(argument, &format!("the argument of `{name}`"))?;
                }
                Ok(Some(Dimension::DIMENSIONLESS))
            }
        }
    }
}

/// Unit in a sentence: "in N m", "a pure number".
pub struct UnitPhrase(pub Dimension);

impl std::fmt::Display for UnitPhrase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0.is_dimensionless() {
            f.write_str("a pure number")
        } else {
            write!(f, "in {}", self.0)
        }
    }
}

fn quantity(dimension: Dimension) -> String {
    if dimension.is_dimensionless() {
        "a pure number".to_owned()
    } else {
        format!("a quantity in {dimension}")
    }
}

/// Returns the unit of a product or quotient; the literal 0 counts as a pure number. `None` if
/// an exponent overflows.
fn combine_units(
    left: InferredUnit,
    right: InferredUnit,
    combine: impl Fn(Dimension, Dimension) -> Option<Dimension>,
) -> Option<InferredUnit> {
    if left.or(right).is_none() {
        return Some(None);
    }
    let [left, right] = [left, right].map(|side| side.unwrap_or(Dimension::DIMENSIONLESS));
    combine(left, right).map(Some)
}

/// Returns the unit multiplied or divided by another one. 0 still fits any unit.
fn scale_unit(
    inferred: InferredUnit,
    by: Option<Dimension>,
    combine: impl Fn(Dimension, Dimension) -> Option<Dimension>,
) -> Option<InferredUnit> {
    match inferred {
        Some(own) => combine(own, by?).map(Some),
        None => Some(None),
    }
}

/// Returns an exponent written as a number or a fraction of whole numbers.
fn rational_exponent(expr: &Expr) -> Option<Exponent> {
    match &expr.kind {
        ExprKind::Number(value) => (1..=12).find_map(|denominator| {
            let numerator = value * f64::from(denominator);
            let whole = numerator.fract() == 0.0 && numerator.abs() <= 1000.0;
            whole.then(|| Ratio::new(numerator as i32, denominator))
        }),
        ExprKind::Negate(operand) => rational_exponent(operand).map(|exponent| -exponent),
        ExprKind::Binary(BinaryOperator::Divide, left, right) => {
            let (above, below) = (rational_exponent(left)?, rational_exponent(right)?);
            (below != Ratio::from_integer(0)).then(|| above / below)
        }
        _ => None,
    }
}

fn unit_overflow_error(span: Span) -> Diagnostic {
    Diagnostic::error("an exponent in the unit of this expression overflows")
        .with_span(span, "exponent too large")
}

/// Returns a number in an expression that probably should have a unit: a number that is not a multiple of 1/2 or, if
/// the whole expression `is_number`, any number other than 1.
fn find_measured_number(expr: &Expr, is_number: bool) -> Option<f64> {
    let mut found = None;
    expr.visit(&mut |part| {
        if let ExprKind::Number(value) = part.kind {
            let is_factor = match is_number {
                true => value.abs() == 1.0,
                false => (2.0 * value).fract() == 0.0,
            };
            if !is_factor && value != 0.0 {
                found = found.or(Some(value));
            }
        }
    });
    found
}
