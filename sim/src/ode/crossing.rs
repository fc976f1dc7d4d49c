//! The approach to a switching surface.
//!
//! From a point before the surface the longest step is sought whose every trial state
//! stays on the near side; from there again, and so on. Each approach leaves a small
//! part of the distance, so that after a few of them the rest is crossed by a step too
//! short to carry an error, whatever side its trial states are on.

use super::stepper::Stepper;
use super::system::System;
use super::watch::WatchedSystem;

/// How much of an approach is left, relative to its length, before the next one begins.
const REMAINDER: f64 = 1e-3;

/// The step over the surface, relative to the step that ran into it. A jump of the rates
/// that changes the state by as much as itself within that step leaves this error.
const OVER: f64 = 1e-13;

/// Trial steps in one approach; bisection alone needs 10.
const MAX_TRIALS: u64 = 60;

/// What a search between a start and a step beyond the surface found.
pub struct Approach {
    /// The longest step that stays on the near side, s; 0 if none does.
    pub length: f64,
    /// How far beyond it the surface may lie, s.
    pub distance_beyond: f64,
    /// The switching functions there; none if they are not known.
    pub guards_beyond: Vec<f64>,
    /// The trial steps made.
    pub trials: u64,
}

/// The step over the surface that belongs to a step of `length` s.
pub fn crossing_step(length: f64) -> f64 {
    length * OVER
}

/// Searches the longest step from where `stepper` stands that stays on the near side of
/// all surfaces, given that one of `length` s does not. A trial that overflows or leaves the domain
/// of the rates counts as one beyond.
pub fn find_approach<S: System + ?Sized, M: Stepper>(
    watched: &WatchedSystem<'_, S>,
    stepper: &mut M,
    length: f64,
    beyond: Vec<f64>,
) -> Approach {
    let start = stepper.current_point();
    let mut near = End {
        at: 0.0,
        guards: watched.evaluate_guards(start.t, &start.y),
    };
    let mut far = End {
        at: length,
        guards: beyond,
    };
    let mut trials = 0;
    while far.at - near.at > REMAINDER * length && trials < MAX_TRIALS {
        let at = next_trial(watched, &near, &far, trials, length);
        watched.forget_trials();
        let point = stepper.trial(watched, at);
        trials += 1;
        let is_beyond = point.is_none() || watched.crossed_guard().is_some();
        let guards = point.map_or(Vec::new(), |point| {
            watched.evaluate_guards(point.t, &point.y)
        });
        let end = if is_beyond { &mut far } else { &mut near };
        *end = End { at, guards };
    }
    Approach {
        length: near.at,
        distance_beyond: far.at - near.at,
        guards_beyond: far.guards,
        trials,
    }
}

/// One end of the interval that holds the surface.
struct End {
    at: f64,
    guards: Vec<f64>,
}

/// Where to try next: a little before, then a little behind the earliest crossing of the
/// secants, and every third time in the middle, so that the interval shrinks whatever
/// the functions do.
fn next_trial<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    near: &End,
    far: &End,
    trial: u64,
    length: f64,
) -> f64 {
    let width = far.at - near.at;
    let middle = near.at + 0.5 * width;
    let secants = near.guards.iter().zip(&far.guards).enumerate();
    let earliest = secants
        .filter(|(guard, (_, value))| watched.is_beyond(*guard, **value))
        .map(|(_, (from, to))| near.at + width * from / (from - to))
        .fold(f64::INFINITY, f64::min);
    let aside = 0.4 * REMAINDER * length;
    let at = match trial % 3 {
        0 => earliest - aside,
        1 => earliest + aside,
        _ => middle,
    };
    if near.at < at && at < far.at {
        at
    } else {
        middle
    }
}
