//! What an accepted step may have passed over: a switching function that changes sign and changes
//! back between the places where the step was evaluated.
//!
//! The switching functions where they are lowest of five times in the step give a parabola each. Where
//! one comes close to zero in between, or beyond, the motion itself is asked there, and again
//! beside the lowest value found until nothing lower is to be expected. This is the search for
//! turning points of the event functions that Shampine and Thompson recommend ("Event location
//! for ordinary differential equations", Computers and Mathematics with Applications 39, 2000),
//! with a parabola in place of the interpolant's polynomial. What it cannot see is a function that turns more
//! than once within a step.

use super::resolution::PARTS;
use super::stepper::{Point, Stepper};
use super::system::System;
use super::watch::WatchedSystem;

/// The motion is asked where a parabola promises less than this part of the lowest value known.
const WORTH_A_LOOK: f64 = 0.5;

/// A parabola through three of equally spaced values is off between them by less than this part of the third
/// difference.
const DOUBT: f64 = 0.1;

/// Negative values up to this part of the highest one in a step may be rounding.
const ROUNDING: f64 = 1e-12;

/// States looked at for one switching function in one step. The search converges in two or three.
const MOST_LOOKS: u32 = 8;

/// A time within a step as a part of its length, and a switching function there, positive on the
/// side that the step began on.
#[derive(Clone, Copy)]
struct Sample {
    at: f64,
    value: f64,
}

/// Returns a function and how far from its start (s) the last, accepted step of a stepper was beyond its surface, which it
/// neither began nor ended beyond; `None` if it was not. `sides` are 0 for functions to ignore, and
/// `values` those of the functions at [`PARTS`] of the step. `trials` counts the states that the stepper
/// computes. A state inside that overflows or leaves the domain of the rates counts as one beyond.
pub fn find_passed_surface<S: System + ?Sized, M: Stepper>(
    (watched, stepper): (&WatchedSystem<'_, S>, &mut M),
    sides: &[f64],
    values: &[Vec<f64>; 5],
    trials: &mut u64,
) -> Option<(usize, f64)> {
    let (begin, end) = (stepper.step_start().t, stepper.current_point().t);
    let mut after = |length: f64| {
        *trials += 1;
        let t = begin + length;
        let y = stepper.inside(watched, t)?;
        Some(Point { t, y })
    };
    let samples = |guard: usize, side: f64| {
        let value = |place: usize| side * values[place][guard];
        let lowest = (1..PARTS.len()).fold(0, |lowest, place| match value(place) < value(lowest) {
            true => place,
            false => lowest,
        });
        let middle = lowest.clamp(1, PARTS.len() - 2);
        let third = |from: usize| {
            (value(from + 3) - value(from) - 3.0 * (value(from + 2) - value(from + 1))).abs()
        };
        let samples = [middle - 1, middle, middle + 1].map(|place| Sample {
            at: PARTS[place],
            value: value(place),
        });
        (samples, DOUBT * third(0).max(third(1)))
    };
    search(watched, end - begin, sides, samples, &mut after)
}

/// Returns a function and how far from its start (s) a motion in a step of `length` s is beyond its surface, given the `samples` of
/// each function on its side and the error of their parabola; `after` computes the point so far from the start.
fn search<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    length: f64,
    sides: &[f64],
    samples: impl Fn(usize, f64) -> ([Sample; 3], f64),
    after: &mut impl FnMut(f64) -> Option<Point>,
) -> Option<(usize, f64)> {
    for (guard, side) in sides.iter().copied().enumerate() {
        if side == 0.0 {
            continue;
        }
        let (samples, doubt) = samples(guard, side);
        let highest = samples
            .map(|sample| sample.value)
            .into_iter()
            .fold(0.0, f64::max);
        let negligible = ROUNDING * highest;
        let mut look = |at: f64| {
            watched.forget_trials();
            let point = after(at * length)?;
            let value = side * watched.evaluate_guards(point.t, &point.y)[guard];
            (value >= -negligible).then_some(value)
        };
        if let Some(at) = beyond(samples, doubt, &mut look) {
            return Some((guard, at * length));
        }
    }
    None
}

/// Where the function of `samples` is beyond the surface, if anywhere; `look` gives its value, or
/// `None` where it is beyond.
fn beyond(
    mut samples: [Sample; 3],
    doubt: f64,
    look: &mut impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    for _ in 0..MOST_LOOKS {
        let at = next_look(&samples, doubt)?;
        let Some(value) = look(at) else {
            return Some(at);
        };
        samples = around(samples, Sample { at, value });
    }
    None
}

/// Where within three samples, whose parabola may be off by `doubt`, to look for something negative, if anywhere.
fn next_look(samples: &[Sample; 3], doubt: f64) -> Option<f64> {
    let [a, b, c] = *samples;
    let lowest = a.value.min(b.value).min(c.value);
    if lowest < 0.0 {
        // Only an interpolated state can be, the middle one at first: is the motion there as well?
        return Some(b.at);
    }
    let before = (b.value - a.value) / (b.at - a.at);
    let after = (c.value - b.value) / (c.at - b.at);
    let curvature = (after - before) / (c.at - a.at);
    if curvature <= 0.0 {
        return None;
    }
    let at = 0.5 * (a.at + b.at - before / curvature);
    let is_inside = a.at < at && at < c.at && at != b.at;
    let value = a.value + (at - a.at) * (before + (at - b.at) * curvature);
    (is_inside && value < (WORTH_A_LOOK * lowest).max(doubt)).then_some(at)
}

/// The three of four samples that stand around the lowest.
fn around(samples: [Sample; 3], new: Sample) -> [Sample; 3] {
    let [a, b, c] = samples;
    if new.at == b.at {
        return [a, new, c];
    }
    let (left, right) = if new.at < b.at { (new, b) } else { (b, new) };
    if left.value < right.value {
        [a, left, right]
    } else {
        [left, right, c]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the point on 0..1 at which a function is found negative, and the number of
    /// evaluations.
    fn search(function: impl Fn(f64) -> f64) -> (Option<f64>, u32) {
        let mut looks = 0;
        let samples = [0.0, 0.5, 1.0].map(|at| Sample {
            at,
            value: function(at),
        });
        let found = beyond(samples, 0.0, &mut |at| {
            looks += 1;
            Some(function(at)).filter(|value| *value >= 0.0)
        });
        (found, looks)
    }

    #[test]
    fn shallow_negative_minimum_is_found() {
        for depth in [1e-3, 1e-6, 1e-9] {
            for lowest in [0.1, 0.37, 0.5, 0.8] {
                let (found, looks) = search(|at| 1.0 - (at - lowest).cos() - depth);
                let at = found.unwrap_or_else(|| panic!("{depth:e} at {lowest}"));
                assert!((at - lowest).abs() < 2.0 * depth.sqrt() && looks <= 4);
            }
        }
    }

    #[test]
    fn distant_minimum_needs_no_evaluation() {
        let (found, looks) = search(|at| 0.5 + (at - 0.4) * (at - 0.4));
        assert_eq!((found, looks), (None, 0));
    }

    #[test]
    fn departure_from_surface_is_no_crossing() {
        let (found, _) = search(|at| at * at * at);
        assert_eq!(found, None);
    }
}
