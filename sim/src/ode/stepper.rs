//! What the driver asks of a method: steps whose length follows from the error, steps of
//! a given length, and states inside a step. Where steps lead is not decided here.

use super::error::SolveError;
use super::system::System;
use super::watch::Watched;

/// A state and its time.
#[derive(Clone, Debug)]
pub struct Point {
    /// Time, s.
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
}

/// How a controlled step ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// The error is small enough. If not, the next step will be shorter.
    pub is_accepted: bool,
    /// The length of the step tried, s.
    pub length: f64,
}

/// A method that stands at a point and can go on from there.
pub trait Stepper: Sized {
    /// Whether stability keeps its steps short where a system is stiff.
    const IS_EXPLICIT: bool;

    /// Steps from `start`, the first one of length `step` (s) at most.
    fn new(start: Point, step: f64, tolerance: f64) -> Self;

    /// Where the next step begins.
    fn here(&self) -> &Point;

    /// Where the last step began.
    fn last(&self) -> &Point;

    /// The length of the next step, s.
    fn step(&self) -> f64;

    /// Makes the next step one of length `step` (s), and forgets nothing else.
    fn set_step(&mut self, step: f64);

    /// Goes on from another point, behind a switching surface, with a step of length
    /// `step` (s) at most and without relying on what came before.
    fn restart(&mut self, point: Point, step: f64);

    /// Tries a step that ends at `until` (s) at the latest, where the right-hand side may
    /// jump. If it is accepted the method stands at the new point.
    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &Watched<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError>;

    /// Undoes the last step, which was accepted; the length of the next one is open.
    fn take_back(&mut self);

    /// The point that a step of exactly `length` s leads to, whatever its error.
    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &Watched<'_, S>,
        length: f64,
    ) -> Result<Point, SolveError>;

    /// The state at time `t` (s) inside the last step by interpolation, without an evaluation; `None` if this
    /// method made none to here.
    fn interpolated(&mut self, t: f64) -> Option<Vec<f64>>;

    /// Whether interpolation inside the last step is as accurate as the step: one that stability keeps short
    /// ends where it should, and may swing in between.
    fn tells_interior<S: System + ?Sized>(&mut self, watched: &Watched<'_, S>) -> bool {
        let _ = watched;
        true
    }

    /// The state at time `t` (s) inside the last step, with the accuracy of the step.
    fn inside<S: System + ?Sized>(
        &mut self,
        watched: &Watched<'_, S>,
        t: f64,
    ) -> Result<Vec<f64>, SolveError>;

    /// The point that a step of exactly `length` s leads to from `start`, whatever its error and
    /// without relying on where the steps before led; what has to be solved for is as accurate as in
    /// those. Where that is hard, it may end earlier, beyond a switching surface.
    fn single_step<S: System + ?Sized>(
        &self,
        watched: &Watched<'_, S>,
        start: &Point,
        length: f64,
    ) -> Result<Point, SolveError>;
}

/// Why a method refused to go on from a point with this step (s).
pub fn refusal<S: System + ?Sized>(
    watched: &Watched<'_, S>,
    from: &Point,
    step: f64,
) -> SolveError {
    let t = from.t;
    match (watched.indefinite(), watched.not_finite()) {
        (Some(coordinate), _) => SolveError::NotPositiveDefinite { t, coordinate },
        (None, Some(state)) => SolveError::NotFinite { t, state },
        (None, None) => SolveError::StepTooSmall {
            t,
            step,
            state: watched.fastest(t, &from.y),
        },
    }
}
