//! Bit-for-bit comparison of the compiled emitted source with the variant that it was emitted from.
//! The check is skipped without a compiler and fails if the source does not compile.

use super::super::certificate::{Check, SkipKind, Worst};
use super::super::compiler::{Compiler, Optimization};
use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;
use super::kinds::{self, BorrowedOutputs};
use super::linked::{Emitted, EmittedFunction, differences, line, run};
use std::fmt::Write as _;

const NAME: &str = "emitted_rust";
const STATES: usize = 100;
const SEED: u64 = 0x0e31_77ed;

/// Compiles `emitted` and counts the numbers that differ from `variant` and `functions` by a bit.
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    functions: Option<BorrowedOutputs<'_>>,
    emitted: &Emitted,
) -> Result<Vec<Check>, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let mut samples = Vec::with_capacity(STATES);
    while samples.len() < STATES
        && let Some(drawn) = sampler.draw_inside()?
    {
        samples.push(drawn.sample);
    }
    if samples.is_empty() {
        let reason = "no state in the model's domain was found";
        return Ok(skipped(
            emitted.outputs.as_deref(),
            SkipKind::NotRun,
            reason,
        ));
    }
    let found =
        tempfile::tempdir().map_err(|error| format!("cannot create a temporary folder: {error}"));
    let (folder, compiler) = match found.and_then(|folder| {
        let compiler = Compiler::find(folder.path())?;
        Ok((folder, compiler))
    }) {
        Ok(found) => found,
        Err(reason) => {
            let outputs = emitted.outputs.as_deref();
            return Ok(skipped(outputs, SkipKind::NotRun, &reason));
        }
    };
    let folder = folder.path();
    let calls = calls(&emitted.functions);
    let found = run(
        &compiler,
        folder,
        (emitted, &calls),
        Optimization::Full,
        &samples,
    );
    let worst = match found.and_then(|lines| compare(variant, emitted, &samples, &lines)) {
        Ok(worst) => worst,
        Err(message) => Worst::of(f64::INFINITY, message),
    };
    let mut checks = vec![Check::made(NAME, worst, 0.0)];
    let judged = (variant, functions);
    checks.extend(kinds::check(&compiler, folder, emitted, judged, &samples));
    Ok(checks)
}

/// Returns the checks of emitted source with `outputs` as skipped.
pub fn skipped(outputs: Option<&[String]>, kind: SkipKind, reason: &str) -> Vec<Check> {
    let check = Check::skipped(NAME.to_owned(), 0.0, kind, reason.to_owned());
    let mut checks = vec![check];
    checks.extend(outputs.map_or_else(Vec::new, |names| kinds::skipped(names, kind, reason)));
    checks
}

fn calls(functions: &[EmittedFunction]) -> String {
    let mut calls = String::new();
    for function in functions {
        let name = function.name();
        let _ = writeln!(
            calls,
            "        model::{name}(t, &state, &inputs, &coefficients).print();"
        );
    }
    calls
}

fn compare(
    variant: &mut dyn Variant,
    emitted: &Emitted,
    samples: &[Sample],
    lines: &str,
) -> Result<Worst, String> {
    let mut lines = lines.lines();
    let mut compared = 0;
    let mut differing = Vec::new();
    for (count, sample) in samples.iter().enumerate() {
        for function in &emitted.functions {
            let numbers = function.expected(variant, sample)?;
            let expected = line(&numbers);
            let found = lines
                .next()
                .ok_or("the compiled model printed fewer lines than expected")?;
            compared += numbers.len();
            let wrong = differences(found, &expected);
            differing.extend(std::iter::repeat_n((function.name(), count), wrong));
        }
    }
    let detail = match differing.first() {
        None => format!("{compared} numbers at {} states", samples.len()),
        Some((name, count)) => format!("first in {name} at state {}", count + 1),
    };
    Ok(Worst::of(differing.len() as f64, detail))
}
