//! Bit-for-bit comparison of the compiled emitted source with the variant that it was emitted from.
//! The check is skipped without a compiler and fails if the source does not compile.

use super::super::certificate::{Check, SkipKind, Worst};
use super::super::compiler::{Compiler, Optimization};
use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;
use super::interface::{Calls, Precision, USUAL_FUNCTIONS, rust_harness};
use super::linked_program::{
    Emitted, EmittedFunction, count_differences, format_bits, run_linked, run_program,
};
use super::number_types::{self, BorrowedOutputs};
use eomgen_codegen::program::Program;
use std::fmt::Write as _;
use std::path::Path;

const NAME: &str = "emitted_rust";
const STATES: usize = 100;
const SEED: u64 = 0x0e31_77ed;

/// Compiles `emitted` and counts the numbers that are not bit-identical to `variant` and `functions`.
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    functions: Option<BorrowedOutputs<'_>>,
    (emitted, program): (&Emitted, Option<&Program>),
) -> Result<Vec<Check>, OracleError> {
    let samples = draw_samples(oracle)?;
    if samples.is_empty() {
        let reason = "no state in the model's domain was found";
        return Ok(skipped_checks(
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
            return Ok(skipped_checks(outputs, SkipKind::NotRun, &reason));
        }
    };
    let folder = folder.path();
    let calls = call_statements(&emitted.functions);
    let found = run_program(
        &compiler,
        folder,
        (emitted, &calls),
        Optimization::Full,
        &samples,
    );
    let worst = match found.and_then(|lines| compare(variant, &emitted.functions, &samples, &lines))
    {
        Ok(worst) => worst,
        Err(message) => Worst::from_deviation(f64::INFINITY, message),
    };
    let interface = program
        .filter(|_| emitted.outputs.is_some())
        .map(|program| {
            check_interface(&compiler, folder, emitted, &Calls::new(program, &samples))
                .unwrap_or_else(|message| Worst::from_deviation(f64::INFINITY, message))
        });
    let mut checks = vec![Check::from_deviation(NAME, worst.with(interface), 0.0)];
    let judged = (variant, functions);
    checks.extend(number_types::check(
        &compiler, folder, emitted, judged, &samples,
    ));
    Ok(checks)
}

/// Compares the interface of the emitted source with the program, in double and in single precision.
fn check_interface(
    compiler: &Compiler,
    folder: &Path,
    emitted: &Emitted,
    calls: &Calls<'_>,
) -> Result<Worst, String> {
    let harness = rust_harness(calls, &emitted.source);
    let harness = ("interface", &*harness);
    let found = run_linked(compiler, folder, harness, Optimization::Full, &calls.text())?;
    let mut lines = found.lines();
    let double = calls.compare(&mut lines, Precision::Double, (true, USUAL_FUNCTIONS));
    let single = calls.compare(&mut lines, Precision::Cast, (false, USUAL_FUNCTIONS));
    Ok(double.with(Some(single)))
}

/// Returns the checks of emitted source with `outputs` as skipped.
pub fn skipped_checks(outputs: Option<&[String]>, kind: SkipKind, reason: &str) -> Vec<Check> {
    let check = Check::with_skip(NAME.to_owned(), 0.0, kind, reason.to_owned());
    let mut checks = vec![check];
    checks.extend(outputs.map_or_else(Vec::new, |names| {
        number_types::skipped_checks(names, kind, reason)
    }));
    checks
}

fn call_statements(functions: &[EmittedFunction]) -> String {
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

/// Returns at most `STATES` states in the model's domain.
pub fn draw_samples(oracle: &Oracle) -> Result<Vec<Sample>, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let mut samples = Vec::with_capacity(STATES);
    while samples.len() < STATES
        && let Some(drawn) = sampler.draw_inside()?
    {
        samples.push(drawn.sample);
    }
    Ok(samples)
}

/// Counts the numbers in the printed `lines` of `functions` that differ from `variant`.
pub fn compare(
    variant: &mut dyn Variant,
    functions: &[EmittedFunction],
    samples: &[Sample],
    lines: &str,
) -> Result<Worst, String> {
    let mut lines = lines.lines();
    let mut compared = 0;
    let mut differing = Vec::new();
    for (count, sample) in samples.iter().enumerate() {
        for function in functions {
            let numbers = function.expected(variant, sample)?;
            let expected = format_bits(&numbers);
            let found = lines
                .next()
                .ok_or("the compiled model printed fewer lines than expected")?;
            compared += numbers.len();
            let wrong = count_differences(found, &expected);
            differing.extend(std::iter::repeat_n((function.name(), count), wrong));
        }
    }
    let detail = match differing.first() {
        None => format!("{compared} numbers at {} states", samples.len()),
        Some((name, count)) => format!("first in {name} at state {}", count + 1),
    };
    Ok(Worst::from_deviation(differing.len() as f64, detail))
}
