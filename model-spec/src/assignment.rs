//! Quantities given beside a specification, as `NAME=VALUE` of an option: read as the specification reads
//! its own.
//!
//! A plain number is in the unit of what is set. Any other value is an expression of parameters and
//! constants, in SI and of the right unit, as `pi/3` or `2*l`; or it has a unit of its own behind it, as
//! `30 deg` or `2*sqrt(2) mm`.

use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use crate::dimension::Dimension;
use crate::document;
use crate::evaluate::evaluate;
use crate::expression::{Resolver, Scope};
use crate::infer::{Inference, Words};
use crate::lexer::{Token, TokenKind, tokens};
use crate::model::{Expr, Model, ParameterValue};
use crate::names::Names;
use crate::parser::parse;
use crate::source::Source;
use crate::space;
use crate::span::Span;
use crate::unit::Unit;

/// The parts of `NAME=VALUE`, with their places.
#[derive(Clone, Debug)]
pub struct Assignment {
    source: Source,
    name: Span,
    value: Span,
}

impl Assignment {
    /// Splits the text of an option; `option` stands for the file in messages, as `--set` does.
    ///
    /// # Errors
    /// There is no `=`, or nothing beside it.
    pub fn split(option: &str, text: &str) -> Result<Self, Diagnostics> {
        let source = Source::new(option, text);
        let trimmed = |start: usize, end: usize| {
            let part = &text[start..end];
            let start = start + part.len() - part.trim_start().len();
            Span::new(start, start + part.trim().len())
        };
        let parts = text
            .find('=')
            .map(|at| [trimmed(0, at), trimmed(at + 1, text.len())]);
        match parts {
            Some([name, value]) if name.start < name.end && value.start < value.end => Ok(Self {
                source,
                name,
                value,
            }),
            _ => {
                let message = format!("{option} {text}: expected NAME=VALUE");
                let wrong = Diagnostic::error(message).at(Span::new(0, text.len()), "");
                let help = "VALUE is a number, an expression of parameters, or one with a unit: k=2*k_0, \
                            theta=pi/3, theta=\"30 deg\"";
                Err(Diagnostics::one(source, wrong.help(help)))
            }
        }
    }

    /// What is set.
    pub fn name(&self) -> &str {
        &self.source.text[self.name.start..self.name.end]
    }

    /// The whole text.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// The finding that the name is wrong.
    pub fn refuse_name(&self, message: String, help: Option<String>) -> Diagnostics {
        let wrong = Diagnostic::error(message).at(self.name, "").help_if(help);
        Diagnostics::one(self.source.clone(), wrong)
    }

    fn value(&self) -> &str {
        &self.source.text[self.value.start..self.value.end]
    }

    fn place(&self, start: usize, end: usize) -> Span {
        Span::new(self.value.start + start, self.value.start + end)
    }
}

/// Reads quantities by the names and parameter values of a model.
pub struct QuantityReader<'m> {
    model: &'m Model,
    names: Names,
    values: Vec<f64>,
}

impl<'m> QuantityReader<'m> {
    /// A reader at the parameter values of the model.
    ///
    /// # Errors
    /// As [`crate::check`], of a model that was changed by hand.
    pub fn new(model: &'m Model) -> Result<Self, Diagnostics> {
        let mut document = document::read(&model.source)?;
        space::expand(&mut document, &model.source)?;
        let mut found = Diagnostics::new(model.source.clone());
        let names = Names::declare(&document, &mut found);
        match found.is_empty() {
            true => Ok(Self {
                values: model.evaluated_parameters(),
                model,
                names,
            }),
            false => Err(found),
        }
    }

    /// The value of an assignment, in the unit of what it sets.
    ///
    /// # Errors
    /// What is no expression, a name that is not known, a unit that does not fit, a value that is not finite;
    /// each with its place in the option.
    pub fn read(&self, given: &Assignment, unit: &Unit) -> Result<f64, Diagnostics> {
        let value = self.value(given, unit);
        let finite = value.and_then(|value| match value.is_finite() {
            true => Ok(value),
            false => {
                let message = format!("{}: `{}` comes out as {value}", given.text(), given.name());
                Err(Diagnostic::error(message)
                    .at(given.value, "")
                    .help("expected a finite number"))
            }
        });
        finite.map_err(|wrong| Diagnostics::one(given.source.clone(), wrong))
    }

    fn value(&self, given: &Assignment, unit: &Unit) -> Result<f64, Diagnostic> {
        let text = given.value();
        if let Ok(number) = text.parse::<f64>() {
            return Ok(number);
        }
        let all = tokens(text, |start, end| given.place(start, end))?;
        let split = unit_start(&all);
        let (expression, own) = all.split_at(split);
        let end = own
            .first()
            .map_or(given.value.end, |token| token.span.start);
        let syntax = parse(expression, Span::new(end, given.value.end.max(end)))?;
        let value = Resolver::new(&self.names, Scope::Parameters).resolve(&syntax)?;
        let dimension = self.dimension(&value)?;
        let number = evaluate(&value, &self.values);
        match own.first() {
            Some(first) => {
                let place = Span::new(first.span.start, given.value.end);
                let written = &given.source.text[place.start..place.end];
                self.in_unit(given, number, dimension, value.span, (written, place), unit)
            }
            None => in_si(given, number, dimension, &syntax, unit),
        }
    }

