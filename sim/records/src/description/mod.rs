//! A dataset file: its tables and keys, each with its place. Names of a model, units and numbers
//! are checked by whoever takes them over.

pub mod columns;
pub mod experiment;
pub mod format;
pub mod keys;
pub mod motion;
pub mod records;
mod required;

use std::path::Path;

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::{Entry, Name, Number, Record};
use eomgen_model_spec::toml_file;

use self::columns::{ChannelColumn, ColumnKey, InputColumn, MotionColumn, Time};
use self::experiment::Experiment;
use self::format::Format;
use self::motion::{InitialState, Windows};
use self::records::Records;
use self::required::required;

/// The largest dataset file accepted, in bytes.
const LARGEST: u64 = 1 << 20;

/// A dataset file.
#[derive(Debug)]
pub struct Description {
    /// The file's text.
    pub source: Source,
    /// One line for people.
    pub title: String,
    /// `[records]`
    pub records: Records,
    /// `[format]`
    pub format: Format,
    /// `[time]`
    pub time: Time,
    /// `[inputs.NAME]`; each is held from sample to sample.
    pub inputs: Vec<InputColumn>,
    /// `[motion.NAME]`
    pub motion: Vec<MotionColumn>,
    /// `[channels.NAME]`
    pub channels: Vec<ChannelColumn>,
    /// `[initial]`
    pub initial: InitialState,
    /// `[uncertain]`: parameters and the relative standard deviation of each.
    pub uncertain: Vec<(Name, Number)>,
    /// `[windows]`
    pub windows: Windows,
    /// `[experiment]`
    pub experiment: Experiment,
}

impl Description {
    /// Reads a dataset file.
    ///
    /// # Errors
    /// A file that cannot be read, and all that is wrong with its grammar, tables and keys.
    pub fn read(path: &Path) -> Result<Self, Diagnostics> {
        Self::of(toml_file::source(path, LARGEST)?)
    }

    /// Reads the text of a dataset file.
    ///
    /// # Errors
    /// All that is wrong with its grammar, tables and keys.
    pub fn of(source: Source) -> Result<Self, Diagnostics> {
        toml_file::read(&source, |entries, found| described(&source, entries, found))
    }

    /// All columns that are read.
    fn columns(&self) -> impl Iterator<Item = &ColumnKey> {
        let inputs = self.inputs.iter().map(|input| &input.column.column);
        let motion = self
            .motion
            .iter()
            .map(|coordinate| &coordinate.column.column);
        let channels = self.channels.iter().map(|channel| &channel.column.column);
        [&self.time.column.column]
            .into_iter()
            .chain(inputs)
            .chain(motion)
            .chain(channels)
    }
}

/// All tables of a file; none where one that is needed is missing or wrong.
fn described(
    source: &Source,
    entries: &[Entry<'_>],
    found: &mut Diagnostics,
) -> Option<Description> {
    let file = Name {
        text: "the dataset".to_owned(),
        span: Span::new(0, 0),
    };
    let top = Record::of(file, entries.to_vec(), &keys::first_level(), found);
    let title = top.text("title", found);
    top.text("source", found);
    let records = top
        .require("records", "write [records] with train and test", found)
        .cloned();
    let records = records.and_then(|entry| records::read(&entry, found));
    let format = match top.get("format") {
        Some(entry) => format::read(entry, found),
        None => Some(Format::default()),
    };
    let time = top
        .require("time", "write [time] with column and unit", found)
        .cloned();
    let time = time.and_then(|entry| columns::time(&entry, found));
    let inputs = each(&top, "inputs", found, columns::input);
    let motion = each(&top, "motion", found, columns::motion);
    let channels = each(&top, "channels", found, columns::channel);
    let uncertain = each(&top, "uncertain", found, uncertain);
    let initial = match top.get("initial") {
        Some(entry) => motion::initial(entry, found),
        None => Some(InitialState::Estimate),
    };
    let windows = match top.get("windows") {
        Some(entry) => motion::windows(entry, found),
        None => Some(Windows::default()),
    };
    let experiment = match top.get("experiment") {
        Some(entry) => experiment::read(entry, found),
        None => Some(Experiment::default()),
    };
    let description = Description {
        source: source.clone(),
        title,
        records: records?,
        format: format?,
        time: time?,
        inputs,
        motion,
        channels,
        initial: initial?,
        uncertain,
        windows: windows?,
        experiment: experiment?,
    };
    nameless(&description, found);
    Some(description)
}

/// Columns of records without names are called by their numbers.
fn nameless(description: &Description, found: &mut Diagnostics) {
    if description.format.names {
        return;
    }
    for column in description.columns() {
        if let ColumnKey::Name(name) = column {
            let number = name.text.parse::<usize>().unwrap_or(2);
            found.push(
                Diagnostic::error(format!("no column is called \"{}\"", name.text))
                    .at(name.span, "[format] says that the columns have no names")
                    .help(format!(
                        "give the column's number, from 1 on: column = {number}"
                    )),
            );
        }
    }
}

/// An entry of `[uncertain]`.
fn uncertain(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<(Name, Number)> {
    let record = entry.record(&keys::UNCERTAIN, "{ relative = 0.05 }", found)?;
    let relative = required(&record, "relative", "0.05", found)?;
    Some((entry.name.clone(), found.keep(relative.number())?))
}

/// The entries of a table, each read by `of`.
fn each<T>(
    top: &Record<'_>,
    name: &str,
    found: &mut Diagnostics,
    of: impl Fn(&Entry<'_>, &mut Diagnostics) -> Option<T>,
) -> Vec<T> {
    let Some(entry) = top.get(name) else {
        return Vec::new();
    };
    let entries = found.keep(entry.table("{ ... }")).unwrap_or_default();
    entries
        .iter()
        .filter_map(|entry| of(entry, found))
        .collect()
}
