//! Where a record begins and how far its states go, as far as records and model tell without a fit.

use eomgen_analysis::qr_iteration;
use nalgebra::{DMatrix, DVector};

use crate::model::estimation_model::EstimationModel;
use crate::thresholds;
use eomgen_records::dataset::{Channel, Initial, Quantity};
use eomgen_records::record::Record;

/// The first state of a record, as far as it is known.
pub fn first_state(
    model: &EstimationModel,
    record: &Record,
    channels: &[Channel],
    initial: &Initial,
) -> Vec<f64> {
    let mut state = model.initial();
    match initial {
        // What is known of the beginning does not hold later.
        _ if record.is_continued => measured(model, record, channels, state),
        Initial::Rest => state,
        Initial::Given(values) => {
            for (name, value) in values {
                let known = model.states.iter().position(|state| state == name);
                if let Some(index) = known {
                    state[index] = *value;
                }
            }
            state
        }
        Initial::Estimate => measured(model, record, channels, state),
    }
}

/// A state with what the channels show of it at the beginning of a record.
fn measured(
    model: &EstimationModel,
    record: &Record,
    channels: &[Channel],
    mut state: Vec<f64>,
) -> Vec<f64> {
    let degrees = model.degrees_of_freedom();
    for (channel, column) in channels.iter().zip(&record.channels) {
        let (value, slope) = begin(&record.times, column);
        match channel.quantity {
            Quantity::Coordinate(coordinate) => {
                state[coordinate] = value;
                state[degrees + coordinate] = slope;
            }
            Quantity::Rate(coordinate) => state[degrees + coordinate] = value,
            Quantity::State(first_order) => state[2 * degrees + first_order] = value,
            Quantity::Observable(_) | Quantity::Acceleration(_) | Quantity::Input(_) => {}
        }
    }
    // Noise may put what is measured beyond where the model lives.
    model.admissible(state)
}

/// The parabola through a column's first samples at the first time: value and slope. A line
/// would show the slope in their middle, and what is late by that looks like a late sensor.
fn begin(times: &[f64], column: &[f64]) -> (f64, f64) {
    let points: Vec<(f64, f64)> = (times.iter().zip(column))
        .filter(|(_, value)| value.is_finite())
        .take(thresholds::FIRST_SAMPLES)
        .map(|(t, value)| (t - times[0], *value))
        .collect();
    let Some(span) = points.last().map(|(t, _)| *t).filter(|span| *span > 0.0) else {
        return (0.0, 0.0);
    };
    let powers = DMatrix::from_fn(points.len(), 3, |row, power| {
        (points[row].0 / span).powi(power as i32)
    });
    let values = DVector::from_fn(points.len(), |row, _| points[row].1);
    let fitted = qr_iteration::svd(&powers).and_then(|svd| svd.solve(&values, 1e-12).ok());
    fitted.map_or((0.0, 0.0), |fitted| (fitted[0], fitted[1] / span))
}

/// How far each state ranges in the motion that the records' inputs cause, SI: the root mean
/// square around its mean. `values`: the model's parameters, on which that may depend much.
pub fn ranges(
    model: &EstimationModel,
    values: &[f64],
    records: &[Record],
    initial: &[f64],
) -> Vec<f64> {
    let states = model.state_count();
    let mut sums = vec![(0.0, 0.0); states];
    let mut count = 0.0;
    if let Ok(mut simulation) = model.simulation(values) {
        for record in records {
            let Ok(motion) = simulation.states(initial, &record.times, &record.inputs) else {
                continue;
            };
            // Every tenth sample shows how far a state goes.
            for state in motion.iter().step_by(10) {
                count += 1.0;
                for (sum, value) in sums.iter_mut().zip(state) {
                    sum.0 += value;
                    sum.1 += value * value;
                }
            }
        }
    }
    let range = |(sum, squares): (f64, f64)| {
        let mean: f64 = sum / count;
        (squares / count - mean * mean).max(0.0).sqrt()
    };
    let found: Vec<f64> = sums.into_iter().map(range).collect();
    let largest = found
        .iter()
        .copied()
        .filter(|r| r.is_finite())
        .fold(0.0, f64::max);
    // A state that nothing moves may still not be known exactly.
    let least = if largest > 0.0 { 1e-9 * largest } else { 1.0 };
    found
        .into_iter()
        .map(|r| if r.is_finite() { r.max(least) } else { 1.0 })
        .collect()
}
