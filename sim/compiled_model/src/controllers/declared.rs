//! Controllers of a specification at given parameter values.

use eomgen_codegen::program::{ControlValues, MeasuredSource, Program, ProgramController};
use eomgen_model_spec::schedule::Schedule;

use super::controller::{Sample, SampledController};
use crate::error::Error;
#[cfg(feature = "derive")]
use crate::instance::Instance;

/// Controller of a specification, at the parameter values of an instance.
#[derive(Clone, Debug)]
pub struct DeclaredController {
    controller: ProgramController,
    schedule: Schedule,
    /// Independent parameters, SI.
    parameters: Vec<f64>,
    states: Vec<f64>,
    /// Measured quantities at the last sample.
    measured: Vec<f64>,
    /// Results of all operations at the last sample.
    results: Vec<f64>,
}

#[cfg(feature = "derive")]
impl Instance<'_> {
    /// Returns the controllers of the specification in their initial states.
    ///
    /// # Errors
    /// Inadmissible times or initial states at the parameter values of the instance.
    pub fn controllers(&self) -> Result<Vec<DeclaredController>, Error> {
        let model = self.model().model();
        let declared = model.controllers.iter();
        for controller in declared {
            let checked = controller.schedule(self.values()).map(drop);
            let checked = checked.and_then(|()| controller.initial_states(self.values()));
            checked.map_err(|error| Error::from_model_error(model, error))?;
        }
        DeclaredController::all(self.model().program(), self.parameters())
    }
}

impl DeclaredController {
    /// Returns the controllers of a program at independent parameters (SI) in their initial states.
    ///
    /// # Errors
    /// Inadmissible times or initial states at `parameters`.
    pub(crate) fn all(program: &Program, parameters: &[f64]) -> Result<Vec<Self>, Error> {
        let controllers = program.controllers.iter();
        let started = controllers.map(|controller| Self::start(controller, parameters));
        started.collect()
    }

    fn start(controller: &ProgramController, parameters: &[f64]) -> Result<Self, Error> {
        let ([period, offset, delay], states) = controller.start(parameters);
        let schedule = Schedule {
            period,
            offset,
            delay,
        };
        let name = &controller.name;
        if let Some((what, value, rule)) = schedule.find_fault() {
            return Err(Error::Request(format!(
                "the {what} of the controller `{name}` is {value} s: give {rule}"
            )));
        }
        let mut named = controller.states.iter().zip(&states);
        if let Some((state, value)) = named.find(|(_, value)| !value.is_finite()) {
            return Err(Error::Request(format!(
                "the initial value of `{}` of the controller `{name}` is {value}",
                state.name
            )));
        }
        Ok(Self {
            controller: controller.clone(),
            schedule,
            parameters: parameters.to_vec(),
            states,
            measured: Vec::new(),
            results: Vec::new(),
        })
    }
}

impl SampledController for DeclaredController {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn driven_inputs(&self) -> &[usize] {
        &self.controller.driven
    }

    fn sample(&mut self, at: &Sample<'_>, outputs: &mut [f64]) -> Result<(), String> {
        let measured = self.controller.sources.iter().map(|source| match *source {
            MeasuredSource::Time => at.t,
            MeasuredSource::State(place) => at.state[place],
            MeasuredSource::Input(place) => at.inputs[place],
            MeasuredSource::Observable(place) => at.observables[place],
        });
        self.measured.clear();
        self.measured.extend(measured);
        let given = ControlValues {
            parameters: &self.parameters,
            period: self.schedule.period,
            measured: &self.measured,
            states: &self.states,
        };
        self.controller.evaluate(given, &mut self.results);
        let owner = &self.controller.name;
        let finite = |place: usize, what: &str, name: &str| match self.results[place] {
            value if value.is_finite() => Ok(value),
            value => Err(format!(
                "{what} `{name}` of the controller `{owner}` is {value}"
            )),
        };
        let values = self.controller.output_values.iter();
        let named = values.zip(&self.controller.outputs);
        for (slot, (place, output)) in outputs.iter_mut().zip(named) {
            *slot = finite(*place, "the output", &output.name)?;
        }
        let values = self.controller.next.iter();
        let named = values.zip(&self.controller.states);
        // If the sample fails, no state is changed.
        let next = named.map(|(place, state)| finite(*place, "the state", &state.name));
        let next = next.collect::<Result<Vec<f64>, String>>()?;
        self.states.copy_from_slice(&next);
        Ok(())
    }

    fn states(&self) -> &[f64] {
        &self.states
    }

    fn set_states(&mut self, states: &[f64]) {
        self.states.copy_from_slice(states);
    }

    fn state_names(&self) -> Vec<String> {
        let states = self.controller.states.iter();
        states.map(|state| state.name.clone()).collect()
    }
}
