//! Runs the program on the specification and dataset of a case, without its label. A case with an
//! existing result is not run again.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::records::write_whole;

/// Way in which a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The program returned an answer.
    Answered,
    /// The time limit was exceeded.
    Timeout,
    /// The program ended with an error or crash.
    Failed,
}

/// Result of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Number of the case.
    pub case: usize,
    /// Way in which the run ended.
    pub ending: Ending,
    /// Duration, s.
    pub seconds: f64,
    /// Last lines of stderr.
    pub said: String,
    /// Contents of `discovery.json`.
    pub discovery: Option<Value>,
}

/// Runs the program on a case in the folder `out` with the time limit `limit`.
///
/// # Errors
///
/// A file that cannot be read or written, or a program that cannot be started.
pub fn run(program: &Path, out: &Path, case: usize, limit: Duration) -> std::io::Result<()> {
    let place = |folder: &str| out.join(folder).join(format!("{case:03}"));
    let result = place("results").with_extension("json");
    if result.exists() {
        return Ok(());
    }
    let (given, found) = (place("cases"), place("found"));
    std::fs::create_dir_all(&found)?;
    let order = std::fs::read_to_string(given.join("order.txt"))?;
    let said = found.join("said.txt");
    let mut command = Command::new(program);
    command
        .arg("discover")
        .arg(given.join("spec.toml"))
        .arg(given.join("dataset.toml"))
        .arg("--out")
        .arg(&found)
        // Each run uses one thread, because cases run in parallel, one per core.
        .env("RAYON_NUM_THREADS", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(&said)?);
    if !order.is_empty() {
        command.args(["--order", &order]);
    }
    let begin = Instant::now();
    let ending = wait_for_end(&mut command, begin, limit)?;
    let seconds = begin.elapsed().as_secs_f64();
    let document = std::fs::read_to_string(found.join("discovery.json")).ok();
    let outcome = RunResult {
        case,
        ending,
        seconds,
        said: last_lines(&std::fs::read_to_string(&said).unwrap_or_default()),
        discovery: document
            .filter(|_| ending == Ending::Answered)
            .and_then(|text| serde_json::from_str(&text).ok()),
    };
    write_whole(&result, &serde_json::to_string_pretty(&outcome)?)
}

fn wait_for_end(command: &mut Command, begin: Instant, limit: Duration) -> std::io::Result<Ending> {
    let mut child = command.spawn()?;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(match status.success() {
                true => Ending::Answered,
                false => Ending::Failed,
            });
        }
        if begin.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(Ending::Timeout);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn last_lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(5)..].join("\n")
}
