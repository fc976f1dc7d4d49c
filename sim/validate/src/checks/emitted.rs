//! The emitted Rust, compiled by a compiler found on this machine, against the variant
//! it was emitted from: the same bits at every state. Without a compiler the check is
//! skipped and says so; source that does not compile fails it. What goes beyond rates of
//! plain numbers is in `kinds`.

use super::super::certificate::{Check, Worst};
use super::super::compiler::{self, Compiler};
use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;
use super::kinds::{self, OnRequest};
use std::fmt::Write as _;
use std::path::Path;

/// Name of the check.
const NAME: &str = "emitted_rust";
/// States compared.
const STATES: usize = 100;
/// The seed of the states.
const SEED: u64 = 0x0e31_77ed;

/// Source text of a variant: a crate on its own with `Parameters`, `Coefficients` and
/// `Inputs`, and functions of `(t, &state, &inputs, &coefficients)`.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// The text of the crate's root.
    pub source: String,
    /// The fields of its `Inputs`, in the order of the model.
    pub input_fields: Vec<String>,
    /// The functions to compare.
    pub functions: Vec<EmittedFunction>,
    /// What was requested besides, by the names of `--with`, of source that computes with
    /// any number of its trait `Scalar`; none of plain functions of `f64`.
    pub requests: Option<Vec<String>>,
}

/// A function of an emitted crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmittedFunction {
    /// `rates`, an array of the state's length.
    Rates,
    /// `observables`, an array.
    Observables,
    /// `energy`, a number.
    Energy,
    /// `power`, a number.
    Power,
    /// `guards`, an array.
    Guards,
    /// `mass_matrix`, an array of rows.
    MassMatrix,
}

impl EmittedFunction {
    fn name(self) -> &'static str {
        match self {
            Self::Rates => "rates",
            Self::Observables => "observables",
            Self::Energy => "energy",
            Self::Power => "power",
            Self::Guards => "guards",
            Self::MassMatrix => "mass_matrix",
        }
    }

    fn expected(self, variant: &mut dyn Variant, sample: &Sample) -> Result<Vec<f64>, String> {
        let Sample {
            time,
            state,
            inputs,
        } = sample;
        match self {
            Self::Rates => {
                let mut rates = vec![f64::NAN; state.len()];
                variant.rates(*time, state, inputs, &mut rates)?;
                Ok(rates)
            }
            Self::Observables => variant.observables(*time, state, inputs),
            Self::Energy => Ok(vec![variant.energy(*time, state, inputs)?]),
            Self::Power => Ok(vec![variant.power(*time, state, inputs)?]),
            Self::Guards => variant.guards(*time, state, inputs),
            Self::MassMatrix => {
                let size = state.len() / 2;
                let mut mass = vec![f64::NAN; size * size];
                variant.mass_matrix(*time, state, inputs, &mut mass)?;
                Ok(mass)
            }
        }
    }
}

/// Compiles `emitted` and compares it with `variant` and `requested` at random states. The
/// value of the first check is the number of numbers whose bits differ.
///
/// # Errors
/// [`OracleError`] as from [`Oracle::equations`].
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    requested: Option<OnRequest<'_>>,
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
        let reason = "no state of the model's domain was found";
        return Ok(skipped(emitted.requests.as_deref(), reason));
    }
    let found = tempfile::tempdir().map_err(|error| format!("no temporary folder: {error}"));
    let (folder, compiler) = match found.and_then(|folder| {
        let compiler = Compiler::find(folder.path())?;
        Ok((folder, compiler))
    }) {
        Ok(found) => found,
        Err(reason) => return Ok(skipped(emitted.requests.as_deref(), &reason)),
    };
    let folder = folder.path();
    let calls = calls(&emitted.functions);
    let found = run(&compiler, folder, (emitted, &calls), &samples);
    let worst = match found.and_then(|lines| compare(variant, emitted, &samples, &lines)) {
        Ok(worst) => worst,
        Err(message) => Worst::of(f64::INFINITY, message),
    };
    let mut checks = vec![Check::made(NAME, worst, 0.0)];
    let judged = (variant, requested);
    checks.extend(kinds::check(&compiler, folder, emitted, judged, &samples));
    Ok(checks)
}

/// The checks of emitted source with `requests`, none of which can be made.
pub fn skipped(requests: Option<&[String]>, reason: &str) -> Vec<Check> {
    let mut checks = vec![Check::skipped(NAME, 0.0, reason)];
    checks.extend(requests.map_or_else(Vec::new, |names| kinds::skipped(names, reason)));
    checks
}

/// Compiles the source to a library in `folder`.
fn build(compiler: &Compiler, folder: &Path, emitted: &Emitted) -> Result<(), String> {
    let library = folder.join("model.rs");
    compiler::write(&library, &emitted.source)?;
    let kind = ["--crate-type", "rlib", "--crate-name", "model"];
    let object = folder.join("libmodel.rlib");
    let output = compiler.compile(&library, &object, &kind)?;
    succeed("the emitted source", output).map(drop)
}

