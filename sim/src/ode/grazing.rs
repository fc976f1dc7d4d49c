//! Search of accepted steps for missed crossings: a switching function that changes sign and changes back
//! between the times at which the step evaluated it.
//!
//! For each switching function, a parabola through the lowest of five samples and its two neighbours predicts
//! the minimum. If the predicted minimum is near or below zero, the search evaluates the function there on the
//! motion and refines the parabola until no lower value is expected. Shampine and Thompson recommend this
//! search for turning points of event functions ("Event location for ordinary differential equations",
//! Computers and Mathematics with Applications 39, 2000), with the polynomial of the interpolant instead of a
//! parabola. The search misses functions with more than one turning point in a step.

use super::resolution::SAMPLE_FRACTIONS;
use super::stepper::{Point, Stepper};
use super::system::System;
use super::watch::WatchedSystem;

/// The search evaluates a predicted minimum if it is below this fraction of the lowest known value.
const MAX_MINIMUM_FRACTION: f64 = 0.5;

/// Bound on the error of a parabola through three equally spaced values, as a fraction of the third difference.
const PARABOLA_ERROR_FRACTION: f64 = 0.1;

/// Rounding of a switching function, as a fraction of its highest value in the step. Smaller
/// negative values count as positive.
const ROUNDING_FRACTION: f64 = 1e-12;

/// Maximum number of evaluations of one switching function in one step. The search converges in two or three.
const MAX_EVALUATIONS: u32 = 8;

/// A time in a step, as a fraction of its length, and the switching function at this time, positive on the side
/// of the start.
#[derive(Clone, Copy)]
struct Sample {
    at: f64,
    value: f64,
}

/// Returns the first switching function found beyond its surface inside the last accepted step, and the time of
/// this crossing since the start of the step, s.
///
/// `sides` are 0 for ignored functions, and `values` are the functions at [`SAMPLE_FRACTIONS`] of the step. `trials`
/// counts the states that the stepper computes. A state that overflows or leaves the domain of the rates counts
/// as beyond the surface.
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
        let y = stepper.compute_state_at(watched, t)?;
        Some(Point { t, y })
    };
    let samples = |guard: usize, side: f64| {
        let value = |index: usize| side * values[index][guard];
        let lowest = (1..SAMPLE_FRACTIONS.len()).fold(0, |lowest, index| {
            match value(index) < value(lowest) {
                true => index,
                false => lowest,
            }
        });
        let middle = lowest.clamp(1, SAMPLE_FRACTIONS.len() - 2);
        let third = |from: usize| {
            (value(from + 3) - value(from) - 3.0 * (value(from + 2) - value(from + 1))).abs()
        };
        let samples = [middle - 1, middle, middle + 1].map(|index| Sample {
            at: SAMPLE_FRACTIONS[index],
            value: value(index),
        });
        (samples, PARABOLA_ERROR_FRACTION * third(0).max(third(1)))
    };
    search(watched, end - begin, sides, samples, &mut after)
}

/// Returns the first switching function found beyond its surface in a step of `length` s, and the time since
/// its start, s. `samples` returns the samples of a function on its side and the error of their parabola.
/// `after` computes the point at a time since the start, s.
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
        let negligible = ROUNDING_FRACTION * highest;
        let mut look = |at: f64| {
            watched.clear_trial_errors();
            let point = after(at * length)?;
            let value = side * watched.evaluate_guards(point.t, &point.y)[guard];
            (value >= -negligible).then_some(value)
        };
        if let Some(at) = find_time_beyond(samples, doubt, &mut look) {
            return Some((guard, at * length));
        }
    }
    None
}

/// Returns a time at which the function of `samples` is beyond the surface. `look` evaluates the
/// function and returns `None` beyond the surface; `doubt` is the error of the first parabola.
fn find_time_beyond(
    mut samples: [Sample; 3],
    doubt: f64,
    look: &mut impl FnMut(f64) -> Option<f64>,
) -> Option<f64> {
    for _ in 0..MAX_EVALUATIONS {
        let at = predict_minimum(&samples, doubt)?;
        let Some(value) = look(at) else {
            return Some(at);
        };
        samples = select_neighbours(samples, Sample { at, value });
    }
    None
}

/// Returns the time of the predicted minimum if it may be negative. `doubt` is the error of the
/// parabola through the samples.
fn predict_minimum(samples: &[Sample; 3], doubt: f64) -> Option<f64> {
    let [a, b, c] = *samples;
    let lowest = a.value.min(b.value).min(c.value);
    if lowest < 0.0 {
        // Only the middle sample can be negative. It is interpolated, so the motion itself is evaluated.
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
    (is_inside && value < (MAX_MINIMUM_FRACTION * lowest).max(doubt)).then_some(at)
}

/// Returns the lowest of the four samples and its two neighbours.
fn select_neighbours(samples: [Sample; 3], new: Sample) -> [Sample; 3] {
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

    /// Returns a point in 0..1 with a negative value, and the number of evaluations.
    fn search(function: impl Fn(f64) -> f64) -> (Option<f64>, u32) {
        let mut looks = 0;
        let samples = [0.0, 0.5, 1.0].map(|at| Sample {
            at,
            value: function(at),
        });
        let found = find_time_beyond(samples, 0.0, &mut |at| {
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
