//! Reads assignments to parameters, and returns the units of states.

use super::Assignment;
use super::quantity_reader::{QuantityReader, find_unit_start};
use crate::diagnostic::{Diagnostics, quote};
use crate::lexer::{TokenKind, tokenize};
use crate::model::{Expr, ExprKind, Model, ParameterValue};
use crate::order::{Reference, sort_by_references};
use crate::span::Span;
use crate::unit::Unit;

impl Model {
    /// Returns the values of assignments to parameters, in the declared units and the given order. An expression uses
    /// the assigned values of other parameters, and the declared value of the parameter that it sets. The order of
    /// the assignments has no effect.
    ///
    /// # Errors
    /// A parameter is unknown, or assignments refer to each other; also errors of [`QuantityReader::read`].
    pub fn read_settings(&self, given: &[Assignment]) -> Result<Vec<(String, f64)>, Diagnostics> {
        let places = given
            .iter()
            .map(|assignment| self.find_assigned(assignment));
        let places = places.collect::<Result<Vec<usize>, Diagnostics>>()?;
        let references = (0..given.len()).map(|index| self.find_references(given, &places, index));
        let references: Vec<Vec<Reference>> = references.collect();
        let order = sort_by_references(&references).map_err(|cycle| cycle_error(given, &cycle))?;
        let mut values = vec![0.0; given.len()];
        let mut model = self.clone();
        for index in order {
            let unit = model.parameters[places[index]].unit.clone();
            let value = QuantityReader::new(&model)?.read(&given[index], &unit)?;
            model.parameters[places[index]].value = ParameterValue::Number(unit.to_si(value));
            values[index] = value;
        }
        let names = given.iter().map(|assignment| assignment.name().to_owned());
        Ok(names.zip(values).collect())
    }

    /// Returns the index of the parameter that an assignment sets.
    fn find_assigned(&self, assignment: &Assignment) -> Result<usize, Diagnostics> {
        let name = assignment.name();
        let place = self.parameters.iter().position(|known| known.name == name);
        place.ok_or_else(|| {
            let message = format!("the model has no parameter {}", quote(name));
            assignment.name_error(message, Some(self.suggest_parameters(name)))
        })
    }

    /// Returns the other assignments to which an assignment refers, directly or through declared expressions of
    /// parameters that are not assigned.
    fn find_references(
        &self,
        given: &[Assignment],
        places: &[usize],
        index: usize,
    ) -> Vec<Reference> {
        let names = named_in_value(&given[index]).into_iter();
        let mut open: Vec<usize> = names
            .filter_map(|name| self.parameters.iter().position(|known| known.name == name))
            .collect();
        let (mut seen, mut found) = (vec![false; self.parameters.len()], Vec::new());
        while let Some(place) = open.pop() {
            if std::mem::replace(&mut seen[place], true) {
                continue;
            }
            match places.iter().position(|assigned| *assigned == place) {
                Some(other) if other != index => found.push((other, given[index].value)),
                _ => {
                    if let ParameterValue::Expression(value) = &self.parameters[place].value {
                        open.extend(parameters_of(value));
                    }
                }
            }
        }
        found
    }

    /// Returns the units of the states at these orders: coordinates and modes, their rates, and first-order states.
    pub fn state_units(&self, orders: &[usize]) -> Vec<Unit> {
        let mut units: Vec<Unit> = self
            .coordinates
            .iter()
            .map(|known| known.unit.clone())
            .collect();
        for (field, order) in self.fields.iter().zip(orders) {
            units.extend(std::iter::repeat_n(field.unit.clone(), *order));
        }
        let rates: Vec<Unit> = units.iter().filter_map(Unit::rate_unit).collect();
        units.extend(rates);
        units.extend(self.states.iter().map(|state| state.unit.clone()));
        units
    }
}

/// Returns the names in the value of an assignment.
fn named_in_value(assignment: &Assignment) -> Vec<String> {
    let tokens = tokenize(assignment.value(), Span::new).unwrap_or_default();
    let end = find_unit_start(&tokens);
    let names = tokens.into_iter().take(end);
    names
        .filter_map(|token| match token.kind {
            TokenKind::Name(name) => Some(name),
            _ => None,
        })
        .collect()
}

/// Returns the indices of the parameters in an expression.
fn parameters_of(value: &Expr) -> Vec<usize> {
    let mut found = Vec::new();
    value.visit(&mut |part| {
        if let ExprKind::Parameter(index) = part.kind {
            found.push(index.index());
        }
    });
    found
}

/// Returns the error for assignments that refer to each other.
fn cycle_error(given: &[Assignment], cycle: &[Reference]) -> Diagnostics {
    let names: Vec<String> = cycle
        .iter()
        .map(|(index, _)| quote(given[*index].name()))
        .collect();
    let message = format!("the values of {} refer to each other", names.join(", "));
    let help = "give one of them as a number";
    given[cycle.first().map_or(0, |(index, _)| *index)].name_error(message, Some(help.to_owned()))
}
