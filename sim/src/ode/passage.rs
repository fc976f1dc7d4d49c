//! Passage through a switching surface.

use super::driver::Driver;
use super::error::SolveError;
use super::event_search::Crossing;
use super::location::LocatedEvent;
use super::stepper::{Point, Stepper, rejection_error};
use super::system::System;

/// Factor by which a step is shortened that does not reach its surface.
const SHORTENING_FACTOR: f64 = 0.25;

impl<S: System + ?Sized, M: Stepper> Driver<'_, S, M> {
    /// Shortens the last step, of `length` s, to end at the first surface that it crosses, and applies the
    /// event.
    pub(super) fn cross(&mut self, crossing: &Crossing, length: f64) -> Result<(), SolveError> {
        let guess = self.find_interior_root(crossing);
        self.run.stepper.undo_step();
        let start = self.run.stepper.current_point().clone();
        let (located, guards) = self.locate_first(crossing, guess, length)?;
        let guard = guards.first().copied();
        let has_crossed = matches!(located, LocatedEvent::Crossed(..));
        let recorded = self.trajectory.events.len();
        match located {
            LocatedEvent::Crossed(near, mut beyond) => {
                let crossed = self.crossed_guards(&beyond);
                if let Some(mut near) = near {
                    let allowed = self.allowed_errors(&near.y);
                    let surfaces = (&guards[..], &allowed[..]);
                    self.watched.project_before(surfaces, near.t, &mut near.y);
                    self.end_step(near)?;
                }
                let near = self.run.stepper.current_point().clone();
                self.apply_event(&crossed, &near, &mut beyond);
                self.run.stepper.restart(beyond, length);
                self.project();
                self.accept(near.t)?;
            }
            LocatedEvent::Touched(point) if point.t > start.t => self.end_step(point)?,
            LocatedEvent::Touched(_) | LocatedEvent::Failed => {
                self.run.stepper.restart(start, SHORTENING_FACTOR * length);
            }
        }
        // Approaches to a surface without an event must make progress, too.
        let is_unrecorded = self.trajectory.events.len() == recorded;
        if let Some(guard) = guard.filter(|_| is_unrecorded) {
            self.check_switch_rate(self.run.stepper.current_point().t, guard)?;
        }
        self.check_approaches(guard, has_crossed)
    }

    /// Crosses a surface so close that no step to it meets the tolerance, for example if the rates beyond it
    /// are singular.
    ///
    /// # Errors
    /// The reason why steps are too short, if there is no surface.
    pub(super) fn cross_close_surface(&mut self) -> Result<(), SolveError> {
        let near = self.run.stepper.current_point().clone();
        let step = self.run.stepper.step();
        let Some(mut beyond) = self.find_point_beyond() else {
            self.evaluate_ahead();
            return Err(rejection_error(self.watched, &near, step));
        };
        let crossed = self.crossed_guards(&beyond);
        self.apply_event(&crossed, &near, &mut beyond);
        self.run.stepper.restart(beyond, step / SHORTENING_FACTOR);
        self.project();
        self.accept(near.t)
    }

    /// Ends the step at a point on the near side of a surface.
    fn end_step(&mut self, point: Point) -> Result<(), SolveError> {
        let begin = self.run.stepper.current_point().t;
        self.run.stepper.end_trial(point);
        self.project();
        self.accept(begin)
    }

    /// Locates the surfaces of `crossing` like [`Driver::locate`]. If the motion crosses other surfaces first,
    /// locates these. Returns the located surfaces as well.
    fn locate_first(
        &mut self,
        crossing: &Crossing,
        guess: f64,
        length: f64,
    ) -> Result<(LocatedEvent, Vec<usize>), SolveError> {
        let mut located = self.locate(crossing, guess, length)?;
        let mut guards = crossing.guards.clone();
        for _ in 0..self.watched.sides().len() {
            let (LocatedEvent::Crossed(Some(reached), _) | LocatedEvent::Touched(reached)) =
                &located
            else {
                break;
            };
            let mut passed = self.crossed_guards(reached);
            passed.retain(|guard| !guards.contains(guard));
            let start = self.run.stepper.current_point();
            if passed.is_empty() || reached.t <= start.t {
                break;
            }
            let [from, to] =
                [start, reached].map(|point| self.watched.lowest_guard(&passed, point.t, &point.y));
            let after = reached.t - start.t;
            let guess = after * (from / (from - to)).clamp(0.0, 1.0);
            let first = Crossing {
                near: 0.0,
                beyond: after / length,
                guards: passed,
            };
            located = self.locate(&first, guess, length)?;
            guards = first.guards;
        }
        Ok((located, guards))
    }

    /// Returns the error allowed to each state.
    fn allowed_errors(&self, y: &[f64]) -> Vec<f64> {
        self.run.stepper.magnitudes().allowed(y).collect()
    }

    /// Applies the event at the crossed surfaces between `start` and `point`, and records the surfaces that
    /// reversed the motion with a jump.
    fn apply_event(&mut self, crossed: &[usize], start: &Point, point: &mut Point) {
        let allowed = self.allowed_errors(&point.y);
        let surfaces = (crossed, &allowed[..]);
        self.watched
            .project_beyond(surfaces, &start.y, point.t, &mut point.y);
        let arrived = self.crossed_guards(point);
        let before = point.y.clone();
        let start = (start.t, &start.y[..]);
        let jumps = self.watched.apply_event(start, point.t, &mut point.y)
            && self.record_jump(point.t, &before, &point.y);
        let beyond = self.crossed_guards(point);
        self.run.rebounds = arrived;
        (self.run.rebounds).retain(|guard| jumps && !beyond.contains(guard));
    }

    /// Returns the surfaces of the current regime that a point is beyond.
    pub(super) fn crossed_guards(&self, point: &Point) -> Vec<usize> {
        let guards = self.watched.evaluate_guards(point.t, &point.y);
        let values = guards.into_iter().enumerate();
        let beyond = values.filter(|(guard, value)| self.watched.is_beyond(*guard, *value));
        beyond.map(|(guard, _)| guard).collect()
    }
}
