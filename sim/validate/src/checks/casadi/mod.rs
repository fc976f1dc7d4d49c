//! Comparison of the compiled functions for CasADi with the program that they were emitted from. The plain C functions
//! of the file are compared bit for bit, as in [`emitted_c`](super::emitted_c). The functions for CasADi are called
//! through CasADi's C interface, without CasADi. Names, sparsity patterns, work arrays and results are compared, with
//! all results requested at once and with single results.
//!
//! `interface` describes functions and sparsity patterns, and `expected` computes the results. `derivatives` compares
//! the derivatives that no other check covers with finite differences.

mod derivatives;
mod expected;
mod interface;

use std::path::Path;
use std::process::Command;

use eomgen_codegen::c::CASADI_OUTPUTS;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::program::{Output, Program};
use nalgebra::DMatrix;

use super::emitted::draw_samples;
use super::emitted_c::CCompiler;
use super::interface::{Calls, Precision, c_harness};
use super::linked_program::{format_bits, require_success};
use crate::certificate::{Check, SkipKind, Worst};
use crate::compiler::{run, write};
use crate::oracle::{Oracle, OracleError};
use derivatives::{DERIVATIVE_TOLERANCE, WeightedRates};
use expected::{Expected, expected_results};
use interface::{Function, Sparsity, functions};

const NAME: &str = "emitted_casadi";
/// Name of the check of the second derivatives.
const HESSIANS: &str = "hessians";
/// Name of the check of the time derivatives of the rates.
const BY_TIME: &str = "rates_by_time";

/// Emitted functions for CasADi with the command that compiles them.
#[derive(Clone, Debug)]
pub struct CasadiSource {
    /// Prefix of the names; the file is `NAME_casadi.c`.
    pub name: String,
    /// Text of the file.
    pub source: String,
    /// Requested outputs in addition to the default outputs of such a file.
    pub with: Vec<Output>,
    /// Compiler.
    pub compiler: CCompiler,
}

impl CasadiSource {
    /// Returns all outputs of the program.
    pub fn outputs(&self) -> Vec<Output> {
        [&CASADI_OUTPUTS[..], &self.with].concat()
    }
}

/// Compiles `emitted` and compares it with `program`.
pub fn check(
    oracle: &Oracle,
    (emitted, program): (&CasadiSource, &Result<Program, String>),
) -> Result<Vec<Check>, OracleError> {
    let failed = |message: String| {
        let place = format!("{}_casadi.c: {message}", emitted.name);
        Check::from_deviation(NAME, Worst::from_deviation(f64::INFINITY, place), 0.0)
    };
    let program = match program {
        Ok(program) => program,
        Err(reason) => return Ok(vec![failed(reason.clone())]),
    };
    let samples = draw_samples(oracle)?;
    if samples.is_empty() {
        return Ok(skipped(program, "no state in the model's domain was found"));
    }
    let folder = match tempfile::tempdir() {
        Ok(folder) => folder,
        Err(error) => {
            let reason = format!("cannot create a temporary folder: {error}");
            return Ok(skipped(program, &reason));
        }
    };
    let folder = folder.path();
    if let Err(reason) = emitted.compiler.probe(folder) {
        return Ok(skipped(program, &reason));
    }
    let calls = Calls::new(program, &samples);
    let [interface, called] = match run_harness(folder, emitted, &calls) {
        Ok(printed) => printed,
        Err(message) => return Ok(vec![failed(message)]),
    };
    let interface = calls.compare(
        &mut interface.lines(),
        Precision::Double,
        (true, usize::MAX),
    );
    let FunctionComparison {
        differing,
        hessians,
    } = compare_functions(&calls, &called);
    let mut checks = vec![Check::from_deviation(
        NAME,
        interface.with(Some(differing)),
        0.0,
    )];
    checks.extend(compare_derivatives(&calls, &hessians));
    Ok(checks)
}

/// Returns the checks of a file as not run.
fn skipped(program: &Program, reason: &str) -> Vec<Check> {
    let not_run = |name: &str, tolerance: f64| {
        Check::with_skip(
            name.to_owned(),
            tolerance,
            SkipKind::NotRun,
            reason.to_owned(),
        )
    };
    let mut checks = vec![not_run(NAME, 0.0), not_run(BY_TIME, DERIVATIVE_TOLERANCE)];
    if program.outputs.gradient_derivative.is_some() {
        checks.push(not_run(HESSIANS, DERIVATIVE_TOLERANCE));
    }
    checks
}

/// Returns the printed lines of the C interface, and the printed lines of the functions for CasADi. One program prints
/// both, because compilation takes most of the time.
fn run_harness(
    folder: &Path,
    emitted: &CasadiSource,
    calls: &Calls<'_>,
) -> Result<[String; 2], String> {
    let CasadiSource {
        name,
        source,
        compiler,
        ..
    } = emitted;
    write(&folder.join(format!("{name}.h")), source)?;
    let names = functions(calls.program).into_iter();
    let names = names.map(|function| format!("FUNCTION({})", function.name));
    let functions = include_str!("../harness/casadi.c")
        .replace("/*FUNCTIONS*/", &names.collect::<Vec<_>>().join(", "))
        .replace("NAME_", &format!("{name}_"));
    let interface = c_harness(calls, name);
    let interface = interface.replacen("int main(void)", "static int print_interface(void)", 1);
    write(&folder.join("harness.c"), &(interface + &functions))?;
    let arguments = ["-I.", "-o", "harness", "harness.c", "-lm"];
    let compiled = compiler.compile(folder, &arguments)?;
    require_success("the emitted source", compiled)?;
    let print = |what: &str| {
        let output = run(
            Command::new(folder.join("harness")).arg(what),
            &calls.text(),
        )?;
        require_success("the compiled model", output)
    };
    Ok([print("interface")?, print("functions")?])
}

