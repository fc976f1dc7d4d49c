//! Initial state and inputs of the motions of a sweep.

use eomgen_compiled_model::{Error, ExpressionInputs, Instance, StateRequest};
use eomgen_sim::inputs::HeldInputs;

use crate::measure::Failure;

/// Initial state and inputs of the motions of a sweep.
pub struct Conditions {
    /// Requested initial state.
    pub state: StateRequest,
    /// Inputs given by expressions.
    pub inputs: ExpressionInputs,
    /// Parameters of these expressions that have the same value at all points, in declared units.
    pub settings: Vec<(String, f64)>,
    /// Record of the other inputs. Without a record these inputs have their default values.
    pub record: Option<HeldInputs>,
}

/// Initial state and inputs of the motion at a point.
pub struct Start {
    /// Initial state, SI; it may violate constraints.
    pub state: Vec<f64>,
    /// Inputs of the motion.
    pub inputs: HeldInputs,
}

impl Conditions {
    /// Returns the times of the record in s; `None` without a record.
    pub fn record_times(&self) -> Option<&[f64]> {
        self.record.as_ref().map(HeldInputs::times)
    }

    /// Returns the start time of every motion, in s.
    pub fn start(&self) -> f64 {
        let first = self.record_times().and_then(|times| times.first());
        first.copied().unwrap_or(0.0)
    }

    /// Returns the end of the inputs, in s.
    pub fn end(&self) -> Option<f64> {
        self.record_times()?.last().copied()
    }

    /// Returns true if inputs vary between samples. The exact solver does not support such inputs.
    pub fn are_time_varying(&self) -> bool {
        let record = self.record.as_ref();
        self.inputs.are_time_varying() || record.is_some_and(HeldInputs::is_time_varying)
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
        let set = self.settings.iter();
        let set = set.map(|(name, value)| (&**name, *value));
        let all: Vec<(&str, f64)> = set.chain(settings.iter().copied()).collect();
        let others = || match &self.record {
            Some(record) => Ok::<_, Error>(record.clone()),
            None => Ok(instance.default_inputs()),
        };
        let inputs = self.inputs.at(&all, others)?;
        let (state, _) = instance
            .requested_state(&self.state)
            .map_err(|error| match error {
                Error::Stopped { .. } => Failure::Undefined,
                error => error.into(),
            })?;
        Ok(Start { state, inputs })
    }
}
