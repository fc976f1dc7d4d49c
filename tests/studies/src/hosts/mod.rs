//! Study `hosts`: one motion in all hosts. Every shipped specification, every example and random
//! machines are simulated by each solver, by sweeps, in Python, in functional mock-up units and on
//! a page. Each host has the motion of the reference, or rejects the model with a reason.

mod cases;
mod command_line;
mod compare;
mod drawn;
mod guests;
mod table;

use rayon::prelude::*;

use crate::sample::Sample;
use cases::Case;
use compare::{Reference, judge};
use table::Table;

/// Motion of one machine in one host.
pub(crate) struct HostRun {
    pub host: Host,
    pub answer: Answer,
}

/// Answer of a host to one machine.
pub(crate) enum Answer {
    /// States at the sample times, SI.
    Motion(Vec<Vec<f64>>),
    /// The host rejects the model or stops, with its message.
    Rejected(String),
    /// The host is not installed.
    Missing(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Host {
    Rk,
    Radau,
    Adams,
    Exact,
    Sweep,
    Python,
    CoSimulation2,
    CoSimulation3,
    Exchange2,
    Exchange3,
    Page,
}

impl Host {
    pub const ALL: [Self; 11] = [
        Self::Rk,
        Self::Radau,
        Self::Adams,
        Self::Exact,
        Self::Sweep,
        Self::Python,
        Self::CoSimulation2,
        Self::CoSimulation3,
        Self::Exchange2,
        Self::Exchange3,
        Self::Page,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Rk => "rk",
            Self::Radau => "radau",
            Self::Adams => "adams",
            Self::Exact => "exact",
            Self::Sweep => "sweep",
            Self::Python => "Python",
            Self::CoSimulation2 => "FMI 2 co-simulation",
            Self::CoSimulation3 => "FMI 3 co-simulation",
            Self::Exchange2 => "FMI 2 model exchange",
            Self::Exchange3 => "FMI 3 model exchange",
            Self::Page => "page",
        }
    }
}

/// Runs the study with `count` random machines and returns its table.
///
/// # Errors
/// Returns the table and a report of all hosts with another motion.
pub fn run(sample: &Sample) -> Result<String, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    guests::assemble_package(folder.path())?;
    let cases = cases::all(sample, folder.path())?;
    let judged: Vec<_> = cases
        .par_iter()
        .map(|case| judge_case(case, folder.path()))
        .collect();
    let mut table = Table::default();
    let mut failures = String::new();
    for (case, outcome) in cases.iter().zip(judged) {
        match outcome {
            Err(problem) => failures += &format!("{}: {problem}\n", case.name),
            Ok(verdicts) => {
                for (host, verdict) in verdicts {
                    if let Some(problem) = table.add(case, host, verdict) {
                        failures += &format!("{} by {}: {problem}\n", case.name, host.name());
                    }
                }
            }
        }
    }
    let report = format!("{} machines\n{table}", cases.len());
    match failures.is_empty() {
        true => Ok(report),
        false => Err(failures + &report),
    }
}

fn judge_case(
    case: &Case,
    folder: &std::path::Path,
) -> Result<Vec<(Host, compare::Verdict)>, String> {
    let reference = Reference::new(case)?;
    let mut runs = command_line::runs(case, folder);
    runs.extend(guests::runs(case, folder)?);
    Ok(runs
        .into_iter()
        .map(|run| (run.host, judge(&reference, run)))
        .collect())
}
