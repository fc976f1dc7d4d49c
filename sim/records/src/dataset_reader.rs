//! Reading and checking of a dataset file with its records, and binding to a model.

use std::path::Path;

use eomgen_model_spec::model::Model;

use crate::binding::bind_description;
use crate::checks::check_records;
use crate::clock::contains_time;
use crate::coverage::{self, check_splittable};
use crate::dataset::{Channel, Dataset, StartSource};
use crate::decimation::Decimation;
use crate::description::Description;
use crate::description::records::Stretch;
use crate::given_motion::list_speed_notes;
use crate::initial_readings::compute_initial_readings;
use crate::inputs::list_input_notes;
use crate::record::{Record, RecordReader};
use crate::record_parts::split_at_gaps;
use crate::refusal::Refusal;
use crate::rest::remove_rest;
use crate::samples::MIN_SAMPLES;

/// Reads a dataset for a model.
///
/// # Errors
/// Errors of the dataset file, or the first error of a record, with its location.
pub fn read_dataset(path: &Path, model: &Model) -> Result<Dataset, Refusal> {
    let description = Description::read(path, model)?;
    if let Some(impact) = model.impacts.first() {
        return Err(Refusal::Record(format!(
            "{}: the model has impacts (`{}`), which `compare` and `discover` do not support yet; \
             `simulate` does",
            path.display(),
            impact.name
        )));
    }
    let bound = bind_description(&description, model)?;
    let mut dataset = Dataset {
        path: path.to_owned(),
        title: description.title.clone(),
        train: Vec::new(),
        test: Vec::new(),
        inputs: bound.input_priors,
        channels: bound.channels,
        initial: bound.initial,
        window: description.windows.length.map(|length| length.value),
        start: match description.windows.is_smoothed {
            true => StartSource::SmoothedRecord,
            false => StartSource::Estimate,
        },
        uncertain: bound.uncertain,
        experiment: bound.experiment,
        experiment_units: bound.experiment_units.clone(),
        motion: match bound.motion.is_empty() {
            true => Vec::new(),
            false => model.coordinates.iter().map(|c| c.name.clone()).collect(),
        },
        notes: list_input_notes(&description, (model, &[])),
    };
    let speeds = list_speed_notes(&bound.motion, &description);
    dataset.notes.extend(speeds);
    let starts = compute_initial_readings(&dataset, model);
    let decimation = Decimation::new(description.time.every, description.time.filter);
    let smooth_noises: Vec<Option<f64>> =
        (dataset.channels.iter().map(Channel::smooth_noise)).collect();
    for channel in &mut dataset.channels {
        channel.noise *= decimation.noise_factor();
    }
    let columns = RecordReader {
        description: &description,
        path,
        time: &bound.time,
        inputs: &bound.inputs,
        motion: &bound.motion,
        channels: &bound.channel_units,
        smooth_noises: &smooth_noises,
        initial_readings: &starts,
        model,
        counts_from_first: !contains_time(model),
        decimation: &decimation,
        min_samples: MIN_SAMPLES,
    };
    let mut notes = Vec::new();
    let mut read = |kind: &str, files: &[Stretch]| -> Result<Vec<Record>, Refusal> {
        let files = files.iter().enumerate();
        let mut records = Vec::new();
        for (place, file) in files {
            let (record, empty) =
                columns.read_record(&format!("{kind}[{place}]"), file, &mut notes)?;
            check_splittable(&record, &description)?;
            records.extend(split_at_gaps(record, empty, &mut notes)?);
        }
        Ok(records)
    };
    dataset.train = read("train", &description.records.train)?;
    dataset.test = read("test", &description.records.test)?;
    dataset.notes.append(&mut notes);
    let notes = check_records(&dataset, &description, &model.inputs)?;
    dataset.notes.extend(notes);
    if dataset.gives_motion() {
        let notes = remove_rest(&mut dataset, model);
        dataset.notes.extend(notes);
        coverage::check_coverage(&dataset, &description)?;
    }
    Ok(dataset)
}
