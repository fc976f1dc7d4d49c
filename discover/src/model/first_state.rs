//! Initial state of a record and ranges of the states, estimated from records and model without a
//! fit.

use eomgen_analysis::qr_iteration;
use nalgebra::{DMatrix, DVector};

use crate::model::admissible_states::AdmissibleStates;
use crate::model::estimation_model::EstimationModel;
use crate::model::measured_coordinates::MeasuredCoordinates;
use crate::model::simulation::Simulation;
use crate::thresholds;
use eomgen_records::dataset::{Channel, Initial, Quantity};
use eomgen_records::record::Record;

/// Estimates the initial state of a record. It satisfies the constraints of the model.
pub fn estimate_first_state(
    model: &EstimationModel,
    record: &Record,
    channels: &[Channel],
    initial: &Initial,
) -> Vec<f64> {
    let state = estimate_without_constraints(model, record, channels, initial);
    let Some(t) = record.times.first() else {
        return state;
    };
    let mut admissible = AdmissibleStates::new(model, &model.values);
    admissible.find_nearest(state, (*t, &record.inputs))
}

/// Returns the initial state of a record before its projection onto the constraints.
pub(crate) fn estimate_without_constraints(
    model: &EstimationModel,
    record: &Record,
    channels: &[Channel],
    initial: &Initial,
) -> Vec<f64> {
    let mut state = model.initial_state();
    match initial {
        // A known initial state applies to the beginning of the record only.
        _ if record.is_continued => apply_measurements(model, record, channels, state),
        Initial::Rest => state,
        Initial::Values(values) => {
            for (name, value) in values {
                let known = model.states.iter().position(|state| state == name);
                if let Some(index) = known {
                    state[index] = *value;
                }
            }
            state
        }
        Initial::Estimate => apply_measurements(model, record, channels, state),
    }
}

/// Returns the indices of the states whose initial values are measured by channels.
pub fn find_measured_states(model: &EstimationModel, channels: &[Channel]) -> Vec<usize> {
    let degrees = model.degrees_of_freedom();
    let measured = channels.iter();
    let measured = measured.flat_map(|channel| list_measured_states(channel.quantity, degrees));
    measured.flatten().collect()
}

/// Returns the states that are measured by the value and by the slope of a quantity.
fn list_measured_states(quantity: Quantity, degrees: usize) -> [Option<usize>; 2] {
    match quantity {
        Quantity::Coordinate(coordinate) => [Some(coordinate), Some(degrees + coordinate)],
        Quantity::Rate(coordinate) => [Some(degrees + coordinate), None],
        Quantity::State(first_order) => [Some(2 * degrees + first_order), None],
        Quantity::Observable(_)
        | Quantity::ObservedRate(_)
        | Quantity::Acceleration(_)
        | Quantity::Input(_) => [None, None],
    }
}

/// Replaces elements of a state by the quantities that sensors measure at the beginning of a
/// record.
fn apply_measurements(
    model: &EstimationModel,
    record: &Record,
    channels: &[Channel],
    mut state: Vec<f64>,
) -> Vec<f64> {
    let degrees = model.degrees_of_freedom();
    let initial = state.clone();
    let mut is_measured = vec![false; degrees];
    let sensors = channels.iter().zip(&model.sensors);
    for ((channel, sensor), column) in sensors.zip(&record.channels) {
        let (value, slope) = fit_first_samples(&record.times, column);
        let (value, slope) = (sensor.quantity(value), slope / sensor.gain);
        let indices = list_measured_states(channel.quantity, degrees);
        for (index, number) in indices.into_iter().zip([value, slope]) {
            // With a sensor gain of 0, the quantity is not finite.
            if let Some(index) = index.filter(|_| number.is_finite()) {
                state[index] = number;
                if let Some(is_measured) = is_measured.get_mut(index) {
                    *is_measured = true;
                }
            }
        }
    }
    // Because of noise, measured values may be outside the ranges of the model.
    let mut state = model.clamp_state(state);
    if let Some(rows) = model.create_constraint_rows(&model.values) {
        let at = (record.times[0], &record.inputs);
        let mut start = AdmissibleStates::new(model, &model.values).find_nearest(initial, at);
        let mut measured = MeasuredCoordinates {
            rows,
            is_holonomic: (model.specification().constraints.iter())
                .map(|constraint| !constraint.is_nonholonomic)
                .collect(),
            is_measured,
            sizes: model.typical_sizes()[..degrees].to_vec(),
        };
        if measured.move_to(&mut start, &state, at).is_some() {
            state[..degrees].copy_from_slice(&start[..degrees]);
        }
    }
    state
}

