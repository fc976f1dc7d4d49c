//! Reads values of assignments, with the names and parameter values of a model.

use super::Assignment;
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dimension::Dimension;
use crate::document;
use crate::evaluate::evaluate;
use crate::expression::{Resolver, Scope};
use crate::infer::{Inference, UnitPhrase};
use crate::lexer::{Token, TokenKind, tokenize};
use crate::model::{Expr, Model};
use crate::names::Names;
use crate::parser::parse;
use crate::space;
use crate::span::Span;
use crate::unit::Unit;

/// Reader of quantities, with the names and parameter values of a model.
pub struct QuantityReader<'m> {
    model: &'m Model,
    names: Names,
    values: Vec<f64>,
}

impl<'m> QuantityReader<'m> {
    /// Creates a reader with the current parameter values of the model.
    ///
    /// # Errors
    /// As for [`crate::check`], if the model was changed by the caller.
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

    /// Returns the value of an assignment, in the unit of the quantity.
    ///
    /// # Errors
    /// The expression is invalid, a name is unknown, the unit does not match, or the value is not finite. Errors have
    /// a position in the option.
    pub fn read(&self, given: &Assignment, unit: &Unit) -> Result<f64, Diagnostics> {
        let value = self.value(given, unit);
        let checked = value.and_then(|value| check_magnitude(given, value, unit));
        checked.map_err(|wrong| Diagnostics::from_one(given.source.clone(), wrong))
    }

    fn value(&self, given: &Assignment, unit: &Unit) -> Result<f64, Diagnostic> {
        let text = given.value();
        let all = tokenize(text, |start, end| given.place(start, end))?;
        if let Ok(number) = text.parse::<f64>() {
            return Ok(number);
        }
        let split = find_unit_start(&all);
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
                self.convert_with_unit(given, number, dimension, value.span, (written, place), unit)
            }
            None => convert_from_si(given, number, dimension, &syntax, unit),
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

    /// Converts a number with an explicit unit to the unit of the quantity.
    fn convert_with_unit(
        &self,
        given: &Assignment,
        number: f64,
        dimension: Option<Dimension>,
        place: Span,
        (written, written_place): (&str, Span),
        unit: &Unit,
    ) -> Result<f64, Diagnostic> {
        if let Some(dimension) = dimension.filter(|dimension| !dimension.is_dimensionless()) {
            return Err(Diagnostic::error(format!(
                "this value is already {}",
                UnitPhrase(dimension)
            ))
            .with_span(place, UnitPhrase(dimension).to_string())
            .with_related_span(written_place, "a second unit")
            .with_help("remove the unit: the expression already has the unit of its parameters"));
        }
        let own = Unit::parse(written).map_err(|error| {
            Diagnostic::error(error.message)
                .with_span(written_place, "not a unit")
                .with_optional_help(error.help)
        })?;
        if own.dimension != unit.dimension {
            let message = format!("`{}` is in {unit}, not in {own}", given.name());
            return Err(Diagnostic::error(message)
                .with_span(written_place, "another kind of quantity")
                .with_help(format!("give a unit of the same dimension as {unit}")));
        }
        if own == *unit {
            return Ok(number);
        }
        let converted = unit.from_si(own.to_si(number));
        match converted == 0.0 && number != 0.0 {
            true => Err(underflow_error(given)),
            false => Ok(converted),
        }
    }
}

/// Rejects a value that is not finite, or that is 0 in SI by underflow only.
fn check_magnitude(given: &Assignment, value: f64, unit: &Unit) -> Result<f64, Diagnostic> {
    if !value.is_finite() {
        let message = format!("{}: `{}` evaluates to {value}", given.text(), given.name());
        return Err(Diagnostic::error(message)
            .with_span(given.value, "")
            .with_help("expected a finite number"));
    }
    match value != 0.0 && unit.to_si(value) == 0.0 {
        true => Err(underflow_error(given)),
        false => Ok(value),
    }
}

fn underflow_error(given: &Assignment) -> Diagnostic {
    Diagnostic::error(format!("the value of `{}` is too small", given.name()))
        .with_span(given.value, "below 4.9e-324 in SI, it would be read as 0")
}

/// Converts the value of an expression without an explicit unit, which is in SI, to the unit of the quantity.
fn convert_from_si(
    given: &Assignment,
    number: f64,
    dimension: Option<Dimension>,
    syntax: &Syntax,
    unit: &Unit,
) -> Result<f64, Diagnostic> {
    match dimension {
        None => Ok(unit.from_si(number)),
        Some(own) if own == unit.dimension => Ok(unit.from_si(number)),
        Some(own) if own.is_dimensionless() && unit.is_coherent() && has_no_names(syntax) => {
            Ok(number)
        }
        Some(own) => {
            let message = format!(
                "the value of `{}` is {}, expected in {unit}",
                given.name(),
                UnitPhrase(own)
            );
            let help = match own.is_dimensionless() {
                true => format!(
                    "write the unit after it: {}=\"{} {unit}\"",
                    given.name(),
                    given.value()
                ),
                false => format!(
                    "the expression has the unit of its parameters; expected {}",
                    UnitPhrase(unit.dimension)
                ),
            };
            Err(Diagnostic::error(message)
                .with_span(syntax.span, UnitPhrase(own).to_string())
                .with_help(help))
        }
    }
}

/// Returns the index of the first token of a unit: an operand that follows another without an
/// operator.
pub(crate) fn find_unit_start(tokens: &[Token]) -> usize {
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

fn has_no_names(tree: &Syntax) -> bool {
    let mut none = true;
    tree.visit(&mut |part| {
        none &= !matches!(&part.kind, SyntaxKind::Name(name) if name != "pi");
    });
    none
}
