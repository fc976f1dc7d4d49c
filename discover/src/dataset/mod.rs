//! Measured records as a dataset file describes them: which columns are time, inputs and
//! channels, their units and noise, what is known of the initial state, how long the
//! restarted windows are, and which parameters are uncertain. Everything is in SI once it is
//! read. Whether a record can be believed is judged by [`crate::gate`].

mod columns;
mod parquet_file;
mod taken;

use std::path::{Path, PathBuf};

use model_spec::diagnostic::{Diagnostic, Diagnostics};
use model_spec::model::Model;
use model_spec::suggest::did_you_mean;
use model_spec::table::Written;
use model_spec::unit::Unit;
use sim::record::description::Description;
use sim::record::{HeldInputs, beside};

pub use sim::record::Refusal;

/// What a channel measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// An observable, by its place.
    Observable(usize),
    /// A coordinate, by its place.
    Coordinate(usize),
    /// The rate of a coordinate, by the coordinate's place.
    Rate(usize),
}

/// A measured channel.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its name in the dataset.
    pub name: String,
    /// What it measures.
    pub quantity: Quantity,
    /// The quantity's SI unit.
    pub unit: String,
    /// One standard deviation of its noise, SI.
    pub noise: f64,
}

/// A parameter of the model that may be refitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertain {
    /// Its name.
    pub name: String,
    /// One standard deviation of its prior, relative to the specification's value.
    pub relative: f64,
}

/// What is known of a record's first state.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// As the model's own initial values say, at rest.
    Rest,
    /// Nothing.
    Estimate,
    /// These states, by name, SI.
    Given(Vec<(String, f64)>),
}

/// Where a window's initial state comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Estimated inside the window.
    Fitted,
    /// Read from the smoothed record.
    Smoothed,
}

/// A record in SI.
#[derive(Clone, Debug)]
pub struct Record {
    /// `train[0]`, `test[1]`, ...
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// The times of the samples, s.
    pub times: Vec<f64>,
    /// The model's inputs, held from sample to sample.
    pub inputs: HeldInputs,
    /// The inputs as columns, NaN where a sample is missing.
    pub input_columns: Vec<Vec<f64>>,
    /// One column per channel, NaN where a sample is missing.
    pub channels: Vec<Vec<f64>>,
}

/// Records with their description.
#[derive(Clone, Debug)]
pub struct Dataset {
    /// The dataset's file.
    pub path: PathBuf,
    /// One line for people.
    pub title: String,
    /// Records to learn from.
    pub train: Vec<Record>,
    /// Records to be judged by.
    pub test: Vec<Record>,
    /// What was measured.
    pub channels: Vec<Channel>,
    /// What is known of the first state.
    pub initial: Initial,
    /// The length of a window, s; none if every record is one window.
    pub window: Option<f64>,
    /// Where a window's initial state comes from.
    pub start: Start,
    /// Which parameters may be refitted.
    pub uncertain: Vec<Uncertain>,
    /// What is worth a remark.
    pub notes: Vec<String>,
}

/// Reads a dataset for a model.
///
/// # Errors
/// What is wrong with the dataset file, or the first thing that is wrong with a record, each with
/// its place.
pub fn read(path: &Path, model: &Model) -> Result<Dataset, Refusal> {
    let description = Description::read(path)?;
    let taken = taken::taken(&description, model)?;
    let mut dataset = Dataset {
        path: path.to_owned(),
        title: description.title.clone(),
        train: Vec::new(),
        test: Vec::new(),
        channels: taken.channels,
        initial: taken.initial,
        window: description.windows.length.map(|length| length.value),
        start: match description.windows.smoothed {
            true => Start::Smoothed,
            false => Start::Fitted,
        },
        uncertain: taken.uncertain,
        notes: notes_of_inputs(&description, model),
    };
    let columns = Columns {
        description: &description,
        path,
        time: &taken.time,
        inputs: &taken.inputs,
        channels: &taken.channel_units,
        model,
    };
    let read = |kind: &str, files: &[Written]| -> Result<Vec<Record>, Refusal> {
        let files = files.iter().enumerate();
        files
            .map(|(place, file)| columns.record(&format!("{kind}[{place}]"), file))
            .collect()
    };
    dataset.train = read("train", &description.records.train)?;
    dataset.test = read("test", &description.records.test)?;
    let notes = crate::gate::examine(&dataset, &description)?;
    dataset.notes.extend(notes);
    Ok(dataset)
}

