//! Specifications as text, derived variants, and `rustc`, for the tests.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_codegen::mechanics::equations::{Equations, derive};
use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::program::lowering::lower;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

/// Checks a specification given as text.
pub fn model(text: &str) -> Model {
    match eomgen_model_spec::check(Source::new("test.toml", text)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}", found.render(false)),
    }
}

/// Loads a shipped specification.
pub fn shipped(name: &str) -> Model {
    let text = std::fs::read_to_string(models().join(format!("{name}.toml"))).unwrap();
    model(&text)
}

/// Returns the folder of the shipped specifications.
pub fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models")
}

/// Derives the equations of a model with every field at one order.
pub fn equations(model: &Model, order: usize) -> Equations {
    derive(model, &vec![order; model.fields.len()]).unwrap_or_else(|error| panic!("{error}"))
}

/// Derives the program of a model with every field at one order.
pub fn program(model: &Model, order: usize) -> Program {
    lower(
        model,
        &equations(model, order),
        &model.parameter_values().unwrap(),
    )
}

/// Derives the evaluator of a model with every field at one order.
pub fn evaluator(model: &Model, order: usize) -> Evaluator {
    Evaluator::new(program(model, order))
}

/// Emits a model with every field at one order, as a crate.
pub fn emitted(model: &Model, order: usize) -> String {
    emit(&program(model, order), Packaging::Crate).unwrap()
}

/// Derives the program with every requestable output.
pub fn program_with_all(model: &Model, order: usize) -> Program {
    let orders = vec![order; model.fields.len()];
    match Variant::derive_with(model, &orders, &Output::ALL) {
        Ok(variant) => variant.program,
        Err(found) => panic!("{}", found.render(false)),
    }
}

/// Emits the crate with every requestable output.
pub fn emitted_with_all(model: &Model, order: usize) -> String {
    emit(&program_with_all(model, order), Packaging::Crate).unwrap()
}

/// Computes all observables at a state, with `energy` and `power` last.
pub fn observables(evaluator: &mut Evaluator, t: f64, state: &[f64]) -> Vec<f64> {
    let mut values = vec![f64::NAN; evaluator.program().observables.len()];
    evaluator.observables(
        Point {
            t,
            state,
            inputs: &[],
        },
        &mut values,
    );
    values
}

/// Computes the accelerations at a state.
pub fn accelerations(evaluator: &mut Evaluator, state: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; state.len()];
    evaluator.rates(
        Point {
            t: 0.0,
            state,
            inputs: &[],
        },
        &mut rates,
    );
    rates.split_off(state.len() / 2)
}

/// Creates a folder in the temporary folder of the tests.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Compiles a source as a library by plain `rustc`; warnings are errors.
pub fn compile(name: &str, source: &str, options: &[&str]) -> PathBuf {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    compile_by(Command::new(compiler), name, source, options)
}

/// Compiles a source as a library by `compiler`; warnings are errors.
pub fn compile_by(mut compiler: Command, name: &str, source: &str, options: &[&str]) -> PathBuf {
    let folder = folder(name);
    let path = folder.join("lib.rs");
    std::fs::write(&path, source).unwrap();
    let output = compiler
        .args([
            "--crate-type",
            "lib",
            "--crate-name",
            "emitted",
            "-D",
            "warnings",
        ])
        .args(options)
        .arg("--out-dir")
        .arg(&folder)
        .arg(&path)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{name}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    folder
}

/// Returns a chain of pendulums `q_1 ..`, each attached to the one before: its mass matrix is full and
/// depends on the state.
pub fn chain_of_pendulums(count: usize) -> String {
    let mut text = String::from(
        "[model]\nname = \"chain\"\ntitle = \"A chain\"\n[parameters]\nm = { value = 0.3, unit = \"kg\" }\n\
         l = { value = 0.4, unit = \"m\" }\ng = { value = 9.81, unit = \"m/s^2\" }\n[coordinates]\n",
    );
    (1..=count).for_each(|i| writeln!(text, "q_{i} = {{ unit = \"rad\" }}").unwrap());
    text.push_str("[definitions]\nx_1 = \"l*sin(q_1)\"\ny_1 = \"-l*cos(q_1)\"\n");
    for (i, before) in (2..=count).zip(1..) {
        let (x, y) = (
            format!("x_{before} + l*sin(q_{i})"),
            format!("y_{before} - l*cos(q_{i})"),
        );
        writeln!(text, "x_{i} = \"{x}\"\ny_{i} = \"{y}\"").unwrap();
    }
    text.push_str("[kinetic]\n");
    (1..=count)
        .for_each(|i| writeln!(text, "b_{i} = \"1/2*m*(dot(x_{i})^2 + dot(y_{i})^2)\"").unwrap());
    text.push_str("[potential]\n");
    (1..=count).for_each(|i| writeln!(text, "h_{i} = \"m*g*y_{i}\"").unwrap());
    text
}
