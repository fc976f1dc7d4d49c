//! Resolves the names in the expressions of a controller.

use crate::ast::{BinaryOperator, Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quote};
use crate::functions::FORMS;
use crate::model::{Function, MeasuredQuantity, SampledExpression, SampledKind};
use crate::names::{Names, Symbol};
use crate::span::Span;
use crate::suggest::did_you_mean;

/// Functions of controllers only, with their arguments.
const FUNCTIONS: [(&str, &[&str]); 2] = [
    ("clamp", &["x", "low", "high"]),
    ("quantise", &["x", "step"]),
];

/// Observables of every model.
const BUILT_IN: [&str; 2] = ["energy", "power"];

const PERIOD: &str = "period";

/// Resolver of the expressions of one controller, which collects the quantities in them.
pub(super) struct ControlResolver<'n> {
    pub names: &'n Names,
    /// Names of the states of the controller.
    pub own: Vec<String>,
    pub measured: Vec<MeasuredQuantity>,
}

impl ControlResolver<'_> {
    pub fn resolve(&mut self, syntax: &Syntax) -> Result<SampledExpression, Diagnostic> {
        let span = syntax.span;
        let kind = match &syntax.kind {
            SyntaxKind::Number(value) => SampledKind::Number(*value),
            SyntaxKind::Name(name) if name == "pi" => SampledKind::Number(std::f64::consts::PI),
            SyntaxKind::Name(name) => {
                let quantity = self.resolve_quantity(name, span)?;
                self.measure(quantity)
            }
            SyntaxKind::Call {
                function,
                function_span,
                arguments,
            } => self.resolve_call(function, *function_span, span, arguments)?,
            SyntaxKind::Negate(operand) => SampledKind::Negate(Box::new(self.resolve(operand)?)),
            SyntaxKind::Binary(operator, left, right) => {
                let left = Box::new(self.resolve(left)?);
                SampledKind::Binary(*operator, left, Box::new(self.resolve(right)?))
            }
            SyntaxKind::Element { name, .. } => {
                return Err(Diagnostic::error(
                    "an expression of a controller cannot contain a sum over modes",
                )
                .with_span(span, "the index has no value here")
                .with_help(format!("write a single mode, such as {name}_1")));
            }
            SyntaxKind::Vector(_) | SyntaxKind::Member { .. } => {
                return Err(Diagnostic::error("a vector cannot be used here")
                    .with_span(span, "expected a scalar")
                    .with_help("add the component to [observables] and use its name"));
            }
        };
        Ok(SampledExpression { kind, span })
    }

    fn measure(&mut self, quantity: MeasuredQuantity) -> SampledKind {
        let known = self.measured.iter().position(|known| *known == quantity);
        SampledKind::Measured(known.unwrap_or_else(|| {
            self.measured.push(quantity);
            self.measured.len() - 1
        }))
    }

    fn resolve_quantity(&self, name: &str, span: Span) -> Result<MeasuredQuantity, Diagnostic> {
        if let Some(place) = self.own.iter().position(|own| own == name) {
            return Ok(MeasuredQuantity::Own(place));
        }
        if name == "t" {
            return Ok(MeasuredQuantity::Time);
        }
        let symbol = self.names.get(name);
        if name == PERIOD {
            return match symbol {
                None => Ok(MeasuredQuantity::Period),
                Some(symbol) => Err(Diagnostic::error("`period` has two meanings here")
                    .with_span(span, format!("the sample time, and {}", symbol.kind()))
                    .with_help("choose another name for the quantity of the model")),
            };
        }
        if self.names.is_observable(name) || BUILT_IN.contains(&name) {
            return Ok(MeasuredQuantity::Observable(name.to_owned()));
        }
        match symbol {
            Some(Symbol::Parameter(id)) => Ok(MeasuredQuantity::Parameter(id)),
            Some(Symbol::Input(id)) => Ok(MeasuredQuantity::Input(id)),
            Some(Symbol::Coordinate(id)) => Ok(MeasuredQuantity::Coordinate(id)),
            Some(Symbol::State(id)) => Ok(MeasuredQuantity::State(id)),
            Some(Symbol::Modes(_)) => Err(Diagnostic::error(format!("`{name}` denotes all modes"))
                .with_span(span, "no mode number")
                .with_help(format!("write a single mode, such as {name}_1"))),
            Some(Symbol::ControllerState) => Err(Diagnostic::error(format!(
                "`{name}` is a state of another controller"
            ))
            .with_span(span, "not measured")
            .with_help("controllers exchange signals through inputs of the model")),
            Some(symbol) => Err(
                Diagnostic::error(format!("{} is not measured", quote(name)))
                    .with_span(span, format!("this is {}", symbol.kind()))
                    .with_help("add it to [observables] and use the name of the observable"),
            ),
            None => self
                .find_mode(name, false, span)
                .ok_or_else(|| self.unknown_name_error(name, span)),
        }
    }

    /// Returns the single mode of this name.
    fn find_mode(&self, name: &str, is_rate: bool, span: Span) -> Option<MeasuredQuantity> {
        let (stem, number) = name.rsplit_once('_')?;
        let Some(Symbol::Modes(field)) = self.names.get(stem) else {
            return None;
        };
        let has_digits = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
        let number = number
            .parse()
            .ok()
            .filter(|number| *number > 0 && has_digits)?;
        Some(MeasuredQuantity::Mode {
            field: field.index(),
            number,
            is_rate,
            span,
        })
    }

    fn unknown_name_error(&self, name: &str, span: Span) -> Diagnostic {
        let rate = name.strip_suffix("_dot");
        let rate = rate.filter(|stem| self.names.get(stem).is_some());
        let own = self.own.iter().map(String::as_str);
        let known = self
            .names
            .known_names()
            .chain(self.names.observable_names());
        let known = known.chain(own).chain(["t", "pi", PERIOD]).chain(BUILT_IN);
        let help = match rate {
            Some(stem) => Some(format!("write dot({stem}) for the rate")),
            None => did_you_mean(name, known),
        };
        Diagnostic::error(format!("unknown name {}", quote(name)))
            .with_span(span, "not declared")
            .with_optional_help(help)
    }

    fn resolve_call(
        &mut self,
        name: &str,
        name_span: Span,
        span: Span,
        arguments: &[Syntax],
    ) -> Result<SampledKind, Diagnostic> {
        if name == "dot" {
            let rate = self.resolve_rate(span, arguments)?;
            return Ok(self.measure(rate));
        }
        if FORMS.contains(&name) {
            return Err(
                Diagnostic::error(format!("a controller cannot use `{name}`"))
                    .with_span(name_span, "not measured")
                    .with_help("add the quantity to [observables] and use its name"),
            );
        }
        let function = Function::from_name(name);
        let own = FUNCTIONS.iter().find(|(known, _)| *known == name);
        let expected = match (own, function) {
            (Some((_, expected)), _) => *expected,
            (None, Some(function)) => function.arguments(),
            (None, None) => return Err(self.unknown_function_error(name, name_span)),
        };
        if arguments.len() != expected.len() {
            let (count, plural) = (arguments.len(), if arguments.len() == 1 { "" } else { "s" });
            let message = format!("`{name}` does not accept {count} argument{plural}");
            return Err(Diagnostic::error(message)
                .with_span(span, "here")
                .with_help(format!("write {name}({})", expected.join(", "))));
        }
        let mut resolved = Vec::with_capacity(arguments.len());
        for argument in arguments {
            resolved.push(self.resolve(argument)?);
        }
        let boxed: Vec<Box<SampledExpression>> = resolved.iter().cloned().map(Box::new).collect();
        Ok(match (name, function) {
            ("clamp", _) => match <[_; 3]>::try_from(boxed) {
                Ok(arguments) => {
                    check_limits(&arguments)?;
                    SampledKind::Clamp(arguments)
                }
                Err(_) => SampledKind::Number(f64::NAN),
            },
            ("quantise", _) => match <[_; 2]>::try_from(boxed) {
                Ok(arguments) => SampledKind::Quantise(arguments),
                Err(_) => SampledKind::Number(f64::NAN),
            },
            (_, Some(function)) => SampledKind::Call(function, resolved),
            (_, None) => SampledKind::Number(f64::NAN),
        })
    }

    fn resolve_rate(
        &self,
        span: Span,
        arguments: &[Syntax],
    ) -> Result<MeasuredQuantity, Diagnostic> {
        let not_measured = || {
            Diagnostic::error("this rate is not measured")
                .with_span(
                    span,
                    "expected the rate of a coordinate or of a single mode",
                )
                .with_help("add the rate to [observables] and use the name of the observable")
        };
        let [
            Syntax {
                kind: SyntaxKind::Name(name),
                span: name_span,
            },
        ] = arguments
        else {
            return Err(not_measured());
        };
        match self.names.get(name) {
            Some(Symbol::Coordinate(id)) => Ok(MeasuredQuantity::CoordinateRate(id)),
            Some(_) => Err(not_measured()),
            None => self
                .find_mode(name, true, span)
                .ok_or_else(|| self.unknown_name_error(name, *name_span)),
        }
    }

    fn unknown_function_error(&self, name: &str, span: Span) -> Diagnostic {
        let known = crate::functions::callable_names();
        let known = known.chain(FUNCTIONS.iter().map(|(known, _)| *known));
        Diagnostic::error(format!("unknown function {}", quote(name)))
            .with_span(span, "not known")
            .with_optional_help(did_you_mean(name, known))
    }
}

