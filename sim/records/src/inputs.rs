//! Inputs of a record, for a simulation.

use std::path::{Path, PathBuf};

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::list_unused_inputs;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_sim::inputs::HeldInputs;

use crate::binding;
use crate::checks::list_missing_inputs;
use crate::decimation::Decimation;
use crate::description::Description;
use crate::files::{find_record, list_record_files};
use crate::gaps::find_missing_rows;
use crate::record::RecordReader;
use crate::refusal::Refusal;
use crate::samples::MIN_INPUT_SAMPLES;

/// Inputs of a record.
#[derive(Debug)]
pub struct RecordInputs {
    /// Inputs over time.
    pub inputs: HeldInputs,
    /// Warnings about columns and inputs.
    pub warnings: Vec<String>,
    /// Paths of all records of the dataset file.
    pub files: Vec<PathBuf>,
}

/// Reads the inputs of a record such as `train[0]`, without channels. `driven` are names of inputs that need no column.
///
/// # Errors
/// Errors of the dataset file or of the record, with their locations.
pub fn read_inputs(
    dataset: &Path,
    record: &str,
    (model, driven): (&Model, &[&str]),
) -> Result<RecordInputs, Refusal> {
    let description = Description::read(dataset, model)?;
    let file = find_record(&description, record).map_err(Refusal::Record)?;
    let mut found = Diagnostics::new(description.source.clone());
    if let Some(given) = description.motion.first() {
        found.push(
            Diagnostic::error("the records give the motion, but no inputs to simulate it")
                .with_span(given.name.span, "here")
                .with_help("use `compare` or `discover`: they compute the forces that such a motion requires"),
        );
    }
    let time = found.push_error(binding::time_unit(&description));
    let inputs = binding::bind_inputs(&description, model, &mut found);
    let Some(time) = time.filter(|_| found.is_empty()) else {
        return Err(found.into());
    };
    let columns = RecordReader {
        description: &description,
        path: dataset,
        time: &time,
        inputs: &inputs,
        motion: &[],
        channels: &[],
        smooth_noises: &[],
        initial_readings: &[],
        model,
        counts_from_first: false,
        decimation: &Decimation::new(description.time.every, description.time.filter),
        min_samples: MIN_INPUT_SAMPLES,
    };
    let mut warnings = list_input_notes(&description, (model, driven));
    let (record, _) = columns.read_record(record, file, &mut warnings)?;
    warnings.extend(find_missing_rows(&record.times).iter().map(|gap| {
        format!(
            "{}: {}: the inputs in between are unknown and their last values are held, so the motion after the gap \
             can differ from that of the machine",
            record.name,
            gap.describe(record.origin)
        )
    }));
    warnings.extend(list_missing_inputs(&record, &model.inputs));
    Ok(RecordInputs {
        inputs: record.inputs,
        warnings,
        files: list_record_files(dataset, &description.records),
    })
}

/// Returns notes on input columns that the model does not have, and on inputs without a column, except those of `driven`.
pub fn list_input_notes(
    description: &Description,
    (model, driven): (&Model, &[&str]),
) -> Vec<String> {
    // Rates of prescribed motion are computed from the spline through its samples.
    let own = || model.inputs.iter().filter(|input| input.rate_of.is_none());
    let inputs = || own().map(|input| input.name.as_str());
    let undriven = model.typical_inputs(0.0).unwrap_or_default();
    let mut notes = Vec::new();
    for column in &description.inputs {
        let name = column.name.text.as_str();
        if inputs().all(|input| input != name) {
            let meant = did_you_mean(name, inputs()).map_or(String::new(), |m| format!("; {m}"));
            notes.push(format!(
                "the model has no input `{name}`: its column is not used{meant}"
            ));
        }
    }
    // The reference input of a controller that is left out has no effect.
    let unused = list_unused_inputs(model);
    for (place, (input, value)) in model.inputs.iter().zip(undriven).enumerate() {
        let name = &input.name;
        let is_fed = (description.inputs.iter()).any(|column| column.name.text == *name);
        let is_measured =
            (description.channels.iter()).any(|channel| channel.quantity_name() == name);
        if is_fed && model.is_controlled(place) {
            notes.push(format!(
                "a controller drives the input `{name}`: its column acts only until the first output acts"
            ));
        }
        let is_driven = model.is_controlled(place) || driven.contains(&&**name);
        let is_used = unused.iter().all(|of| of.name != *name);
        if input.rate_of.is_some() || is_fed || is_measured || is_driven || !is_used {
            continue;
        }
        notes.push(match input.rate {
            Some(_) => format!("input `{name}`, a prescribed motion, is not driven and rests at {value}"),
            None => format!(
                "input `{name}` is not driven and is taken as {value}; give its column in [inputs.{name}]"
            ),
        });
    }
    notes
}
