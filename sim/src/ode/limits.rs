//! When to give up: steps too short or too many, switches too fast, stiffness.

use super::driver::Driver;
use super::error::SolveError;
use super::stepper::{Point, Stepper, refusal};
use super::stiffness::Standing;
use super::system::System;

/// Over this many switches their rate is averaged.
const SWITCHES_AVERAGED: usize = 256;

/// Times closer to 0 than this part of the span count as so far from it when a step is
/// judged too short.
const SMALLEST_TIME: f64 = 1e-6;

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    /// Returns true if the next step would still move the time; if not, what the last trial ran
    /// into says why.
    pub(super) fn check_step_size(&self) -> Result<(), SolveError> {
        let (t, step) = (self.stepper.here().t, self.stepper.step());
        if step > self.shortest_step() {
            return Ok(());
        }
        Err(match (self.watched.indefinite(), self.watched.crossed()) {
            (None, Some(guard)) if self.watched.not_finite().is_none() => {
                SolveError::Caught { t, guard }
            }
            _ => refusal(self.watched, self.stepper.here(), step),
        })
    }

    /// The shortest step that moves the time, s.
    pub(super) fn shortest_step(&self) -> f64 {
        let t = self.stepper.here().t.abs();
        f64::EPSILON * t.max(SMALLEST_TIME * self.end.abs())
    }

    pub(super) fn check_switch_rate(&mut self, t: f64, guard: usize) -> Result<(), SolveError> {
        let rate = self.settings.max_switch_rate;
        self.recent.push_back((t, guard));
        if self.recent.len() < SWITCHES_AVERAGED {
            return Ok(());
        }
        let first = self.recent.pop_front().map_or(t, |(first, _)| first);
        if (t - first) * rate < SWITCHES_AVERAGED as f64 {
            let guard = self.rarest();
            return Err(SolveError::TooManySwitches { t, guard, rate });
        }
        Ok(())
    }

    /// Of the switching functions that take turns in the last switches, the one that switched least: a
    /// surface that catches the motion and lets it go between those of another is not what chatters.
    fn rarest(&self) -> usize {
        let mut counts = vec![
            0;
            self.trajectory
                .switches
                .iter()
                .map(|switch| switch.guard + 1)
                .max()
                .unwrap_or(1)
        ];
        for (_, guard) in &self.recent {
            counts[*guard] += 1;
        }
        let turns = counts
            .iter()
            .enumerate()
            .filter(|(_, count)| 4 * **count >= self.recent.len());
        turns
            .min_by_key(|(_, count)| **count)
            .map_or(0, |(guard, _)| guard)
    }

    pub(super) fn check_steps(&self) -> Result<(), SolveError> {
        let steps = self.settings.max_steps;
        if self.steps() < steps {
            return Ok(());
        }
        let Point { t, y } = self.stepper.here();
        Err(SolveError::TooManySteps {
            t: *t,
            steps,
            state: self.watched.fastest(*t, y),
        })
    }

    /// All steps that were tried so far.
    fn steps(&self) -> u64 {
        let work = &self.trajectory.work;
        work.steps + work.rejected + work.trials
    }

    /// Returns true if there will be an end.
    pub(super) fn look_at_the_pace(&mut self, system: &S) -> Result<(), SolveError> {
        if !M::IS_EXPLICIT {
            return Ok(());
        }
        let Point { t, y } = self.stepper.here();
        let standing = Standing {
            t: *t,
            y,
            step: self.stepper.step(),
            steps: (self.steps(), self.settings.max_steps),
            most_if_stiff: self.settings.max_steps_if_stiff,
            end: self.end,
        };
        self.pace.look(system, &standing)
    }
}
