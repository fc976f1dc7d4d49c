//! The dataset file itself: its keys as they are written. Values are checked as they are
//! taken over.

use std::collections::BTreeMap;
use std::path::Path;

use model_spec::model::{Model, ParameterValue};
use serde::Deserialize;

use super::{Initial, Refusal, Start, Uncertain};

/// The largest dataset file read, in bytes.
const LARGEST_DATASET: u64 = 1 << 20;

/// A dataset file.
#[derive(Deserialize)]
pub struct Description {
    pub title: Option<String>,
    pub records: Records,
    pub time: Column,
    #[serde(default)]
    pub inputs: BTreeMap<String, InputColumn>,
    #[serde(default)]
    pub channels: BTreeMap<String, ChannelColumn>,
    initial: Option<InitialEntry>,
    #[serde(default)]
    uncertain: BTreeMap<String, UncertainEntry>,
    windows: Option<WindowsEntry>,
}

/// `[records]`
#[derive(Deserialize)]
pub struct Records {
    #[serde(default)]
    pub train: Vec<String>,
    #[serde(default)]
    pub test: Vec<String>,
}

/// `[time]`
#[derive(Deserialize)]
pub struct Column {
    pub column: String,
    pub unit: String,
}

/// `[inputs.NAME]`
#[derive(Deserialize)]
pub struct InputColumn {
    pub column: String,
    pub unit: String,
    hold: Option<String>,
}

/// `[channels.NAME]`
#[derive(Deserialize)]
pub struct ChannelColumn {
    pub column: String,
    pub unit: String,
    pub noise: f64,
    pub observable: Option<String>,
}

#[derive(Deserialize)]
struct InitialEntry {
    state: StateEntry,
    #[serde(default)]
    values: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum StateEntry {
    Word(String),
    Values(BTreeMap<String, f64>),
}

#[derive(Deserialize)]
struct UncertainEntry {
    relative: f64,
}

#[derive(Deserialize)]
struct WindowsEntry {
    length: LengthEntry,
    start: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum LengthEntry {
    Seconds(f64),
    Word(String),
}

impl Description {
    /// Reads a dataset file.
    pub fn read(path: &Path) -> Result<Self, Refusal> {
        let unreadable =
            |error: std::io::Error| Refusal::file(path, format!("cannot be read: {error}"));
        let metadata = std::fs::metadata(path).map_err(unreadable)?;
        if !metadata.is_file() {
            return Err(Refusal::file(
                path,
                "is not a file; expected a dataset file",
            ));
        }
        if metadata.len() > LARGEST_DATASET {
            return Err(Refusal::file(
                path,
                format!(
                    "has {} bytes; expected a dataset file, TOML",
                    metadata.len()
                ),
            ));
        }
        let text = std::fs::read_to_string(path).map_err(unreadable)?;
        toml_edit::de::from_str(&text).map_err(|error| Refusal::file(path, error.to_string()))
    }

    /// The length of a window, s; none for the whole record.
    pub fn window(&self, path: &Path) -> Result<Option<f64>, Refusal> {
        match self.windows.as_ref().map(|windows| &windows.length) {
            None => Ok(None),
            Some(LengthEntry::Word(word)) if word == "record" => Ok(None),
            Some(LengthEntry::Seconds(length)) if length.is_finite() && *length > 0.0 => {
                Ok(Some(*length))
            }
            Some(LengthEntry::Seconds(length)) => Err(Refusal::file(
                path,
                format!("windows.length = {length}; expected seconds, or \"record\""),
            )),
            Some(LengthEntry::Word(word)) => Err(Refusal::file(
                path,
                format!("windows.length = \"{word}\"; expected seconds, or \"record\""),
            )),
        }
    }

    /// Where a window's initial state comes from.
    pub fn start(&self, path: &Path) -> Result<Start, Refusal> {
        let start = self
            .windows
            .as_ref()
            .and_then(|windows| windows.start.as_deref());
        match start {
            None | Some("fitted") => Ok(Start::Fitted),
            Some("smoothed") => Ok(Start::Smoothed),
            Some(other) => Err(Refusal::file(
                path,
                format!("windows.start = \"{other}\"; expected \"fitted\" or \"smoothed\""),
            )),
        }
    }

    /// What is known of the first state.
    pub fn initial(&self, path: &Path, model: &Model) -> Result<Initial, Refusal> {
        let Some(entry) = &self.initial else {
            return Ok(Initial::Estimate);
        };
        let values = match &entry.state {
            StateEntry::Word(word) => match word.as_str() {
                "rest" => return Ok(Initial::Rest),
                "estimate" => return Ok(Initial::Estimate),
                "given" => &entry.values,
                other => {
                    return Err(Refusal::file(
                        path,
                        format!(
                            "initial.state = \"{other}\"; expected \"rest\", \"estimate\" or \"given\" with [initial.values]"
                        ),
                    ));
                }
            },
            StateEntry::Values(values) => values,
        };
        let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
        let names = model.state_names(&orders);
        for (name, value) in values {
            if !names.contains(name) || !value.is_finite() {
                return Err(Refusal::file(
                    path,
                    format!(
                        "initial.values.{name} = {value}; expected finite numbers for states of the model: {}",
                        names.join(", ")
                    ),
                ));
            }
        }
        Ok(Initial::Given(values.clone().into_iter().collect()))
    }

    /// The parameters that may be refitted.
    pub fn uncertain(&self, path: &Path, model: &Model) -> Result<Vec<Uncertain>, Refusal> {
        let mut list = Vec::new();
        for (name, entry) in &self.uncertain {
            let parameter = model.parameters.iter().find(|p| p.name == *name);
            let problem = match parameter.map(|parameter| &parameter.value) {
                None => "the model has no such parameter",
                Some(ParameterValue::Expression(_)) => {
                    "it is given by an expression; list what the expression is made of"
                }
                Some(ParameterValue::Number(_))
                    if !(entry.relative.is_finite() && entry.relative > 0.0) =>
                {
                    "expected { relative = r } with r greater than 0"
                }
                Some(ParameterValue::Number(_)) => {
                    list.push(Uncertain {
                        name: name.clone(),
                        relative: entry.relative,
                    });
                    continue;
                }
            };
            return Err(Refusal::file(path, format!("uncertain.{name}: {problem}")));
        }
        Ok(list)
    }
}

impl InputColumn {
    /// Only one kind of hold is known.
    pub fn check_hold(&self, path: &Path, place: &str) -> Result<(), Refusal> {
        match self.hold.as_deref() {
            None | Some("zero-order") => Ok(()),
            Some(other) => Err(Refusal::file(
                path,
                format!("{place}: hold = \"{other}\" is not known; expected \"zero-order\""),
            )),
        }
    }
}
