//! Compiles emitted source to a library and links it with a harness that prints results as bits.

use std::fmt::Write as _;
use std::path::Path;

use crate::compiler::{self, Compiler, Optimization};
use crate::sampler::Sample;
use crate::variant::Variant;

/// Source of a variant: a crate with `Parameters`, `Coefficients`, `Inputs` and functions.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// Text of the crate root.
    pub source: String,
    /// Field names of `Inputs`, in the order of the model.
    pub input_fields: Vec<String>,
    /// Functions to compare.
    pub functions: Vec<EmittedFunction>,
    /// Requested outputs, by their names in `--with`; `None` if the functions use only `f64`.
    pub outputs: Option<Vec<String>>,
}

/// Function of an emitted crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmittedFunction {
    /// `rates`, an array with the state's length.
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
    /// Returns the name of the function in the emitted source.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rates => "rates",
            Self::Observables => "observables",
            Self::Energy => "energy",
            Self::Power => "power",
            Self::Guards => "guards",
            Self::MassMatrix => "mass_matrix",
        }
    }

    /// Returns the result of the variant for this function at a state.
    pub fn expected(self, variant: &mut dyn Variant, sample: &Sample) -> Result<Vec<f64>, String> {
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
                let size = variant.coordinate_names().len();
                let mut mass = vec![f64::NAN; size * size];
                variant.mass_matrix(*time, state, inputs, &mut mass)?;
                Ok(mass)
            }
        }
    }
}

fn build_program(
    compiler: &Compiler,
    folder: &Path,
    emitted: &Emitted,
    optimization: Optimization,
) -> Result<(), String> {
    let library = folder.join("model.rs");
    compiler::write(&library, &emitted.source)?;
    let kind = ["--crate-type", "rlib", "--crate-name", "model"];
    let object = folder.join("libmodel.rlib");
    let output = compiler.compile(&library, &object, optimization, &kind)?;
    require_success("the emitted source", output).map(drop)
}

/// Compiles the source with a program that executes `calls` at every sample, and returns the printed lines.
pub fn run_program(
    compiler: &Compiler,
    folder: &Path,
    (emitted, calls): (&Emitted, &str),
    optimization: Optimization,
    samples: &[Sample],
) -> Result<String, String> {
    build_program(compiler, folder, emitted, optimization)?;
    let harness = ("harness", &*harness_source(emitted, calls));
    run_linked(
        compiler,
        folder,
        harness,
        optimization,
        &format_samples(samples),
    )
}

/// Compiles a program that calls the library in `folder` and returns its output for `input`.
pub fn run_linked(
    compiler: &Compiler,
    folder: &Path,
    (name, source): (&str, &str),
    optimization: Optimization,
    input: &str,
) -> Result<String, String> {
    let (harness, program) = (folder.join(format!("{name}.rs")), folder.join(name));
    compiler::write(&harness, source)?;
    let link = format!("model={}", folder.join("libmodel.rlib").display());
    let linked = compiler.compile(&harness, &program, optimization, &["--extern", &link])?;
    require_success("the harness", linked)?;
    let output = compiler::execute(&program, input)?;
    require_success("the compiled model", output)
}

/// Returns the output of a successful process, or the first line of its error message.
pub fn require_success(what: &str, output: compiler::Output) -> Result<String, String> {
    if output.success {
        Ok(output.stdout)
    } else {
        Err(format!(
            "{what} failed: {}",
            compiler::first_line(&output.stderr)
        ))
    }
}

/// Returns times, states and inputs as bits, one sample per line.
pub fn format_samples(samples: &[Sample]) -> String {
    let mut table = String::new();
    for sample in samples {
        let numbers = [&[sample.time][..], &sample.state, &sample.inputs].concat();
        table += &format_bits(&numbers);
        table.push('\n');
    }
    table
}

/// Returns numbers as hexadecimal bits, separated by spaces.
pub fn format_bits(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers
        .iter()
        .map(|number| format!("{:016x}", number.to_bits()))
        .collect();
    words.join(" ")
}

fn harness_source(emitted: &Emitted, calls: &str) -> String {
    let mut inputs = String::new();
    for field in &emitted.input_fields {
        let _ = writeln!(inputs, "        inputs.{field} = numbers.next().unwrap();");
    }
    HARNESS
        .replace("        // inputs\n", &inputs)
        .replace("        // calls\n", calls)
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

/// Counts the numbers of a line of bits that differ from `expected`; 0 equals -0.
pub fn count_differing_numbers(line: &str, expected: &[f64]) -> usize {
    let number = |word: &str| u64::from_str_radix(word, 16).ok().map(f64::from_bits);
    let mut words = line.split(' ').map(number);
    let differs = |expected: &&f64| words.next().flatten() != Some(**expected);
    expected.iter().filter(differs).count()
}

/// Counts the words that differ between two lines, including missing words. All NaNs are equal.
pub fn count_differences(found: &str, expected: &str) -> usize {
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
