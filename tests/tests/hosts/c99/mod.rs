//! Bit-for-bit comparison of compiled emitted C with compiled emitted Rust: every output at equal states, some of them
//! infinite or NaN. The tests cover every shipped model, every language feature, and names and texts with a meaning in
//! C. Skipped with a message if there is no C compiler.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_codegen::c;
use eomgen_codegen::program::{Output, Program};
use eomgen_codegen::rust::{self, Packaging};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::{project, shipped_specifications};

mod command;
mod data;
mod header_only;
mod hostile;
mod linked;
mod number_types;
mod reordered;

/// Compiler warnings for all emitted C.
const WARNINGS: [&str; 4] = ["-pedantic", "-Wall", "-Wextra", "-Werror"];

fn supported_outputs() -> Vec<Output> {
    let mut all = Output::ALL.to_vec();
    all.retain(|output| *output != Output::Lanes);
    all
}

/// Returns true if C and C++ compilers exist; otherwise reports the skip.
pub(super) fn has_compilers() -> bool {
    let works = |program: &str| Command::new(program).arg("--version").output().is_ok();
    let there = works("cc") && works("c++");
    if !there {
        skips::skip("the emitted C was not compiled: cc or c++ is missing (Debian: g++)");
    }
    there
}

pub(super) fn run(command: &mut Command) -> String {
    let output = command.output().expect("the command starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{said}");
    String::from_utf8(output.stdout).expect("text")
}

fn model(text: &str) -> Model {
    match eomgen_model_spec::check(Source::new("model.toml", text)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{found}"),
    }
}

fn program(text: &str, order: usize, outputs: &[Output]) -> Program {
    let model = model(text);
    let orders = vec![order; model.fields.len()];
    let variant = Variant::derive_with(&model, &orders, outputs);
    variant.expect("the model can be derived").program
}

/// Writes the emitted C to a folder and compiles it as C++ in these precisions.
fn compile_as_cpp(program: &Program, precisions: &[&str], folder: &Path) {
    let files = c::emit(program).expect("emitted");
    let name = &program.name;
    std::fs::write(folder.join(format!("{name}.h")), files.header).expect("written");
    std::fs::write(folder.join(format!("{name}.c")), files.source).expect("written");
    for real in precisions {
        run(Command::new("c++")
            .args(["-x", "c++", "-std=c++11", "-fsyntax-only"])
            .args(WARNINGS)
            .arg(format!("-D{name}_REAL={real}"))
            .arg(folder.join(format!("{name}.c"))));
    }
}

#[derive(Clone, Copy)]
enum Compiled {
    Optimised,
    /// Undefined behaviour of C, such as converting NaN to an integer, stops the driver. The driver is not optimised,
    /// because optimisation would make compilation five times as long.
    Trapping,
}

impl Compiled {
    fn flags(self) -> &'static [&'static str] {
        match self {
            Self::Optimised => &["-O1"],
            Self::Trapping => &[
                "-O0",
                "-fsanitize=undefined,float-cast-overflow",
                "-fsanitize-undefined-trap-on-error",
            ],
        }
    }
}

fn run_c_driver(program: &Program, real: &str, compiled: Compiled, folder: &Path) -> String {
    let name = &program.name;
    let mut defaults: Vec<String> = program
        .default_parameters()
        .iter()
        .map(|value| format!("{value:e}"))
        .collect();
    if defaults.is_empty() {
        defaults.push("0".to_owned());
    }
    let defaults = format!(
        "static const double defaults[] = {{{}}};\n",
        defaults.join(", ")
    );
    let driver = include_str!("driver.c")
        .replace("#define POINTS", &format!("{defaults}#define POINTS"))
        .replace("NAME", name);
    let path = folder.join("driver.c");
    std::fs::write(&path, driver).expect("written");
    let executable = folder.join(format!("driver_{real}"));
    let mut command = Command::new("cc");
    command
        .arg("-std=c99")
        .args(compiled.flags())
        .args(WARNINGS);
    for (name, requested) in ["-DREQUESTED", "-DDERIVATIVES"]
        .iter()
        .zip(has_requested(program))
    {
        if requested {
            command.arg(name);
        }
    }
    run(command
        .arg(format!("-D{name}_REAL={real}"))
        .arg(path)
        .arg(folder.join(format!("{name}.c")))
        .arg("-o")
        .arg(&executable));
    run(&mut Command::new(executable))
}

