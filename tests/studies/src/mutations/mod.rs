//! Study `mutations`: each run seeds one fault at a random position of an emitted file. The checks of `eomgen verify`
//! must detect it without comparing the hash of the file. An undetected mutant must be proven equivalent by equal
//! tokens, or by equal machine code in both precisions.

mod fault;
mod subject;
mod tokens;

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::sample::Sample;
use fault::Fault;
use subject::{Subject, Verdict};

/// Runs the study and returns its summary.
///
/// # Errors
/// Returns a report of all mutants that are neither detected nor proven equivalent.
pub fn run(sample: &Sample) -> Result<String, String> {
    let subjects = subject::all()?;
    for subject in &subjects {
        if subject.judge(&subject.files)? != Verdict::Passed {
            return Err(format!("{subject}: the checks fail without a fault"));
        }
    }
    let results: Vec<Result<(Fault, String, Verdict), String>> = (0..sample.count)
        .into_par_iter()
        .map(|index| {
            seed_fault(
                &subjects,
                sample.seed.wrapping_mul(1_000_003) + index as u64,
            )
        })
        .collect();
    let mut counts: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    let mut failures = String::new();
    for result in results {
        let (fault, place, verdict) = result?;
        let row = counts.entry(fault.kind.name()).or_default();
        match verdict {
            Verdict::Noticed => row[0] += 1,
            Verdict::Equivalent => row[1] += 1,
            Verdict::Passed => {
                row[2] += 1;
                failures += &format!("not noticed: {place}: {fault}\n");
            }
        }
    }
    let mut summary = String::from("fault       noticed  equivalent  not noticed\n");
    let mut total = [0; 3];
    for (kind, row) in &counts {
        summary += &format!("{kind:10} {:8} {:11} {:12}\n", row[0], row[1], row[2]);
        for (sum, count) in total.iter_mut().zip(row) {
            *sum += count;
        }
    }
    let [noticed, equivalent, missed] = total;
    let score = 100.0 * noticed as f64 / (noticed + missed).max(1) as f64;
    summary += &format!(
        "mutations: {noticed} of {} faults of seed {} noticed ({score:.1} %), {equivalent} proven equivalent",
        noticed + missed,
        sample.seed
    );
    match failures.is_empty() {
        true => Ok(summary),
        false => Err(failures + &summary),
    }
}

/// Seeds one fault and runs the checks.
fn seed_fault(subjects: &[Subject], seed: u64) -> Result<(Fault, String, Verdict), String> {
    let random = &mut eomgen_validate::random::Random::new(seed);
    let subject = random.pick(subjects).ok_or("no subject")?;
    let mut files = subject.files.clone();
    let file = random.pick(&subject.choices()).copied().unwrap_or(0);
    let fault = fault::draw(&files[file].text, random).ok_or("no place for a fault")?;
    files[file]
        .text
        .replace_range(fault.range.clone(), &fault.after);
    let line = 1 + subject.files[file].text[..fault.range.start]
        .matches('\n')
        .count();
    let place = format!("seed {seed}, {subject}, {}:{line}", files[file].name);
    let verdict = match subject.judge(&files)? {
        Verdict::Passed if subject.is_equivalent(file, &files)? => Verdict::Equivalent,
        verdict => verdict,
    };
    Ok((fault, place, verdict))
}
