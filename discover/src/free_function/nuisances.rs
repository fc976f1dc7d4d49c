//! Responses to the declared parameters and sensors of a fit along a reference motion.

use nalgebra::DMatrix;

use crate::fit::fit_result::Fit;
use crate::free_function::drives::{DrivenModel, average_drive};
use crate::free_function::reference_motion::ReferenceMotion;
use crate::free_function::segments::NuisanceResponse;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, UnknownKind};
use crate::thresholds;

/// Returns the response to each unknown of a fit, per standard deviation of its prior; without a
/// prior, per scale of the unknown.
pub(crate) fn respond_to_unknowns(
    motion: &ReferenceMotion,
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    base: &DrivenModel,
) -> Vec<NuisanceResponse> {
    let shooting = fit.training_shooting(problem);
    let sensors = shooting.sensor_values(&motion.theta);
    let channels = problem.noise.len();
    let mut found = Vec::new();
    for (number, unknown) in fit.unknowns.iter().enumerate() {
        let size = unknown.prior.map_or(unknown.scale, |prior| prior.sd);
        let response = match &unknown.kind {
            UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_) => {
                let step = choose_parameter_step(unknown, motion.theta[number]);
                let mut theta = motion.theta.clone();
                theta[number] += step;
                let mut moved = DrivenModel::new(&fit.model, &shooting.parameter_values(&theta));
                let drive = average_drive(motion, base, &mut moved, size / step);
                let before = base.outputs();
                let after = moved.measure_outputs(motion, &fit.model);
                let outputs = before.iter().zip(after).map(|(before, after)| {
                    DMatrix::from_fn(after.nrows(), channels, |row, channel| {
                        let slope = (after[(row, channel)] - before[(row, channel)]) / step;
                        size * sensors.gain[channel] * slope / problem.noise[channel]
                    })
                });
                NuisanceResponse {
                    drive: Some(drive),
                    outputs: outputs.collect(),
                    has_prior: unknown.prior.is_some(),
                }
            }
            UnknownKind::Gain(_)
            | UnknownKind::Bias(_)
            | UnknownKind::Delay(_)
            | UnknownKind::InputDelay => {
                let quantities = base.outputs();
                let outputs = quantities
                    .iter()
                    .zip(&motion.records)
                    .map(|(values, record)| {
                        let rows = values.nrows();
                        DMatrix::from_fn(rows, channels, |row, channel| {
                            let (before, after) = (row.saturating_sub(1), (row + 1).min(rows - 1));
                            let slope = || {
                                let change = values[(after, channel)] - values[(before, channel)];
                                change / (record.times[after] - record.times[before])
                            };
                            let derivative = match unknown.kind {
                                UnknownKind::Gain(own) if own.index() == channel => {
                                    values[(row, channel)]
                                }
                                UnknownKind::Bias(own) if own.index() == channel => 1.0,
                                UnknownKind::Delay(own) if own.index() == channel => {
                                    -sensors.gain[channel] * slope()
                                }
                                UnknownKind::InputDelay => -sensors.gain[channel] * slope(),
                                _ => 0.0,
                            };
                            size * derivative / problem.noise[channel]
                        })
                    });
                NuisanceResponse {
                    drive: None,
                    outputs: outputs.collect(),
                    has_prior: unknown.prior.is_some(),
                }
            }
        };
        found.push(response);
    }
    found
}

/// Returns the step of a parameter's difference quotient; it is negative close to the upper bound.
fn choose_parameter_step(unknown: &Unknown, value: f64) -> f64 {
    let step = thresholds::PARAMETER_QUOTIENT_IN_SCALES * unknown.scale;
    match value + step > unknown.bounds.high {
        true => -step,
        false => step,
    }
}
