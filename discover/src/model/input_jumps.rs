//! Interpolation error of measured quantities due to held inputs. At each sample the inputs jump,
//! and with them slopes or second derivatives of quantities. The samples of a record do not show
//! this error, because a cubic through all samples has its kinks at the samples.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_records::dataset::Dataset;
use eomgen_records::record::Record;

use crate::model::estimation_model::EstimationModel;
use crate::model::first_state::estimate_first_state;
use crate::model::input_faults::find_delayed_input;
use crate::model::measured_outputs::Output;
use crate::model::output_times::compute_lagrange_weight;

/// Change of a state for the slope of a quantity, relative to the typical size of the state.
const STATE_CHANGE: f64 = 1e-4;

/// Fractions of a sample interval at which the error is computed.
const INTERVAL_FRACTIONS: [f64; 3] = [0.25, 0.5, 0.75];

/// Nodes of the cubic, in sample intervals, relative to the beginning of the interval.
const CUBIC_NODES: [f64; 4] = [-1.0, 0.0, 1.0, 2.0];

/// Jumps of the first and second derivative of each channel, per unit of an input.
type JumpsPerUnit = [Vec<f64>; 2];

/// Returns the RMS error, SI, of a cubic through four samples of each channel due to jumps of the
/// inputs. It is 0 for a channel without delay, which is not interpolated, and for accelerations,
/// which jump themselves. The jumps of the derivatives are computed at the first state of each
/// training record.
pub(crate) fn compute_jump_errors(model: &EstimationModel, dataset: &Dataset) -> Vec<f64> {
    let channels = dataset.channels.len();
    let (mut squares, mut count) = (vec![0.0; channels], 0.0);
    let mut evaluator = model.create_evaluator(&model.values);
    let weights = INTERVAL_FRACTIONS.map(|at| [1, 2].map(|order| compute_kink_errors(order, at)));
    for record in &dataset.train {
        let first = estimate_first_state(model, record, &dataset.channels, &dataset.initial);
        let changes = compute_input_changes(record);
        let gains = compute_gains(model, &mut evaluator, record, (&first, &changes));
        for (sample, pair) in changes.windows(2).enumerate() {
            let step = record.times[sample + 2] - record.times[sample + 1];
            for (channel, square) in squares.iter_mut().enumerate() {
                let jump = |order: usize, change: &[f64]| -> f64 {
                    let products = gains.iter().zip(change);
                    products
                        .map(|(gain, change)| gain[order][channel] * change)
                        .sum()
                };
                for weights in &weights {
                    let errors = (0..2).map(|order| {
                        let [before, after] = [jump(order, &pair[0]), jump(order, &pair[1])];
                        let [at_before, at_after] = weights[order];
                        (before * at_before + after * at_after) * step.powi(order as i32 + 1)
                    });
                    *square += errors.sum::<f64>().powi(2);
                }
            }
            count += INTERVAL_FRACTIONS.len() as f64;
        }
    }
    let errors = squares.iter().enumerate().map(|(channel, square)| {
        let error = model.sensors[channel].gain.abs() * f64::sqrt(square / f64::max(count, 1.0));
        // If the model is singular at the first state, the error is not finite and is unknown.
        let is_interpolated = is_smooth(model, channel) && is_delayed(model, dataset, channel);
        if error.is_finite() && is_interpolated {
            error
        } else {
            0.0
        }
    });
    errors.collect()
}

/// Returns false for channels of accelerations.
fn is_smooth(model: &EstimationModel, channel: usize) -> bool {
    matches!(
        model.measured.outputs()[channel],
        Output::State(_) | Output::Observable(_)
    )
}

/// Returns true if the delay of a channel differs from 0 or is estimated.
fn is_delayed(model: &EstimationModel, dataset: &Dataset, channel: usize) -> bool {
    let delay = dataset.channels[channel].priors.delay;
    let is_known = delay.is_some_and(|prior| prior.sd == 0.0);
    !is_known
        || model.sensors[channel].delay != 0.0
        || find_delayed_input(&dataset.inputs).is_some()
}

/// Returns the changes of the inputs at the samples of a record, without its first sample.
fn compute_input_changes(record: &Record) -> Vec<Vec<f64>> {
    let difference = |pair: &[f64]| -> Vec<f64> {
        let [before, after] = [pair[0], pair[1]].map(|t| record.inputs.last_sample(t));
        let changes = after.iter().zip(before).map(|(a, b)| a - b).enumerate();
        // A prescribed motion is a spline and does not jump.
        let held = changes.map(|(input, change)| match record.inputs.is_held(input) {
            true => change,
            false => 0.0,
        });
        held.collect()
    };
    record.times.windows(2).map(difference).collect()
}