/// Result of the comparison of the printed functions.
struct FunctionComparison {
    /// Number of differing results, with the first one.
    differing: Worst,
    /// Second derivatives of the weighted rates with respect to time, state, inputs and parameters, for each call.
    hessians: Vec<DMatrix<f64>>,
}

/// Differences of the printed lines.
struct Differences {
    count: usize,
    compared: usize,
    first: Option<String>,
}

impl Differences {
    fn include(&mut self, is_same: bool, place: impl FnOnce() -> String) {
        self.compared += 1;
        if !is_same {
            self.count += 1;
            self.first.get_or_insert_with(place);
        }
    }
}

fn compare_functions(calls: &Calls<'_>, printed: &str) -> FunctionComparison {
    let program = calls.program;
    let mut lines = printed.lines();
    let mut next = || lines.next().unwrap_or("nothing");
    let mut found = Differences {
        count: 0,
        compared: 0,
        first: None,
    };
    let functions = functions(program);
    let mut shapes: Vec<Vec<Option<Sparsity>>> = Vec::new();
    for function in &functions {
        let Function {
            name,
            given,
            results,
        } = function;
        let head = format!("{name} {} {}", given.len(), results.len());
        found.include(next() == head, || {
            format!("the number of arguments of {name}")
        });
        for (argument, length) in given {
            let expected = format!("{argument}{}", Sparsity::column(*length).text());
            found.include(next() == expected, || {
                format!("argument {argument} of {name}")
            });
        }
        let mut of_results = Vec::new();
        for (result, (rows, columns)) in results {
            let shape = Sparsity::parse(next(), result)
                .filter(|shape| (shape.rows, shape.columns) == (*rows, *columns));
            found.include(shape.is_some(), || format!("result {result} of {name}"));
            of_results.push(shape);
        }
        shapes.push(of_results);
    }
    let count = program.parameters.len();
    for (expected, place) in [
        ("default_parameters 0 1".to_owned(), "arguments"),
        (format!("p{}", Sparsity::column(count).text()), "result"),
        (format_bits(&program.default_parameters()), "values"),
    ] {
        found.include(next() == expected, || {
            format!("the {place} of default_parameters")
        });
    }
    let mut evaluator = Evaluator::new(program.clone());
    let length = 1 + program.states() + program.inputs.len() + count;
    let mut hessians = Vec::new();
    for (call, (parameters, sample)) in (1..).zip(calls.points()) {
        evaluator.prepare(parameters);
        let mut hessian = DMatrix::zeros(length, length);
        for (function, shapes) in functions.iter().zip(&shapes) {
            let expected = expected_results(function.name, &mut evaluator, sample);
            let all: Vec<&str> = shapes.iter().map(|_| next()).collect();
            for (place, shape) in shapes.iter().enumerate() {
                let (result, _) = &function.results[place];
                let alone = next();
                found.include(alone == all[place], || {
                    format!("result {result} of {} alone, call {call}", function.name)
                });
                let matrix = shape.as_ref().and_then(|shape| shape.dense(all[place]));
                let is_same = match (&expected[place], matrix) {
                    (Expected::Exact(expected), Some(matrix)) => is_equal(expected, &matrix),
                    (Expected::Second(row, column), Some(matrix)) => {
                        let first = (*row, *column);
                        hessian.view_mut(first, matrix.shape()).copy_from(&matrix);
                        true
                    }
                    (_, None) => false,
                };
                found.include(is_same, || {
                    format!("result {result} of {}, call {call}", function.name)
                });
            }
        }
        hessians.push(hessian);
    }
    let detail = match found.first {
        Some(first) => format!("first in {first}"),
        None => format!("{} results and names for CasADi", found.compared),
    };
    FunctionComparison {
        differing: Worst::from_deviation(found.count as f64, detail),
        hessians,
    }
}

/// Returns true for equal numbers; 0 equals -0, and all NaNs are equal.
fn is_equal(expected: &DMatrix<f64>, found: &DMatrix<f64>) -> bool {
    expected.shape() == found.shape()
        && expected
            .iter()
            .zip(found)
            .all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
}

fn compare_derivatives(calls: &Calls<'_>, hessians: &[DMatrix<f64>]) -> Vec<Check> {
    let program = calls.program;
    let has_hessians = program.outputs.gradient_derivative.is_some();
    let mut weighted = WeightedRates::new(program);
    let (mut by_time, mut second) = (Worst::default(), Worst::default());
    let states = super::interface::STATES;
    let points = (1..).zip(calls.points().zip(hessians)).take(states);
    let mut count = 0;
    for (call, ((parameters, sample), hessian)) in points {
        count += 1;
        let place = format!("call {call}");
        if let Some(deviation) = weighted.time_deviation(parameters, sample) {
            by_time.include(Worst::from_deviation(deviation, place.clone()));
        }
        if has_hessians && let Some(deviation) = weighted.deviation(parameters, sample, hessian) {
            second.include(Worst::from_deviation(deviation, place));
        }
    }
    let made = |name: &str, worst: Worst| match worst == Worst::default() {
        true => {
            let reason = "every sampled state is too close to a switching surface";
            Check::not_run(name, DERIVATIVE_TOLERANCE, reason)
        }
        false => Check::from_deviation(
            name,
            worst.with_count(count, "states"),
            DERIVATIVE_TOLERANCE,
        ),
    };
    let mut checks = vec![made(BY_TIME, by_time)];
    if has_hessians {
        checks.push(made(HESSIANS, second));
    }
    checks
}
