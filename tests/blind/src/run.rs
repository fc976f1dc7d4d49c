//! Runs the program on a case with a specification, a dataset and an order, without its label. A
//! case with a result is not run again.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::records::write_whole;

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// Regular end with an answer.
    Answered,
    /// Time limit exceeded.
    Timeout,
    /// Error or crash without an answer.
    Failed,
}

/// Result of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Number of the case.
    pub case: usize,
    /// End of the run.
    pub ending: Ending,
    /// Duration, s.
    pub seconds: f64,
    /// Last lines of stderr.
    pub said: String,
    /// Contents of `discovery.json`.
    pub discovery: Option<Value>,
}

/// Runs the program on a case of the folder `out` with the time limit `limit`.
///
/// # Errors
/// Returns an error if a file cannot be read or written, or the program cannot be started.
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
        // Cases run in parallel, one per core.
        .env("RAYON_NUM_THREADS", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(&said)?);
    if !order.is_empty() {
        command.args(["--order", &order]);
    }
    let begin = Instant::now();
    let ending = ending(&mut command, begin, limit)?;
    let seconds = begin.elapsed().as_secs_f64();
    let document = std::fs::read_to_string(found.join("discovery.json")).ok();
    let outcome = Outcome {
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

fn ending(command: &mut Command, begin: Instant, limit: Duration) -> std::io::Result<Ending> {
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
