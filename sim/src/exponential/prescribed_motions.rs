//! Prescribed motions among the inputs. Each is a cubic between its samples. The integrator treats it, its rate
//! and its second derivative as states, and holds its third derivative between samples, so the steps are exact.

use std::borrow::Cow;

use eomgen_codegen::program::affine::AffineEvaluator;

use crate::inputs::HeldInputs;

/// Prescribed motions of a model.
#[derive(Clone, Debug)]
pub(super) struct PrescribedMotions {
    /// Index of each prescribed motion among the inputs. Its rates follow it.
    places: Vec<usize>,
    /// Number of states of the model. The states of prescribed motions follow them.
    model_states: usize,
}

impl PrescribedMotions {
    pub fn new(evaluator: &AffineEvaluator) -> Self {
        Self {
            places: evaluator.prescribed_states().to_vec(),
            model_states: evaluator.model_states(),
        }
    }

    /// Sets the states of prescribed motions at `t` (s) from the cubics at the time `piece` (s), and the inputs
    /// at the indices of second derivatives to the third derivatives.
    pub fn set(
        &self,
        inputs: &HeldInputs,
        (t, piece): (f64, f64),
        state: &mut [f64],
        values: &mut [f64],
    ) {
        let states = state[self.model_states..].chunks_exact_mut(3);
        for (place, state) in self.places.iter().zip(states) {
            let [motion @ .., third] = inputs.evaluate_prescribed(*place, t, piece);
            state.copy_from_slice(&motion);
            values[place + 2] = third;
        }
    }

    /// Returns the part of a state that belongs to the model.
    pub fn model_state<'s>(&self, state: &'s [f64]) -> &'s [f64] {
        &state[..self.model_states]
    }

    /// Returns the inputs of the model, with prescribed motions from a state.
    pub fn model_inputs<'i>(&self, state: &[f64], inputs: &'i [f64]) -> Cow<'i, [f64]> {
        if self.places.is_empty() {
            return Cow::Borrowed(inputs);
        }
        let mut inputs = inputs.to_vec();
        let states = state[self.model_states..].chunks_exact(3);
        for (place, state) in self.places.iter().zip(states) {
            inputs[*place..place + 3].copy_from_slice(state);
        }
        Cow::Owned(inputs)
    }
}
