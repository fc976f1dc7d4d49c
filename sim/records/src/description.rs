//! A dataset file: its tables and keys, each with its place. Names of a model, units and numbers
//! are checked by whoever takes them over.

use std::path::Path;

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::{Entry, Name, Number, Record, Written};
use eomgen_model_spec::toml_file;

/// The largest dataset file accepted, in bytes.
const LARGEST: u64 = 1 << 20;

/// The tables and keys of the first level.
const TABLES: [&str; 9] = [
    "title",
    "source",
    "records",
    "time",
    "inputs",
    "channels",
    "initial",
    "uncertain",
    "windows",
];

/// A dataset file.
#[derive(Debug)]
pub struct Description {
    /// The file's text.
    pub source: Source,
    /// One line for people.
    pub title: String,
    /// The files of `[records]`.
    pub records: Records,
    /// `[time]`
    pub time: Column,
    /// `[inputs.NAME]`; each is held from sample to sample.
    pub inputs: Vec<InputColumn>,
    /// `[channels.NAME]`
    pub channels: Vec<ChannelColumn>,
    /// `[initial]`
    pub initial: InitialState,
    /// `[uncertain]`: parameters and the relative standard deviation of each.
    pub uncertain: Vec<(Name, Number)>,
    /// `[windows]`
    pub windows: Windows,
}

/// `[records]`
#[derive(Debug)]
pub struct Records {
    /// Files to learn from, relative to the dataset's folder.
    pub train: Vec<Written>,
    /// Files to be judged by.
    pub test: Vec<Written>,
    /// Where the table stands.
    pub span: Span,
}

/// A column of the records.
#[derive(Debug)]
pub struct Column {
    /// What it is called there.
    pub column: Written,
    /// Its unit.
    pub unit: Written,
}

/// `[inputs.NAME]`
#[derive(Debug)]
pub struct InputColumn {
    /// The input.
    pub name: Name,
    /// Its column.
    pub column: Column,
}

/// `[channels.NAME]`
#[derive(Debug)]
pub struct ChannelColumn {
    /// The channel.
    pub name: Name,
    /// Its column.
    pub column: Column,
    /// One standard deviation of its noise, in its unit.
    pub noise: Number,
    /// What it measures, where that is not its name.
    pub observable: Option<Written>,
}

/// `[initial]`
#[derive(Debug)]
pub enum InitialState {
    /// As the model says, at rest.
    Rest,
    /// Not known.
    Estimate,
    /// These states, by name.
    Given(Vec<(Name, Number)>),
}

