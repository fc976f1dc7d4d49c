//! Test of piecewise functions and the reciprocal of a pivot at zeros, infinities, NaN and thresholds. The interpreter,
//! machine code, WebAssembly, C and Rust must have equal results in both precisions.

use std::path::Path;
use std::process::{Command, Stdio};

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::program::{Output, Program};
use eomgen_codegen::rust::Packaging;
use eomgen_codegen::variant::Variant;
use eomgen_codegen::{c, rust, wasm};
use eomgen_model_spec::source::Source;

use super::page::bits::{Case, node, run_module};

#[path = "../../../codegen/elementary/tests/elementary/piecewise_cases.rs"]
mod piecewise_cases;

use piecewise_cases::{DEFLECTION_CASES, ONE_NUMBER_CASES};

/// The mass is the coordinate. Therefore the acceleration is the reciprocal of a pivot that equals the coordinate.
const MODEL: &str = r#"
[model]
name = "edges"
[parameters]
m = { value = 1, unit = "kg m^2" }
f = { value = 1, unit = "N m" }
[coordinates]
x = { unit = "1", initial = 1 }
[inputs]
b = { unit = "1" }
[kinetic]
mass = "1/2*m*x*dot(x)^2"
[forces]
push = { on = "x", value = "f" }
[observables]
dead = "deadzone(x, b)"
touch = "contact(x, b)"
up = "above(x)"
"#;

const C_DRIVER: &str = r#"
#include "edges.h"
#include <stdio.h>

int main(void) {
    edges_parameters parameters;
    edges_coefficients coefficients;
    double x, b;
    edges_default_parameters(&parameters);
    edges_prepare(&parameters, &coefficients);
    while (scanf("%lf %lf", &x, &b) == 2) {
        const edges_real state[2] = {(edges_real)x, 0}, signals[1] = {(edges_real)b};
        edges_real rates[2], values[edges_OBSERVABLES];
        edges_inputs inputs;
        edges_inputs_from_array(signals, &inputs);
        edges_rates(0, state, &inputs, &coefficients, rates);
        edges_observables(0, state, &inputs, &coefficients, values);
        printf("%.17g %.17g %.17g %.17g\n", (double)values[0], (double)values[1], (double)values[2],
               (double)rates[1]);
    }
    return 0;
}
"#;

const RUST_DRIVER: &str = r#"
#[path = "edges.rs"]
mod edges;
use edges::*;

fn main() {
    let coefficients = Coefficients::prepare(&Parameters::default().cast::<REAL>());
    for line in std::io::stdin().lines() {
        let numbers: Vec<f64> = line.unwrap().split(' ').map(|word| word.parse().unwrap()).collect();
        let state = [numbers[0] as REAL, 0.0];
        let inputs = Inputs::from([numbers[1] as REAL]);
        let values = observables(0.0, &state, &inputs, &coefficients);
        let rates = rates(0.0, &state, &inputs, &coefficients);
        let [dead, touch, up] = [values[0], values[1], values[2]].map(f64::from);
        println!("{dead:?} {touch:?} {up:?} {:?}", f64::from(rates[1]));
    }
}
"#;

/// Returns `[x, b]` of all cases.
fn arguments() -> Vec<[f64; 2]> {
    let of_one = ONE_NUMBER_CASES.map(|[p, ..]| [p, 1.0]);
    [&DEFLECTION_CASES.map(|[p, b, ..]| [p, b])[..], &of_one].concat()
}

fn program() -> Program {
    let model = match eomgen_model_spec::check(Source::new("edges.toml", MODEL)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{found}"),
    };
    let variant = Variant::derive_with(&model, &[], &[] as &[Output]);
    variant.expect("the model can be derived").program
}

/// Compares deadzone, contact, above and the reciprocal with the tables of expected values, for all cases.
fn assert_values(backend: &str, found: &[[f64; 4]]) {
    assert_eq!(found.len(), arguments().len(), "{backend}");
    let check = |name: &str, at: &[f64], found: f64, expected: f64| {
        let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
        assert!(
            same,
            "{backend}: {name}{at:?} is {found:?}, not {expected:?}"
        );
    };
    let (of_deflection, of_one) = found.split_at(DEFLECTION_CASES.len());
    for ([p, b, deadzone, contact], found) in DEFLECTION_CASES.iter().zip(of_deflection) {
        check("deadzone", &[*p, *b], found[0], *deadzone);
        check("contact", &[*p, *b], found[1], *contact);
    }
    for ([p, above, reciprocal], found) in ONE_NUMBER_CASES.iter().zip(of_one) {
        check("above", &[*p], found[2], *above);
        check("pivot_reciprocal", &[*p], found[3], *reciprocal);
    }
}

