//! Initial state and inputs of the motions of a sweep.

use eomgen_compiled_model::{Error, Instance, StateRequest, StepInputs};
use eomgen_sim::inputs::HeldInputs;

use crate::measure::Failure;

/// Initial state and inputs of the motions of a sweep. Without requests these are the initial state of the
/// specification and its default inputs.
#[derive(Default)]
pub struct Conditions {
    /// Requested initial state.
    pub state: StateRequest,
    /// Requested inputs, if they are not definitions of the model.
    pub inputs: InputSource,
}

/// Source of the inputs.
#[derive(Default)]
pub enum InputSource {
    /// Default inputs of the model.
    #[default]
    Default,
    /// Expressions that are constant between steps, and the parameters that are equal at all points, in
    /// declared units.
    Steps(StepInputs, Vec<(String, f64)>),
    /// A record.
    Record(HeldInputs),
}

/// Start of the motion at a point.
pub struct Start {
    /// Initial state, SI; it may violate constraints.
    pub state: Vec<f64>,
    /// Inputs of the motion.
    pub inputs: HeldInputs,
}

impl Conditions {
    /// Returns the times of the record in s, if a record gives the inputs.
    pub fn record_times(&self) -> Option<&[f64]> {
        match &self.inputs {
            InputSource::Record(record) => Some(record.times()),
            _ => None,
        }
    }

    /// Returns the start of every motion, in s.
    pub fn start(&self) -> f64 {
        let first = self.record_times().and_then(|times| times.first());
        first.copied().unwrap_or(0.0)
    }

    /// Returns the end of the inputs, in s.
    pub fn end(&self) -> Option<f64> {
        self.record_times()?.last().copied()
    }

    /// Returns true if inputs vary between samples, so that no motion is solved exactly.
    pub fn are_time_varying(&self) -> bool {
        matches!(&self.inputs, InputSource::Record(record) if record.is_time_varying())
    }

    /// Returns the start of the motion at a point; `settings` are its varied parameters in declared units.
    ///
    /// # Errors
    /// [`Failure::Parameters`] for inadmissible values, [`Failure::Undefined`] if there is no equilibrium.
    pub fn start_at(
        &self,
        instance: &Instance<'_>,
        settings: &[(&str, f64)],
    ) -> Result<Start, Failure> {
        let inputs = match &self.inputs {
            InputSource::Default => instance.default_inputs(),
            InputSource::Steps(steps, set) => {
                let set = set.iter().map(|(name, value)| (&**name, *value));
                let all: Vec<(&str, f64)> = set.chain(settings.iter().copied()).collect();
                steps.held(&all)?
            }
            InputSource::Record(record) => record.clone(),
        };
        let (state, _) = instance
            .requested_state(&self.state)
            .map_err(|error| match error {
                Error::Stopped { .. } => Failure::Undefined,
                error => error.into(),
            })?;
        Ok(Start { state, inputs })
    }
}
