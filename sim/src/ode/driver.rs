//! The loop: steps, samples, switches and limits.

use std::collections::VecDeque;

use super::adams::Adams;
use super::approach::Approach;
use super::bernstein::BernsteinBasis;
use super::dormand_prince::DormandPrince853;
use super::error::SolveError;
use super::event_search::Crossing;
use super::events::{Event, Jump, SurfaceMode};
use super::magnitudes::Magnitudes;
use super::radau::Radau;
use super::request;
use super::resolution::Resolution;
use super::settings::{Method, Settings};
use super::stepper::{Outcome, Point, Stepper, rejection_error};
use super::stiffness::Pace;
use super::system::{Interior, System};
use super::trajectory::Trajectory;
use super::watch::WatchedSystem;

/// The first step, relative to the span; the error estimate corrects it at once.
const FIRST_STEP: f64 = 1e-6;

/// Number of times that a step is shortened because it does not resolve the switching functions. Finer
/// changes of these count as rounding.
const MOST_SHORTENED: u32 = 12;

/// Factor by which a step is shortened at most, and if it leaves the domain of the rates.
pub(super) const SHORTENED: f64 = 0.2;

/// More samples than this in a step are many.
const MANY: usize = 2;

/// Simulates `system` from `initial` over `span` (begin, end; s) and returns the states at
/// `samples` (s, ascending, inside the span). Calls `progress` with the time after every step.
///
/// # Errors
/// An invalid request, a rate that is not finite, or a limit of `settings`; see [`SolveError`].
pub fn simulate(
    system: &dyn System,
    initial: &[f64],
    span: (f64, f64),
    samples: &[f64],
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
) -> Result<Trajectory, SolveError> {
    let mut trajectory = Trajectory::default();
    let request = (initial, span, samples);
    simulate_into(&mut trajectory, system, request, settings, progress)?;
    Ok(trajectory)
}

/// Simulates like [`simulate`] into an empty `trajectory`, which keeps all results up to an error.
/// The request is the initial state, the span and the samples.
///
/// # Errors
/// Same as [`simulate`].
pub fn simulate_into(
    trajectory: &mut Trajectory,
    system: &dyn System,
    (initial, span, samples): (&[f64], (f64, f64), &[f64]),
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
) -> Result<(), SolveError> {
    request::check(system, initial, span, samples, settings)?;
    let run = match settings.method {
        Method::DormandPrince853 => run::<DormandPrince853>,
        Method::Adams => run::<Adams>,
        Method::Radau => run::<Radau>,
    };
    run(
        trajectory,
        system,
        (initial, span, samples),
        settings,
        progress,
    )
}

/// Simulates with one method. The system is a trait object, so that each method is compiled once.
fn run<M: Stepper>(
    trajectory: &mut Trajectory,
    system: &dyn System,
    (initial, span, samples): (&[f64], (f64, f64), &[f64]),
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
) -> Result<(), SolveError> {
    let start = Point {
        t: span.0,
        y: initial.to_vec(),
    };
    let watched = WatchedSystem::new(system, (start.t, &start.y), settings.tolerance);
    watched.fix_sides(true);
    let step = FIRST_STEP * (span.1 - span.0);
    let magnitudes = Magnitudes::new(&start.y, &system.typical_sizes(), settings.tolerance);
    let mut driver = Driver {
        watched: &watched,
        stepper: M::new(start, step, magnitudes),
        settings,
        samples,
        end: span.1,
        until: span.1,
        recent: VecDeque::new(),
        pace: Pace::new(span.0),
        approaches: VecDeque::new(),
        resolution: Resolution::new(settings.tolerance),
        basis: BernsteinBasis::new(),
        projected: None,
        modes: Vec::new(),
        earlier_modes: Vec::new(),
        has_roundings: false,
        rebounds: Vec::new(),
        trajectory,
    };
    watched.write_modes(&mut driver.modes);
    driver.sample_start();
    let ended = driver.go_to_the_end(system, progress);
    driver.finish();
    ended
}

