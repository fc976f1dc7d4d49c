//! Examination of an accepted step for surfaces that the motion crossed inside it.

use eomgen_codegen::program::evaluator::Enclosure;

use super::bernstein::Piece;
use super::driver::{Driver, SHORTENING_FACTOR, StepVerdict};
use super::event_search::{Crossing, SwitchingFunctions, find_crossing};
use super::grazing::find_passed_surface;
use super::resolution::SAMPLE_FRACTIONS;
use super::stepper::Stepper;
use super::system::System;
use super::watch::WatchedSystem;

/// Length of the shortest step that is examined, relative to the time. In shorter steps, rounding makes times
/// equal.
const MIN_EXAMINED_FRACTION: f64 = 1e-12;

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    /// Examines an accepted step of `length` s. If `may_shorten`, the step may be undone and shortened first.
    pub(super) fn examine_step(&mut self, length: f64, may_shorten: bool) -> StepVerdict {
        let found = self.find_crossing_inside(length, may_shorten);
        match found {
            StepVerdict::Continues => {}
            StepVerdict::Shortened | StepVerdict::Crossed(_) => return found,
        }
        if !self.project() && may_shorten {
            self.reject_step(length);
            return StepVerdict::Shortened;
        }
        StepVerdict::Continues
    }

    /// Searches the last step, of `length` s, for crossings. Functions with bounds are searched by interval
    /// arithmetic, the others by samples.
    fn find_crossing_inside(&mut self, length: f64, may_shorten: bool) -> StepVerdict {
        let (start, end) = (
            self.run.stepper.step_start().clone(),
            self.run.stepper.current_point().clone(),
        );
        let is_short = end.t - start.t <= MIN_EXAMINED_FRACTION * end.t.abs();
        if !self.watched.has_guards() {
            return StepVerdict::Continues;
        }
        if is_short {
            return self.find_change_over_step();
        }
        let Some(piece) = self.run.stepper.interior(self.watched, &self.basis) else {
            return StepVerdict::Continues;
        };
        let mut sampled: Vec<f64> = self.watched.sides();
        let mut bounded = sampled.clone();
        let mut step = SearchedStep {
            watched: self.watched,
            times: (start.t, end.t),
            state: Vec::new(),
        };
        let mut bounds = vec![Enclosure::UNKNOWN; bounded.len()];
        step.bound(&piece, &mut bounds);
        for (guard, bound) in bounds.iter().enumerate() {
            let kind = match bound.is_unknown() {
                true => &mut bounded,
                false => &mut sampled,
            };
            kind[guard] = 0.0;
        }
        let ends = (step.evaluate(0.0, &start.y), step.evaluate(1.0, &end.y));
        let mut undecided = Vec::new();
        let interior = (piece, end.t - start.t);
        let guards = (&bounded[..], bounds);
        let found = find_crossing(interior, guards, ends, &mut step, &mut undecided);
        for guard in undecided {
            sampled[guard] = bounded[guard];
        }
        let by_samples = match sampled.iter().any(|side| *side != 0.0) {
            true => self.find_sampled_crossing(&sampled, length, may_shorten),
            false => StepVerdict::Continues,
        };
        match (found, by_samples) {
            (_, StepVerdict::Shortened) => StepVerdict::Shortened,
            (Some(bounded), StepVerdict::Crossed(sampled)) => {
                let roots = [&bounded, &sampled].map(|crossing| self.find_interior_root(crossing));
                StepVerdict::Crossed(if roots[1] < roots[0] {
                    sampled
                } else {
                    bounded
                })
            }
            (Some(crossing), StepVerdict::Continues) => StepVerdict::Crossed(crossing),
            (None, StepVerdict::Crossed(crossing)) => StepVerdict::Crossed(crossing),
            // The end of the step may be beyond a surface by rounding.
            (None, StepVerdict::Continues) => self.find_change_over_step(),
        }
    }

    /// Finds the surfaces that separate the ends of the last step.
    fn find_change_over_step(&self) -> StepVerdict {
        let end = self.run.stepper.current_point();
        let values = self.watched.evaluate_guards_before(end.t, &end.y);
        let guards =
            (0..values.len()).filter(|guard| self.watched.is_beyond(*guard, values[*guard]));
        let guards: Vec<usize> = guards.collect();
        match guards.is_empty() {
            true => StepVerdict::Continues,
            false => StepVerdict::Crossed(Crossing {
                near: 0.0,
                beyond: 1.0,
                guards,
            }),
        }
    }

    /// Searches for crossings of functions without bounds, whose `sides` are not 0.
    fn find_sampled_crossing(
        &mut self,
        sides: &[f64],
        length: f64,
        may_shorten: bool,
    ) -> StepVerdict {
        let Some(values) = self.sample_guards() else {
            return StepVerdict::Continues;
        };
        if may_shorten && self.shorten_unresolved(&values, sides, length) {
            return StepVerdict::Shortened;
        }
        if let Some(crossing) = find_sign_change(&values, sides) {
            return StepVerdict::Crossed(crossing);
        }
        let trials = &mut self.trajectory.statistics.trial_steps;
        let step = (self.watched, &mut self.run.stepper);
        if let Some((guard, passed)) = find_passed_surface(step, sides, &values, trials) {
            return StepVerdict::Crossed(Crossing {
                near: 0.0,
                beyond: passed / length,
                guards: vec![guard],
            });
        }
        self.run.resolution.settle(&values);
        StepVerdict::Continues
    }

    /// Evaluates the switching functions at [`SAMPLE_FRACTIONS`] of the last step. Returns `None` if the method provides
    /// no interpolation.
    fn sample_guards(&mut self) -> Option<[Vec<f64>; 5]> {
        let (start, end) = (
            self.run.stepper.step_start().clone(),
            self.run.stepper.current_point().clone(),
        );
        let mut values: [Vec<f64>; 5] = Default::default();
        for (part, values) in SAMPLE_FRACTIONS.into_iter().zip(&mut values) {
            let t = start.t + part * (end.t - start.t);
            let state = match part {
                0.0 => start.y.clone(),
                1.0 => end.y.clone(),
                _ => self.run.stepper.interpolate(self.watched, t)?,
            };
            *values = self.watched.evaluate_guards_before(t, &state);
        }
        Some(values)
    }

    /// Undoes an accepted step of `length` s and shortens it if it does not resolve the switching functions;
    /// otherwise limits the next step so that it resolves them. Returns true if the step was undone.
    fn shorten_unresolved(&mut self, values: &[Vec<f64>; 5], sides: &[f64], length: f64) -> bool {
        let side = |guard: usize| sides[guard];
        let mut longest = self.run.resolution.find_growth_factor(values, side, &[]);
        if longest < 1.0 {
            let start = self.run.stepper.step_start();
            let roundings = self.watched.guard_roundings(start.t, &start.y);
            longest = self
                .run
                .resolution
                .find_growth_factor(values, side, &roundings);
        }
        let is_resolved = longest >= 1.0;
        if is_resolved {
            let step = self.run.stepper.step();
            self.run.stepper.set_step(step.min(longest * length));
        } else {
            self.run.stepper.undo_step();
            self.run
                .stepper
                .set_step(longest.max(SHORTENING_FACTOR) * length);
            self.trajectory.statistics.rejected_steps += 1;
        }
        !is_resolved
    }
}

