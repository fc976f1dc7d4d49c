//! Study `hosts`: the same motion in all hosts. Every shipped specification, every example and random machines are
//! simulated by each solver, by sweeps, in Python, in functional mock-up units and on a page. Each host must agree with
//! the reference motion, or reject the model with a reason.

mod cases;
mod command_line;
mod compare;
mod drawn;
mod guests;
mod host;
mod kind;
mod table;

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;

use crate::sample::Sample;
use cases::Case;
use compare::{Reference, Verdict, judge};
use host::Host;
use table::Table;

/// Number of random machines in the table of README.md.
const PRINTED_COUNT: usize = 24;

/// Runs the study with `count` random machines and returns its table. With the default seed and the number of machines
/// of README.md, the table must equal the table in README.md.
///
/// # Errors
/// Returns the table and a report of all hosts that differ from the reference.
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
    let table_text = table.to_string();
    if !table.is_complete() {
        return finish(failures, table_text + &table.notes());
    }
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let readme = std::fs::read_to_string(readme).map_err(|error| format!("README.md: {error}"))?;
    if sample.count == PRINTED_COUNT && sample.seed == 1 && !readme.contains(&table_text) {
        failures += "README.md has another table than this one\n";
    }
    finish(failures, table_text + &table.notes())
}

fn finish(failures: String, report: String) -> Result<String, String> {
    match failures.is_empty() {
        true => Ok(report),
        false => Err(failures + &report),
    }
}

fn judge_case(case: &Case, folder: &Path) -> Result<BTreeMap<Host, Verdict>, String> {
    let reference = Reference::new(case)?;
    let mut runs = command_line::runs(case, folder);
    runs.extend(guests::runs(case, folder)?);
    let mut worst = BTreeMap::new();
    for run in runs {
        let (host, verdict) = (run.host, judge(&reference, run));
        let known = worst.remove(&host);
        worst.insert(host, verdict.worse(known));
    }
    Ok(worst)
}
