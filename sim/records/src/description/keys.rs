//! The tables and keys of a dataset file: what the reader takes, and what its documentation and
//! its schema must list.

/// Tables with their keys; of those that hold entries by name, the keys of an entry. `title` and
/// `source` stand outside of all tables.
pub const TABLES: [(&str, &[&str]); 10] = [
    ("records", &RECORDS),
    ("format", &FORMAT),
    ("time", &TIME),
    ("inputs", &INPUT),
    ("motion", &MOTION),
    ("channels", &CHANNEL),
    ("initial", &INITIAL),
    ("uncertain", &UNCERTAIN),
    ("windows", &WINDOWS),
    ("experiment", &EXPERIMENT),
];

/// Keys outside of all tables.
pub const TEXTS: [&str; 2] = ["title", "source"];

/// `[records]`
pub const RECORDS: [&str; 2] = ["train", "test"];

/// An entry of a list of `[records]` that is a table.
pub const STRETCH: [&str; 3] = ["file", "from", "to"];

/// `[format]`
pub const FORMAT: [&str; 6] = ["separator", "decimal", "skip", "comment", "names", "units"];

/// `[time]`
pub const TIME: [&str; 4] = ["column", "unit", "every", "filter"];

/// `[inputs.NAME]`
pub const INPUT: [&str; 7] = ["column", "unit", "wrap", "hold", "gain", "bias", "delay"];

/// `[motion.NAME]`
pub const MOTION: [&str; 4] = ["column", "unit", "wrap", "initial"];

/// `[channels.NAME]`
pub const CHANNEL: [&str; 8] = [
    "column",
    "unit",
    "wrap",
    "noise",
    "observable",
    "gain",
    "bias",
    "delay",
];

/// What is known of a gain, a bias or a delay.
pub const PRIOR: [&str; 2] = ["mean", "sd"];

/// `[initial]`
pub const INITIAL: [&str; 2] = ["state", "values"];

/// `[uncertain]`
pub const UNCERTAIN: [&str; 1] = ["relative"];

/// `[windows]`
pub const WINDOWS: [&str; 2] = ["length", "start"];

/// `[experiment]`
pub const EXPERIMENT: [&str; 4] = ["duration", "sample", "inputs", "limits"];

/// `[experiment.inputs.NAME]`
pub const EXPERIMENT_INPUT: [&str; 3] = ["range", "rate", "band"];

/// All keys of the first level.
pub fn first_level() -> Vec<&'static str> {
    let tables = TABLES.iter().map(|(name, _)| *name);
    TEXTS.into_iter().chain(tables).collect()
}