    fn dimension(&self, value: &Expr) -> Result<Option<Dimension>, Diagnostic> {
        let inference = Inference {
            model: self.model,
            definitions: Vec::new(),
            coefficients: Vec::new(),
        };
        inference.infer(value)
    }

    /// A number with a unit of its own.
    fn in_unit(
        &self,
        given: &Assignment,
        number: f64,
        dimension: Option<Dimension>,
        place: Span,
        (written, written_place): (&str, Span),
        unit: &Unit,
    ) -> Result<f64, Diagnostic> {
        if let Some(dimension) = dimension.filter(|dimension| !dimension.is_none()) {
            return Err(Diagnostic::error(format!(
                "this value is {} without a unit",
                Words(dimension)
            ))
            .at(place, Words(dimension).to_string())
            .also(written_place, "a second unit")
            .help("leave the unit out: parameters have theirs"));
        }
        let own = Unit::parse(written).map_err(|error| {
            Diagnostic::error(error.message)
                .at(written_place, "not a unit")
                .help_if(error.help)
        })?;
        if own.dimension != unit.dimension {
            let message = format!("`{}` is in {unit}, not in {own}", given.name());
            return Err(Diagnostic::error(message)
                .at(written_place, "another kind of quantity")
                .help(format!("give a unit such as {unit}")));
        }
        Ok(match own == *unit {
            true => number,
            false => unit.from_si(own.to_si(number)),
        })
    }
}

/// An expression without a unit behind it, which is in SI.
fn in_si(
    given: &Assignment,
    number: f64,
    dimension: Option<Dimension>,
    syntax: &Syntax,
    unit: &Unit,
) -> Result<f64, Diagnostic> {
    match dimension {
        None => Ok(unit.from_si(number)),
        Some(own) if own == unit.dimension => Ok(unit.from_si(number)),
        Some(own) if own.is_none() && unit.is_coherent() && holds_no_names(syntax) => Ok(number),
        Some(own) => {
            let message = format!(
                "the value of `{}` is {}, expected in {unit}",
                given.name(),
                Words(own)
            );
            let help = match own.is_none() {
                true => format!(
                    "write the unit behind it: {}=\"{} {unit}\"",
                    given.name(),
                    given.value()
                ),
                false => format!(
                    "parameters have their units; expected {}",
                    Words(unit.dimension)
                ),
            };
            Err(Diagnostic::error(message)
                .at(syntax.span, Words(own).to_string())
                .help(help))
        }
    }
}

/// Where a unit begins behind an expression: at an operand that follows another without an operator.
fn unit_start(tokens: &[Token]) -> usize {
    let ends = |kind: &TokenKind| {
        matches!(
            kind,
            TokenKind::Number(_) | TokenKind::Name(_) | TokenKind::Close
        )
    };
    let begins = |kind: &TokenKind| matches!(kind, TokenKind::Number(_) | TokenKind::Name(_));
    let mut pairs = tokens.windows(2);
    let found = pairs.position(|pair| ends(&pair[0].kind) && begins(&pair[1].kind));
    found.map_or(tokens.len(), |place| place + 1)
}

fn holds_no_names(tree: &Syntax) -> bool {
    let mut none = true;
    tree.visit(&mut |part| {
        none &= !matches!(&part.kind, SyntaxKind::Name(name) if name != "pi");
    });
    none
}

impl Model {
    /// The values of assignments to parameters, one after the other, in the units that the specification
    /// declares; an expression sees what was set before it.
    ///
    /// # Errors
    /// A name that no parameter has, and as [`QuantityReader::read`].
    pub fn read_settings(&self, given: &[Assignment]) -> Result<Vec<(String, f64)>, Diagnostics> {
        let mut set = Vec::with_capacity(given.len());
        let mut model = self.clone();
        for assignment in given {
            let name = assignment.name();
            let Some(place) = model.parameters.iter().position(|known| known.name == name) else {
                let message = format!("the model has no parameter {}", quoted(name));
                return Err(assignment.refuse_name(message, Some(self.parameters_like(name))));
            };
            let unit = model.parameters[place].unit.clone();
            let value = QuantityReader::new(&model)?.read(assignment, &unit)?;
            model.parameters[place].value = ParameterValue::Number(unit.to_si(value));
            set.push((name.to_owned(), value));
        }
        Ok(set)
    }

