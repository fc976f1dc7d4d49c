//! Interface between the driver and a method: steps of controlled length, steps of given length, and states
//! inside a step. The driver handles switches.

use super::bernstein::{BernsteinBasis, Piece};
use super::error::SolveError;
use super::magnitudes::Magnitudes;
pub use super::point::Point;
use super::system::System;
use super::watch::WatchedSystem;

/// Maximum number of parts that may be rejected; see [`split_step`].
const MAX_REJECTED_PARTS: u32 = 50;

/// Result of a controlled step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// True if the error meets the tolerance. If false, the next step is shorter.
    pub is_accepted: bool,
    /// Length of the trial step, s.
    pub length: f64,
}

/// A one-step or multistep method with its current point.
pub trait Stepper: Sized {
    /// True if stability limits the step size for stiff systems.
    const IS_EXPLICIT: bool;

    /// Creates the method at `start`. The first step is at most `step` (s) long.
    fn new(start: Point, step: f64, magnitudes: Magnitudes) -> Self;

    /// Start of the next step.
    fn current_point(&self) -> &Point;

    /// Start of the last step.
    fn step_start(&self) -> &Point;

    /// Returns the length of the next step, s.
    fn step(&self) -> f64;

    /// Sets the length of the next step to `step` (s) and keeps the history.
    fn set_step(&mut self, step: f64);

    /// Continues from another point, beyond a switching surface, without history. The first step is at most
    /// `step` (s) long.
    fn restart(&mut self, point: Point, step: f64);

    /// Replaces the current state by one that differs within the errors of the last step, and continues from it.
    fn correct(&mut self, y: Vec<f64>) {
        let t = self.current_point().t;
        self.restart(Point { t, y }, self.step());
    }

    /// Returns the scales of the errors. They depend only on the states of the trajectory; see
    /// [`Stepper::settle`].
    fn magnitudes(&self) -> &Magnitudes;

    /// Returns the scales of the errors, to set the rounding of the next step.
    fn magnitudes_mut(&mut self) -> &mut Magnitudes;

    /// Adds the current state, which belongs to the trajectory, to the scales of the errors. Undone steps do
    /// not affect the scales. A state that `is_projected` onto constraints has the rounding of all its
    /// components.
    fn settle(&mut self, is_projected: bool);

    /// Tries a step that ends at `until` (s) at the latest, as the right-hand side may jump there.
    /// An accepted step moves the method to its end.
    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError>;

    /// Undoes the last step, which was accepted. The length of the next step must be set again.
    fn undo_step(&mut self);

    /// Makes a step of exactly `length` s from the current point, without error control, and returns its end
    /// and the rates there; `None` if the step overflows or leaves the domain of the rates. The current point
    /// does not change.
    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Option<(Point, Vec<f64>)>;

    /// Moves to a point that differs from the end of the last trial by a small fraction of its length.
    fn end_trial(&mut self, point: Point);

    /// Returns the state at time `t` (s) inside the last step by interpolation; `None` if the method did not
    /// make the last step itself.
    fn interpolate<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>>;

    /// Returns the dense output of the last step as a polynomial; `None` if the method did not make the last
    /// step itself.
    fn interior<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        basis: &BernsteinBasis,
    ) -> Option<Piece> {
        let (start, end) = (self.step_start().clone(), self.current_point().clone());
        let at = |part: f64| start.t + part * (end.t - start.t);
        basis.fit((&start.y, &end.y), |part| {
            self.interpolate(watched, at(part))
        })
    }

    /// Returns true if interpolation inside the last step is as accurate as the step. If stability limits the
    /// step size, the end of a step is accurate, but the interpolation may oscillate.
    fn has_accurate_interior<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
    ) -> bool {
        let _ = watched;
        true
    }

    /// Returns true if interpolation inside the last step is accurate enough for samples of a smooth motion.
    fn has_smooth_interior<S: System + ?Sized>(&mut self, watched: &WatchedSystem<'_, S>) -> bool {
        let _ = watched;
        true
    }

    /// Returns the state at time `t` (s) inside the last step, with the accuracy of the step; `None` if no step
    /// to this time meets the tolerance.
    fn compute_state_at<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>>;
}

/// Makes a step of `length` s from `start` in parts. `step` makes one part: it takes the start point, the
/// length and the end time, and returns `None` if the part must be shorter. The parts result from repeated
/// halving, so their sum is exact. Returns `None` if the parts get too short.
pub fn split_step(
    start: &Point,
    length: f64,
    mut step: impl FnMut(&Point, f64, f64) -> Option<Point>,
) -> Option<Point> {
    let mut point = start.clone();
    let (mut part, mut done, mut rejected) = (1.0, 0.0, 0);
    while done < 1.0 {
        let t = match done + part < 1.0 {
            true => start.t + (done + part) * length,
            false => start.t + length,
        };
        if let Some(next) = step(&point, part * length, t) {
            point = next;
            done += part;
            if done % (2.0 * part) == 0.0 {
                part *= 2.0;
            }
            continue;
        }
        part *= 0.5;
        rejected += 1;
        if rejected > MAX_REJECTED_PARTS {
            return None;
        }
    }
    Some(point)
}

/// Returns the reason why a method rejected a step (s) from a point.
pub fn rejection_error<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    from: &Point,
    step: f64,
) -> SolveError {
    let t = from.t;
    match (watched.indefinite_coordinate(), watched.non_finite_state()) {
        (Some(coordinate), _) => SolveError::NotPositiveDefinite { t, coordinate },
        (None, Some(state)) => SolveError::NotFinite { t, state },
        (None, None) => SolveError::StepTooSmall {
            t,
            step,
            state: watched.fastest_state(t, &from.y),
        },
    }
}
