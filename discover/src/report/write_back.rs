//! Extended specification: effects are added, refitted values and sensors are written, and comments
//! are kept.

use crate::ids::{ChannelId, UnknownId};
use eomgen_model_spec::edit::{self, Edit, SetParameter, SetSensor};

use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::model::input_faults::find_delayed_input;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::edited_source;
use crate::model::unknowns::UnknownKind;
use crate::report::quantity::format_number;
use crate::search::search_result::AcceptedEffect;
use crate::thresholds;

/// Returns the specification with the effects and values of a fit. `floor`: noise floor in standard
/// deviations of the noise.
///
/// # Errors
///
/// An edit that is not possible.
pub fn write_extended(
    problem: &EstimationProblem<'_>,
    text: &str,
    fit: &Fit,
    accepted: &[AcceptedEffect],
    floor: f64,
) -> Result<String, DiscoverError> {
    let source = describe_source(problem);
    let theta = &fit.train.estimate.theta;
    let mut text = text.to_owned();
    let written = || {
        accepted
            .iter()
            .filter(|effect| effect.candidate.dropped_prior.is_none())
    };
    for effect in written() {
        let values = fit.values_in_specification(&effect.unknowns);
        let written = effect
            .candidate
            .write_effect(&text, &problem.path, &values, &source);
        text = written?;
    }
    let added: Vec<UnknownId> = written()
        .flat_map(|effect| effect.unknowns.clone())
        .collect();
    let mut edits = Vec::new();
    for (id, unknown) in fit.unknowns() {
        if let UnknownKind::Parameter(name) = &unknown.kind
            && (added.contains(&id) || has_moved(fit, id, !accepted.is_empty()))
            && let Some(parameter) = fit
                .model
                .specification()
                .parameters
                .iter()
                .find(|p| p.name == *name)
        {
            let sd = match added.contains(&id) {
                true => fit.sd_with_misfit(id, floor),
                false => fit.sd[id],
            };
            let sd = format_number(parameter.unit.from_si(sd), 2);
            edits.push(Edit::SetParameter(SetParameter {
                name: name.clone(),
                value: parameter.unit.from_si(theta[id]),
                source: format!("{source}; standard deviation {sd} {}", parameter.unit),
            }));
        }
    }
    edits.extend(list_sensor_edits(problem, fit, !accepted.is_empty()));
    Ok(edit::apply(&edited_source(&problem.path, &text), &edits)?)
}

/// Describes the source of the fitted values.
fn describe_source(problem: &EstimationProblem<'_>) -> String {
    let title = &problem.dataset.title;
    let files = problem
        .dataset
        .train
        .iter()
        .filter_map(|record| record.path.file_name());
    let files: Vec<String> = files
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    match title.is_empty() {
        true => format!("fitted to {}", files.join(", ")),
        false => format!("fitted to {title}, {}", files.join(", ")),
    }
}

/// Returns true if the estimate of an unknown differs from its initial value: by any amount if
/// `at_all`, otherwise by more than a fraction of its standard deviation.
fn has_moved(fit: &Fit, unknown: UnknownId, at_all: bool) -> bool {
    let least = if at_all {
        0.0
    } else {
        thresholds::MIN_WRITTEN_CHANGE_IN_SD * fit.effect_sd[unknown]
    };
    (fit.train.estimate.theta[unknown] - fit.unknowns[unknown].start).abs() > least
}

/// Returns edits for the sensors whose estimates differ from their initial values, see
/// [`has_moved`].
fn list_sensor_edits(problem: &EstimationProblem<'_>, fit: &Fit, at_all: bool) -> Vec<Edit> {
    let shooting = fit.training_shooting(problem);
    let sensors = shooting.sensor_values(&fit.train.estimate.theta);
    let moved = |channel: ChannelId| {
        fit.unknowns().any(|(id, unknown)| {
            let own = match unknown.kind {
                UnknownKind::Gain(of) | UnknownKind::Bias(of) | UnknownKind::Delay(of) => {
                    of == channel
                }
                UnknownKind::InputDelay => true,
                UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_) => false,
            };
            own && has_moved(fit, id, at_all)
        })
    };
    // The delay of the input is contained in the delays of all sensors: if one sensor is written,
    // all are written.
    let is_late = find_delayed_input(&problem.dataset.inputs).is_some();
    let any = ChannelId::first(problem.dataset.channels.len()).any(moved);
    let all = &problem.dataset.channels;
    let channels = ChannelId::first(all.len()).zip(all);
    channels
        .filter(|(id, _)| moved(*id) || (is_late && any))
        .map(|(id, channel)| {
            Edit::SetSensor(SetSensor {
                channel: channel.name.clone(),
                observable: channel.observable.clone(),
                gain: sensors.gain[id],
                bias: sensors.bias[id],
                delay: sensors.delay[id],
            })
        })
        .collect()
}