/// `[windows]`
#[derive(Debug, Default)]
pub struct Windows {
    /// The length of a window, s; none if every record is one.
    pub length: Option<Number>,
    /// Whether initial states are read from the smoothed record.
    pub smoothed: bool,
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
    let top = Record::of(file, entries.to_vec(), &TABLES, found);
    let title = top.text("title", found);
    top.text("source", found);
    let records = top
        .require("records", "write [records] with train and test", found)
        .cloned();
    let records = records.and_then(|entry| records_of(&entry, found));
    let time = top
        .require("time", "write [time] with column and unit", found)
        .cloned();
    let time = time.and_then(|entry| {
        let record = entry.record(
            &["column", "unit"],
            "{ column = \"t\", unit = \"s\" }",
            found,
        )?;
        column(&record, found)
    });
    let inputs = each(&top, "inputs", found, input);
    let channels = each(&top, "channels", found, channel);
    let uncertain = each(&top, "uncertain", found, |entry, found| {
        let example = "{ relative = 0.05 }";
        let record = entry.record(&["relative"], example, found)?;
        let relative = required(&record, "relative", "0.05", found)?;
        Some((entry.name.clone(), found.keep(relative.number())?))
    });
    let initial = match top.get("initial") {
        Some(entry) => initial(entry, found),
        None => Some(InitialState::Estimate),
    };
    let windows = match top.get("windows") {
        Some(entry) => windows(entry, found),
        None => Some(Windows::default()),
    };
    Some(Description {
        source: source.clone(),
        title,
        records: records?,
        time: time?,
        inputs,
        channels,
        initial: initial?,
        uncertain,
        windows: windows?,
    })
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

fn required<'r, 'd>(
    record: &'r Record<'d>,
    key: &str,
    example: &str,
    found: &mut Diagnostics,
) -> Option<&'r Entry<'d>> {
    record.require(key, &format!("write {key} = {example}"), found)
}

fn records_of(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Records> {
    let example = "{ train = [\"train.csv\"], test = [\"test.csv\"] }";
    let record = entry.record(&["train", "test"], example, found)?;
    let mut files = |key: &str| {
        let Some(entry) = record.get(key) else {
            return Vec::new();
        };
        let elements = found
            .keep(entry.list("[\"record.csv\"]"))
            .unwrap_or_default();
        let written = elements.iter().map(Entry::written);
        written.filter_map(|file| found.keep(file)).collect()
    };
    Some(Records {
        train: files("train"),
        test: files("test"),
        span: entry.name.span,
    })
}

fn column(record: &Record<'_>, found: &mut Diagnostics) -> Option<Column> {
    let column = required(record, "column", "\"its name in the records\"", found).cloned();
    let unit = required(record, "unit", "\"m\"", found).cloned();
    let written = [column, unit].map(|entry| found.keep(entry?.written()));
    let [column, unit] = written;
    Some(Column {
        column: column?,
        unit: unit?,
    })
}

fn input(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InputColumn> {
    let example = "{ column = \"u\", unit = \"N\" }";
    let record = entry.record(&["column", "unit", "hold"], example, found)?;
    if let Some(hold) = record.get("hold") {
        found.keep(hold.word(&[("zero-order", ())]));
    }
    Some(InputColumn {
        name: entry.name.clone(),
        column: column(&record, found)?,
    })
}

fn channel(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<ChannelColumn> {
    let known = ["column", "unit", "noise", "observable"];
    let example = "{ column = \"x\", unit = \"m\", noise = 1e-6 }";
    let record = entry.record(&known, example, found)?;
    let noise = required(&record, "noise", "1e-6, one standard deviation", found).cloned();
    let noise = noise.and_then(|noise| found.keep(noise.number()));
    let observable = record.written("observable", found);
    Some(ChannelColumn {
        name: entry.name.clone(),
        column: column(&record, found)?,
        noise: noise?,
        observable,
    })
}

/// The words of `initial.state`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Word {
    Rest,
    Estimate,
    Given,
}

fn initial(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InitialState> {
    let record = entry.record(&["state", "values"], "{ state = \"rest\" }", found)?;
    let state = required(&record, "state", "\"rest\"", found)?.clone();
    if state.is_table() {
        return given(&state, found);
    }
    let words = [
        ("rest", Word::Rest),
        ("estimate", Word::Estimate),
        ("given", Word::Given),
    ];
    let word = found.keep(state.word(&words))?;
    let values = record.get("values");
    match (word, values) {
        (Word::Given, Some(values)) => given(values, found),
        (Word::Given, None) => {
            found.push(
                Diagnostic::error("no state is given")
                    .at(state.span(), "`values` are missing")
                    .help("write [initial.values] with the states by name, in SI"),
            );
            None
        }
        (_, Some(values)) => {
            found.push(
                Diagnostic::error("`values` are not used")
                    .at(values.name.span, "these say nothing")
                    .also(state.span(), "beside this")
                    .help("write state = \"given\", or leave the values out"),
            );
            None
        }
        (Word::Rest, None) => Some(InitialState::Rest),
        (Word::Estimate, None) => Some(InitialState::Estimate),
    }
}

fn given(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InitialState> {
    let values = found.keep(entry.table("{ x = 0.1 }"))?;
    if values.is_empty() {
        found.push(
            Diagnostic::error("no state is given")
                .at(entry.span(), "this is empty")
                .help("give states by name, in SI, as x = 0.1"),
        );
    }
    let mut given = Vec::with_capacity(values.len());
    for value in values {
        given.push((value.name.clone(), found.keep(value.number())?));
    }
    Some(InitialState::Given(given))
}

fn windows(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Windows> {
    let record = entry.record(&["length", "start"], "{ length = 0.5 }", found)?;
    let smoothed = match record.get("start") {
        Some(start) => found.keep(start.word(&[("fitted", false), ("smoothed", true)])),
        None => Some(false),
    };
    let length = required(&record, "length", "0.5, in s, or \"record\"", found)?;
    let length = match length.written() {
        Ok(_) => found.keep(length.word(&[("record", None)])),
        Err(_) => found.keep(length.number()).map(Some),
    };
    let length = length?;
    if let Some(length) = length.filter(|length| length.value <= 0.0) {
        found.push(
            Diagnostic::error(format!("a window cannot last {} s", length.value))
                .at(length.span, "expected seconds, more than 0, or \"record\""),
        );
    }
    Some(Windows {
        length,
        smoothed: smoothed?,
    })
}