/// Inputs that the model or the dataset lacks.
fn notes_of_inputs(description: &Description, model: &Model) -> Vec<String> {
    let inputs = || model.inputs.iter().map(|input| input.name.as_str());
    let mut notes = Vec::new();
    for column in &description.inputs {
        let name = column.name.text.as_str();
        if inputs().all(|input| input != name) {
            let meant = did_you_mean(name, inputs()).map_or(String::new(), |m| format!("; {m}"));
            notes.push(format!(
                "the model has no input `{name}`: that column is not used{meant}"
            ));
        }
    }
    for input in inputs() {
        if (description.inputs.iter()).all(|column| column.name.text != input) {
            notes.push(format!("the dataset has no input `{input}`: it is 0"));
        }
    }
    notes
}

/// Which columns of a record are what.
struct Columns<'d> {
    description: &'d Description,
    /// The dataset file.
    path: &'d Path,
    /// The time's unit.
    time: &'d Unit,
    /// For each input of the model its column and unit, if there is one.
    inputs: &'d [Option<(&'d Written, Unit)>],
    /// The unit of each channel's column.
    channels: &'d [Unit],
    model: &'d Model,
}

impl Columns<'_> {
    /// Reads one record.
    fn record(&self, name: &str, file: &Written) -> Result<Record, Refusal> {
        let wrong =
            |diagnostic: Diagnostic| Diagnostics::one(self.description.source.clone(), diagnostic);
        let place = beside(self.path, file).map_err(wrong)?;
        let mut wanted = vec![self.description.time.column.text.as_str()];
        let mut units = vec![self.time];
        for (column, unit) in self.inputs.iter().flatten() {
            wanted.push(&column.text);
            units.push(unit);
        }
        let first_channel = wanted.len();
        for (channel, unit) in self.description.channels.iter().zip(self.channels) {
            wanted.push(&channel.column.column.text);
            units.push(unit);
        }
        let mut columns = columns::read(&place, &wanted)?;
        for (column, unit) in columns.iter_mut().zip(&units) {
            for value in column.iter_mut() {
                // What is too large for a number in SI is as good as missing.
                *value = Some(unit.to_si(*value))
                    .filter(|v| v.is_finite())
                    .unwrap_or(f64::NAN);
            }
        }
        let channels = columns.split_off(first_channel);
        let mut columns = columns.into_iter();
        let times = columns.next().unwrap_or_default();
        let input_columns: Vec<Vec<f64>> = (self.inputs.iter())
            .map(|fed| fed.as_ref().and_then(|_| columns.next()))
            .map(|column| column.unwrap_or_else(|| vec![0.0; times.len()]))
            .collect();
        crate::gate::check_times(&place, &times)?;
        for (input, column) in self.model.inputs.iter().zip(&input_columns) {
            crate::gate::check_input(&place, &input.name, column)?;
        }
        Ok(Record {
            name: name.to_owned(),
            inputs: held(&times, &input_columns),
            path: place,
            times,
            input_columns,
            channels,
        })
    }
}

/// Inputs held from sample to sample, over missing ones too.
fn held(times: &[f64], columns: &[Vec<f64>]) -> HeldInputs {
    let mut last = vec![0.0; columns.len()];
    let mut values = Vec::with_capacity(times.len() * columns.len());
    for sample in 0..times.len() {
        for (slot, column) in last.iter_mut().zip(columns) {
            if column[sample].is_finite() {
                *slot = column[sample];
            }
        }
        values.extend_from_slice(&last);
    }
    HeldInputs::new(times.to_vec(), values, columns.len())
        .unwrap_or_else(|| HeldInputs::zero(columns.len()))
}