    /// The units of the states at these orders, in their order: coordinates and modes, their rates, states
    /// of first order.
    pub fn state_units(&self, orders: &[usize]) -> Vec<Unit> {
        let mut units: Vec<Unit> = self
            .coordinates
            .iter()
            .map(|known| known.unit.clone())
            .collect();
        for (field, order) in self.fields.iter().zip(orders) {
            units.extend(std::iter::repeat_n(field.unit.clone(), *order));
        }
        let rates: Vec<Unit> = units.iter().filter_map(Unit::per_second).collect();
        units.extend(rates);
        units.extend(self.states.iter().map(|state| state.unit.clone()));
        units
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 500, unit = "mm" }
a = { value = 30, unit = "deg" }
r = { value = 3 }
d = { value = "l/r", unit = "mm" }
[coordinates]
theta = { unit = "rad" }
x = { unit = "m" }
[kinetic]
mass = "1/2*m*l^2*dot(theta)^2*r + 1/2*m*dot(x)^2"
[observables]
kept = "a + d/l"
"#;

    fn model() -> Model {
        crate::check(Source::new("pendulum.toml", TEXT))
            .expect("a model")
            .model
    }

    fn read(text: &str, unit: &str) -> Result<f64, String> {
        let model = model();
        let given = Assignment::split("--at", text).map_err(|error| error.to_string())?;
        let unit = Unit::parse(unit).expect("a unit");
        let reader = QuantityReader::new(&model).expect("a reader");
        reader
            .read(&given, &unit)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn values_are_numbers_expressions_or_have_a_unit() {
        use std::f64::consts::PI;
        for (text, unit, right) in [
            ("theta=0.5", "rad", 0.5),
            ("theta = -1e-3", "rad", -1e-3),
            ("theta=pi", "rad", PI),
            ("theta=30 deg", "rad", PI / 6.0),
            ("theta=-(10 + 20) deg", "rad", -PI / 6.0),
            ("theta=a", "rad", PI / 6.0),
            ("theta=2*pi/3", "rad", 2.0 * PI / 3.0),
            ("theta=pi rad", "rad", PI),
            ("x=2*l", "m", 1.0),
            ("x=250 mm", "m", 0.25),
            ("x=1/4", "m", 0.25),
            ("u=3 N m", "N m", 3.0),
            ("u=2 kN mm", "N m", 2.0),
            ("l=1/3 m", "mm", 1000.0 / 3.0),
            ("l=250 mm", "mm", 250.0),
            ("l=250", "mm", 250.0),
            ("l=l/2", "mm", 250.0),
            ("a=pi/2", "deg", 90.0),
            ("a=2", "deg", 2.0),
        ] {
            let found = read(text, unit).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert!(
                (found - right).abs() <= 1e-15 * right.abs().max(1.0),
                "{text}: {found}"
            );
        }
    }

    #[test]
    fn wrong_values_are_refused_with_their_place() {
        for (text, unit, parts) in [
            ("theta", "rad", &["expected NAME=VALUE"][..]),
            ("theta=", "rad", &["expected NAME=VALUE"]),
            (
                "theta=2*pii",
                "rad",
                &["--at:1:9", "unknown name `pii`", "`pi`"],
            ),
            ("theta=2*", "rad", &["--at:1:9"]),
            ("theta=30 mm", "rad", &["--at:1:10", "in rad, not in mm"]),
            (
                "theta=30 degs",
                "rad",
                &["--at:1:10", "unknown unit `degs`"],
            ),
            ("x=a", "m", &["--at:1:3", "a pure number"]),
            ("x=m", "m", &["--at:1:3", "in kg"]),
            (
                "x=2*l mm",
                "m",
                &["--at:1:3", "a second unit", "leave the unit out"],
            ),
            ("l=1/3", "mm", &["--at:1:3", "1/3 mm"]),
            ("x=nan", "m", &["finite"]),
            ("x=1/0", "m", &["finite"]),
            ("x=theta", "m", &["--at:1:3", "a coordinate"]),
            ("x=1=2", "m", &["--at:1:4"]),
            ("x=3 (2)", "m", &["--at:1:5"]),
        ] {
            let error = read(text, unit).expect_err(text);
            for part in parts {
                assert!(
                    error.contains(part),
                    "{text}: {part} is missing in\n{error}"
                );
            }
        }
    }

    #[test]
    fn settings_see_those_before_them() {
        let model = model();
        let given = ["l=1 m", "m=2*m", "d=l/4", "l=d"].map(|text| Assignment::split("--set", text));
        let given = given.map(|given| given.expect("an assignment"));
        let found = model.read_settings(&given).expect("settings");
        let values: Vec<f64> = found.iter().map(|(_, value)| *value).collect();
        assert_eq!(values, [1000.0, 4.0, 250.0, 250.0]);
        let wrong = Assignment::split("--set", "ll=1").expect("an assignment");
        let error = model
            .read_settings(&[wrong])
            .expect_err("no such parameter")
            .to_string();
        assert!(
            error.contains("--set:1:1") && error.contains("did you mean `l`"),
            "{error}"
        );
    }
}
