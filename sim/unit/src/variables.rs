//! Access to variables by value reference.

use crate::layout::Variable;
use crate::rejection::{Outcome, Rejection, invalid, unavailable};
use crate::unit::{BEFORE_START, Kind, Mode, Unit};

/// Modes in which inputs and parameters may be set. Parameters may also be set in continuous-time mode: callers
/// that use the unit as a function set all arguments.
const SETTABLE_MODES: u8 =
    BEFORE_START | Mode::Event as u8 | Mode::Continuous as u8 | Mode::Step as u8;

/// Results at the current point, computed at their first use.
#[derive(Default)]
struct Computed {
    rates: Option<Vec<f64>>,
    observables: Option<Vec<f64>>,
    indicators: Option<Vec<f64>>,
    controller_states: Option<Vec<f64>>,
}

impl Unit {
    /// Returns the variable with a value reference.
    pub fn find(&self, reference: u32) -> Outcome<Variable> {
        let found = usize::try_from(reference)
            .ok()
            .and_then(|place| self.layout.find(place));
        found.ok_or_else(|| {
            invalid(format!(
                "there is no variable with the value reference {reference}"
            ))
        })
    }

    fn name(&self, variable: Variable) -> String {
        let program = self.compiled.program();
        match variable {
            Variable::Time => "time".to_owned(),
            Variable::State(place) => self.compiled.state_names()[place].clone(),
            Variable::Rate(place) => format!("der({})", self.compiled.state_names()[place]),
            Variable::Input(place) => program.inputs[place].name.clone(),
            Variable::Parameter(place) => program.parameters[place].quantity.name.clone(),
            Variable::Observable(place) => program.observables[place].name.clone(),
            Variable::Indicator(place) => format!("indicator[{}]", place + 1),
            Variable::ControllerState(place) => self.compiled.model().controller_states()[place]
                .0
                .to_owned(),
        }
    }

    /// Returns the rejection of a value of a variable.
    fn reject_value(&self, variable: Variable, value: f64, why: &str) -> Rejection {
        invalid(format!("{} = {value:?}: {why}", self.name(variable)))
    }

    /// Writes the values of the variables with these references.
    pub fn get_values(&mut self, references: &[u32], values: &mut [f64]) -> Outcome {
        let mut computed = Computed::default();
        for (reference, slot) in references.iter().zip(values) {
            let variable = self.find(*reference)?;
            let value = self.value(variable, &mut computed)?;
            if !value.is_finite() {
                let name = self.name(variable);
                return Err(unavailable(format!(
                    "{name} = {value:?}: not a finite number"
                )));
            }
            *slot = value;
        }
        Ok(())
    }

    fn value(&mut self, variable: Variable, computed: &mut Computed) -> Outcome<f64> {
        Ok(match variable {
            Variable::Time => self.now.t,
            Variable::State(place) => self.now.state[place],
            Variable::Input(place) => self.now.inputs[place],
            Variable::Parameter(place) => self.now.parameters[place],
            Variable::Rate(place) => compute(&mut computed.rates, || self.rates())?[place],
            Variable::Observable(place) => {
                compute(&mut computed.observables, || self.observables())?[place]
            }
            Variable::Indicator(place) => {
                compute(&mut computed.indicators, || self.indicators())?[place]
            }
            Variable::ControllerState(place) => {
                compute(&mut computed.controller_states, || self.controller_states())?[place]
            }
        })
    }

