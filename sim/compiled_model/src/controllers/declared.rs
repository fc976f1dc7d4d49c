//! Controllers of a specification at parameter values.

use eomgen_model_spec::control::Schedule;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::{Controller, MeasuredQuantity};

use super::controller::{Sample, SampledController};
use crate::error::Error;
use crate::instance::Instance;

/// Source of a measured quantity.
#[derive(Clone, Copy, Debug)]
enum Measured {
    Constant(f64),
    Time,
    State(usize),
    Input(usize),
    Observable(usize),
    Own(usize),
}

/// Controller of a specification, at the parameter values of an instance.
#[derive(Clone, Debug)]
pub struct DeclaredController {
    controller: Controller,
    schedule: Schedule,
    measured: Vec<Measured>,
    driven: Vec<usize>,
    /// Names of the driven inputs.
    inputs: Vec<String>,
    states: Vec<f64>,
    /// Values of the measured quantities at the last sample.
    values: Vec<f64>,
}

impl Instance<'_> {
    /// Returns the controllers of the specification in their initial states.
    ///
    /// # Errors
    /// Inadmissible times at these parameter values, and a mode that does not exist at the order of the model.
    pub fn controllers(&self) -> Result<Vec<DeclaredController>, Error> {
        let declared = &self.model().model().controllers;
        declared
            .iter()
            .map(|controller| self.controller(controller))
            .collect()
    }

    fn controller(&self, controller: &Controller) -> Result<DeclaredController, Error> {
        let model = self.model().model();
        let refused = |error| Error::from_model_error(model, error);
        let schedule = controller.schedule(self.values()).map_err(refused)?;
        let states = controller.initial_states(self.values()).map_err(refused)?;
        let measured = controller.measured.iter();
        let measured = measured.map(|quantity| self.find_measured(quantity, schedule.period));
        let driven = controller.outputs.iter().map(|output| output.input.index());
        let inputs = controller.outputs.iter();
        let inputs = inputs.map(|output| model.inputs[output.input].name.clone());
        Ok(DeclaredController {
            schedule,
            measured: measured.collect::<Result<_, _>>()?,
            driven: driven.collect(),
            inputs: inputs.collect(),
            states,
            values: vec![0.0; controller.measured.len()],
            controller: controller.clone(),
        })
    }

    fn find_measured(&self, quantity: &MeasuredQuantity, period: f64) -> Result<Measured, Error> {
        let model = self.model().model();
        Ok(match quantity {
            MeasuredQuantity::Time => Measured::Time,
            MeasuredQuantity::Period => Measured::Constant(period),
            MeasuredQuantity::Parameter(id) => {
                let value = self.values().get(id.index()).copied();
                Measured::Constant(value.unwrap_or(f64::NAN))
            }
            MeasuredQuantity::Input(id) => Measured::Input(id.index()),
            MeasuredQuantity::Own(place) => Measured::Own(*place),
            MeasuredQuantity::Observable(name) => {
                let names = self.model().observable_names();
                let place = names.iter().position(|known| known == name);
                place.map_or(Measured::Constant(f64::NAN), Measured::Observable)
            }
            part => {
                let name = part.state_name(model).unwrap_or_default();
                let names = self.model().state_names();
                match names.iter().position(|known| *known == name) {
                    Some(place) => Measured::State(place),
                    None => return Err(self.missing_mode_error(part, &name)),
                }
            }
        })
    }

    fn missing_mode_error(&self, part: &MeasuredQuantity, name: &str) -> Error {
        let model = self.model().model();
        let mut diagnostic = Diagnostic::error(format!("the model has no mode `{name}`"));
        if let MeasuredQuantity::Mode {
            field,
            number,
            span,
            ..
        } = part
        {
            let order = self.model().orders().get(*field).copied().unwrap_or(0);
            let name = model.fields.get(*field).map_or("", |field| &*field.name);
            diagnostic = diagnostic
                .with_span(*span, format!("the field `{name}` has {order} modes here"))
                .with_help(format!("give an order of {number} or more"));
        }
        Diagnostics::from_one(model.source.clone(), diagnostic).into()
    }
}

impl SampledController for DeclaredController {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn driven_inputs(&self) -> &[usize] {
        &self.driven
    }

    fn sample(&mut self, at: &Sample<'_>, outputs: &mut [f64]) -> Result<(), String> {
        for (value, measured) in self.values.iter_mut().zip(&self.measured) {
            *value = match *measured {
                Measured::Constant(value) => value,
                Measured::Time => at.t,
                Measured::State(place) => at.state[place],
                Measured::Input(place) => at.inputs[place],
                Measured::Observable(place) => at.observables[place],
                Measured::Own(place) => self.states[place],
            };
        }
        let owner = &self.controller.name;
        let finite = |value: f64, what: &str, name: &str| match value.is_finite() {
            true => Ok(value),
            false => Err(format!(
                "{what} `{name}` of the controller `{owner}` is {value}"
            )),
        };
        for ((slot, output), name) in outputs
            .iter_mut()
            .zip(&self.controller.outputs)
            .zip(&self.inputs)
        {
            *slot = finite(output.value.evaluate(&self.values), "the output", name)?;
        }
        for (slot, state) in self.states.iter_mut().zip(&self.controller.states) {
            *slot = finite(state.next.evaluate(&self.values), "the state", &state.name)?;
        }
        Ok(())
    }

    fn states(&self) -> &[f64] {
        &self.states
    }

    fn state_names(&self) -> Vec<String> {
        let states = self.controller.states.iter();
        states.map(|state| state.name.clone()).collect()
    }
}
