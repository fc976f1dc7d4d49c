//! Event location: finds the root of a switching function on the dense output of a step, then makes steps from
//! the start of this step that end at the surface.

use super::driver::Driver;
use super::error::SolveError;
use super::event_search::Crossing;
use super::stepper::{Point, Stepper};
use super::system::System;

/// Maximum number of iterations of the search on the dense output. Bisection needs 52.
const MAX_ITERATIONS: u32 = 60;

/// Maximum number of steps to a surface. Newton's method needs one or two.
const MAX_STEPS: u32 = 60;

/// Longest linear extrapolation to a surface, as a fraction of a step. Its error is of second order.
const MAX_EXTRAPOLATION: f64 = 1e-8;

/// Shortest time between the points on both sides of a surface, as a fraction of a step.
const MIN_DISTANCE: f64 = 1e-13;

/// Shortest time between the points on both sides of a surface, in shortest steps.
const MIN_SHORTEST_STEPS: f64 = 2.0;

/// Largest distance from a surface, in shortest steps, at which the motion crosses it without a step that meets
/// the tolerance.
const MAX_ROUNDINGS: f64 = 64.0;

/// Growth factor of this distance until a point is beyond the surface.
const DISTANCE_GROWTH: f64 = 4.0;

/// Fraction of the distance to a surface with singular rates that a step covers.
const APPROACH_FRACTION: f64 = 0.999;

/// Fraction of a step used to compute the slope of a switching function.
const SLOPE_STEP_FRACTION: f64 = 1e-5;

