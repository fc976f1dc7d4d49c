//! Coordinates of a section that grow without bound, for example in rotating machines.
//!
//! Points that differ only in a cyclic coordinate are equal. Points that differ by full turns of a periodic angle are
//! equal.

use std::f64::consts::TAU;

use eomgen_compiled_model::{Instance, OperatingPoint};

use super::numbers::{CoordinateComparison, compute_extents, wrap_angle};
use super::quantity::Quantity;
use crate::conditions::Start;
use crate::measure::Failure;

/// Number of states at which the equations are compared after a turn.
const COMPARED_STATES: usize = 8;

pub struct MotionSamples<'m> {
    /// Start and inputs of the motion.
    pub start: &'m Start,
    /// Times of the samples, in s.
    pub times: &'m [f64],
    pub states: &'m [Vec<f64>],
}

impl MotionSamples<'_> {
    /// Returns the point of a state, with the inputs at its time.
    fn point(&self, t: f64, state: Vec<f64>) -> OperatingPoint {
        OperatingPoint {
            t,
            state,
            inputs: self.start.inputs.evaluate(t).into_owned(),
        }
    }
}

/// Replaces the comparison of a drifting coordinate, and removes full turns from the points. `resolution` is the
/// relative error of the states.
pub fn remove_drift(
    (instance, resolution): (&Instance<'_>, f64),
    quantity: &Quantity,
    looks: &MotionSamples<'_>,
    (seen, points): (&[[f64; 2]], &mut [[f64; 2]]),
    parts: &mut [CoordinateComparison; 2],
) -> Result<(), Failure> {
    let (shown, place) = quantity.coordinate();
    let is_angle = instance.is_angle(place);
    let extent = compute_extents(seen.iter())[shown];
    let turns = is_angle && extent.1 - extent.0 >= TAU;
    if is_cyclic(instance, looks, place)? {
        parts[shown] = CoordinateComparison::Ignored;
    } else if turns && has_equal_equations_after_turn(instance, looks, place)? {
        parts[shown] = CoordinateComparison::Angle;
    } else {
        return Ok(());
    }
    // The solver's error is relative to the angle, which grows without bound, and affects the rate.
    let [angle, rate] = [shown, 1 - shown].map(|place| compute_extents(seen.iter())[place]);
    let size = |(least, greatest): (f64, f64)| least.abs().max(greatest.abs());
    if is_angle && rate.1 - rate.0 <= resolution * size(angle).max(1.0) * size(rate) {
        parts[1 - shown] = CoordinateComparison::Ignored;
    }
    if is_angle {
        let start = looks.start.state[place];
        for point in points {
            point[shown] = wrap_angle(point[shown], start);
        }
    }
    Ok(())
}

/// Returns true if a coordinate is an angle and the equations are periodic in it.
pub fn is_periodic_angle(
    instance: &Instance<'_>,
    looks: &MotionSamples<'_>,
    place: usize,
) -> Result<bool, Failure> {
    if !instance.is_angle(place) {
        return Ok(false);
    }
    // All samples may be at one angle, so the angle is varied.
    let turned = |state: &[f64], part: usize| {
        let mut state = state.to_vec();
        state[place] += TAU * part as f64 / COMPARED_STATES as f64;
        state
    };
    let step = (looks.states.len() / COMPARED_STATES).max(1);
    let samples = looks.times.iter().zip(looks.states).step_by(step);
    let compared = samples.flat_map(|(t, state)| {
        (0..COMPARED_STATES).map(move |part| looks.point(*t, turned(state, part)))
    });
    let compared: Vec<OperatingPoint> = compared.collect();
    Ok(is_cyclic(instance, looks, place)? || instance.repeats_after_turn(place, &compared)?)
}

fn is_cyclic(
    instance: &Instance<'_>,
    looks: &MotionSamples<'_>,
    place: usize,
) -> Result<bool, Failure> {
    let Some((t, state)) = looks.times.iter().zip(looks.states).next_back() else {
        return Ok(false);
    };
    let at = looks.point(*t, state.clone());
    // Without Jacobians no cyclic direction is known.
    let directions = instance.find_cyclic_directions(&at).unwrap_or_default();
    Ok(directions.iter().any(|direction| direction[place] != 0.0))
}

fn has_equal_equations_after_turn(
    instance: &Instance<'_>,
    looks: &MotionSamples<'_>,
    place: usize,
) -> Result<bool, Failure> {
    let step = (looks.states.len() / COMPARED_STATES).max(1);
    let samples = looks.times.iter().zip(looks.states).step_by(step);
    let compared: Vec<OperatingPoint> = samples
        .map(|(t, state)| looks.point(*t, state.clone()))
        .collect();
    Ok(instance.repeats_after_turn(place, &compared)?)
}