    /// Sets all variables with these references, or none if a value is invalid.
    pub fn set_values(&mut self, references: &[u32], values: &[f64]) -> Outcome {
        for (reference, value) in references.iter().zip(values) {
            self.check_value(*reference, *value)?;
        }
        for (reference, value) in references.iter().zip(values) {
            match self.find(*reference)? {
                Variable::State(place) => {
                    self.now.state[place] = *value;
                    self.now.surface_modes.clear();
                    self.forget_motion();
                }
                Variable::Input(place) if self.now.inputs[place] != *value => {
                    self.now.inputs[place] = *value;
                    self.follow_inputs();
                }
                Variable::Parameter(place) if self.now.parameters[place] != *value => {
                    // A sample at this time precedes the change.
                    if self.now.mode == Mode::Event && self.instance.is_some() {
                        self.take_samples()?;
                    }
                    self.keep_resting_modes();
                    self.now.parameters[place] = *value;
                    self.forget_parameters();
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Checks that a variable may be set to a value in the current mode.
    fn check_value(&self, reference: u32, value: f64) -> Outcome {
        let variable = self.find(reference)?;
        let modes = match variable {
            Variable::State(_) if self.kind == Kind::ModelExchange => {
                BEFORE_START | Mode::Event as u8 | Mode::Continuous as u8
            }
            Variable::State(_) => BEFORE_START,
            Variable::Input(place) if self.compiled.model().is_controlled(place) => {
                let why = "a controller in the FMU drives this input";
                return Err(self.reject_value(variable, value, why));
            }
            Variable::Input(_) => SETTABLE_MODES,
            Variable::Parameter(place) => {
                let (min, max) = self.bounds(place);
                if min.is_some_and(|min| value < min) {
                    let why = "below the smallest admissible value";
                    return Err(self.reject_value(variable, value, why));
                }
                if max.is_some_and(|max| value > max) {
                    let why = "above the largest admissible value";
                    return Err(self.reject_value(variable, value, why));
                }
                SETTABLE_MODES
            }
            _ => 0,
        };
        if !self.is_in(modes) {
            let why = "it cannot be set in the current state of the FMU";
            return Err(self.reject_value(variable, value, why));
        }
        if !value.is_finite() {
            return Err(self.reject_value(variable, value, "not a finite number"));
        }
        Ok(())
    }

    /// Returns the bounds of an independent parameter, SI.
    fn bounds(&self, place: usize) -> (Option<f64>, Option<f64>) {
        let name = &self.compiled.program().parameters[place].quantity.name;
        let mut declared = self.compiled.model().parameters.iter();
        let known = declared.find(|known| known.name == *name);
        known.map_or((None, None), |known| (known.min, known.max))
    }

    /// Checks that a vector has `expected` entries.
    pub fn check_length(length: usize, expected: usize, what: &str) -> Outcome {
        match length == expected {
            true => Ok(()),
            false => Err(invalid(format!(
                "{length} {what}, but the FMU has {expected}"
            ))),
        }
    }

    /// Sets the continuous states.
    pub fn set_states(&mut self, states: &[f64]) -> Outcome {
        Self::check_length(states.len(), self.layout.states, "continuous states")?;
        if let Some(place) = states.iter().position(|entry| !entry.is_finite()) {
            let why = "not a finite number";
            let rejection = self.reject_value(Variable::State(place), states[place], why);
            return Err(unavailable(rejection.message));
        }
        self.now.state.copy_from_slice(states);
        Ok(())
    }

    /// Sets the time, s.
    pub fn set_time(&mut self, t: f64) -> Outcome {
        if !t.is_finite() {
            return Err(self.reject_value(Variable::Time, t, "not a finite number"));
        }
        self.now.t = t;
        Ok(())
    }

    /// Returns the rates if all are finite.
    pub fn finite_rates(&mut self) -> Outcome<Vec<f64>> {
        let rates = self.rates()?;
        match rates.iter().all(|rate| rate.is_finite()) {
            true => Ok(rates),
            false => Err(unavailable(
                "a rate is not finite: the state is too large, or the mass matrix is not positive definite",
            )),
        }
    }

    /// Returns the event indicators if all are finite.
    pub fn finite_indicators(&mut self) -> Outcome<Vec<f64>> {
        let indicators = self.indicators()?;
        match indicators.iter().all(|value| value.is_finite()) {
            true => Ok(indicators),
            false => Err(unavailable("an event indicator is not finite")),
        }
    }
}

/// Returns the numbers in `slot`, computed at the first use.
fn compute(
    slot: &mut Option<Vec<f64>>,
    values: impl FnOnce() -> Outcome<Vec<f64>>,
) -> Outcome<&[f64]> {
    if slot.is_none() {
        *slot = Some(values()?);
    }
    Ok(slot.as_deref().unwrap_or_default())
}
