//! Check of a declared initial state against the first samples of the records.

use eomgen_records::dataset::{Dataset, Initial, Quantity};
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;

use crate::ids::ChannelId;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{UnknownKind, list_sensor_unknowns};
use crate::report::quantity::format_quantity;

/// Minimum distance of a first sample from the declared value that is a contradiction, in standard
/// deviations of noise and sensor errors. Normal noise exceeds it in one of 500 million samples.
const MIN_CONTRADICTION: f64 = 6.0;

/// Describes the channels whose first sample contradicts the initial state declared in the dataset
/// file with `state = "rest"` or `"given"`. Channels of coordinates, rates and first-order states
/// are compared.
pub fn describe_contradicted_initial_states(
    problem: &EstimationProblem<'_>,
    model: &EstimationModel,
) -> Vec<String> {
    let dataset = problem.dataset;
    if dataset.initial == Initial::Estimate || dataset.gives_motion() {
        return Vec::new();
    }
    let records = dataset.train.iter().chain(&dataset.test);
    let starts = records.filter(|record| !record.is_continued);
    starts
        .flat_map(|record| {
            let stated = problem.estimate_first_state(model, record);
            let channels = 0..dataset.channels.len();
            channels.filter_map(move |channel| describe(dataset, model, record, &stated, channel))
        })
        .collect()
}

fn describe(
    dataset: &Dataset,
    model: &EstimationModel,
    record: &Record,
    stated: &[f64],
    index: usize,
) -> Option<String> {
    let channel = &dataset.channels[index];
    let degrees = model.degrees_of_freedom();
    let (value, rate) = match channel.quantity {
        Quantity::Coordinate(index) => (stated[index], stated[degrees + index]),
        Quantity::Rate(index) => (stated[degrees + index], 0.0),
        Quantity::State(index) => (stated[2 * degrees + index], 0.0),
        _ => return None,
    };
    let sensor = model.sensors[index];
    let expected = sensor.gain * value + sensor.bias;
    let measured = *record.channels[index].first()?;
    let step = typical_step(&record.times);
    let unknowns =
        list_sensor_unknowns(ChannelId::new(index), channel, model.specification(), step);
    let parts = unknowns.iter().map(|unknown| match unknown.kind {
        UnknownKind::Gain(_) => unknown.scale * value,
        UnknownKind::Delay(_) => unknown.scale * rate,
        _ => unknown.scale,
    });
    let variance = parts.map(|part| part * part).sum::<f64>() + channel.noise * channel.noise;
    let distance = (measured - expected).abs() / variance.sqrt();
    // The distance of a missing sample is NaN.
    (distance > MIN_CONTRADICTION).then(|| {
        let [begins, gives] =
            [measured, expected].map(|value| format_quantity(value, 3, &channel.unit));
        format!(
            "{}: `{}` begins at {begins}, but [initial] gives {gives}; correct [initial], or write state = \
             \"estimate\"",
            record.name, channel.name
        )
    })
}
