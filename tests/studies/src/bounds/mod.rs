//! Study `bounds`: comparison of the rounding errors of all shipped machines at random points with their bounds, for
//! the ranges of the certificate's random states and for single states.

mod machine;

use std::fmt::Write;

use rayon::prelude::*;

use crate::sample::Sample;
use machine::{KindSummary, judge, machines};

/// Runs the study with `count` points for each machine and precision, and returns its table.
///
/// # Errors
/// Returns the table and a report of all errors above their bounds.
pub fn run(sample: &Sample) -> Result<String, String> {
    let machines = machines()?;
    let judged: Vec<Result<Vec<KindSummary>, String>> = machines
        .par_iter()
        .map(|path| judge(path, sample))
        .collect();
    let mut table = "machine | precision | quantity | bounded | bound / worst error: least, median, largest | with the largest: bound, worst error\n--- | --- | --- | --- | --- | ---\n".to_owned();
    let mut failures = String::new();
    for outcome in judged {
        match outcome {
            Err(problem) => failures += &format!("{problem}\n"),
            Ok(rows) => {
                for row in rows {
                    let _ = writeln!(table, "{row}");
                    failures += &row.failures;
                }
            }
        }
    }
    match failures.is_empty() {
        true => Ok(table),
        false => Err(failures + &table),
    }
}
