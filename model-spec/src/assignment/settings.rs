//! Reads assignments to parameters, and returns the units of states.

use super::Assignment;
use super::quantity_reader::QuantityReader;
use crate::diagnostic::{Diagnostics, quote};
use crate::model::{Model, ParameterValue};
use crate::unit::Unit;

impl Model {
    /// Returns the values of assignments to parameters, in the declared units. Each expression uses
    /// the values set before it.
    ///
    /// # Errors
    /// An unknown parameter, and errors of [`QuantityReader::read`].
    pub fn read_settings(&self, given: &[Assignment]) -> Result<Vec<(String, f64)>, Diagnostics> {
        let mut set = Vec::with_capacity(given.len());
        let mut model = self.clone();
        for assignment in given {
            let name = assignment.name();
            let Some(place) = model.parameters.iter().position(|known| known.name == name) else {
                let message = format!("the model has no parameter {}", quote(name));
                return Err(assignment.name_error(message, Some(self.suggest_parameters(name))));
            };
            let unit = model.parameters[place].unit.clone();
            let value = QuantityReader::new(&model)?.read(assignment, &unit)?;
            model.parameters[place].value = ParameterValue::Number(unit.to_si(value));
            set.push((name.to_owned(), value));
        }
        Ok(set)
    }

    /// Returns the units of the states at these orders: coordinates and modes, their rates, states
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
        let rates: Vec<Unit> = units.iter().filter_map(Unit::rate_unit).collect();
        units.extend(rates);
        units.extend(self.states.iter().map(|state| state.unit.clone()));
        units
    }
}
