//! Propagation of a motion to a given time, with samples on the way.

use super::error::ExactError;
use super::flow::Flow;
use super::propagator::{Follow, Motion, Propagator, Segment};
use crate::inputs::HeldInputs;
use crate::ode::SolveError;

impl Propagator {
    /// Propagates the motion to a time, s, through all switches before it.
    pub(super) fn follow_until(
        &mut self,
        motion: &mut Motion,
        end: f64,
        inputs: &HeldInputs,
        follow: &mut dyn Follow,
    ) -> Result<(), ExactError> {
        while motion.time() < end && !self.advance(motion, end, inputs, follow)? {}
        Ok(())
    }
}

/// States at given times.
pub(super) struct Samples<'s> {
    wanted: &'s [f64],
    /// Times of the samples stored so far, s.
    pub times: Vec<f64>,
    /// State at each of these times.
    pub states: Vec<Vec<f64>>,
}

impl<'s> Samples<'s> {
    /// Creates samples at the times `wanted`, s, which must ascend within the span (begin, end; s).
    pub fn new((begin, end): (f64, f64), wanted: &'s [f64]) -> Result<Self, SolveError> {
        let ascending = wanted.windows(2).all(|pair| pair[0] <= pair[1]);
        let inside = wanted.iter().all(|t| (begin..=end).contains(t));
        if begin.is_finite() && end.is_finite() && begin <= end && ascending && inside {
            return Ok(Self {
                wanted,
                times: Vec::with_capacity(wanted.len()),
                states: Vec::with_capacity(wanted.len()),
            });
        }
        Err(SolveError::Request {
            problem: format!(
                "expected a finite span and samples that ascend within {begin:?} s to {end:?} s"
            ),
        })
    }

    /// Stores the samples until a time at which the state is known.
    pub fn store_until(&mut self, t: f64, state: &[f64]) {
        while let Some(sample) = self.next().filter(|sample| *sample <= t) {
            self.times.push(sample);
            self.states.push(state.to_vec());
        }
    }

    /// Returns the time from the start of a segment to the next sample, s, if it is within the segment.
    pub fn time_to_next(&self, segment: &Segment<'_>) -> Option<f64> {
        let after = segment.start.time_until(self.next()?);
        (after <= segment.tau).then_some(after)
    }

    /// Stores the next sample, `after` s after the start of a segment.
    pub fn store_next(&mut self, segment: &Segment<'_>, after: f64, flow: &mut Flow) {
        let Some(sample) = self.next() else { return };
        let mut state = vec![0.0; segment.state.len()];
        flow.state_at(segment.regime, after, &mut state);
        self.times.push(sample);
        self.states.push(state);
    }

    fn next(&self) -> Option<f64> {
        self.wanted.get(self.times.len()).copied()
    }
}
