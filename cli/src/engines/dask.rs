//! Dask: the Python module `eomgen.dask` distributes the shards to the workers of a scheduler.

use std::process::{Command, Stdio};

use serde_json::json;

use super::Submission;
use super::shards::Commands;
use crate::arguments::Sweep;
use crate::error::{Error, Result};

/// Runs the sweep and waits until it ends.
pub fn run(options: &Sweep) -> Result<Submission> {
    let commands = Commands::new(options)?;
    let scheduler = options
        .scheduler
        .clone()
        .or_else(|| std::env::var("DASK_SCHEDULER_ADDRESS").ok());
    let scheduler = scheduler.ok_or_else(|| {
        Error::input(
            "--engine dask: --scheduler is missing: the address of the scheduler, such as tcp://node1:8786; or set \
             DASK_SCHEDULER_ADDRESS",
        )
    })?;
    let count = commands.count.to_string();
    let threads = commands.threads.unwrap_or(1).to_string();
    // Stdout is reserved for the output of this program, so messages of the module are printed to stderr.
    let status = Command::new("python3")
        .args([
            "-m",
            "eomgen.dask",
            "--scheduler",
            &scheduler,
            "--shards",
            &count,
        ])
        .args(["--", &commands.program])
        .args(&commands.sweep)
        .args(["--threads", &threads])
        .stdout(Stdio::null())
        .status()
        .map_err(|error| Error::input(format!("--engine dask: cannot run python3 ({error})")))?;
    if status.success() {
        return Ok(Submission {
            document: json!({ "engine": "dask", "shards": commands.count, "folder": options.out.display().to_string() }),
            text: format!("{}: {count} shards, merged\n", options.out.display()),
        });
    }
    Err(Error::input(
        "--engine dask: the sweep did not finish; the same command resumes it. It needs the Python \
         package (pip install './python[dask]') for the python3 that is first on the path",
    ))
}
