//! Operating points: time, state and inputs, set by name.

use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::foreign::suggest_state;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::CompiledModel;

/// Time, state and inputs, SI, in the order of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatingPoint {
    /// Time, s.
    pub t: f64,
    /// Coordinates and modes, their rates, then first-order states.
    pub state: Vec<f64>,
    /// Inputs.
    pub inputs: Vec<f64>,
}

impl OperatingPoint {
    /// Returns the point as an argument of evaluators.
    pub fn point(&self) -> Point<'_> {
        Point {
            t: self.t,
            state: &self.state,
            inputs: &self.inputs,
        }
    }
}

/// Quantity of an operating point that can be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// Time.
    Time,
    /// State, by its index.
    State(usize),
    /// Input, by its index.
    Input(usize),
}

impl CompiledModel {
    /// Finds the quantity with a name: a coordinate, mode, rate, first-order state, input, or `t`.
    ///
    /// # Errors
    /// An unknown name.
    pub fn find_setting(&self, name: &str) -> Result<Setting, Error> {
        let states = self.state_names();
        if let Some(place) = states.iter().position(|known| known == name) {
            return Ok(Setting::State(place));
        }
        let mut inputs = self.model().inputs.iter();
        if let Some(place) = inputs.position(|known| known.name == name) {
            return Ok(Setting::Input(place));
        }
        if name == "t" {
            return Ok(Setting::Time);
        }
        let inputs = self.model().inputs.iter().map(|input| &*input.name);
        let known = states.iter().map(|name| &**name).chain(inputs);
        let help = suggest_state(name, known)
            .unwrap_or_else(|| format!("there are {}", self.settable_names().join(", ")));
        Err(Error::Request(format!(
            "the model `{}` has no state and no input `{name}`: {help}",
            self.model().name
        )))
    }

    fn settable_names(&self) -> Vec<String> {
        let inputs = self.model().inputs.iter().map(|input| input.name.clone());
        self.state_names()
            .into_iter()
            .take(20)
            .chain(inputs)
            .collect()
    }
}

impl Instance<'_> {
    /// Returns the initial state of the specification at time 0 with the default inputs, changed
    /// by `settings` (SI).
    ///
    /// # Errors
    /// An unknown name, or a value that is not finite.
    pub fn operating_point(&self, settings: &[(&str, f64)]) -> Result<OperatingPoint, Error> {
        let mut point = OperatingPoint {
            t: 0.0,
            state: self.initial_state().to_vec(),
            inputs: self.model().default_inputs(),
        };
        for (name, value) in settings {
            if !value.is_finite() {
                let message = format!("{name} = {value}: expected a finite number");
                return Err(Error::Request(message));
            }
            match self.model().find_setting(name)? {
                Setting::Time => point.t = *value,
                Setting::State(place) => point.state[place] = *value,
                Setting::Input(place) => point.inputs[place] = *value,
            }
        }
        Ok(point)
    }
}
