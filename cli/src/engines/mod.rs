//! Sweeps on several machines with a shared folder. Each shard is a run of this program with `--shard`; `merge`
//! follows.

mod dask;
mod shards;
mod slurm;

pub use slurm::quote;

use serde_json::Value;

use crate::arguments::{Engine, Sweep};
use crate::error::{Error, Result};

/// Report on a submitted sweep, as JSON and as text.
pub struct Submission {
    pub document: Value,
    pub text: String,
}

/// Submits a sweep to an engine. Its output folder must exist.
pub fn submit(engine: Engine, options: &Sweep) -> Result<Submission> {
    match engine {
        Engine::Slurm => slurm::submit(options),
        Engine::Dask => dask::run(options),
    }
}

/// Rejects options that exclude each other, before any file is written.
pub fn check(options: &Sweep) -> Result {
    let wrong = |message: &str| Err(Error::input(message.to_owned()));
    match options.engine {
        Some(_) if options.shard.is_some() => wrong(
            "--shard and --engine exclude each other: an engine runs all shards; --shards sets their number",
        ),
        None if options.shards.is_some() => {
            wrong("--shards needs --engine; --shard I/N computes one of N shards on this machine")
        }
        Some(Engine::Dask) => Ok(()),
        _ if options.scheduler.is_some() => wrong("--scheduler needs --engine dask"),
        _ => Ok(()),
    }
}
