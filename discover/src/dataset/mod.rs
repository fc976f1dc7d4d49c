//! Measured records as a dataset file describes them: which columns are time, inputs and
//! channels, their units and noise, what is known of the initial state, how long the
//! restarted windows are, and which parameters are uncertain. Everything is in SI once it is
//! read. Whether a record can be believed is judged by [`crate::gate`].

mod columns;
mod description;
mod parquet_file;

use std::path::{Component, Path, PathBuf};

use model_spec::model::Model;
use model_spec::unit::Unit;
use sim::record::HeldInputs;

use description::Description;

/// Why a dataset is not taken: where it is wrong, what is wrong and what would be right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal(pub String);

impl Refusal {
    pub(crate) fn file(path: &Path, message: impl Into<String>) -> Self {
        Self(format!("{}: {}", path.display(), message.into()))
    }

    pub(crate) fn line(path: &Path, line: u64, message: impl Into<String>) -> Self {
        Self(format!(
            "{}, line {line}: {}",
            path.display(),
            message.into()
        ))
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

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
/// The first thing that is wrong, with its file and, where there is one, its line.
pub fn read(path: &Path, model: &Model) -> Result<Dataset, Refusal> {
    let description = Description::read(path)?;
    let mut dataset = Dataset {
        path: path.to_owned(),
        title: description.title.clone().unwrap_or_default(),
        train: Vec::new(),
        test: Vec::new(),
        channels: channels(path, &description, model)?,
        initial: description.initial(path, model)?,
        window: description.window(path)?,
        start: description.start(path)?,
        uncertain: description.uncertain(path, model)?,
        notes: Vec::new(),
    };
    for name in description.inputs.keys() {
        if model.inputs.iter().all(|input| input.name != *name) {
            let note = format!("the model has no input `{name}`: that column is not used");
            dataset.notes.push(note);
        }
    }
    for input in &model.inputs {
        if !description.inputs.contains_key(&input.name) {
            let note = format!("the dataset has no input `{}`: it is 0", input.name);
            dataset.notes.push(note);
        }
    }
    let lists = [
        ("train", &description.records.train),
        ("test", &description.records.test),
    ];
    for (kind, files) in lists {
        if files.is_empty() {
            return Err(Refusal::file(
                path,
                format!("[records] lists no {kind} record; discovery needs both kinds"),
            ));
        }
        for (place, file) in files.iter().enumerate() {
            let name = format!("{kind}[{place}]");
            let record = record(path, &name, file, &description, model, &dataset.channels)?;
            if kind == "train" {
                dataset.train.push(record);
            } else {
                dataset.test.push(record);
            }
        }
    }
    let notes = crate::gate::examine(&dataset)?;
    dataset.notes.extend(notes);
    Ok(dataset)
}

fn channels(
    path: &Path,
    description: &Description,
    model: &Model,
) -> Result<Vec<Channel>, Refusal> {
    let mut channels = Vec::new();
    for (name, entry) in &description.channels {
        let asked = entry.observable.as_ref().unwrap_or(name);
        let (quantity, unit) = quantity(model, asked).ok_or_else(|| {
            let known: Vec<&str> = (model.observables.iter().map(|o| o.name.as_str()))
                .chain(model.coordinates.iter().map(|c| c.name.as_str()))
                .collect();
            Refusal::file(
                path,
                format!(
                    "channels.{name}: the model has no observable or coordinate `{asked}`; it has {}",
                    known.join(", ")
                ),
            )
        })?;
        let given = unit_of(path, &format!("channels.{name}"), &entry.unit, &unit)?;
        let noise = given.to_si(entry.noise);
        if !(noise.is_finite() && noise > 0.0) {
            return Err(Refusal::file(
                path,
                format!(
                    "channels.{name}: noise = {}; expected its standard deviation, greater than 0",
                    entry.noise
                ),
            ));
        }
        channels.push(Channel {
            name: name.clone(),
            quantity,
            unit,
            noise,
        });
    }
    if channels.is_empty() {
        return Err(Refusal::file(
            path,
            "there is no [channels.NAME]; expected at least one measured quantity",
        ));
    }
    Ok(channels)
}

/// A quantity of the model by name, and its SI unit.
fn quantity(model: &Model, name: &str) -> Option<(Quantity, String)> {
    if let Some(place) = model.observables.iter().position(|o| o.name == name) {
        let unit = model.observables[place].unit.text.clone();
        return Some((Quantity::Observable(place), unit));
    }
    if let Some(place) = model.coordinates.iter().position(|c| c.name == name) {
        let unit = model.coordinates[place].unit.text.clone();
        return Some((Quantity::Coordinate(place), unit));
    }
    let of = name.strip_suffix("_dot")?;
    let place = model.coordinates.iter().position(|c| c.name == of)?;
    let unit = format!("{}/s", model.coordinates[place].unit.text);
    Some((Quantity::Rate(place), unit))
}

/// A unit that has the dimension of the expected one.
fn unit_of(path: &Path, place: &str, text: &str, expected: &str) -> Result<Unit, Refusal> {
    let refuse = |message: String| Refusal::file(path, format!("{place}: {message}"));
    let unit = Unit::parse(text).map_err(|error| refuse(format!("unit \"{text}\": {error}")))?;
    let wanted = Unit::parse(expected).map_err(|error| refuse(error.to_string()))?;
    if unit.dimension == wanted.dimension {
        Ok(unit)
    } else {
        Err(refuse(format!("is in {text}, expected {expected}")))
    }
}

fn record(
    path: &Path,
    name: &str,
    file: &str,
    description: &Description,
    model: &Model,
    channels: &[Channel],
) -> Result<Record, Refusal> {
    let relative = Path::new(file);
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if !relative.components().all(inside) {
        return Err(Refusal::file(
            path,
            format!("the record \"{file}\" lies outside the dataset's folder"),
        ));
    }
    let place = path.parent().unwrap_or(Path::new(".")).join(relative);
    let mut wanted = vec![description.time.column.as_str()];
    let mut units = vec![unit_of(path, "time", &description.time.unit, "s")?];
    let mut fed = Vec::new();
    for input in &model.inputs {
        fed.push(description.inputs.get(&input.name).map(|entry| {
            wanted.push(&entry.column);
            (wanted.len() - 1, entry)
        }));
        if let Some(Some((_, entry))) = fed.last() {
            let place = format!("inputs.{}", input.name);
            units.push(unit_of(path, &place, &entry.unit, &input.unit.text)?);
            entry.check_hold(path, &place)?;
        }
    }
    let first_channel = wanted.len();
    for channel in channels {
        let entry = &description.channels[&channel.name];
        wanted.push(&entry.column);
        units.push(unit_of(path, &channel.name, &entry.unit, &channel.unit)?);
    }
    let mut columns = columns::read(&place, &wanted)?;
    for (column, unit) in columns.iter_mut().zip(&units) {
        column
            .iter_mut()
            .for_each(|value| *value = unit.to_si(*value));
    }
    let channels = columns.split_off(first_channel);
    let times = columns[0].clone();
    let missing = vec![0.0; times.len()];
    let input_columns: Vec<Vec<f64>> = fed
        .iter()
        .map(|feed| match feed {
            Some((place, _)) => columns[*place].clone(),
            None => missing.clone(),
        })
        .collect();
    crate::gate::check_times(&place, &times)?;
    for (input, column) in model.inputs.iter().zip(&input_columns) {
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
