//! Interface of sampled controllers.

pub use eomgen_model_spec::schedule::Schedule;

/// Values before a sample, SI.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'s> {
    /// Time of the sample, s.
    pub t: f64,
    /// State of the model.
    pub state: &'s [f64],
    /// Inputs just before the sample.
    pub inputs: &'s [f64],
    /// Observables with these inputs; `energy` and `power` are the last two.
    pub observables: &'s [f64],
}

/// Controller with sample times, whose outputs are inputs of the model. An output acts after the delay of the schedule
/// and is held until the next one acts.
pub trait SampledController {
    /// Returns the sample times.
    fn schedule(&self) -> Schedule;

    /// Returns the indices of the driven inputs.
    fn driven_inputs(&self) -> &[usize];

    /// Computes the outputs, in the order of [`SampledController::driven_inputs`], and the new states.
    ///
    /// # Errors
    /// The reason why the motion cannot continue, as a sentence without the time.
    fn sample(&mut self, at: &Sample<'_>, outputs: &mut [f64]) -> Result<(), String>;

    /// Returns the controller states after the last sample, SI.
    fn states(&self) -> &[f64] {
        &[]
    }

    /// Sets the controller states, SI, from which to continue. Controllers without states ignore them.
    fn set_states(&mut self, _states: &[f64]) {}

    /// Returns the names of the states.
    fn state_names(&self) -> Vec<String> {
        Vec::new()
    }
}

impl<C: SampledController + ?Sized> SampledController for &mut C {
    fn schedule(&self) -> Schedule {
        (**self).schedule()
    }

    fn driven_inputs(&self) -> &[usize] {
        (**self).driven_inputs()
    }

    fn sample(&mut self, at: &Sample<'_>, outputs: &mut [f64]) -> Result<(), String> {
        (**self).sample(at, outputs)
    }

    fn states(&self) -> &[f64] {
        (**self).states()
    }

    fn set_states(&mut self, states: &[f64]) {
        (**self).set_states(states);
    }

    fn state_names(&self) -> Vec<String> {
        (**self).state_names()
    }
}
