//! Input data of the script as JSON; numeric columns are base64-encoded bytes.

use eomgen_page::name_letters;
use eomgen_page::play::{encode_base64, format_unit};
use serde_json::{Value, json};

use crate::fit::fit_result::Fit;
use crate::ids::ChannelId;
use crate::model::estimation_model::EstimationModel;
use crate::model::measured_outputs::Output;
use crate::model::problem::EstimationProblem;
use crate::report::playback::record_excerpt::{ExcerptWindow, RecordExcerpt};

pub(super) fn write_json(
    problem: &EstimationProblem<'_>,
    best: &Fit,
    model: &EstimationModel,
    stretch: &RecordExcerpt,
    moving: Value,
) -> String {
    let inputs = &problem.dataset.test[0].inputs;
    let rows = stretch
        .times
        .iter()
        .flat_map(|t| inputs.last_sample(*t))
        .copied();
    let piece = |piece: &ExcerptWindow| {
        let start = best.map_state(model, &best.test.estimate.initial_states[piece.window]);
        json!({
            "first": piece.first_sample,
            "samples": piece.samples,
            "judged": [piece.compared_samples.start, piece.compared_samples.end],
            "initial": start,
        })
    };
    let document = json!({
        "moving": moving,
        "parameters": model.values,
        "times": encode_doubles(stretch.times.iter().copied()),
        "driven": encode_doubles(rows),
        "measured": encode_doubles(stretch.measured.iter().copied()),
        "before": encode_doubles(stretch.before.iter().copied()),
        "windows": stretch.windows.iter().map(piece).collect::<Vec<Value>>(),
        "channels": write_channels(problem, best, model, stretch),
    });
    document.to_string()
}

/// Returns column, sensor and residual of each channel.
fn write_channels(
    problem: &EstimationProblem<'_>,
    best: &Fit,
    model: &EstimationModel,
    stretch: &RecordExcerpt,
) -> Vec<Value> {
    let shooting = best.training_shooting(problem);
    let sensors = shooting.sensor_values(&best.train.estimate.theta);
    let all = &problem.dataset.channels;
    let channels = ChannelId::first(all.len())
        .zip(all)
        .zip(model.measured.outputs());
    let of =
        |((id, channel), output): ((ChannelId, &eomgen_records::dataset::Channel), &Output)| {
            let from = match output {
                Output::State(index) => json!({ "state": index }),
                Output::Observable(index) => json!({ "observable": index }),
                Output::Acceleration(of) => json!({ "observable": of.index }),
                Output::Rate(index) => json!({ "rate": index }),
                Output::Input(index) => json!({ "input": index }),
            };
            json!({
                "symbol": name_letters(&channel.name),
                "unit": format_unit(&channel.unit),
                "from": from,
                "gain": sensors.gain[id],
                "bias": sensors.bias[id],
                "delay": sensors.delay[id],
                "left": stretch.rms_before_after[id],
            })
        };
    channels.map(of).collect()
}

/// Returns numbers as base64-encoded little-endian bytes, the byte order of all current browsers.
fn encode_doubles(numbers: impl Iterator<Item = f64>) -> String {
    encode_base64(&numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}
