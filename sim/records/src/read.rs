//! Reading, checking and binding of a dataset file with its records.

use std::path::Path;

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;

use crate::bound::bound;
use crate::checks::examine;
use crate::coverage::{self, can_be_cut};
use crate::dataset::{Dataset, Initial, Quantity, Start};
use crate::decimation::Decimation;
use crate::description::Description;
use crate::description::records::Stretch;
use crate::gaps::unbroken;
use crate::given_motion::notes_of_speeds;
use crate::inputs::notes_of_inputs;
use crate::record::{Columns, Record};
use crate::refusal::Refusal;
use crate::rest::without_rest;
use crate::samples::FEWEST_SAMPLES;

/// Reads a dataset for a model.
///
/// # Errors
/// Problems of the dataset file, or the first problem of a record, with its place.
pub fn read_dataset(path: &Path, model: &Model) -> Result<Dataset, Refusal> {
    let description = Description::read(path)?;
    if let Some(refused) = prescribed_column(&description, model) {
        return Err(Diagnostics::one(description.source.clone(), refused).into());
    }
    if let Some(constraint) = model.constraints.first() {
        return Err(Refusal::Record(format!(
            "{}: the model has constraints (`{}`), which `compare` and `discover` do not support yet; \
             `simulate` does",
            path.display(),
            constraint.name
        )));
    }
    if let Some(impact) = model.impacts.first() {
        return Err(Refusal::Record(format!(
            "{}: the model has impacts (`{}`), which `compare` and `discover` do not support yet; \
             `simulate` does",
            path.display(),
            impact.name
        )));
    }
    let bound = bound(&description, model)?;
    let mut dataset = Dataset {
        path: path.to_owned(),
        title: description.title.clone(),
        train: Vec::new(),
        test: Vec::new(),
        inputs: bound.input_priors,
        channels: bound.channels,
        initial: bound.initial,
        window: description.windows.length.map(|length| length.value),
        start: match description.windows.smoothed {
            true => Start::Smoothed,
            false => Start::Fitted,
        },
        uncertain: bound.uncertain,
        experiment: bound.experiment,
        played: bound.played.clone(),
        motion: match bound.motion.is_empty() {
            true => Vec::new(),
            false => model.coordinates.iter().map(|c| c.name.clone()).collect(),
        },
        notes: notes_of_inputs(&description, model),
    };
    let speeds = notes_of_speeds(&bound.motion, &description);
    dataset.notes.extend(speeds);
    let starts = starts(&dataset, model);
    let decimation = Decimation::new(description.time.every, description.time.filter);
    for channel in &mut dataset.channels {
        channel.noise *= decimation.noise();
    }
    let columns = Columns {
        description: &description,
        path,
        time: &bound.time,
        inputs: &bound.inputs,
        motion: &bound.motion,
        channels: &bound.channel_units,
        starts: &starts,
        model,
        decimation: &decimation,
        fewest: FEWEST_SAMPLES,
    };
    let mut notes = Vec::new();
    let mut read = |kind: &str, files: &[Stretch]| -> Result<Vec<Record>, Refusal> {
        let files = files.iter().enumerate();
        let mut records = Vec::new();
        for (place, file) in files {
            let record = columns.record(&format!("{kind}[{place}]"), file, &mut notes)?;
            can_be_cut(&record, &description)?;
            records.extend(unbroken(record, &mut notes));
        }
        Ok(records)
    };
    dataset.train = read("train", &description.records.train)?;
    dataset.test = read("test", &description.records.test)?;
    dataset.notes.append(&mut notes);
    let notes = examine(&dataset, &description, &model.inputs)?;
    dataset.notes.extend(notes);
    if dataset.gives_motion() {
        let notes = without_rest(&mut dataset, model);
        dataset.notes.extend(notes);
        coverage::check(&dataset, &description)?;
    }
    Ok(dataset)
}

/// Rejects columns of prescribed motion, because `compare` and `discover` hold inputs constant.
fn prescribed_column(description: &Description, model: &Model) -> Option<Diagnostic> {
    let is_prescribed = |name: &str| {
        let mut inputs = model.inputs.iter();
        inputs.any(|input| input.rate.is_some() && input.name == name)
    };
    let mut columns = description.inputs.iter();
    let column = columns.find(|column| is_prescribed(&column.name.text))?;
    let name = &column.name;
    Some(
        Diagnostic::error(format!(
            "input `{}` is a prescribed motion (rates = 2), which `compare` and `discover` do not support",
            name.text
        ))
        .at(name.span, "these commands hold inputs constant between samples")
        .help("remove this section to keep the input at rest, or use `simulate --record`, which supports prescribed motion"),
    )
}

/// Returns the initial value of each channel in SI, for coordinates with a known initial state.
fn starts(dataset: &Dataset, model: &Model) -> Vec<Option<f64>> {
    let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
    let state = model.initial_state(&orders).unwrap_or_default();
    let of = |place: usize| match &dataset.initial {
        Initial::Estimate => None,
        Initial::Rest => state.get(place).copied(),
        Initial::Given(values) => {
            let name = &model.coordinates[place].name;
            let given = values.iter().find(|(given, _)| given == name);
            given.map(|(_, value)| *value).or(state.get(place).copied())
        }
    };
    let channels = dataset.channels.iter();
    channels
        .map(|channel| match channel.quantity {
            Quantity::Coordinate(place) => of(place),
            _ => None,
        })
        .collect()
}
