//! Interface between the driver and a method: steps of controlled length, steps of a given length,
//! and states inside a step. The driver decides about switches.

use super::bernstein::{BernsteinBasis, Piece};
use super::error::SolveError;
use super::magnitudes::Magnitudes;
pub use super::point::Point;
use super::system::System;
use super::watch::WatchedSystem;

/// Parts of a step that may be refused; see [`split_step`].
const MOST_REFUSED: u32 = 50;

/// Result of a controlled step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// The error meets the tolerance. If not, the next step will be shorter.
    pub is_accepted: bool,
    /// The length of the step tried, s.
    pub length: f64,
}

/// A method with a current point from which it can step.
pub trait Stepper: Sized {
    /// True if stability keeps its steps short where a system is stiff.
    const IS_EXPLICIT: bool;

    /// Steps from `start`, the first one of length `step` (s) at most.
    fn new(start: Point, step: f64, magnitudes: Magnitudes) -> Self;

    /// Start of the next step.
    fn current_point(&self) -> &Point;

    /// Start of the last step.
    fn step_start(&self) -> &Point;

    /// The length of the next step, s.
    fn step(&self) -> f64;

    /// Makes the next step one of length `step` (s), and forgets nothing else.
    fn set_step(&mut self, step: f64);

    /// Continues from another point, beyond a switching surface, without history. The first step is
    /// at most `step` (s) long.
    fn restart(&mut self, point: Point, step: f64);

    /// Goes on from a state that replaces the one here and differs from it by errors of the last step.
    fn correct(&mut self, y: Vec<f64>) {
        let t = self.current_point().t;
        self.restart(Point { t, y }, self.step());
    }

    /// Scales of the errors. They follow only the states of the trajectory; see
    /// [`Stepper::settle`].
    fn magnitudes(&self) -> &Magnitudes;

    /// Scales of the errors, to set the rounding of the next step.
    fn magnitudes_mut(&mut self) -> &mut Magnitudes;

    /// Adds the state here, which enters the trajectory, to the scales of the errors. A step that is
    /// taken back leaves no trace in them. A state that `is_projected` onto constraints has the rounding of
    /// all its components.
    fn settle(&mut self, is_projected: bool);

    /// Tries a step that ends at `until` (s) at the latest, as the right-hand side may jump there.
    /// An accepted step moves the method to its end.
    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError>;

    /// Undoes the last step, which was accepted; the length of the next one is open.
    fn take_back(&mut self);

    /// Makes a step of exactly `length` s from here, whatever its error, and returns its end and the rates there;
    /// `None` if the step overflows or leaves the domain of the rates. The method stays here.
    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Option<(Point, Vec<f64>)>;

    /// Goes to a point that differs from the end of the last trial by a small part of its length.
    fn end_trial(&mut self, point: Point);

    /// Returns the state at time `t` (s) inside the last step by interpolation; `None` if this method made no step
    /// to here.
    fn interpolated<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>>;

    /// Returns the interpolation inside the last step as a polynomial; `None` if this method made no step to here.
    fn interior<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        basis: &BernsteinBasis,
    ) -> Option<Piece> {
        let (start, end) = (self.step_start().clone(), self.current_point().clone());
        let at = |part: f64| start.t + part * (end.t - start.t);
        basis.fit((&start.y, &end.y), |part| {
            self.interpolated(watched, at(part))
        })
    }

    /// Returns true if interpolation inside the last step is as accurate as the step: one that
    /// stability keeps short ends where it should, and may swing in between.
    fn tells_interior<S: System + ?Sized>(&mut self, watched: &WatchedSystem<'_, S>) -> bool {
        let _ = watched;
        true
    }

    /// Returns true if interpolation inside the last step is accurate enough for samples of a smooth motion.
    fn tells_smooth_interior<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
    ) -> bool {
        let _ = watched;
        true
    }

    /// The state at time `t` (s) inside the last step, with the accuracy of the step; `None` if no
    /// step to there meets the tolerance.
    fn inside<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>>;
}

/// A step of `length` s from `start` in parts: `step` makes the part of a length from a point that ends
/// at a time, and returns `None` if it must be shorter. Parts are halves of halves, so that they
/// add up exactly. Returns `None` if parts get too short.
pub fn split_step(
    start: &Point,
    length: f64,
    mut step: impl FnMut(&Point, f64, f64) -> Option<Point>,
) -> Option<Point> {
    let mut point = start.clone();
    let (mut part, mut done, mut refused) = (1.0, 0.0, 0);
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
        refused += 1;
        if refused > MOST_REFUSED {
            return None;
        }
    }
    Some(point)
}

/// Why a method refused to go on from a point with this step (s).
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