/// What the compiled source prints for `samples` by a program that makes these calls.
pub(super) fn run(
    compiler: &Compiler,
    folder: &Path,
    (emitted, calls): (&Emitted, &str),
    samples: &[Sample],
) -> Result<String, String> {
    build(compiler, folder, emitted)?;
    let harness = ("harness", &*harness_source(emitted, calls));
    run_linked(compiler, folder, harness, &table(samples))
}

/// What a program that calls the library in `folder` prints for `input`.
pub(super) fn run_linked(
    compiler: &Compiler,
    folder: &Path,
    (name, source): (&str, &str),
    input: &str,
) -> Result<String, String> {
    let (harness, program) = (folder.join(format!("{name}.rs")), folder.join(name));
    compiler::write(&harness, source)?;
    let link = format!("model={}", folder.join("libmodel.rlib").display());
    let linked = compiler.compile(&harness, &program, &["--extern", &link])?;
    succeed("the harness", linked)?;
    let output = compiler::execute(&program, input)?;
    succeed("the compiled model", output)
}

fn succeed(what: &str, output: compiler::Output) -> Result<String, String> {
    if output.success {
        Ok(output.stdout)
    } else {
        Err(format!(
            "{what} failed: {}",
            compiler::first_line(&output.stderr)
        ))
    }
}

/// One line of bits for each state: time, state, inputs.
fn table(samples: &[Sample]) -> String {
    let mut table = String::new();
    for sample in samples {
        let numbers = [&[sample.time][..], &sample.state, &sample.inputs].concat();
        table += &line(&numbers);
        table.push('\n');
    }
    table
}

pub(super) fn line(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers
        .iter()
        .map(|number| format!("{:016x}", number.to_bits()))
        .collect();
    words.join(" ")
}

/// A program that reads such lines and prints one line for each function and state.
fn harness_source(emitted: &Emitted, calls: &str) -> String {
    let mut inputs = String::new();
    for field in &emitted.input_fields {
        // Writing to a string cannot fail.
        let _ = writeln!(inputs, "        inputs.{field} = numbers.next().unwrap();");
    }
    HARNESS
        .replace("        // inputs\n", &inputs)
        .replace("        // calls\n", calls)
}

/// The text that calls these functions.
fn calls(functions: &[EmittedFunction]) -> String {
    let mut calls = String::new();
    for function in functions {
        let name = function.name();
        // Writing to a string cannot fail.
        let _ = writeln!(
            calls,
            "        model::{name}(t, &state, &inputs, &coefficients).print();"
        );
    }
    calls
}

const HARNESS: &str = r#"#![allow(unused_mut, unused_variables)]
trait Print {
    fn print(&self);
}

impl Print for f64 {
    fn print(&self) {
        println!("{:016x}", self.to_bits());
    }
}

impl<const N: usize> Print for [f64; N] {
    fn print(&self) {
        let words: Vec<String> = self.iter().map(|x| format!("{:016x}", x.to_bits())).collect();
        println!("{}", words.join(" "));
    }
}

impl<const N: usize, const M: usize> Print for [[f64; N]; M] {
    fn print(&self) {
        let words = self.as_flattened().iter().map(|x| format!("{:016x}", x.to_bits()));
        println!("{}", words.collect::<Vec<String>>().join(" "));
    }
}

fn main() {
    let coefficients = model::Coefficients::prepare(&model::Parameters::default());
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let mut numbers = line
            .split(' ')
            .map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap()));
        let t = numbers.next().unwrap();
        let mut state = [0.0; model::STATES];
        for entry in &mut state {
            *entry = numbers.next().unwrap();
        }
        let mut inputs = model::Inputs::default();
        // inputs
        // calls
    }
}
"#;

/// Counts the numbers of `lines` whose bits are not the variant's.
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
            let found = lines.next().ok_or("the compiled model stopped early")?;
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

/// How many numbers of a line, given by their bits, are not these; 0 is -0.
pub(super) fn differing_numbers(line: &str, expected: &[f64]) -> usize {
    let number = |word: &str| u64::from_str_radix(word, 16).ok().map(f64::from_bits);
    let mut words = line.split(' ').map(number);
    let differs = |expected: &&f64| words.next().flatten() != Some(**expected);
    expected.iter().filter(differs).count()
}

/// How many words of two lines differ; a missing word differs. A NaN is a NaN, whatever
/// its sign and payload, which no rule of arithmetic gives.
pub(super) fn differences(found: &str, expected: &str) -> usize {
    let (found, expected): (Vec<_>, Vec<_>) =
        (found.split(' ').collect(), expected.split(' ').collect());
    let same = found
        .iter()
        .zip(&expected)
        .filter(|(left, right)| left == right || (is_nan(left) && is_nan(right)))
        .count();
    found.len().max(expected.len()) - same
}

fn is_nan(word: &str) -> bool {
    u64::from_str_radix(word, 16).is_ok_and(|bits| f64::from_bits(bits).is_nan())
}