/// Result of a location.
pub(super) enum LocatedEvent {
    /// Points on the near side of a surface and just beyond it. The first one is `None` if it is the start of
    /// the step.
    Crossed(Option<Point>, Point),
    /// The step ends at this point, before the surface or on it.
    Touched(Point),
    /// No step leads to the surface.
    Failed,
}

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    /// Returns the time (s) since the start of the last step at which a function of `crossing` is zero on the
    /// dense output.
    pub(super) fn find_interior_root(&mut self, crossing: &Crossing) -> f64 {
        let (begin, end) = (
            self.run.stepper.step_start().t,
            self.run.stepper.current_point().t,
        );
        let length = end - begin;
        let mut near = (crossing.near * length, 0.0);
        let mut beyond = (crossing.beyond * length, 0.0);
        let (stepper, watched) = (&mut self.run.stepper, self.watched);
        let mut value = |after: f64| {
            let y = match after {
                after if after <= 0.0 => stepper.step_start().y.clone(),
                after if after >= length => stepper.current_point().y.clone(),
                after => stepper.interpolate(watched, begin + after)?,
            };
            Some(watched.lowest_guard(&crossing.guards, begin + after, &y))
        };
        near.1 = value(near.0).unwrap_or(0.0);
        beyond.1 = value(beyond.0).unwrap_or(-1.0);
        if near.1 < 0.0 {
            // The motion may be beyond the surface by less than the rounding in the step.
            beyond = near;
            near = (0.0, value(0.0).unwrap_or(0.0));
        }
        if near.1 <= 0.0 {
            return near.0;
        }
        // The Illinois method (Dowell and Jarratt, BIT 11, 1971).
        for _ in 0..MAX_ITERATIONS {
            let secant = beyond.0 - beyond.1 * (beyond.0 - near.0) / (beyond.1 - near.1);
            let middle = 0.5 * (near.0 + beyond.0);
            let is_inside = near.0 < secant && secant < beyond.0;
            let after = if is_inside { secant } else { middle };
            if after <= near.0 || after >= beyond.0 {
                break;
            }
            let Some(found) = value(after) else {
                return after;
            };
            if found == 0.0 {
                return after;
            }
            if found > 0.0 {
                near = (after, found);
                beyond.1 *= 0.5;
            } else {
                beyond = (after, found);
                near.1 *= 0.5;
            }
        }
        near.0
    }

    /// Locates the surfaces of `crossing` in a step of `length` s from the current point. `guess` is the
    /// estimated time since the start, s.
    pub(super) fn locate(
        &mut self,
        crossing: &Crossing,
        guess: f64,
        length: f64,
    ) -> Result<LocatedEvent, SolveError> {
        let (mut near, mut beyond) = (crossing.near * length, crossing.beyond * length);
        if guess < near {
            (near, beyond) = (0.0, near);
        }
        let is_singular = crossing
            .guards
            .iter()
            .any(|guard| self.watched.is_singular(*guard));
        if is_singular && guess > MAX_ROUNDINGS * self.shortest_step() {
            return Ok(self.approach_surface(&crossing.guards, guess));
        }
        let mut after = guess;
        for _ in 0..MAX_STEPS {
            self.check_steps()?;
            self.trajectory.statistics.trial_steps += 1;
            self.watched.clear_trial_errors();
            let line = match after > self.shortest_step() {
                true => (self.run.stepper.trial(self.watched, after))
                    .map(|(point, rates)| Line { point, rates }),
                false => Some(self.line_here()),
            };
            let Some(line) = line else {
                return Ok(LocatedEvent::Failed);
            };
            let value = line.evaluate_lowest(self, &crossing.guards, 0.0);
            let part = SLOPE_STEP_FRACTION * if after > 0.0 { after } else { length };
            let rise = line.evaluate_lowest(self, &crossing.guards, part)
                - line.evaluate_lowest(self, &crossing.guards, -part);
            let slope = rise / (2.0 * part);
            match value >= 0.0 {
                true => near = near.max(after),
                false => beyond = beyond.min(after),
            }
            let newton = -value / slope;
            let longest = MAX_EXTRAPOLATION * after;
            let is_near = slope < 0.0 && newton.abs() <= longest.max(MIN_DISTANCE * length);
            if is_near || beyond - near <= longest {
                let offset = if is_near { newton } else { 0.0 };
                return Ok(self.cross_on_line(line, (offset, slope), length, &crossing.guards));
            }
            let next = after + newton;
            after = match slope < 0.0 && near < next && next < beyond {
                true => next,
                false => 0.5 * (near + beyond),
            };
        }
        Ok(LocatedEvent::Failed)
    }

    fn line_here(&self) -> Line {
        let point = self.run.stepper.current_point().clone();
        let mut rates = vec![0.0; point.y.len()];
        self.watched.rates(point.t, &point.y, &mut rates);
        Line { point, rates }
    }

    /// Returns the first point beyond a surface along the current rates, at most [`MAX_ROUNDINGS`] shortest
    /// steps ahead.
    pub(super) fn find_point_beyond(&self) -> Option<Point> {
        let line = self.line_here();
        let guards: Vec<usize> = (0..self.watched.sides().len()).collect();
        let shortest = self.shortest_step();
        let mut distance = MIN_SHORTEST_STEPS * shortest;
        while distance <= MAX_ROUNDINGS * shortest {
            let beyond = line.point_at(distance);
            if self.watched.lowest_guard(&guards, beyond.t, &beyond.y) < 0.0 {
                return Some(beyond);
            }
            distance *= DISTANCE_GROWTH;
        }
        None
    }

    /// Evaluates the rates just ahead, to record a state without a finite rate there. If the last step ended at
    /// the end of the domain of the rates, no trial evaluated them beyond it.
    pub(super) fn evaluate_ahead(&self) {
        let mut line = self.line_here();
        let Point { t, y } = line.point_at(MIN_SHORTEST_STEPS * self.shortest_step());
        self.watched.rates(t, &y, &mut line.rates);
    }

    /// Finds points on both sides of the surfaces of `guards` on a line, around an `offset` (s) from its point,
    /// in a step of `length` s. `slope` (per s) is the rate of the lowest guard there.
    fn cross_on_line(
        &mut self,
        line: Line,
        (offset, slope): (f64, f64),
        length: f64,
        guards: &[usize],
    ) -> LocatedEvent {
        let begin = self.run.stepper.current_point().t;
        let shortest = self.shortest_step();
        let mut distance = (MIN_DISTANCE * length).max(MIN_SHORTEST_STEPS * shortest);
        let longest = DISTANCE_GROWTH * (MAX_EXTRAPOLATION * length).max(distance);
        let lowest_guard = |point: &Point| self.watched.lowest_guard(guards, point.t, &point.y);
        let mut found = None;
        while distance <= longest {
            let limited_point = |offset: f64| {
                let Point { t, y } = line.point_at(offset);
                let t = t.min(self.until);
                Point { t, y }
            };
            let (near, beyond) = (
                limited_point(offset - distance),
                limited_point(offset + distance),
            );
            if lowest_guard(&beyond) < 0.0 && beyond.t > begin {
                // Rounding may move the point on the near side by more than the distance.
                let is_near = near.t <= begin || lowest_guard(&near) >= 0.0;
                found = Some((Some(near).filter(|near| near.t > begin), beyond));
                if is_near {
                    break;
                }
            }
            distance *= DISTANCE_GROWTH;
        }
        if let Some((near, beyond)) = found {
            return LocatedEvent::Crossed(near, beyond);
        }
        let roundings = self.watched.guard_roundings(line.point.t, &line.point.y);
        let here = self.run.stepper.current_point();
        let within = |guard: &usize| {
            let value = self.watched.lowest_guard(&[*guard], here.t, &here.y);
            value <= DISTANCE_GROWTH * roundings[*guard]
        };
        let slow: Vec<usize> = guards.iter().copied().filter(within).collect();
        if slow.is_empty() {
            return LocatedEvent::Touched(line.point);
        }
        let rounding = slow.iter().map(|guard| roundings[*guard]);
        let until_beyond = DISTANCE_GROWTH * rounding.fold(0.0, f64::max) / slope.abs();
        let first = line.point.t - begin + until_beyond;
        self.cross_slowly((first, length), &slow, line.point)
    }

    /// Crosses surfaces if a step of `length` s starts within their rounding error. The first trial step has at
    /// least `first` s; a slow motion needs a long step to leave the rounding error. The step ends at `touched`
    /// if it reaches other surfaces first.
    fn cross_slowly(
        &mut self,
        (first, length): (f64, f64),
        guards: &[usize],
        touched: Point,
    ) -> LocatedEvent {
        let (mut near, mut after) = (0.0, first.max(self.shortest_step()).min(length));
        while let Some((side, beyond)) = self.try_step(after, guards) {
            match side {
                TrialSide::Beyond => {
                    return self.find_first_beyond((near, after), (guards, beyond), length);
                }
                TrialSide::Near if after < length => {
                    near = after;
                    after = (DISTANCE_GROWTH * after).min(length);
                }
                TrialSide::Near | TrialSide::BeyondOthers => break,
            }
        }
        let back = touched.t - self.run.stepper.current_point().t;
        if back > 0.0 {
            // The dense output must belong to this step, so the trial is repeated.
            self.run.stepper.trial(self.watched, back);
        }
        LocatedEvent::Touched(touched)
    }

    /// Returns the first point beyond surfaces that steps of `near` s do not reach and steps of `after` s
    /// cross. The rates of the near side do not apply beyond this point.
    fn find_first_beyond(
        &mut self,
        (mut near, mut after): (f64, f64),
        (guards, mut beyond): (&[usize], Point),
        length: f64,
    ) -> LocatedEvent {
        let shortest = (MIN_DISTANCE * length).max(MIN_SHORTEST_STEPS * self.shortest_step());
        let mut is_last = true;
        while after - near > shortest {
            let middle = 0.5 * (near + after);
            is_last = match self.try_step(middle, guards) {
                Some((TrialSide::Beyond, point)) => {
                    (after, beyond) = (middle, point);
                    true
                }
                _ => {
                    near = middle;
                    false
                }
            };
        }
        if !is_last {
            // The dense output must belong to this step, so the trial is repeated.
            self.run.stepper.trial(self.watched, after);
        }
        LocatedEvent::Crossed(None, beyond)
    }

    /// Tries a step of `after` s and returns its end, and the side of the surfaces of `guards` on which it
    /// ends.
    fn try_step(&mut self, after: f64, guards: &[usize]) -> Option<(TrialSide, Point)> {
        self.trajectory.statistics.trial_steps += 1;
        let (point, _) = self.run.stepper.trial(self.watched, after)?;
        let crossed = self.crossed_guards(&point);
        let side = match crossed.iter().all(|guard| guards.contains(guard)) {
            _ if crossed.is_empty() => TrialSide::Near,
            true => TrialSide::Beyond,
            false => TrialSide::BeyondOthers,
        };
        Some((side, point))
    }

    /// Steps to a point before a surface with singular rates, which is `after` s from the current point.
    fn approach_surface(&mut self, guards: &[usize], after: f64) -> LocatedEvent {
        self.trajectory.statistics.trial_steps += 1;
        let trial = self
            .run
            .stepper
            .trial(self.watched, APPROACH_FRACTION * after);
        let near =
            trial.filter(|(point, _)| self.watched.lowest_guard(guards, point.t, &point.y) >= 0.0);
        self.run
            .stepper
            .set_step(2.0 * (1.0 - APPROACH_FRACTION) * after);
        near.map_or(LocatedEvent::Failed, |(point, _)| {
            LocatedEvent::Touched(point)
        })
    }
}

/// Side of surfaces on which a trial step ends.
enum TrialSide {
    Near,
    /// The step ends beyond these surfaces, and beyond no others.
    Beyond,
    BeyondOthers,
}

/// Line through a point of the motion along its rates.
struct Line {
    point: Point,
    rates: Vec<f64>,
}

impl Line {
    /// Returns the point at an `offset` in s.
    fn point_at(&self, offset: f64) -> Point {
        let entries = self.point.y.iter().zip(&self.rates);
        Point {
            t: self.point.t + offset,
            y: entries.map(|(y, rate)| y + offset * rate).collect(),
        }
    }

    /// Returns the value of the lowest of `guards` at an `offset` in s; each is positive on its near side.
    fn evaluate_lowest<S: System + ?Sized, M: Stepper>(
        &self,
        driver: &Driver<'_, S, M>,
        guards: &[usize],
        offset: f64,
    ) -> f64 {
        let point = self.point_at(offset);
        driver.watched.lowest_guard(guards, point.t, &point.y)
    }
}
