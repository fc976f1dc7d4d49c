//! The loop of the solver: steps, samples, switches and limits.

use std::collections::VecDeque;

use super::approach::Approach;
use super::bernstein::BernsteinBasis;
use super::error::SolveError;
use super::event_search::Crossing;
use super::events::{Event, Jump, SurfaceMode};
use super::resolution::Resolution;
use super::settings::Settings;
use super::stepper::{Outcome, Point, Stepper, rejection_error};
use super::stiffness::StepRate;
use super::system::{Interior, System};
use super::trajectory::Trajectory;
use super::watch::WatchedSystem;

/// Maximum number of times that a step is shortened to resolve the switching functions. Finer changes of these
/// functions count as rounding.
const MAX_SHORTENINGS: u32 = 12;

/// Smallest factor by which a step is shortened; also the factor after a step that leaves the domain of the
/// rates.
pub(super) const SHORTENING_FACTOR: f64 = 0.2;

/// Number of samples in a step above which the dense output is tested.
const MAX_UNTESTED_SAMPLES: usize = 2;

/// Length of the first step after a jump of inputs or of the state, relative to the time to the next output. In
/// a much longer step, interpolated states would have the rounding error of its end.
const MAX_STEP_OVER_OUTPUT: f64 = 10.0;

/// Action after a step with an acceptable error.
pub(super) enum StepVerdict {
    /// The motion continues from the end of the step.
    Continues,
    /// The step was undone and is repeated with a shorter length.
    Shortened,
    /// The step crosses surfaces.
    Crossed(Crossing),
}

/// State of the loop that continues from one call to the next.
pub(super) struct Run<M> {
    pub(super) stepper: M,
    pub(super) resolution: Resolution,
    /// Last switches: time, s, and index of the switching function.
    pub(super) recent: VecDeque<(f64, usize)>,
    /// Current state after projection onto constraints, if the projection changes it.
    projected: Option<Vec<f64>>,
    /// Modes of the surfaces at the current point, and those before the last event.
    pub(super) modes: Vec<SurfaceMode>,
    earlier_modes: Vec<SurfaceMode>,
    /// True if the error scales include roundings of a motion at rest.
    has_roundings: bool,
    /// Surfaces whose event in the last step reversed the motion with a jump, as impacts do.
    pub(super) rebounds: Vec<usize>,
    /// Step that extends beyond the end of a call.
    pending: Option<PendingStep>,
    /// True if the next step is the first after a jump of inputs or of the state.
    follows_jump: bool,
}

/// Accepted step that extends beyond the end of a call. It was searched for crossings and projected onto
/// constraints; its end is not part of the motion yet.
#[derive(Clone, Copy)]
struct PendingStep {
    begin: f64,
    /// True if states inside the step are interpolated.
    is_interpolated: bool,
    /// Time up to which an observer has seen the step, s.
    observed: f64,
}

impl<M: Stepper> Run<M> {
    pub fn new(stepper: M, tolerance: f64) -> Self {
        Self {
            stepper,
            resolution: Resolution::new(tolerance),
            recent: VecDeque::new(),
            projected: None,
            modes: Vec::new(),
            earlier_modes: Vec::new(),
            has_roundings: false,
            rebounds: Vec::new(),
            pending: None,
            follows_jump: false,
        }
    }

    /// Returns the last point of the motion so far.
    pub fn last_point(&self) -> &Point {
        match self.pending {
            Some(_) => self.stepper.step_start(),
            None => self.stepper.current_point(),
        }
    }

    /// Discards a pending step and continues from another point.
    pub fn restart(&mut self, point: Point) {
        let step = self.stepper.step();
        if self.pending.take().is_some() {
            self.stepper.undo_step();
        }
        self.projected = None;
        self.follows_jump = true;
        self.stepper.restart(point, step);
    }
}

/// End of a call, and whether a step may pass it.
#[derive(Clone, Copy)]
pub(super) struct Span {
    /// End of the call, s.
    pub end: f64,
    /// True if a step may extend beyond the end.
    pub may_pass: bool,
}

