//! Derivatives of a motion with respect to its initial state. One propagator serves many motions
//! at the same parameters, so that each regime is prepared once.

use super::error::ExactError;
use super::flow::Flow;
use super::follow::Samples;
use super::propagator::{Change, Follow, Propagator, Segment};
use super::tangent::Tangents;
use crate::inputs::HeldInputs;

/// States at the samples and their derivatives with respect to the initial state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensitivities {
    /// Times of the samples, s.
    pub times: Vec<f64>,
    /// State at each sample.
    pub states: Vec<Vec<f64>>,
    /// Derivative of the state for each sample and each direction.
    pub derivatives: Vec<Vec<Vec<f64>>>,
}

impl Propagator {
    /// Simulates from `initial` over `span` (begin, end; s). `directions` are changes of the initial state.
    /// Returns states and derivatives at `samples` (s, ascending).
    ///
    /// # Errors
    /// Same as [`Propagator::simulate`].
    pub fn simulate_with_derivatives(
        &mut self,
        initial: &[f64],
        span: (f64, f64),
        samples: &[f64],
        inputs: &HeldInputs,
        directions: Vec<Vec<f64>>,
    ) -> Result<Sensitivities, ExactError> {
        let samples = Samples::new(span, samples)?;
        let mut motion = self.start(span.0, initial, inputs)?;
        let mut carrier = Carrier {
            samples,
            tangents: Tangents::new(directions),
            at_sample: Tangents::default(),
            derivatives: Vec::new(),
        };
        carrier.store_until(span.0, initial);
        self.follow_until(&mut motion, span.1, inputs, &mut carrier)?;
        carrier.store_until(span.1, motion.state());
        Ok(Sensitivities {
            times: carrier.samples.times,
            states: carrier.samples.states,
            derivatives: carrier.derivatives,
        })
    }
}

/// Propagates directions and stores them at samples.
struct Carrier<'s> {
    samples: Samples<'s>,
    tangents: Tangents,
    /// Scratch memory: directions at a sample within a segment.
    at_sample: Tangents,
    derivatives: Vec<Vec<Vec<f64>>>,
}

impl Carrier<'_> {
    /// Stores the samples until a time at which state and directions are known.
    fn store_until(&mut self, t: f64, state: &[f64]) {
        self.samples.store_until(t, state);
        let taken = self.samples.times.len();
        self.derivatives
            .resize(taken, self.tangents.vectors.clone());
    }
}

impl Follow for Carrier<'_> {
    fn observe_segment(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        // Inputs change at samples, so the last sample of a segment is usually at its end.
        let mut at_end = false;
        while let Some(after) = self.samples.time_to_next(segment) {
            self.samples.store_next(segment, after, flow);
            if after >= segment.tau {
                at_end = true;
                break;
            }
            self.at_sample.vectors.clone_from(&self.tangents.vectors);
            self.at_sample.advance(segment.regime, after);
            self.derivatives.push(self.at_sample.vectors.clone());
        }
        self.tangents.advance(segment.regime, segment.tau);
        if at_end {
            self.derivatives.push(self.tangents.vectors.clone());
        }
    }

    fn observe_switch(&mut self, change: &Change<'_>) {
        self.tangents.switch(change);
    }
}
