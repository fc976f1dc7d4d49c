//! Simulation with samples; the results have the form of those of the general solver.

use super::error::ExactError;
use super::flow::Flow;
use super::follow::Samples;
use super::propagator::{Change, Follow, Motion, Propagator, Segment};
use crate::inputs::HeldInputs;
use crate::ode::{Event, ObservedStep, Trajectory};

/// Observer of the steps of the exact solver; the boolean is true if a surface holds the motion.
pub type StepObserver<'o> = dyn FnMut(&mut ObservedStep<'_>, bool) + 'o;

impl Propagator {
    /// Simulates from `initial` over `span` (begin, end; s) and returns the states at `samples`
    /// (s, ascending, inside the span). Calls `progress` with the time reached, at every event and
    /// in between. There is no tolerance: samples and events are exact up to rounding.
    ///
    /// # Errors
    /// An invalid request, a regime that cannot be prepared, or events faster than
    /// [`Propagator::max_switch_rate`].
    pub fn simulate(
        &mut self,
        initial: &[f64],
        span: (f64, f64),
        samples: &[f64],
        inputs: &HeldInputs,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Trajectory, ExactError> {
        let mut trajectory = Trajectory::default();
        let request = (initial, span, samples);
        self.simulate_into(&mut trajectory, request, inputs, progress)?;
        Ok(trajectory)
    }

    /// Simulates like [`Propagator::simulate`] into an empty `trajectory`, which keeps all results
    /// up to an error. The request is the initial state, the span and the samples.
    ///
    /// # Errors
    /// Same as [`Propagator::simulate`].
    pub fn simulate_into(
        &mut self,
        trajectory: &mut Trajectory,
        request: (&[f64], (f64, f64), &[f64]),
        inputs: &HeldInputs,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), ExactError> {
        self.simulate_observed(trajectory, request, inputs, (progress, None))
    }

    /// Simulates like [`Propagator::simulate_into`] with an observer of the steps.
    ///
    /// # Errors
    /// Same as [`Propagator::simulate`].
    pub fn simulate_observed(
        &mut self,
        trajectory: &mut Trajectory,
        (initial, span, samples): (&[f64], (f64, f64), &[f64]),
        inputs: &HeldInputs,
        (progress, observer): (&mut dyn FnMut(f64), Option<&mut StepObserver<'_>>),
    ) -> Result<(), ExactError> {
        let samples = Samples::new(span, samples)?;
        let mut motion = self.start(span.0, initial, inputs)?;
        let request = (span.1, samples, Some(initial));
        self.record_until(
            &mut motion,
            request,
            inputs,
            (progress, observer),
            trajectory,
        )
    }

    /// Continues a motion to the time `until` (s). Adds the states at `samples` (s, ascending, after the time
    /// reached), the events and the statistics to `trajectory`. Reports progress and steps to the observers.
    ///
    /// # Errors
    /// Same as [`Propagator::simulate`].
    pub fn continue_motion(
        &mut self,
        motion: &mut Motion,
        (until, samples): (f64, &[f64]),
        inputs: &HeldInputs,
        trajectory: &mut Trajectory,
        observer: (&mut dyn FnMut(f64), Option<&mut StepObserver<'_>>),
    ) -> Result<(), ExactError> {
        let samples = Samples::new((motion.time(), until), samples)?;
        let request = (until, samples, None);
        self.record_until(motion, request, inputs, observer, trajectory)
    }

    fn record_until(
        &mut self,
        motion: &mut Motion,
        (until, samples, initial): (f64, Samples<'_>, Option<&[f64]>),
        inputs: &HeldInputs,
        (progress, observer): (&mut dyn FnMut(f64), Option<&mut StepObserver<'_>>),
        trajectory: &mut Trajectory,
    ) -> Result<(), ExactError> {
        let before = motion.effort.clone();
        let mut recorder = Recorder {
            samples,
            events: Vec::new(),
            progress,
            observer,
        };
        if let Some(initial) = initial {
            recorder.samples.store_until(motion.time(), initial);
        }
        let ended = self.follow_until(motion, until, inputs, &mut recorder);
        if ended.is_ok() {
            // The last switch may be at the end of the span, up to rounding.
            recorder.samples.store_until(until, motion.state());
        }
        trajectory.times.append(&mut recorder.samples.times);
        trajectory.states.append(&mut recorder.samples.states);
        trajectory.events.append(&mut recorder.events);
        trajectory.final_state = motion.state().to_vec();
        trajectory.statistics.steps += motion.effort.steps - before.steps;
        trajectory.statistics.trial_steps += motion.effort.newton - before.newton;
        ended
    }
}

/// Stores samples and records events.
struct Recorder<'s, 'o> {
    samples: Samples<'s>,
    events: Vec<Event>,
    progress: &'s mut dyn FnMut(f64),
    observer: Option<&'s mut StepObserver<'o>>,
}

impl Recorder<'_, '_> {
    fn observe(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        let Some(observer) = &mut self.observer else {
            return;
        };
        let begin = segment.start.time();
        let mut state_after = |after: f64| {
            let mut state = vec![0.0; segment.state.len()];
            flow.state_at(segment.regime, after, &mut state);
            state
        };
        let end = state_after(segment.tau);
        let mut step = ObservedStep {
            start: (begin, segment.state),
            end: (segment.start.advanced_by(segment.tau).time(), &end),
            state_inside: &mut |t, _| Some(state_after((t - begin).clamp(0.0, segment.tau))),
        };
        observer(&mut step, segment.is_held);
    }
}

impl Follow for Recorder<'_, '_> {
    fn observe_segment(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        self.observe(segment, flow);
        while let Some(after) = self.samples.time_to_next(segment) {
            self.samples.store_next(segment, after, flow);
        }
        (self.progress)(segment.start.advanced_by(segment.tau).time());
    }

    fn observe_switch(&mut self, change: &Change<'_>) {
        let (before, after) = change.cells;
        let cells = change.families.iter().zip(before.iter().zip(after));
        for (family, (from, to)) in cells.filter(|(_, (from, to))| from != to) {
            self.events
                .extend(family.mode_changes(*from, *to, change.t));
        }
    }
}