fn evaluate(mut evaluator: Evaluator) -> Vec<[f64; 4]> {
    let observables = evaluator.program().observables.len();
    let compute = |[x, b]: [f64; 2]| {
        let (state, inputs) = ([x, 0.0], [b]);
        let point = || Point {
            t: 0.0,
            state: &state,
            inputs: &inputs,
        };
        let (mut rates, mut values) = ([0.0; 2], vec![0.0; observables]);
        evaluator.rates(point(), &mut rates);
        evaluator.observables(point(), &mut values);
        [values[0], values[1], values[2], rates[1]]
    };
    arguments().into_iter().map(compute).collect()
}

#[test]
fn interpreter_and_machine_code_have_the_tabulated_values() {
    let program = program();
    let single = Evaluator::new(program.clone()).in_single_precision(&[]);
    assert_values("interpreter", &evaluate(Evaluator::new(program.clone())));
    assert_values("interpreter in single precision", &evaluate(single));
    assert_values("machine code", &evaluate(eomgen_jit::evaluator(program)));
}

#[test]
fn web_assembly_has_the_tabulated_values() {
    if !node() {
        return;
    }
    let program = program();
    let case = |[x, b]: [f64; 2]| Case {
        parameters: program.default_parameters(),
        time: 0.0,
        state: vec![x, 0.0],
        inputs: vec![b],
    };
    let cases: Vec<Case> = arguments().into_iter().map(case).collect();
    let guards = Evaluator::new(program.clone()).guard_count();
    let observables = program.observables.len();
    let counts = [2, 2, 1, observables, guards];
    let results = run_module(
        &wasm::emit(&program).expect("emitted").bytes,
        &cases,
        counts,
    );
    // The results are the default parameters, then for each case validity, rates, observables and guards.
    let rows = results[2..].chunks(3 + observables + guards);
    let found: Vec<[f64; 4]> = rows.map(|row| [row[3], row[4], row[5], row[2]]).collect();
    assert_values("WebAssembly", &found);
}

/// Runs a compiled driver on all cases.
fn run_driver(folder: &Path, executable: &Path) -> Vec<[f64; 4]> {
    let lines: String = arguments()
        .iter()
        .map(|[x, b]| format!("{x:?} {b:?}\n"))
        .collect();
    let cases = folder.join("cases");
    std::fs::write(&cases, lines).expect("written");
    let cases = std::fs::File::open(cases).expect("readable");
    let output = Command::new(executable).stdin(Stdio::from(cases)).output();
    let text = String::from_utf8(output.expect("it runs").stdout).expect("text");
    let row = |line: &str| {
        let numbers = line.split(' ').map(|word| word.parse().expect("a number"));
        let numbers: Vec<f64> = numbers.collect();
        <[f64; 4]>::try_from(numbers).expect("four numbers")
    };
    text.lines().map(row).collect()
}

#[test]
fn emitted_c_has_the_tabulated_values() {
    if !super::c99::has_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let files = c::emit(&program()).expect("emitted");
    std::fs::write(folder.join("edges.h"), files.header).expect("written");
    std::fs::write(folder.join("edges.c"), files.source).expect("written");
    std::fs::write(folder.join("driver.c"), C_DRIVER).expect("written");
    for real in ["double", "float"] {
        for level in ["-O0", "-O2"] {
            let executable = folder.join(format!("{real}{level}"));
            super::c99::run(
                Command::new("cc")
                    .args(["-std=c99", level])
                    .arg(format!("-Dedges_REAL={real}"))
                    .args([folder.join("driver.c"), folder.join("edges.c")])
                    .arg("-o")
                    .arg(&executable),
            );
            assert_values(
                &format!("C, {real}, {level}"),
                &run_driver(folder, &executable),
            );
        }
    }
}

#[test]
fn emitted_rust_has_the_tabulated_values() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let source = rust::emit(&program(), Packaging::Module).expect("emitted");
    std::fs::write(folder.join("edges.rs"), source).expect("written");
    for real in ["f64", "f32"] {
        let driver = folder.join("driver.rs");
        std::fs::write(&driver, RUST_DRIVER.replace("REAL", real)).expect("written");
        for level in ["0", "2"] {
            let executable = folder.join(format!("{real}_{level}"));
            let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
            super::c99::run(
                Command::new(rustc)
                    .args(["--edition", "2021", "-A", "warnings"])
                    .arg(format!("-Copt-level={level}"))
                    .arg(&driver)
                    .arg("-o")
                    .arg(&executable),
            );
            assert_values(
                &format!("Rust, {real}, {level}"),
                &run_driver(folder, &executable),
            );
        }
    }
}
