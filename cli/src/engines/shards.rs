//! The command of a shard, with paths that are the same from everywhere.

use std::path::{Path, PathBuf};

use crate::arguments::Sweep;
use crate::error::{Error, Result};

/// Shards where nothing is said: enough that several machines end at about the same time.
const DEFAULT: u16 = 16;

/// A sweep as commands of this program.
pub struct Commands {
    /// How many shards there are.
    pub count: u16,
    /// The folder, absolute.
    pub folder: PathBuf,
    /// The same in scripts.
    pub out: String,
    /// This program.
    pub program: String,
    /// The arguments of every shard, but `--shard` and `--threads`.
    pub sweep: Vec<String>,
    /// How many threads a shard has, if that was said.
    pub threads: Option<u16>,
}

impl Commands {
    /// The commands of a sweep whose folder is there.
    pub fn of(options: &Sweep) -> Result<Self> {
        let folder = absolute(&options.out)?;
        let program = std::env::current_exe()
            .map_err(|error| Error::input(format!("this program has no path: {error}")))?;
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
            count: options.shards.unwrap_or(DEFAULT),
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

/// A path in a text that a shell or another machine reads.
fn text(path: &Path) -> Result<String> {
    let text = path
        .to_str()
        .filter(|text| !text.chars().any(char::is_control));
    text.map(str::to_owned).ok_or_else(|| {
        Error::input(format!(
            "--engine: the path {path:?} has characters that are not for the scripts of a cluster; rename it"
        ))
    })
}
