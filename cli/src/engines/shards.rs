//! Command line of a shard, with absolute paths.

use std::path::{Path, PathBuf};

use crate::arguments::Sweep;
use crate::error::{Error, Result};

/// Default number of shards, large enough that several machines finish at about the same time.
const DEFAULT_SHARDS: u16 = 16;

/// Data for the command lines that run the shards of a sweep.
pub struct Commands {
    /// Number of shards.
    pub count: u16,
    /// Absolute output folder.
    pub folder: PathBuf,
    /// Output folder as text.
    pub out: String,
    /// Path of this program.
    pub program: String,
    /// Arguments of every shard, except `--shard` and `--threads`.
    pub sweep: Vec<String>,
    /// Requested number of threads per shard.
    pub threads: Option<u16>,
}

impl Commands {
    /// Creates the commands of a sweep. Its output folder must exist.
    pub fn new(options: &Sweep) -> Result<Self> {
        let folder = absolute(&options.out)?;
        let program = std::env::current_exe().map_err(|error| {
            Error::input(format!("cannot find the path of this program: {error}"))
        })?;
        let mut sweep = vec!["sweep".to_owned(), text(&absolute(&options.model.spec)?)?];
        let mut add =
            |option: &str, value: &str| sweep.extend([option.to_owned(), value.to_owned()]);
        for vary in &options.vary {
            add("--vary", vary);
        }
        if let Some(samples) = options.samples {
            add("--samples", &samples.to_string());
            add("--seed", &options.seed.to_string());
        }
        for set in &options.parameters.set {
            add("--set", set);
        }
        for state in &options.initial.state {
            add("--state", state);
        }
        for input in &options.inputs.input {
            add("--input", input);
        }
        if let Some(record) = &options.inputs.record {
            add("--record", &text(&absolute(record)?)?);
            add("--record-name", &options.inputs.record_name);
        }
        if let Some(order) = options.model.order.text() {
            add("--order", order);
        }
        add("--measure", &options.measure.join(","));
        add("--frequency", &options.frequency);
        add("--transient", &options.transient.to_string());
        add("--periods", &options.periods.to_string());
        if let Some(until) = options.until {
            add("--until", &format!("{until:?}"));
        }
        if let Some(section) = &options.section {
            add("--section", section);
        }
        let out = text(&folder)?;
        add("--out", &out);
        Ok(Self {
            count: options.shards.unwrap_or(DEFAULT_SHARDS),
            folder,
            out,
            program: text(&program)?,
            sweep,
            threads: options.threads,
        })
    }
}

fn absolute(path: &Path) -> Result<PathBuf> {
    path.canonicalize()
        .map_err(|error| Error::file("find", path, &error))
}

/// Returns a path as text that is safe in scripts.
fn text(path: &Path) -> Result<String> {
    let text = path
        .to_str()
        .filter(|text| !text.chars().any(char::is_control));
    text.map(str::to_owned).ok_or_else(|| {
        Error::input(format!(
            "--engine: the path {path:?} has characters that scripts do not support; rename it"
        ))
    })
}
