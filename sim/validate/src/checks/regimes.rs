//! Comparison of the compiled kernels of regimes with the variant's rates in every regime.

use super::super::certificate::{Check, Worst};
use super::super::compiler::{Compiler, Optimization};
use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::Sample;
use super::super::variant::Variant;
use super::linked_program::{Emitted, count_differing_numbers, run_program};
use super::regime_interiors::interior_samples;
use std::collections::BTreeSet;
use std::fmt::Write as _;

const NAME: &str = "regime_kernels";
const STATES_PER_REGIME: usize = 10;
const MAX_KERNELS: usize = 100;
/// Maximum number of switching surfaces that a regime number can encode.
const MAX_SURFACES: usize = u32::BITS as usize;
const SEED: u64 = 0x2e61_3e5a;

/// Compiles the regime kernels in `emitted` and counts the numbers that differ from `variant`.
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    emitted: &Emitted,
) -> Result<Check, OracleError> {
    let samples = interior_samples(oracle, variant, STATES_PER_REGIME, SEED)?;
    let folder = match tempfile::tempdir() {
        Ok(folder) => folder,
        Err(error) => {
            let reason = format!("cannot create a temporary folder: {error}");
            return Ok(Check::not_run(NAME, 0.0, reason));
        }
    };
    let compiler = match Compiler::find(folder.path()) {
        Ok(compiler) => compiler,
        Err(reason) => return Ok(Check::not_run(NAME, 0.0, reason)),
    };
    let found = samples.and_then(|samples| {
        let (samples, numbers) = samples_in_kernels(variant, samples)?;
        let calls = kernel_calls(&numbers);
        let lines = run_program(
            &compiler,
            folder.path(),
            (emitted, &calls),
            Optimization::None,
            &samples,
        )?;
        compare(variant, &samples, &lines, numbers.len())
    });
    let worst = found.unwrap_or_else(|message| Worst::from_deviation(f64::INFINITY, message));
    Ok(Check::from_deviation(NAME, worst, 0.0))
}

/// Returns the skipped check (not applicable) of a variant without kernels or regimes.
pub fn skipped_check(reason: impl Into<String>) -> Check {
    Check::not_applicable(NAME, 0.0, reason)
}

fn samples_in_kernels(
    variant: &mut dyn Variant,
    samples: Vec<Sample>,
) -> Result<(Vec<Sample>, BTreeSet<u32>), String> {
    let mut numbers = BTreeSet::new();
    let mut kept = Vec::new();
    for sample in samples {
        let guards = variant.guards(sample.time, &sample.state, &sample.inputs)?;
        let bits = guards.iter().take(MAX_SURFACES).enumerate();
        let number = bits.fold(0, |bits, (place, guard)| {
            bits | u32::from(*guard > 0.0) << place
        });
        if numbers.len() < MAX_KERNELS || numbers.contains(&number) {
            numbers.insert(number);
            kept.push(sample);
        }
    }
    Ok((kept, numbers))
}

fn kernel_calls(numbers: &BTreeSet<u32>) -> String {
    let arguments = "(t, &state, &inputs, &coefficients";
    let mut text = "        let mut rates = [f64::NAN; model::STATES];\n".to_owned();
    let _ = writeln!(text, "        match model::regime{arguments}) {{");
    for number in numbers {
        let kernel = format!("model::rates_in_regime_into::<{number}, _>");
        let _ = writeln!(
            text,
            "            {number} => {kernel}{arguments}, &mut rates),"
        );
    }
    text + "            _ => {}\n        }\n        rates.print();\n"
}

fn compare(
    variant: &mut dyn Variant,
    samples: &[Sample],
    lines: &str,
    regimes: usize,
) -> Result<Worst, String> {
    let mut lines = lines.lines();
    let (mut differing, mut first) = (0, None);
    for (count, sample) in samples.iter().enumerate() {
        let mut expected = vec![f64::NAN; sample.state.len()];
        variant.rates(sample.time, &sample.state, &sample.inputs, &mut expected)?;
        let found = lines
            .next()
            .ok_or("the compiled kernels printed fewer lines than expected")?;
        let wrong = count_differing_numbers(found, &expected);
        if wrong > 0 && first.is_none() {
            first = Some(format!("first at state {}", count + 1));
        }
        differing += wrong;
    }
    let all = format!("{regimes} regimes, {} states", samples.len());
    Ok(Worst::from_deviation(
        differing as f64,
        first.map_or(all.clone(), |first| format!("{all}, {first}")),
    ))
}
