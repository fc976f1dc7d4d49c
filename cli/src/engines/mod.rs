//! Sweeps on many machines: each shard is a run of this program with `--shard`, in one folder that all
//! machines see, and `merge` comes last.
//!
//! `shards` has the command of a shard; `slurm` and `dask` have it run.

mod dask;
mod shards;
mod slurm;

use serde_json::Value;

use crate::arguments::{Engine, Sweep};
use crate::error::{Error, Result};

/// What was done, for programs and for people.
pub struct Submitted {
    /// For programs.
    pub document: Value,
    /// For people.
    pub text: String,
}

/// Has a sweep, whose folder is there, run by an engine.
pub fn submit(engine: Engine, options: &Sweep) -> Result<Submitted> {
    match engine {
        Engine::Slurm => slurm::submit(options),
        Engine::Dask => dask::run(options),
    }
}

/// Refuses options that do not go together, before anything is written.
pub fn check(options: &Sweep) -> Result {
    let wrong = |message: &str| Err(Error::input(message.to_owned()));
    match options.engine {
        Some(_) if options.shard.is_some() => {
            wrong("--shard and --engine: an engine runs all shards; --shards says how many")
        }
        None if options.shards.is_some() => wrong(
            "--shards goes with --engine: without one, --shard I/N computes one of N shards here",
        ),
        Some(Engine::Dask) => Ok(()),
        _ if options.scheduler.is_some() => {
            wrong("--scheduler goes with --engine dask: the address of its scheduler")
        }
        _ => Ok(()),
    }
}