/// Returns value and slope at the first time of a parabola through the first samples of a column. A
/// line would give the slope in the middle of these samples, which would be interpreted as a sensor
/// delay.
fn fit_first_samples(times: &[f64], column: &[f64]) -> (f64, f64) {
    let points: Vec<(f64, f64)> = (times.iter().zip(column))
        .filter(|(_, value)| value.is_finite())
        .take(thresholds::INITIAL_SLOPE_SAMPLE_COUNT)
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

/// Returns the range of each state, SI: its RMS deviation from the mean in the motion from the
/// first state of each record. `values`: parameters of the model; `noise`: standard deviation of
/// each channel, SI.
pub fn compute_state_ranges(
    model: &EstimationModel,
    values: &[f64],
    records: &[Record],
    firsts: &[Vec<f64>],
    noise: &[f64],
) -> Vec<f64> {
    let Ok(mut simulation) = model.create_simulation(values) else {
        return vec![1.0; model.state_count()];
    };
    let moved = measure_ranges(&mut simulation, records, firsts);
    // A state without influence on any channel has the range 1.
    let mut of = |(state, range): (usize, f64)| match range > 0.0 {
        true => range,
        false => (records.first().zip(firsts.first()))
            .and_then(|(record, first)| {
                find_range_from_noise(&mut simulation, record, first, noise, state)
            })
            .unwrap_or(1.0),
    };
    moved.into_iter().enumerate().map(&mut of).collect()
}

/// Returns the range of each state in the records, or in the longest initial segments that can be
/// simulated; 0 if it is constant.
fn measure_ranges(
    simulation: &mut Simulation<'_>,
    records: &[Record],
    firsts: &[Vec<f64>],
) -> Vec<f64> {
    for halving in 0..=thresholds::MAX_RECORD_HALVINGS {
        let motions = records.iter().zip(firsts).filter_map(|(record, first)| {
            let count = record.times.len() >> halving;
            let times = &record.times[..count];
            simulation
                .simulate_states(first, times, &record.inputs)
                .ok()
        });
        // For a range, every tenth sample is sufficient.
        let states = motions.flat_map(|states| states.into_iter().step_by(10));
        let states: Vec<Vec<f64>> = states.collect();
        let of =
            |state: usize| compute_standard_deviation(states.iter().map(|values| values[state]));
        let found: Vec<f64> = (0..count_states(firsts)).map(of).collect();
        if !states.is_empty() && found.iter().all(|range| range.is_finite()) {
            return found;
        }
    }
    vec![0.0; count_states(firsts)]
}

fn count_states(firsts: &[Vec<f64>]) -> usize {
    firsts.first().map_or(0, Vec::len)
}

/// Returns the standard deviation of values.
fn compute_standard_deviation(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Returns the change of a state for which the outputs change by the fraction
/// [`thresholds::INVISIBLE_CHANGE_IN_NOISE`] of the noise; `None` if it has no influence.
fn find_range_from_noise(
    simulation: &mut Simulation<'_>,
    record: &Record,
    initial: &[f64],
    noise: &[f64],
    state: usize,
) -> Option<f64> {
    let times = &record.times[..record.times.len().min(thresholds::STEP_TEST_SAMPLE_COUNT)];
    let own = simulation
        .simulate_outputs(initial, times, &record.inputs)
        .ok()?;
    let mut moved_by = |size: f64| {
        let mut moved = initial.to_vec();
        moved[state] += size;
        let moved = simulation
            .simulate_outputs(&moved, times, &record.inputs)
            .ok()?;
        let pairs = moved.values.iter().zip(&own.values).enumerate();
        let squares = pairs.map(|(index, (a, b))| ((a - b) / noise[index % noise.len()]).powi(2));
        Some((squares.sum::<f64>() / own.values.len() as f64).sqrt())
    };
    let mut size = 1.0;
    for _ in 0..thresholds::MAX_SIZE_ATTEMPTS {
        let factor = match moved_by(size) {
            Some(moved) if moved.is_finite() && moved > 0.0 => {
                thresholds::INVISIBLE_CHANGE_IN_NOISE / moved
            }
            Some(0.0) => thresholds::MAX_SIZE_FACTOR,
            _ => 1e-3,
        };
        size *= factor.clamp(
            1.0 / thresholds::MAX_SIZE_FACTOR,
            thresholds::MAX_SIZE_FACTOR,
        );
        if (0.5..2.0).contains(&factor) {
            return Some(size);
        }
    }
    None
}
