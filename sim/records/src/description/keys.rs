//! Tables and keys of a dataset file, for the reader, its documentation and its schema.

/// Tables with their keys, or with the keys of their entries; not `title` and `source`.
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

/// Keys of `[records]`.
pub const RECORDS: [&str; 2] = ["train", "test"];

/// Keys of a table in a list of `[records]`.
pub const STRETCH: [&str; 3] = ["file", "from", "to"];

/// Keys of `[format]`.
pub const FORMAT: [&str; 6] = ["separator", "decimal", "skip", "comment", "names", "units"];

/// Keys of `[time]`.
pub const TIME: [&str; 4] = ["column", "unit", "every", "filter"];

/// Keys of `[inputs.NAME]`.
pub const INPUT: [&str; 7] = ["column", "unit", "wrap", "hold", "gain", "bias", "delay"];

/// Keys of `[motion.NAME]`.
pub const MOTION: [&str; 4] = ["column", "unit", "wrap", "initial"];

/// Keys of `[channels.NAME]`.
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

/// Keys of the prior of a gain, a bias or a delay.
pub const PRIOR: [&str; 2] = ["mean", "sd"];

/// Keys of `[initial]`.
pub const INITIAL: [&str; 2] = ["state", "values"];

/// Keys of an entry of `[uncertain]`.
pub const UNCERTAIN: [&str; 1] = ["relative"];

/// Keys of `[windows]`.
pub const WINDOWS: [&str; 2] = ["length", "start"];

/// Keys of `[experiment]`.
pub const EXPERIMENT: [&str; 4] = ["duration", "sample", "inputs", "limits"];

/// Keys of `[experiment.inputs.NAME]`.
pub const EXPERIMENT_INPUT: [&str; 3] = ["range", "rate", "band"];

/// Returns all keys of the first level.
pub fn first_level_keys() -> Vec<&'static str> {
    let tables = TABLES.iter().map(|(name, _)| *name);
    TEXTS.into_iter().chain(tables).collect()
}
