//! A simulation with samples, in the form that the general solver gives.

use super::error::ExactError;
use super::flow::Flow;
use super::propagator::{Change, Follow, Propagator, Segment};
use crate::record::HeldInputs;
use crate::solve::{SolveError, Trajectory};

impl Propagator {
    /// Simulates from `initial` over `span` (begin, end; s) and returns the states at
    /// `samples` (s, ascending, inside the span). `progress` is called with the time after
    /// every switch.
    ///
    /// There is no tolerance: samples and switches are right up to rounding.
    ///
    /// # Errors
    /// If the request makes no sense, a regime cannot be prepared, or switches come faster
    /// than [`Propagator::max_switch_rate`].
    pub fn simulate(
        &mut self,
        initial: &[f64],
        span: (f64, f64),
        samples: &[f64],
        inputs: &HeldInputs,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Trajectory, ExactError> {
        check(span, samples)?;
        let mut motion = self.start(span.0, initial, inputs)?;
        let mut recorder = Recorder {
            samples,
            trajectory: Trajectory::default(),
            states: self.states(),
        };
        recorder.take(span.0, initial);
        while motion.time() < span.1 {
            let reached = self.advance(&mut motion, span.1, inputs, &mut recorder)?;
            progress(motion.time());
            if reached {
                break;
            }
        }
        // The last switch may stand at the end, up to rounding.
        recorder.take(span.1, motion.state());
        let mut trajectory = recorder.trajectory;
        trajectory.last = motion.state().to_vec();
        trajectory.work.steps = motion.effort.steps;
        trajectory.work.trials = motion.effort.newton;
        Ok(trajectory)
    }
}

/// Takes samples and notes switches.
struct Recorder<'s> {
    samples: &'s [f64],
    trajectory: Trajectory,
    states: usize,
}

impl Recorder<'_> {
    /// The samples until a time at which the state is known.
    fn take(&mut self, t: f64, state: &[f64]) {
        while let Some(&sample) = self.next().filter(|sample| **sample <= t) {
            self.trajectory.times.push(sample);
            self.trajectory.states.push(state.to_vec());
        }
    }

    fn next(&self) -> Option<&f64> {
        self.samples.get(self.trajectory.times.len())
    }
}

impl Follow for Recorder<'_> {
    fn flowed(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        while let Some(&sample) = self.next() {
            let after = segment.start.until(sample);
            if after > segment.tau {
                return;
            }
            flow.go_to(segment.regime, after);
            let mut state = vec![0.0; self.states];
            flow.state(segment.regime, &mut state);
            self.trajectory.times.push(sample);
            self.trajectory.states.push(state);
        }
    }

    fn switched(&mut self, change: &Change<'_>) {
        self.trajectory.switches.push(change.switch);
    }
}

pub(super) fn check((begin, end): (f64, f64), samples: &[f64]) -> Result<(), SolveError> {
    let ascending = samples.windows(2).all(|pair| pair[0] <= pair[1]);
    let inside = samples.iter().all(|t| (begin..=end).contains(t));
    if begin.is_finite() && end.is_finite() && begin <= end && ascending && inside {
        return Ok(());
    }
    Err(SolveError::Request {
        problem: format!(
            "expected a finite span and samples that ascend within {begin:?} s to {end:?} s"
        ),
    })
}