/// Returns the first sign change among samples of the functions whose `sides` are not 0.
fn find_sign_change(values: &[Vec<f64>; 5], sides: &[f64]) -> Option<Crossing> {
    let beyond = |index: usize| {
        let guards = 0..sides.len();
        let beyond = guards.filter(|guard| sides[*guard] * values[index][*guard] < 0.0);
        beyond.collect::<Vec<usize>>()
    };
    let index = (1..SAMPLE_FRACTIONS.len()).find(|index| !beyond(*index).is_empty())?;
    Some(Crossing {
        near: SAMPLE_FRACTIONS[index - 1],
        beyond: SAMPLE_FRACTIONS[index],
        guards: beyond(index),
    })
}

/// Last step, whose dense output is searched.
struct SearchedStep<'a, S: System + ?Sized> {
    watched: &'a WatchedSystem<'a, S>,
    /// Start and end, s.
    times: (f64, f64),
    state: Vec<Enclosure>,
}

impl<S: System + ?Sized> SearchedStep<'_, S> {
    fn time(&self, part: f64) -> f64 {
        match part {
            1.0 => self.times.1,
            _ => self.times.0 + part * (self.times.1 - self.times.0),
        }
    }
}

impl<S: System + ?Sized> SwitchingFunctions for SearchedStep<'_, S> {
    fn evaluate(&mut self, part: f64, y: &[f64]) -> Vec<f64> {
        self.watched.evaluate_guards_before(self.time(part), y)
    }

    fn bound(&mut self, piece: &Piece, out: &mut [Enclosure]) {
        piece.bound(self.times.1 - self.times.0, &mut self.state);
        let times = (self.time(piece.from), self.time(piece.to));
        self.watched.bound_guards(times, &self.state, out);
    }
}