/// Writes and compiles the driver in Rust for these precisions and the regimes that the C driver
/// visited.
fn compile_rust_driver(
    program: &Program,
    precisions: &[&str],
    by_c: &[String],
    folder: &Path,
) -> PathBuf {
    let source = rust::emit(program, Packaging::Module).expect("emitted");
    std::fs::write(folder.join("lib.rs"), source).expect("written");
    let regimes: BTreeSet<&str> = by_c
        .iter()
        .flat_map(|text| text.lines())
        .filter_map(|line| line.strip_prefix("regime "))
        .collect();
    let arms: String = regimes
        .iter()
        .map(|regime| {
            format!(
                "{regime} => rates_in_regime_into::<{regime}, _>\
                 (t, &state, &inputs, &coefficients, &mut rates),\n"
            )
        })
        .collect();
    let inputs: Vec<String> = program
        .inputs
        .iter()
        .map(|input| format!("input_product.{}", input.name))
        .collect();
    let [requested, derivatives] = has_requested(program);
    let requested = requested.then(|| include_str!("requested.rs.txt").replace("//REGIMES", &arms));
    let derivatives = derivatives.then(|| {
        let inputs = format!("[{}]", inputs.join(", "));
        include_str!("derivatives.rs.txt").replace("OF_INPUTS", &inputs)
    });
    let defaults: Vec<String> = program
        .default_parameters()
        .iter()
        .map(|value| format!("{value:?}"))
        .collect();
    let precision = include_str!("driver.rs.txt")
        .replace("//REQUESTED", &requested.unwrap_or_default())
        .replace("//DERIVATIVES", &derivatives.unwrap_or_default());
    let mut driver = format!(
        "#[path = \"lib.rs\"]\nmod model;\n\
         const DEFAULTS: [f64; model::PARAMETERS] = [{}];\n",
        defaults.join(", ")
    );
    let mut arms = String::new();
    for real in precisions {
        let number = if *real == "float" { "f32" } else { "f64" };
        let module = precision.replace("REAL", number);
        driver += &format!("mod {real} {{\n{module}}}\n");
        arms += &format!("Some(\"{real}\") => {real}::run(),\n");
    }
    driver += &format!(
        "fn main() {{\nmatch std::env::args().nth(1).as_deref() {{\n{arms}_ => {{}}\n}}\n}}\n"
    );
    let path = folder.join("driver.rs");
    std::fs::write(&path, driver).expect("written");
    let executable = folder.join("rust");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc)
        .args(["--edition", "2021", "-A", "warnings"])
        .arg(path)
        .arg("-o")
        .arg(&executable));
    executable
}

/// Returns two flags: whether forces and regimes were requested, and whether derivatives were requested.
fn has_requested(program: &Program) -> [bool; 2] {
    let kinds = &program.outputs.kinds;
    [Output::Regimes, Output::Products].map(|output| kinds.contains(&output))
}

fn compare(program: &Program) {
    compare_precisions(program, &["double", "float"], Compiled::Trapping);
}

fn compare_precisions(program: &Program, precisions: &[&str], compiled: Compiled) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    compile_as_cpp(program, precisions, folder);
    let by_c = precisions
        .iter()
        .map(|real| run_c_driver(program, real, compiled, folder));
    let by_c: Vec<String> = by_c.collect();
    let in_rust = compile_rust_driver(program, precisions, &by_c, folder);
    for (real, by_c) in precisions.iter().zip(&by_c) {
        let by_rust = run(Command::new(&in_rust).arg(real));
        assert!(by_c.lines().count() > 24 * 2 * program.states());
        let numbers = by_c.lines().filter(|line| !line.ends_with("nan")).count();
        assert!(2 * numbers > by_c.lines().count(), "most numbers are NaN");
        let mut last = "";
        for (c, rust) in by_c.lines().zip(by_rust.lines()) {
            if c.starts_with("point") {
                last = c;
            }
            assert_eq!(c, rust, "{} in {real}, {last}", program.name);
        }
        assert_eq!(by_c.lines().count(), by_rust.lines().count());
    }
}

/// Compares a specification in these precisions: at `order` with all outputs that can be requested, at other orders
/// without additional outputs.
fn compare_file(
    path: PathBuf,
    with: usize,
    without: &[usize],
    precisions: &[&str],
    compiled: Compiled,
) {
    let text = std::fs::read_to_string(&path).expect("a readable specification");
    println!("{}", path.display());
    let rigid = !text.contains("[fields.");
    let model = model(&text);
    let derived = |outputs: &[Output]| {
        let orders = vec![with; model.fields.len()];
        Variant::derive_with(&model, &orders, outputs)
    };
    // A sum whose weights of squared mode shapes depend on the state has no emitted derivatives.
    let forces = [
        Output::BiasForces,
        Output::InverseDynamics,
        Output::GuardRates,
        Output::Regimes,
    ];
    let variant = derived(&supported_outputs()).or_else(|_| derived(&forces));
    let variant = variant.expect("the model can be derived");
    compare_precisions(&variant.program, precisions, compiled);
    for order in without {
        if !rigid {
            compare_precisions(
                &program(&text, *order, &[]),
                &["double"],
                Compiled::Trapping,
            );
        }
    }
}

#[test]
fn shipped_models_match_rust_bitwise() {
    if has_compilers() {
        for path in shipped_specifications() {
            compare_file(
                path,
                4,
                &[0, 1, 9],
                &["double", "float"],
                Compiled::Optimised,
            );
        }
    }
}

#[test]
fn language_features_match_rust_bitwise() {
    if !has_compilers() {
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
        let order = match path.file_stem().and_then(|name| name.to_str()) {
            Some("massless_beam" | "massless_beam_by_sum") => 1,
            _ => 2,
        };
        compare_file(path, order, &[], &["double"], Compiled::Trapping);
    }
}