/// Returns the gains for each input; zeros for a constant input.
fn compute_gains(
    model: &EstimationModel,
    evaluator: &mut Evaluator,
    record: &Record,
    (state, changes): (&[f64], &[Vec<f64>]),
) -> Vec<JumpsPerUnit> {
    let (t, states, degrees) = (record.times[0], state.len(), model.degrees_of_freedom());
    let inputs = record.inputs.evaluate(t).into_owned();
    let mut rates = |inputs: &[f64]| {
        let mut rates = vec![0.0; states];
        evaluator.rates(Point { t, state, inputs }, &mut rates);
        rates
    };
    let own = rates(&inputs);
    let input_gains = (0..inputs.len()).map(|input| {
        let square: f64 = changes.iter().map(|change| change[input].powi(2)).sum();
        let size = (square / changes.len().max(1) as f64).sqrt();
        let mut moved = inputs.clone();
        moved[input] += size;
        let after = rates(&moved);
        let pairs = after.iter().zip(&own);
        let gain = pairs.map(|(after, own)| {
            if size > 0.0 {
                (after - own) / size
            } else {
                0.0
            }
        });
        gain.collect()
    });
    let input_gains: Vec<Vec<f64>> = input_gains.collect();
    let slopes = input_gains.into_iter().map(|jump| {
        // For a function of coordinates, the second derivative jumps with the accelerations.
        let mut of_coordinates = vec![0.0; states];
        of_coordinates[..degrees].copy_from_slice(&jump[degrees..2 * degrees]);
        [jump, of_coordinates]
            .map(|direction| compute_slope(model, evaluator, (t, state, &inputs), &direction))
    });
    slopes.collect()
}

/// Returns the derivative of each channel along a direction of the state, SI.
fn compute_slope(
    model: &EstimationModel,
    evaluator: &mut Evaluator,
    (t, state, inputs): (f64, &[f64], &[f64]),
    direction: &[f64],
) -> Vec<f64> {
    let sizes = direction.iter().zip(model.typical_sizes());
    let largest = sizes
        .map(|(entry, size)| entry.abs() / size)
        .fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() {
        return vec![0.0; model.measured.count()];
    }
    let step = STATE_CHANGE / largest;
    let mut buffers = model.measured.create_buffers();
    let [after, before] = [step, -step].map(|step| {
        let moved = state.iter().zip(direction);
        let moved: Vec<f64> = moved.map(|(value, entry)| value + step * entry).collect();
        let (state, mut values) = (&moved[..], Vec::new());
        let point = Point { t, state, inputs };
        model
            .measured
            .append(evaluator, point, &mut buffers, &mut values);
        values
    });
    let pairs = after.iter().zip(&before);
    pairs
        .map(|(after, before)| (after - before) / (2.0 * step))
        .collect()
}

/// Returns the errors of the cubic at a fraction of a sample interval of length 1, if the
/// derivative of order `order` jumps by 1 at the beginning or at the end of the interval.
fn compute_kink_errors(order: i32, at: f64) -> [f64; 2] {
    [0.0, 1.0].map(|kink| {
        let function = |t: f64| f64::max(t - kink, 0.0).powi(order) / f64::from(order);
        let weight = |node| compute_lagrange_weight(&CUBIC_NODES, 0..CUBIC_NODES.len(), node, at);
        let nodes = CUBIC_NODES.iter().enumerate();
        let between: f64 = nodes.map(|(node, t)| weight(node) * function(*t)).sum();
        between - function(at)
    })
}

#[cfg(test)]
mod tests {
    use super::compute_kink_errors;

    #[test]
    fn interpolation_errors_of_kinks_match_closed_form() {
        // In the middle of the interval, a slope jump of 1 causes an error of 1/16, and a jump of
        // the second derivative an error of 1/32.
        let [before, after] = compute_kink_errors(1, 0.5);
        assert!((before + 1.0 / 16.0).abs() < 1e-15 && (after + 1.0 / 16.0).abs() < 1e-15);
        let [before, after] = compute_kink_errors(2, 0.5);
        assert!((before - 1.0 / 32.0).abs() < 1e-15 && (after + 1.0 / 32.0).abs() < 1e-15);
    }
}