/// Rejects numbers as limits of `clamp` if the lower limit is above the upper one.
fn check_limits([_, low, high]: &[Box<SampledExpression>; 3]) -> Result<(), Diagnostic> {
    match (find_constant(low), find_constant(high)) {
        (Some(lower), Some(upper)) if lower > upper => Err(Diagnostic::error(
            "the lower limit of `clamp` is above the upper limit",
        )
        .with_span(
            Span::new(low.span.start, high.span.end),
            format!("{lower} is above {upper}"),
        )
        .with_help(format!(
            "the lower limit is the second argument: write clamp(x, {upper}, {lower})"
        ))),
        _ => Ok(()),
    }
}

/// Returns the value of an expression of numbers; `None` if the expression contains a quantity or a function.
fn find_constant(expression: &SampledExpression) -> Option<f64> {
    match &expression.kind {
        SampledKind::Number(value) => Some(*value),
        SampledKind::Negate(operand) => find_constant(operand).map(|value| -value),
        SampledKind::Binary(operator, left, right) => {
            let (left, right) = (find_constant(left)?, find_constant(right)?);
            Some(match operator {
                BinaryOperator::Add => left + right,
                BinaryOperator::Subtract => left - right,
                BinaryOperator::Multiply => left * right,
                BinaryOperator::Divide => left / right,
                BinaryOperator::Power => left.powf(right),
            })
        }
        _ => None,
    }
}