/// Simulation in progress.
pub(super) struct Driver<'a, S: System + ?Sized, M: Stepper> {
    pub(super) watched: &'a WatchedSystem<'a, S>,
    pub(super) run: &'a mut Run<M>,
    pub(super) settings: &'a Settings,
    samples: &'a [f64],
    /// Number of samples stored.
    taken: usize,
    pub(super) end: f64,
    may_pass: bool,
    /// Latest end of the current step, s.
    pub(super) until: f64,
    pub(super) pace: StepRate,
    /// The last approaches to switching surfaces.
    pub(super) approaches: VecDeque<Approach>,
    pub(super) basis: BernsteinBasis,
    pub(super) trajectory: &'a mut Trajectory,
}

impl<'a, S: System + ?Sized, M: Stepper> Driver<'a, S, M> {
    pub fn new(
        watched: &'a WatchedSystem<'a, S>,
        run: &'a mut Run<M>,
        (span, samples): (Span, &'a [f64]),
        settings: &'a Settings,
        trajectory: &'a mut Trajectory,
    ) -> Self {
        let t = run.stepper.current_point().t;
        Self {
            watched,
            run,
            settings,
            samples,
            taken: 0,
            end: span.end,
            may_pass: span.may_pass,
            until: span.end,
            pace: StepRate::new(t),
            approaches: VecDeque::new(),
            basis: BernsteinBasis::new(),
            trajectory,
        }
    }

    /// Starts a motion: determines the modes and stores the samples at its first point.
    pub fn start(&mut self) {
        self.update_root_bands();
        self.watched.fix_sides(true);
        self.watched.write_modes(&mut self.run.modes);
        self.take_samples_here();
    }

    /// Simulates to the end of the call.
    ///
    /// # Errors
    /// See [`SolveError`]; the run keeps its last point.
    pub fn run_to_end(
        &mut self,
        system: &S,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), SolveError> {
        self.continue_pending_step()?;
        while self.run.stepper.current_point().t < self.end {
            self.advance(system)?;
            progress(self.run.stepper.current_point().t.min(self.end));
            self.check_stiffness(system)?;
        }
        Ok(())
    }

    /// Stores the samples inside a pending step, and accepts it if it ends before the end of the call.
    fn continue_pending_step(&mut self) -> Result<(), SolveError> {
        let Some(pending) = self.run.pending else {
            return Ok(());
        };
        if self.run.stepper.current_point().t > self.end {
            return self.take_inner_samples(pending, self.end.next_up());
        }
        self.run.pending = None;
        self.accept_pending(pending)
    }

    /// Returns the point at the end of the call, s.
    pub fn end_point(&mut self) -> Result<Point, SolveError> {
        let Some(pending) = self.run.pending else {
            return Ok(self.run.stepper.current_point().clone());
        };
        let y = self.state_inside(pending, self.end)?;
        let end = Point { t: self.end, y };
        self.observe_step(pending, &end)?;
        self.run.pending = Some(PendingStep {
            observed: end.t,
            ..pending
        });
        Ok(end)
    }

    /// Applies a jump of the inputs at the current point.
    pub fn follow_input_jump(&mut self) -> Result<(), SolveError> {
        let mut point = self.run.stepper.current_point().clone();
        if self.watched.apply_breakpoint(point.t, &mut point.y) {
            self.take_jump(point);
        }
        self.enter_regime()
    }

    /// Makes one accepted step, or steps to and over a switching surface.
    fn advance(&mut self, system: &S) -> Result<(), SolveError> {
        let begin = self.run.stepper.current_point().t;
        let next = system.next_breakpoint(begin).filter(|next| *next > begin);
        let farthest = next
            .unwrap_or(f64::INFINITY)
            .min(self.find_jump_limit(begin));
        let until = farthest.min(self.end);
        self.until = if self.may_pass { farthest } else { until };
        self.watched.limit_time(next.unwrap_or(f64::INFINITY));
        let mut shortened = 0;
        loop {
            self.limit_step();
            self.watched.restore_sides();
            self.update_roundings();
            if self.is_step_too_short() {
                return self.cross_close_surface();
            }
            let outcome = self.make_controlled_step(self.until)?;
            if outcome.is_accepted {
                let passes = self.run.stepper.current_point().t > self.end;
                match self.examine_step(outcome.length, shortened < MAX_SHORTENINGS) {
                    StepVerdict::Shortened => shortened += 1,
                    StepVerdict::Crossed(_) if passes => {
                        self.reject_pending(outcome.length);
                        self.until = until;
                    }
                    StepVerdict::Crossed(crossing) => return self.cross(&crossing, outcome.length),
                    StepVerdict::Continues if passes => return self.suspend_step(begin),
                    StepVerdict::Continues => return self.accept(begin),
                }
            }
            if self.watched.non_finite_state().is_some() {
                // The rates beyond the end of the call may be undefined.
                self.until = until;
            }
        }
    }

    /// Returns the latest end (s) of a step from `begin` that follows a jump.
    fn find_jump_limit(&self, begin: f64) -> f64 {
        let output = self.next_sample().map_or(self.end, |t| t.min(self.end));
        match self.run.follows_jump && output > begin {
            true => begin + MAX_STEP_OVER_OUTPUT * (output - begin),
            false => f64::INFINITY,
        }
    }

    /// Limits the next step to the maximum length of the settings.
    fn limit_step(&mut self) {
        if self.run.stepper.step() > self.settings.max_step {
            self.run.stepper.set_step(self.settings.max_step);
        }
    }

    /// Sets the rounding of the next step at rest, or resets it if the motion is no longer at rest.
    fn update_roundings(&mut self) {
        let is_at_rest =
            |mode: &SurfaceMode| matches!(mode, SurfaceMode::Held | SurfaceMode::Closed);
        let is_resting = self.run.modes.iter().any(is_at_rest);
        if !is_resting && !self.run.has_roundings {
            return;
        }
        self.run.has_roundings = is_resting;
        let mut rates = vec![0.0; self.run.stepper.current_point().y.len()];
        let length = self.run.stepper.step();
        if is_resting {
            self.watched.add_rate_roundings(length, &mut rates);
        }
        self.run
            .stepper
            .magnitudes_mut()
            .set_rate_roundings(&rates, length);
    }

    /// Passes the part of the last step up to `end` that was not observed yet to an observing system.
    fn observe_step(&mut self, step: PendingStep, end: &Point) -> Result<(), SolveError> {
        if !self.watched.is_observing() || end.t <= step.observed {
            return Ok(());
        }
        let mut start = self.run.stepper.step_start().clone();
        if step.observed > start.t {
            start = Point {
                t: step.observed,
                y: self.state_inside(step, step.observed)?,
            };
        }
        let (stepper, watched) = (&mut self.run.stepper, self.watched);
        let mut is_accurate = None;
        let mut inside = |t, interior| match interior {
            Interior::Interpolated => stepper.interpolate(watched, t),
            Interior::Recomputed => stepper.compute_state_at(watched, t),
            Interior::Accurate => {
                match *is_accurate.get_or_insert_with(|| stepper.has_smooth_interior(watched)) {
                    true => stepper.interpolate(watched, t),
                    false => stepper.compute_state_at(watched, t),
                }
            }
        };
        watched.observe_step(&start, end, &mut inside);
        Ok(())
    }

    /// Tries a step that ends at `until` at the latest.
    pub(super) fn make_controlled_step(&mut self, until: f64) -> Result<Outcome, SolveError> {
        self.check_steps()?;
        self.watched.clear_trial_errors();
        let mut outcome = self.run.stepper.advance(self.watched, until)?;
        if !outcome.is_accepted && self.watched.release_sides() {
            // The rates of the near side may be undefined beyond a surface.
            self.watched.clear_trial_errors();
            self.run.stepper.set_step(outcome.length);
            outcome = self.run.stepper.advance(self.watched, until)?;
        }
        if outcome.is_accepted && self.watched.non_finite_state().is_some() {
            // The step ends where the rates are undefined, which the motion cannot reach.
            self.reject_step(outcome.length);
            outcome.is_accepted = false;
        } else if !outcome.is_accepted {
            self.trajectory.statistics.rejected_steps += 1;
        }
        Ok(outcome)
    }

    /// Undoes an accepted step of `length` s, to repeat it with a shorter one.
    pub(super) fn reject_step(&mut self, length: f64) {
        self.run.stepper.undo_step();
        self.run.stepper.set_step(SHORTENING_FACTOR * length);
        self.trajectory.statistics.rejected_steps += 1;
    }

    /// Projects the current state onto the constraints. Returns false if the correction exceeds the error
    /// estimate by so much that the step did not meet the tolerance.
    pub(super) fn project(&mut self) -> bool {
        let here = self.run.stepper.current_point();
        let mut y = here.y.clone();
        self.run.projected = None;
        if !self.watched.project(here.t, &mut y) {
            return true;
        }
        let here = here.y.clone();
        let moved: Vec<f64> = y.iter().zip(&here).map(|(to, from)| to - from).collect();
        let mut is_corrected: Vec<bool> = moved.iter().map(|change| *change != 0.0).collect();
        self.watched.mark_corrected(&mut is_corrected);
        let magnitudes = self.run.stepper.magnitudes_mut();
        magnitudes.mark_corrections(&is_corrected, &here);
        let is_near = magnitudes.allow(moved.into_iter(), &here);
        self.run.projected = Some(y);
        is_near
    }

    /// Returns the state at `t` (s) inside the last step. It is interpolated if `may_interpolate` is true and the step
    /// crossed no surface.
    fn compute_state_at(&mut self, t: f64, may_interpolate: bool) -> Result<Vec<f64>, SolveError> {
        if may_interpolate && let Some(state) = self.run.stepper.interpolate(self.watched, t) {
            return Ok(state);
        }
        self.check_steps()?;
        self.trajectory.statistics.trial_steps += 1;
        self.watched.clear_trial_errors();
        let state = self.run.stepper.compute_state_at(self.watched, t);
        state.ok_or_else(|| {
            let start = self.run.stepper.step_start();
            rejection_error(self.watched, start, t - start.t)
        })
    }

    /// Undoes an accepted step of `length` s that extends beyond the end of the call.
    fn reject_pending(&mut self, length: f64) {
        self.run.stepper.undo_step();
        self.run.stepper.set_step(length);
        self.trajectory.statistics.rejected_steps += 1;
    }

    /// Stores the samples inside a step from `begin` (s) that extends beyond the end of the call, and makes the
    /// step pending.
    fn suspend_step(&mut self, begin: f64) -> Result<(), SolveError> {
        check_finite(begin, &self.run.stepper.current_point().y)?;
        let pending = PendingStep {
            begin,
            is_interpolated: self.has_accurate_interior(),
            observed: begin,
        };
        self.run.pending = Some(pending);
        self.take_inner_samples(pending, self.end.next_up())
    }

    /// Accepts the last step, which starts at `begin` (s).
    pub(super) fn accept(&mut self, begin: f64) -> Result<(), SolveError> {
        check_finite(begin, &self.run.stepper.current_point().y)?;
        let t = self.run.stepper.current_point().t;
        let is_interpolated = self.is_interpolated(t);
        self.accept_pending(PendingStep {
            begin,
            is_interpolated,
            observed: begin,
        })
    }

    /// Stores the samples inside a step, replaces its end by the projected state, and enters the regime at the
    /// end.
    fn accept_pending(&mut self, step: PendingStep) -> Result<(), SolveError> {
        self.run.stepper.settle(self.run.projected.is_some());
        self.run.follows_jump = false;
        self.trajectory.statistics.steps += 1;
        self.watched.clear_later_errors();
        let end = self.run.stepper.current_point().clone();
        self.observe_step(step, &end)?;
        let t = end.t;
        self.take_inner_samples(step, t)?;
        if let Some(y) = self.run.projected.take() {
            check_finite(step.begin, &y)?;
            self.run.stepper.correct(y);
            self.run.stepper.settle(false);
        }
        self.take_samples_here();
        self.pass_breakpoint();
        self.enter_regime()
    }

    /// Stores the samples before `end` (s) inside the last step.
    fn take_inner_samples(&mut self, step: PendingStep, end: f64) -> Result<(), SolveError> {
        while let Some(sample) = self.next_sample().filter(|sample| *sample < end) {
            let state = self.state_inside(step, sample)?;
            self.take_sample(sample, state);
        }
        Ok(())
    }

    /// Returns the state at a time (s) inside the last step.
    fn state_inside(&mut self, step: PendingStep, t: f64) -> Result<Vec<f64>, SolveError> {
        let mut state = self.compute_state_at(t, step.is_interpolated)?;
        self.watched.project(t, &mut state);
        check_finite(step.begin, &state)?;
        Ok(state)
    }

    /// Stores the samples up to the current point.
    fn take_samples_here(&mut self) {
        let t = self.run.stepper.current_point().t;
        while let Some(sample) = self.next_sample().filter(|sample| *sample <= t) {
            let state = self.run.stepper.current_point().y.clone();
            self.take_sample(sample, state);
        }
    }

    fn take_sample(&mut self, t: f64, state: Vec<f64>) {
        self.taken += 1;
        self.trajectory.times.push(t);
        self.trajectory.states.push(state);
    }

    /// Applies jumps of the state at a breakpoint of the inputs.
    fn pass_breakpoint(&mut self) {
        let here = self.run.stepper.current_point();
        if !self.watched.has_breakpoint_at(here.t) {
            return;
        }
        self.run.follows_jump = true;
        let mut point = here.clone();
        let is_changed = self.watched.apply_breakpoint(point.t, &mut point.y);
        if is_changed {
            self.take_jump(point);
        }
    }

    /// Continues from a point after a jump of the state.
    fn take_jump(&mut self, point: Point) {
        let before = self.run.stepper.current_point().y.clone();
        self.record_jump(point.t, &before, &point.y);
        let step = self.run.stepper.step();
        self.run.stepper.restart(point, step);
    }

    /// Returns true if samples inside the last step, which ends at `t` (s), are interpolated. Near switching
    /// surfaces states must be accurate to rounding. The dense output is tested only if there are many samples,
    /// because a test takes as long as a sample without interpolation.
    fn is_interpolated(&mut self, t: f64) -> bool {
        let least = if self.watched.has_guards() {
            MAX_UNTESTED_SAMPLES
        } else {
            0
        };
        let last = self.samples.get(self.taken + least);
        last.is_some_and(|sample| *sample < t) && self.has_accurate_interior()
    }

    fn has_accurate_interior(&mut self) -> bool {
        self.watched.clear_trial_errors();
        match self.watched.has_guards() {
            true => self.run.stepper.has_accurate_interior(self.watched),
            false => self.run.stepper.has_smooth_interior(self.watched),
        }
    }

    fn next_sample(&self) -> Option<f64> {
        self.samples.get(self.taken).copied()
    }

    /// Records the jump of the state at an event if it exceeds the tolerance. Returns true if it does.
    pub(super) fn record_jump(&mut self, t: f64, before: &[f64], after: &[f64]) -> bool {
        let magnitudes = self.run.stepper.magnitudes();
        let changes = before.iter().zip(after).map(|(a, b)| b - a);
        let change = magnitudes.round_to_tolerance(changes, after);
        let is_jump = change.iter().any(|entry| *entry != 0.0);
        if is_jump {
            self.trajectory.jumps.push(Jump { t, change });
        }
        is_jump
    }

    /// Finds the surfaces near the current point at which the rates grow as a root.
    fn update_root_bands(&mut self) {
        if self.watched.has_guards() {
            let stepper = &self.run.stepper;
            let here = stepper.current_point();
            let allowed: Vec<f64> = stepper.magnitudes().allowed(&here.y).collect();
            self.watched.update_root_bands(here.t, &here.y, &allowed);
        }
    }

    /// Enters the regime at the current point. Records the surfaces whose mode changed and those whose event
    /// reversed the motion with a jump.
    fn enter_regime(&mut self) -> Result<(), SolveError> {
        let here = self.run.stepper.current_point();
        let t = here.t;
        self.watched.update_modes(t, &here.y);
        self.update_root_bands();
        let here = self.run.stepper.current_point();
        self.watched.enter_regime(t, &here.y);
        std::mem::swap(&mut self.run.modes, &mut self.run.earlier_modes);
        self.watched.write_modes(&mut self.run.modes);
        let rebounds = std::mem::take(&mut self.run.rebounds);
        for guard in 0..self.run.modes.len() {
            let (from, to) = (self.run.earlier_modes[guard], self.run.modes[guard]);
            let has_changed = from != to && from != SurfaceMode::Unknown;
            if has_changed || rebounds.contains(&guard) {
                self.trajectory.events.push(Event { t, guard, from, to });
            }
            if has_changed {
                self.check_switch_rate(t, guard)?;
            }
        }
        // With sides that lead back to a surface, trial steps could not reach the other side of it.
        self.watched.fix_sides(true);
        Ok(())
    }
}

/// Returns an error if a state after a step from `begin` (s) is not finite.
fn check_finite(begin: f64, state: &[f64]) -> Result<(), SolveError> {
    match state.iter().position(|entry| !entry.is_finite()) {
        Some(state) => Err(SolveError::NotFinite { t: begin, state }),
        None => Ok(()),
    }
}
