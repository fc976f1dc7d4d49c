//! The passage over a switching surface, or past one that was touched.

use super::crossing::{crossing_step, find_approach};
use super::dormand_prince::make_step;
use super::driver::{Accepted, Driver};
use super::error::SolveError;
use super::grazing::find_leapt_surface;
use super::resolution::ROUNDINGS;
use super::stepper::{Point, Stepper};
use super::system::System;

/// How short a stay beyond a surface is searched for in the step over it, relative to the step
/// that ran into it: well above where rounding makes a switching function change its sign.
const SHORTEST_CONTACT: f64 = 1e-9;

/// A step over a surface is as short as can be if it is so many times the shortest step.
const SHORTEST_WINDOW: f64 = 16.0;

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    /// Goes to the surface that may lie within `length` of here, and over it.
    pub(super) fn cross(&mut self, length: f64) -> Result<(), SolveError> {
        let guard = self.watched.crossed_guard();
        let mut window = length;
        let mut beyond = Vec::new();
        while window > crossing_step(length) {
            let begin = self.stepper.current_point().t;
            let found = find_approach(self.watched, &mut self.stepper, window, beyond);
            self.trajectory.statistics.trial_steps += found.trials;
            window = found.distance_beyond;
            beyond = found.guards_beyond;
            if found.length > 0.0 {
                self.stepper.set_step(found.length);
                let outcome = self.make_controlled_step(f64::INFINITY)?;
                if !outcome.is_accepted {
                    // Not the surface alone: shorter steps, and then again.
                    return Ok(());
                }
                if outcome.length < found.length {
                    // A method that starts may begin with a shorter step.
                    window += found.length - outcome.length;
                    beyond = Vec::new();
                }
                match self.look_at(outcome.length, true) {
                    Accepted::Shortened => return Ok(()),
                    Accepted::SurfacePassed(length) => {
                        window = length.min(0.5 * found.length);
                        beyond = Vec::new();
                        continue;
                    }
                    Accepted::Continues => {}
                }
                if self.watched.crossed_guard().is_some()
                    && self.is_beyond(self.stepper.current_point())
                {
                    // Its error led it over.
                    let mut point = self.stepper.current_point().clone();
                    self.stepper.take_back();
                    let start = self.stepper.current_point().clone();
                    self.apply_event(&start, &mut point);
                    self.stepper.restart(point, length);
                    self.project();
                    return self.accept(begin);
                }
                self.accept(begin)?;
            }
        }
        let has_crossed = self.step_over(window.max(crossing_step(length)), length)?;
        self.check_approaches(guard, has_crossed)
    }

    /// Steps over the surface `window` ahead, wider where rounding hides it and as long as the step is
    /// resolved, and goes on with steps of `length`. Returns false if the motion did not cross the surface.
    fn step_over(&mut self, mut window: f64, length: f64) -> Result<bool, SolveError> {
        let start = self.stepper.current_point().clone();
        let mut last = 0.0;
        while last < length {
            self.check_steps()?;
            self.trajectory.statistics.trial_steps += 1;
            let Some(mut point) = self.resolved_step(&start, window) else {
                break;
            };
            if self.is_beyond(&point) {
                self.apply_event(&start, &mut point);
                self.stepper.restart(point, length);
                self.project();
                self.accept(start.t)?;
                return Ok(true);
            }
            // In a step that does not move the time there is nothing to leap over.
            if window > SHORTEST_CONTACT * length && point.t > start.t {
                let trials = &mut self.trajectory.statistics.trial_steps;
                let step = (&start, &point);
                if let Some(ahead) = find_leapt_surface(self.watched, &self.stepper, step, trials) {
                    // Too short for this step: let shorter ones find it.
                    self.stepper.restart(start, 0.25 * ahead);
                    return Ok(false);
                }
            }
            last = window;
            window = (4.0 * window).min(length);
        }
        // The surface was touched, by a trial state or by the motion, and not crossed by a step that
        // meets the tolerance.
        self.stepper.restart(start, 0.25 * length);
        Ok(false)
    }

    /// Applies the event at the surfaces between `start` and `point`, and notes those that returned the
    /// motion to its side.
    fn apply_event(&mut self, start: &Point, point: &mut Point) {
        let arrived = self.crossed_guards(point);
        self.watched
            .apply_event((start.t, &start.y), point.t, &mut point.y);
        let beyond = self.crossed_guards(point);
        self.rebounds = arrived;
        self.rebounds.retain(|guard| !beyond.contains(guard));
    }

    /// The point that a step of `window` s leads to from `start`, if the step meets the tolerance. The error
    /// estimate of a method means nothing across a surface: the step must be so short that the rates
    /// at neither end lead to another point, or as short as times or states can be told apart. Such a step is explicit
    /// for every method: Newton's method may not converge across a jump, and nothing is stiff in it.
    fn resolved_step(&self, start: &Point, window: f64) -> Option<Point> {
        self.watched.forget_trials();
        let kept = make_step(self.watched, start, window);
        let point = kept.or_else(|| self.step_of_own_sides(start, window))?;
        let near = self.rates_at(start);
        self.watched.fix_sides(false);
        let beyond = self.rates_at(&point);
        self.watched.fix_sides(true);
        let is_resolved = |rates: &Vec<f64>| {
            let ends = point.y.iter().zip(&start.y);
            let errors = ends.zip(rates).map(|((b, a), rate)| b - a - window * rate);
            self.stepper.magnitudes().norm(errors, &point.y) <= 1.0
        };
        let is_shortest = window <= SHORTEST_WINDOW * self.shortest_step();
        let is_taken = is_shortest
            || [near, beyond].iter().all(is_resolved)
            || self.moves_by_rounding(start, &point);
        is_taken.then_some(point)
    }

    /// Returns true if a step crosses surfaces and changes their functions by no more than rounding: no shorter
    /// step may cross them.
    fn moves_by_rounding(&self, start: &Point, end: &Point) -> bool {
        let [from, to] = [start, end].map(|point| self.watched.evaluate_guards(point.t, &point.y));
        let crossed = self.crossed_guards(end);
        if crossed.is_empty() {
            return false;
        }
        let roundings = self.watched.guard_roundings(start.t, &start.y);
        let is_rounding =
            |guard: &usize| (to[*guard] - from[*guard]).abs() <= ROUNDINGS * roundings[*guard];
        crossed.iter().all(is_rounding)
    }

    /// The same whatever its error, where the rates of the near side have no value beyond the surface, and
    /// those of the side where a trial is have one.
    fn step_of_own_sides(&self, start: &Point, window: f64) -> Option<Point> {
        self.watched.forget_trials();
        self.watched.fix_sides(false);
        let point = make_step(self.watched, start, window);
        self.watched.fix_sides(true);
        point
    }

    fn rates_at(&self, point: &Point) -> Vec<f64> {
        let mut rates = vec![0.0; point.y.len()];
        self.watched.rates(point.t, &point.y, &mut rates);
        rates
    }

    /// Returns true if a point lies beyond a surface of the present regime.
    fn is_beyond(&self, point: &Point) -> bool {
        !self.crossed_guards(point).is_empty()
    }

    /// Returns the surfaces of the present regime that a point is beyond.
    fn crossed_guards(&self, point: &Point) -> Vec<usize> {
        let guards = self.watched.evaluate_guards(point.t, &point.y);
        let values = guards.into_iter().enumerate();
        let beyond = values.filter(|(guard, value)| self.watched.is_beyond(*guard, *value));
        beyond.map(|(guard, _)| guard).collect()
    }
}
