//! Study `grazing`: random passive oscillators whose turning point grazes a stop.
//!
//! Each machine runs with `rk`, `radau` and, if it is piecewise linear, `exact`, at the default tolerance and at a
//! tighter one. The energy must not increase. The difference of each run from a reference must not exceed the
//! difference of motions that start a few tolerances apart.

mod judge;
mod machine;
mod turning_point;

use rayon::prelude::*;

use crate::sample::Sample;
use judge::{Verdict, judge};
use machine::Machine;

/// Runs the study and returns its summary.
///
/// # Errors
///
/// Returns a report of all failed runs.
pub fn run(sample: &Sample) -> Result<String, String> {
    let verdicts: Vec<Verdict> = (0..sample.count)
        .into_par_iter()
        .map(|place| {
            let machine = Machine::draw(sample.seed, place);
            judge(&machine)
                .unwrap_or_else(|problem| Verdict::failed(format!("{machine}: {problem}")))
        })
        .collect();
    let failures: Vec<&str> = verdicts
        .iter()
        .flat_map(|verdict| verdict.failures.iter().map(String::as_str))
        .collect();
    let failed = verdicts
        .iter()
        .filter(|verdict| !verdict.failures.is_empty())
        .count();
    let summary = summarise(sample, &verdicts, failed);
    if failures.is_empty() {
        return Ok(summary);
    }
    Err(format!("{}\n{summary}", failures.join("\n")))
}

fn summarise(sample: &Sample, verdicts: &[Verdict], failed: usize) -> String {
    let largest = |of: fn(&Verdict) -> f64| verdicts.iter().map(of).fold(0.0, f64::max);
    let runs: usize = verdicts.iter().map(|verdict| verdict.runs).sum();
    let exact = verdicts.iter().filter(|verdict| verdict.is_exact).count();
    let switches: usize = verdicts.iter().map(|verdict| verdict.switches).sum();
    format!(
        "grazing: {} machines of seed {}, {failed} failed; {runs} runs, {exact} machines by exact, \
         {switches} switches in the references; largest rise of the energy {:.1e} of what is \
         allowed, largest difference {:.1e} of what is allowed",
        sample.count,
        sample.seed,
        largest(|verdict| verdict.rise),
        largest(|verdict| verdict.difference),
    )
}
