//! Bit-for-bit comparison of the WebAssembly module of a page with the interpreter, for shipped models and every
//! language feature. Rates, observables and guards are compared at random states in every regime and at non-finite
//! numbers.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::wasm;
use eomgen_model_spec::model::Model;
use eomgen_tests::models::{project, samples, shipped_specifications, variant};

/// Returns true if node is installed; otherwise reports the skip.
pub fn node() -> bool {
    let found = Command::new("node").arg("--version").output();
    let there = found.is_ok_and(|output| output.status.success());
    if !there {
        skips::skip("no emitted WebAssembly was run: node is missing (Debian: nodejs)");
    }
    there
}

pub struct Case {
    pub parameters: Vec<f64>,
    pub time: f64,
    pub state: Vec<f64>,
    pub inputs: Vec<f64>,
}

/// Returns states in every regime with default and other parameters, and cases with non-finite or
/// too large numbers.
fn cases(model: &Model, program: &Program, order: usize) -> Vec<Case> {
    let defaults = program.default_parameters();
    let mut cases = Vec::new();
    for (place, sample) in samples(model, order, 7, 3).into_iter().enumerate() {
        let factor = 1.0 + 0.037 * (place % 3) as f64;
        cases.push(Case {
            parameters: defaults.iter().map(|value| value * factor).collect(),
            time: sample.time,
            state: sample.state,
            inputs: sample.inputs,
        });
    }
    for odd in [0.0, -0.0, 1e9, 1e200, f64::INFINITY, f64::NAN, 5e-324] {
        let all = |length: usize| vec![odd; length];
        cases.push(Case {
            parameters: defaults.clone(),
            time: odd,
            state: all(program.states()),
            inputs: all(program.inputs.len()),
        });
        cases.push(Case {
            parameters: all(defaults.len()),
            time: 0.1,
            state: vec![0.1; program.states()],
            inputs: vec![0.1; program.inputs.len()],
        });
    }
    cases
}

fn interpret(evaluator: &mut Evaluator, case: &Case) -> Vec<f64> {
    evaluator.prepare(&case.parameters);
    let usable = f64::from(u8::from(evaluator.pivots_are_positive()));
    let point = || Point {
        t: case.time,
        state: &case.state,
        inputs: &case.inputs,
    };
    let mut rates = vec![0.0; case.state.len()];
    let mut observables = vec![0.0; evaluator.program().observables.len()];
    let mut guards = vec![0.0; evaluator.guard_count()];
    evaluator.rates(point(), &mut rates);
    evaluator.observables(point(), &mut observables);
    evaluator.guards(point(), &mut guards);
    [vec![usable], rates, observables, guards].concat()
}

/// Returns the module's initial parameters, then its results for all cases.
pub fn run_module(module: &[u8], cases: &[Case], counts: [usize; 5]) -> Vec<f64> {
    let folder = tempfile::tempdir().expect("a folder");
    let numbers = cases.iter().flat_map(|case| {
        let parts = [
            &case.parameters,
            &vec![case.time],
            &case.state,
            &case.inputs,
        ];
        parts.map(Clone::clone).concat()
    });
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    std::fs::write(folder.path().join("module.wasm"), module).expect("written");
    std::fs::write(folder.path().join("points.bin"), bytes).expect("written");
    let output = Command::new("node")
        .arg(project().join("tests/tests/hosts/page/bits.mjs"))
        .arg(folder.path())
        .args(counts.map(|count| count.to_string()))
        .output()
        .expect("node can be run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let bytes = std::fs::read(folder.path().join("results.bin")).expect("results");
    let numbers = bytes.chunks_exact(8);
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
    numbers.map(number).collect()
}

/// Compares a specification at one order; returns the number of compared finite numbers.
fn compare(path: &Path, order: Option<usize>) -> usize {
    let model = eomgen_model_spec::load(path).expect("it loads").model;
    let order = order.or_else(|| model.fields.first().map(|field| field.order));
    let order = order.unwrap_or(0);
    let mut evaluator = variant(&model, order).evaluator;
    let program = evaluator.program().clone();
    let module = wasm::emit(&program).expect("emitted").bytes;
    assert_eq!(
        module,
        wasm::emit(&program).expect("emitted").bytes,
        "two runs give different modules"
    );
    let cases = cases(&model, &program, order);
    let counts = [
        program.parameters.len(),
        program.states(),
        program.inputs.len(),
        program.observables.len(),
        evaluator.guard_count(),
    ];
    let results = run_module(&module, &cases, counts);
    let (defaults, results) = results.split_at(program.parameters.len());
    assert_eq!(defaults, program.default_parameters());
    let width = 1 + program.states() + program.observables.len() + evaluator.guard_count();
    assert_eq!(results.len(), cases.len() * width);
    let mut compared = 0;
    for (case, found) in cases.iter().zip(results.chunks(width)) {
        let wanted = interpret(&mut evaluator, case);
        for (place, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
            let same = found.to_bits() == wanted.to_bits() || found.is_nan() && wanted.is_nan();
            let name = &program.name;
            assert!(
                same,
                "{name} at order {order}, number {place}: {found:e}, not {wanted:e}"
            );
            compared += usize::from(!found.is_nan());
        }
    }
    assert!(
        2 * compared > cases.len() * width / 2,
        "most numbers are NaN"
    );
    compared
}

#[test]
fn shipped_models_match_interpreter_bitwise() {
    if !node() {
        return;
    }
    let mut compared = 0;
    for path in shipped_specifications() {
        println!("{}", path.display());
        compared += compare(&path, None);
    }
    for order in [0, 1, 9, 64] {
        compared += compare(&eomgen_tests::models::path("planetary_arm"), Some(order));
    }
    assert!(compared > 1000, "{compared} numbers");
}

#[test]
fn language_features_match_interpreter_bitwise() {
    if !node() {
        return;
    }
    let folder = project().join("tests/features");
    let entries = std::fs::read_dir(folder).expect("the folder of features");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    assert!(paths.len() > 20, "features are missing");
    for path in paths {
        println!("{}", path.display());
        let massless = path.to_string_lossy().contains("massless_beam");
        compare(&path, Some(if massless { 1 } else { 2 }));
    }
}
