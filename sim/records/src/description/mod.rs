//! Dataset file: tables and keys with their locations. Other modules check names, units and numbers.

pub mod columns;
pub mod experiment;
pub mod format;
#[rustfmt::skip]
pub mod keys;
pub mod motion;
pub mod records;

use std::path::Path;

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::quantity::{Name, Number};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::Entry;
use eomgen_model_spec::toml_file;

use self::columns::{ChannelColumn, Column, ColumnKey, InputColumn, MotionColumn, Time};
use self::experiment::Experiment;
use self::format::Format;
use self::motion::{InitialState, Windows};
use self::records::Records;

const MAX_DESCRIPTION_BYTES: u64 = 1 << 20;

/// Parsed dataset file.
#[derive(Debug)]
pub struct Description {
    /// Text of the file.
    pub source: Source,
    /// Title for reports.
    pub title: String,
    /// Table `[records]`.
    pub records: Records,
    /// Table `[format]`.
    pub format: Format,
    /// Table `[time]`.
    pub time: Time,
    /// Tables `[inputs.NAME]`. Inputs are held between samples.
    pub inputs: Vec<InputColumn>,
    /// Tables `[motion.NAME]`.
    pub motion: Vec<MotionColumn>,
    /// Tables `[channels.NAME]`.
    pub channels: Vec<ChannelColumn>,
    /// Table `[initial]`.
    pub initial: InitialState,
    /// Table `[uncertain]`: parameters with their relative standard deviations.
    pub uncertain: Vec<(Name, Number)>,
    /// Table `[windows]`.
    pub windows: Windows,
    /// Table `[experiment]`.
    pub experiment: Experiment,
}

impl Description {
    /// Reads a dataset file. Its expressions may contain names of a model, with the parameter values of the model.
    ///
    /// # Errors
    /// A file that cannot be read, all errors of grammar, tables and keys, and errors of expressions.
    pub fn read(path: &Path, model: &Model) -> Result<Self, Diagnostics> {
        let mut description = Self::parse(toml_file::source(path, MAX_DESCRIPTION_BYTES)?)?;
        let mut found = Diagnostics::new(description.source.clone());
        for column in description.columns_mut() {
            found.push_error(column.evaluate_period(model));
        }
        match found.is_empty() {
            true => Ok(description),
            false => Err(found),
        }
    }

    fn columns_mut(&mut self) -> impl Iterator<Item = &mut Column> {
        let inputs = self.inputs.iter_mut().map(|input| &mut input.column);
        let motion = self.motion.iter_mut().map(|given| &mut given.column);
        let channels = self.channels.iter_mut().map(|channel| &mut channel.column);
        inputs.chain(motion).chain(channels)
    }

    /// Parses the text of a dataset file.
    pub fn parse(source: Source) -> Result<Self, Diagnostics> {
        toml_file::read(&source, |entries, found| {
            read_tables(&source, entries, found)
        })
    }

    fn column_keys(&self) -> impl Iterator<Item = &ColumnKey> {
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

fn read_tables(
    source: &Source,
    entries: &[Entry<'_>],
    found: &mut Diagnostics,
) -> Option<Description> {
    let file = Name {
        text: "the dataset".to_owned(),
        span: Span::new(0, 0),
    };
    let top = Record::new(file, entries.to_vec(), &keys::TABLES, found).as_file();
    let title = top.text("title", found);
    top.text("source", found);
    let records = top.require("records", found).cloned();
    let records = records.and_then(|entry| records::read_records(&entry, found));
    let format = read_or_default(&top, "format", found, format::read_format);
    let time = top.require("time", found).cloned();
    let time = time.and_then(|entry| columns::read_time(&entry, found));
    let inputs = read_entries(&top, "inputs", found, columns::read_input);
    let motion = read_entries(&top, "motion", found, columns::read_motion);
    let channels = read_entries(&top, "channels", found, columns::read_channel);
    let uncertain = read_entries(&top, "uncertain", found, read_uncertain);
    let initial = read_or_default(&top, "initial", found, motion::read_initial);
    let windows = read_or_default(&top, "windows", found, motion::read_windows);
    let experiment = read_or_default(&top, "experiment", found, experiment::read_experiment);
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
    check_column_numbers(&description, found);
    Some(description)
}

fn check_column_numbers(description: &Description, found: &mut Diagnostics) {
    if description.format.has_names {
        return;
    }
    for column in description.column_keys() {
        if let ColumnKey::Name(name) = column {
            let number = name.text.parse::<usize>().unwrap_or(2);
            found.push(
                Diagnostic::error(format!("there is no column \"{}\"", name.text))
                    .with_span(
                        name.span,
                        "the columns have no names: names = false in [format]",
                    )
                    .with_help(format!(
                        "give the column's number, from 1 on: column = {number}"
                    )),
            );
        }
    }
}

fn read_uncertain(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<(Name, Number)> {
    let record = Record::read(entry, &keys::UNCERTAIN, found)?;
    let relative = record.required("relative", Entry::number, found)?;
    Some((entry.name.clone(), relative))
}

/// Reads a table, or returns its default if it is absent.
fn read_or_default<T: Default>(
    top: &Record<'_>,
    name: &str,
    found: &mut Diagnostics,
    read: impl Fn(&Entry<'_>, &mut Diagnostics) -> Option<T>,
) -> Option<T> {
    match top.get(name) {
        Some(entry) => read(entry, found),
        None => Some(T::default()),
    }
}

fn read_entries<T>(
    top: &Record<'_>,
    name: &str,
    found: &mut Diagnostics,
    of: impl Fn(&Entry<'_>, &mut Diagnostics) -> Option<T>,
) -> Vec<T> {
    let Some(entry) = top.get(name) else {
        return Vec::new();
    };
    let entries = found.push_error(entry.table("{ ... }")).unwrap_or_default();
    entries
        .iter()
        .filter_map(|entry| of(entry, found))
        .collect()
}
