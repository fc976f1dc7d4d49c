//! Sampled controllers: difference equations of measured quantities, with outputs that are inputs of the model. `read`
//! reads their entries, `resolve` their names, `units` checks units, `expression` evaluates.

mod expression;
mod names;
mod read;
mod resolve;
mod units;

pub(crate) use read::read_controller;
pub(crate) use resolve::resolve_controller;
pub(crate) use units::check_units;

use crate::evaluate::evaluate;
use crate::model::{Controller, Model, SampledExpression};
pub use crate::schedule::Schedule;
use crate::unit::Unit;
use crate::variant::ModelError;

impl Controller {
    /// Returns the times for parameter values in SI.
    ///
    /// # Errors
    /// The period is not positive, or the offset or delay is negative. Errors have a position in the text.
    pub fn schedule(&self, parameters: &[f64]) -> Result<Schedule, ModelError> {
        let times = [&self.period, &self.offset, &self.delay];
        let [period, offset, delay] =
            times.map(|time| time.unit.to_si(evaluate(&time.value, parameters)));
        let schedule = Schedule {
            period,
            offset,
            delay,
        };
        let Some((what, value, rule)) = schedule.find_fault() else {
            return Ok(schedule);
        };
        let message = format!("the {what} of the controller `{}` is {value} s", self.name);
        let place = match what {
            "period" => &self.period,
            "offset" => &self.offset,
            _ => &self.delay,
        };
        Err(ModelError::new(message)
            .help(format!("give {rule}"))
            .at(place.span))
    }

    /// Returns the initial values of the states for parameter values in SI.
    ///
    /// # Errors
    /// A value is not finite.
    pub fn initial_states(&self, parameters: &[f64]) -> Result<Vec<f64>, ModelError> {
        let states = self.states.iter().map(|state| {
            let Some(initial) = &state.initial else {
                return Ok(0.0);
            };
            match evaluate(initial, parameters) {
                value if value.is_finite() => Ok(value),
                value => {
                    let message = format!("the initial value of `{}` is {value}", state.name);
                    Err(ModelError::new(message)
                        .help("give a finite number")
                        .at(initial.span))
                }
            }
        });
        states.collect()
    }

    /// Returns all expressions over sampled quantities.
    pub fn expressions(&self) -> impl Iterator<Item = &SampledExpression> {
        let outputs = self.outputs.iter().map(|output| &output.value);
        self.states.iter().map(|state| &state.next).chain(outputs)
    }
}

impl Model {
    /// Returns names and units of the states of all controllers, in the order of the specification.
    pub fn controller_states(&self) -> Vec<(&str, &Unit)> {
        let states = self.controllers.iter().flat_map(|known| &known.states);
        states.map(|state| (&*state.name, &state.unit)).collect()
    }

    /// Returns true if a controller drives an input.
    pub fn is_controlled(&self, input: usize) -> bool {
        let mut outputs = self.controllers.iter().flat_map(|known| &known.outputs);
        outputs.any(|output| output.input.index() == input)
    }

    /// Rejects a model with controllers. `what` names the computation that does not support controllers.
    ///
    /// # Errors
    /// The model has a controller; the error names the first one.
    pub fn reject_controllers(&self, what: &str) -> Result<(), ModelError> {
        self.controllers.first().map_or(Ok(()), |controller| {
            let message = format!(
                "the model has controllers (`{}`), which {what} does not support",
                controller.name
            );
            Err(ModelError::new(message)
                .help("use `eomgen simulate`, or remove [controllers]")
                .at(controller.span))
        })
    }

    /// Checks the times and initial states of all controllers.
    pub(crate) fn check_controllers(&self, parameters: &[f64]) -> Result<(), ModelError> {
        for controller in &self.controllers {
            controller.schedule(parameters)?;
            controller.initial_states(parameters)?;
        }
        Ok(())
    }
}