/// Action after a step with an acceptable error.
pub(super) enum Accepted {
    /// The motion continues from its end.
    Continues,
    /// It was taken back and is to be made shorter.
    Shortened,
    /// It crosses surfaces.
    Crossed(Crossing),
}

/// A simulation under way.
pub(super) struct Driver<'a, S: System + ?Sized, M: Stepper> {
    pub(super) watched: &'a WatchedSystem<'a, S>,
    pub(super) stepper: M,
    pub(super) settings: &'a Settings,
    samples: &'a [f64],
    pub(super) end: f64,
    /// Time at which the present step ends at the latest, s.
    pub(super) until: f64,
    /// The last switches: when, s, and of which function.
    pub(super) recent: VecDeque<(f64, usize)>,
    pub(super) pace: Pace,
    /// The last approaches to switching surfaces.
    pub(super) approaches: VecDeque<Approach>,
    pub(super) resolution: Resolution,
    pub(super) basis: BernsteinBasis,
    /// The state here brought back onto what the motion keeps, if that moves it.
    projected: Option<Vec<f64>>,
    /// Modes of the surfaces here, and those before the last event.
    pub(super) modes: Vec<SurfaceMode>,
    earlier_modes: Vec<SurfaceMode>,
    /// True if the scales of the errors have roundings of a motion at rest.
    has_roundings: bool,
    /// Surfaces that returned the motion in the last step over them.
    pub(super) rebounds: Vec<usize>,
    pub(super) trajectory: &'a mut Trajectory,
}

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    fn go_to_the_end(
        &mut self,
        system: &S,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), SolveError> {
        while self.stepper.current_point().t < self.end {
            self.advance(system)?;
            progress(self.stepper.current_point().t);
            self.look_at_the_pace(system)?;
        }
        Ok(())
    }

    /// One accepted step, or the way to and over a switching surface.
    fn advance(&mut self, system: &S) -> Result<(), SolveError> {
        let begin = self.stepper.current_point().t;
        let next = system.next_breakpoint(begin).filter(|next| *next > begin);
        let until = next.map_or(self.end, |next| next.min(self.end));
        self.until = until;
        self.watched.limit_time(next.unwrap_or(f64::INFINITY));
        let mut shortened = 0;
        loop {
            self.limit_step();
            self.watched.restore_sides();
            self.set_roundings();
            if self.step_is_too_short() {
                return self.cross_at_once();
            }
            let outcome = self.make_controlled_step(until)?;
            if outcome.is_accepted {
                match self.look_at(outcome.length, shortened < MOST_SHORTENED) {
                    Accepted::Shortened => shortened += 1,
                    Accepted::Crossed(crossing) => return self.cross(&crossing, outcome.length),
                    Accepted::Continues => return self.accept(begin),
                }
            }
        }
    }

    /// Makes the next step no longer than the settings allow.
    fn limit_step(&mut self) {
        if self.stepper.step() > self.settings.max_step {
            self.stepper.set_step(self.settings.max_step);
        }
    }

    /// Sets the rounding of the next step at rest, and resets it if the motion is not at rest any more.
    fn set_roundings(&mut self) {
        let is_at_rest =
            |mode: &SurfaceMode| matches!(mode, SurfaceMode::Held | SurfaceMode::Closed);
        let is_resting = self.modes.iter().any(is_at_rest);
        if !is_resting && !self.has_roundings {
            return;
        }
        self.has_roundings = is_resting;
        let mut rates = vec![0.0; self.stepper.current_point().y.len()];
        if is_resting {
            self.watched.add_rate_roundings(&mut rates);
        }
        let length = self.stepper.step();
        self.stepper
            .magnitudes_mut()
            .set_rate_roundings(&rates, length);
    }

    /// Shows the last step to a system that observes steps.
    fn observe_step(&mut self) {
        if !self.watched.is_observing() {
            return;
        }
        let (start, end) = (
            self.stepper.step_start().clone(),
            self.stepper.current_point().clone(),
        );
        let (stepper, watched) = (&mut self.stepper, self.watched);
        let mut inside = |t, interior| match interior {
            Interior::Interpolated => stepper.interpolated(watched, t),
            Interior::Recomputed => stepper.inside(watched, t),
        };
        watched.observe_step(&start, &end, &mut inside);
    }

    /// Tries a step that ends at `until` at the latest.
    pub(super) fn make_controlled_step(&mut self, until: f64) -> Result<Outcome, SolveError> {
        self.check_steps()?;
        self.watched.forget_trials();
        let mut outcome = self.stepper.advance(self.watched, until)?;
        if !outcome.is_accepted && self.watched.release_sides() {
            // Beyond a surface the rates of the near side may have no value.
            self.watched.forget_trials();
            self.stepper.set_step(outcome.length);
            outcome = self.stepper.advance(self.watched, until)?;
        }
        if outcome.is_accepted && self.watched.non_finite_state().is_some() {
            // It ends where the rates have no value: no motion gets there.
            self.refuse(outcome.length);
            outcome.is_accepted = false;
        } else if !outcome.is_accepted {
            self.trajectory.statistics.rejected_steps += 1;
        }
        Ok(outcome)
    }

    /// Takes an accepted step of `length` s back for a shorter one.
    pub(super) fn refuse(&mut self, length: f64) {
        self.stepper.take_back();
        self.stepper.set_step(SHORTENED * length);
        self.trajectory.statistics.rejected_steps += 1;
    }

    /// Finds the state here that the motion keeps. Returns whether it is as near as the tolerance
    /// promises: a step that strayed farther than its error estimate says did not meet the tolerance.
    pub(super) fn project(&mut self) -> bool {
        let here = self.stepper.current_point();
        let mut y = here.y.clone();
        self.projected = None;
        if !self.watched.project(here.t, &mut y) {
            return true;
        }
        let moved = y.iter().zip(&here.y).map(|(to, from)| to - from);
        let is_near = self.stepper.magnitudes().allow(moved, &here.y);
        self.projected = Some(y);
        is_near
    }

    /// Returns the state at `t` (s) inside the last step. It is interpolated if the interior
    /// `is_told` and the step crossed no surface.
    fn inside(&mut self, t: f64, is_told: bool) -> Result<Vec<f64>, SolveError> {
        if is_told && let Some(state) = self.stepper.interpolated(self.watched, t) {
            return Ok(state);
        }
        self.check_steps()?;
        self.trajectory.statistics.trial_steps += 1;
        self.watched.forget_trials();
        let state = self.stepper.inside(self.watched, t);
        state.ok_or_else(|| {
            let start = self.stepper.step_start();
            rejection_error(self.watched, start, t - start.t)
        })
    }

    /// Samples from `begin` (s) to here, takes the projected state, and enters the regime found here.
    pub(super) fn accept(&mut self, begin: f64) -> Result<(), SolveError> {
        check_finite(begin, &self.stepper.current_point().y)?;
        self.stepper.settle(self.projected.is_some());
        self.trajectory.statistics.steps += 1;
        self.watched.forget_later_trials();
        self.observe_step();
        let t = self.stepper.current_point().t;
        let is_told = self.is_interior_told(t);
        while let Some(sample) = self.next_sample().filter(|sample| *sample < t) {
            let mut state = self.inside(sample, is_told)?;
            self.watched.project(sample, &mut state);
            check_finite(begin, &state)?;
            self.trajectory.times.push(sample);
            self.trajectory.states.push(state);
        }
        if let Some(y) = self.projected.take() {
            check_finite(begin, &y)?;
            self.stepper.correct(y);
            self.stepper.settle(false);
        }
        while let Some(sample) = self.next_sample().filter(|sample| *sample <= t) {
            self.trajectory.times.push(sample);
            self.trajectory
                .states
                .push(self.stepper.current_point().y.clone());
        }
        self.pass_breakpoint();
        self.enter_regime()
    }

    /// Changes the state where it jumps with inputs.
    fn pass_breakpoint(&mut self) {
        let mut point = self.stepper.current_point().clone();
        let is_changed = self.watched.has_breakpoint_at(point.t)
            && self.watched.apply_breakpoint(point.t, &mut point.y);
        if is_changed {
            let before = self.stepper.current_point().y.clone();
            self.record_jump(point.t, &before, &point.y);
            let step = self.stepper.step();
            self.stepper.restart(point, step);
        }
    }

    /// Returns true if samples inside the last step, which ends at `t` (s), are interpolated.
    /// Beside switching surfaces, where states are to be right to the last digit, the interior is
    /// looked at first: that takes as long as a sample that is not interpolated, and is worth it
    /// where there are many.
    fn is_interior_told(&mut self, t: f64) -> bool {
        if !self.watched.has_guards() {
            return true;
        }
        let next = self.trajectory.times.len() + MANY;
        if self.samples.get(next).is_none_or(|sample| *sample >= t) {
            return false;
        }
        self.watched.forget_trials();
        self.stepper.tells_interior(self.watched)
    }

    fn next_sample(&self) -> Option<f64> {
        self.samples.get(self.trajectory.times.len()).copied()
    }

    /// Records the jump of the state at an event, unless it is below the tolerance.
    pub(super) fn record_jump(&mut self, t: f64, before: &[f64], after: &[f64]) {
        let magnitudes = self.stepper.magnitudes();
        let changes = before.iter().zip(after).map(|(a, b)| b - a);
        let change = magnitudes.round_to_tolerance(changes, after);
        if change.iter().any(|entry| *entry != 0.0) {
            self.trajectory.jumps.push(Jump { t, change });
        }
    }

    /// Enters the regime of the point here, and records the surfaces whose mode changed and those that returned the motion.
    fn enter_regime(&mut self) -> Result<(), SolveError> {
        let here = self.stepper.current_point();
        let t = here.t;
        self.watched.update_modes(t, &here.y);
        self.watched.enter_regime(t, &here.y);
        std::mem::swap(&mut self.modes, &mut self.earlier_modes);
        self.watched.write_modes(&mut self.modes);
        let rebounds = std::mem::take(&mut self.rebounds);
        for guard in 0..self.modes.len() {
            let (from, to) = (self.earlier_modes[guard], self.modes[guard]);
            let has_changed = from != to && from != SurfaceMode::Unknown;
            if has_changed || rebounds.contains(&guard) {
                self.trajectory.events.push(Event { t, guard, from, to });
            }
            if has_changed {
                self.check_switch_rate(t, guard)?;
            }
        }
        // Rates that lead back from beyond a surface must not keep trials from getting there.
        self.watched.fix_sides(true);
        Ok(())
    }
}

/// Returns true if a state is made of numbers, after a step from `begin` (s).
fn check_finite(begin: f64, state: &[f64]) -> Result<(), SolveError> {
    match state.iter().position(|entry| !entry.is_finite()) {
        Some(state) => Err(SolveError::NotFinite { t: begin, state }),
        None => Ok(()),
    }
}

/// Samples at the start, and the end.
impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    fn sample_start(&mut self) {
        let start = self.stepper.current_point();
        for sample in self.samples.iter().take_while(|sample| **sample <= start.t) {
            self.trajectory.times.push(*sample);
            self.trajectory.states.push(start.y.clone());
        }
    }

    fn finish(self) {
        self.watched.fix_sides(false);
        self.trajectory.final_state = self.stepper.current_point().y.clone();
        self.trajectory.statistics.evaluations = self.watched.evaluations();
    }
}
