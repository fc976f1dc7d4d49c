//! Limits of a simulation: step length, number of steps, switching rate, stiffness.

use super::approach::Approach;
use super::driver::Driver;
use super::error::SolveError;
use super::stepper::{Point, Stepper};
use super::stiffness::Progress;
use super::system::System;

/// Number of switches over which their rate is averaged.
const SWITCHES_AVERAGED: usize = 256;

/// Number of approaches to a surface after which the steps of an explicit method are checked for stiffness.
const CHECKED_APPROACHES: usize = 64;

/// Largest number of crossings among [`CHECKED_APPROACHES`] that counts as overshoot due to stiffness. In 120 machines
/// of the study `grazing`, 56 or more approaches crossed the surface in every window. In flows through orifices
/// that settle, 16 or fewer crossed it in 222 of 230 windows.
const MAX_CROSSED_APPROACHES: usize = 32;

/// Lower bound of the time in [`Driver::shortest_step`], as a fraction of the span.
const MIN_TIME_FRACTION: f64 = 1e-6;

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    /// Returns true if the next step would not change the time.
    pub(super) fn is_step_too_short(&self) -> bool {
        self.run.stepper.step() <= self.shortest_step()
    }

    /// Returns the shortest step that changes the time, s.
    pub(super) fn shortest_step(&self) -> f64 {
        let t = self.run.stepper.current_point().t.abs();
        f64::EPSILON * t.max(MIN_TIME_FRACTION * self.end.abs())
    }

    pub(super) fn check_switch_rate(&mut self, t: f64, guard: usize) -> Result<(), SolveError> {
        let rate = self.settings.max_switch_rate;
        self.run.recent.push_back((t, guard));
        if self.run.recent.len() < SWITCHES_AVERAGED {
            return Ok(());
        }
        let first = self.run.recent.pop_front().map_or(t, |(first, _)| first);
        if (t - first) * rate < SWITCHES_AVERAGED as f64 {
            if self.run.recent.iter().all(|(_, other)| *other == guard) {
                return Err(self.create_staying_error((first, t), guard));
            }
            let guard = self.find_rarest_guard();
            return Err(SolveError::TooManySwitches { t, guard, rate });
        }
        Ok(())
    }

    /// Returns the error for a motion that stayed near a surface over a time span (s). If the rates are
    /// continuous at the surface, steps of an explicit method overshot it. If they jump, the rates on both
    /// sides point towards it.
    fn create_staying_error(&self, (first, t): (f64, f64), guard: usize) -> SolveError {
        let sticking = SolveError::Sticking { t: first, guard };
        if !M::IS_EXPLICIT {
            return sticking;
        }
        let stepper = &self.run.stepper;
        let here = stepper.current_point();
        let allowed: Vec<f64> = stepper.magnitudes().allowed(&here.y).collect();
        let is_continuous = (self.watched).has_continuous_rates(guard, (here.t, &here.y), &allowed);
        if !is_continuous {
            return sticking;
        }
        let within = (t - first) / SWITCHES_AVERAGED as f64;
        SolveError::StiffAtSurface {
            t,
            guard,
            within,
            steps: (self.end - t) / within,
        }
    }

    /// Returns the least frequent switching function among those with at least a quarter of the recent
    /// switches, or the most frequent one if there are none. A surface that sticks and releases between the
    /// switches of another surface does not chatter.
    fn find_rarest_guard(&self) -> usize {
        let mut counts = vec![0; self.run.modes.len()];
        for (_, guard) in &self.run.recent {
            counts[*guard] += 1;
        }
        let largest = counts.iter().copied().max().unwrap_or(0);
        let least = largest.min(self.run.recent.len().div_ceil(4));
        let turns = counts.iter().enumerate();
        let turns = turns.filter(|(_, count)| **count >= least);
        turns
            .min_by_key(|(_, count)| **count)
            .map_or(0, |(guard, _)| guard)
    }

    pub(super) fn check_steps(&self) -> Result<(), SolveError> {
        let steps = self.settings.max_steps;
        if self.count_steps() < steps {
            return Ok(());
        }
        let Point { t, y } = self.run.stepper.current_point();
        Err(SolveError::TooManySteps {
            t: *t,
            steps,
            state: self.watched.fastest_state(*t, y),
        })
    }

    /// Records an approach to the surface `guard`. Returns an error if steps of an explicit method overshoot a
    /// surface that the motion does not cross, and the projected number of steps exceeds `max_steps_if_stiff`.
    pub(super) fn check_approaches(
        &mut self,
        guard: Option<usize>,
        has_crossed: bool,
    ) -> Result<(), SolveError> {
        // At a surface where the motion reverses, steps are short for some approaches and then grow. The
        // projected number is therefore only used if the caller can change to an implicit method.
        let can_change = self.settings.max_steps_if_stiff < self.settings.max_steps;
        if !M::IS_EXPLICIT || !can_change {
            return Ok(());
        }
        let (t, steps) = (self.run.stepper.current_point().t, self.count_steps());
        self.approaches.push_back(Approach {
            t,
            steps,
            has_crossed,
        });
        if self.approaches.len() <= CHECKED_APPROACHES {
            return Ok(());
        }
        let Some(first) = self.approaches.pop_front() else {
            return Ok(());
        };
        let crossed = self.approaches.iter().filter(|a| a.has_crossed).count();
        let needed = (self.end - t) / (t - first.t) * (steps - first.steps) as f64;
        let allowed = self.settings.max_steps_if_stiff.saturating_sub(steps);
        let Some(guard) = guard else {
            return Ok(());
        };
        if crossed > MAX_CROSSED_APPROACHES || needed < allowed as f64 {
            return Ok(());
        }
        Err(SolveError::StiffAtSurface {
            t,
            guard,
            within: (t - first.t) / CHECKED_APPROACHES as f64,
            steps: needed,
        })
    }

    /// Returns the number of steps tried so far.
    fn count_steps(&self) -> u64 {
        let work = &self.trajectory.statistics;
        work.steps + work.rejected_steps + work.trial_steps
    }

    /// Returns an error if the system is stiff and the step limit will be exceeded; see
    /// [`super::stiffness`].
    pub(super) fn check_stiffness(&mut self, system: &S) -> Result<(), SolveError> {
        if !M::IS_EXPLICIT {
            return Ok(());
        }
        let Point { t, y } = self.run.stepper.current_point();
        let standing = Progress {
            t: *t,
            y,
            step: self.run.stepper.step(),
            steps: (self.count_steps(), self.settings.max_steps),
            max_steps_if_stiff: self.settings.max_steps_if_stiff,
            end: self.end,
        };
        self.pace.check(system, &standing)
    }
}
