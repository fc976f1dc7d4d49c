//! Measures forward and inverse dynamics of rigid trees for the same states: emitted C, CasADi with the same
//! expressions, and Pinocchio with the same arm:
//!
//!     cargo run --release -p eomgen-benches --bin rigid_trees
//!
//! CasADi and Pinocchio are Python packages (`pip install casadi pin cmeel-eigen`). The environment variable PYTHON
//! selects the interpreter, `python3` by default. If a package is missing, the program prints a message and the columns
//! of the package are empty. Operation counts per call are printed for emitted code and for energies simplified by
//! hand; a function counts as one operation.

use std::error::Error;
use std::path::Path;
use std::process::Command;

use eomgen_benches::casadi_contender::definitions;
use eomgen_benches::rigid_specifications as specifications;
use eomgen_codegen::c;
use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::Program;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Largest accepted difference between contenders, relative to the largest result of a call. Contenders sum in
/// different orders.
const MAX_DIFFERENCE: f64 = 1e-10;
/// Maximum number of printed lines of a failed command's output.
const MAX_LINES: usize = 20;
/// Compiler definitions with limits of Boost that Pinocchio's package requires.
const LIMITS: [&str; 4] = [
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
];
/// PUMA 560 for Pinocchio: rotation about x, translation, mass, centre of mass and inertia of each link.
const ARM: &str = "\
JOINT(M_PI / 2, 0, 0, 0, 0, 0, 0, 0, 0.35, 0.35, 0.35)
JOINT(0, 0, 0, 0, 17.4, 0.4318 - 0.3638, 0.006, 0.2275, 0.13, 0.524, 0.539)
JOINT(-M_PI / 2, 0.4318, 0, 0, 4.8, 0, -0.0141 - 0.15005, 0.07, 0.066, 0.086, 0.0125)
JOINT(M_PI / 2, 0.0203, -0.15005, 0, 0.82, 0, 0.4318 + 0.019, 0, 0.0018, 0.0013, 0.0018)
JOINT(-M_PI / 2, 0, 0.4318, 0, 0.34, 0, 0, 0, 0.0003, 0.0004, 0.0003)
JOINT(0, 0, 0, 0, 0.09, 0, 0, 0.032, 0.00015, 0.00015, 4e-5)
";

/// Runs a command and returns its output.
fn run(command: &mut Command) -> Outcome<String> {
    let output = command.output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let said: Vec<&str> = said.lines().take(MAX_LINES).collect();
        let said = said.join("\n");
        return Err(format!("{command:?}: {said}").into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

fn python() -> Command {
    Command::new(std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned()))
}

/// Derives a specification with inverse dynamics.
fn derive_text(text: String) -> Outcome<(Model, Program)> {
    let checked = eomgen_model_spec::check(Source::new("rigid_tree.toml", text))
        .map_err(|found| found.render(false))?;
    let variant = Variant::derive_with(&checked.model, &[], &[Output::InverseDynamics])
        .map_err(|found| found.render(false))?;
    Ok((checked.model, variant.program))
}

fn operations(program: &Program) -> (usize, usize) {
    let inverse = program.outputs.inverse_dynamics.as_ref();
    let inverse = inverse.map_or(0, |rows| program.operations(&rows.all()));
    (program.operations(&program.accelerations.all()), inverse)
}

/// Returns the include folder of Pinocchio's package.
fn pinocchio() -> Option<String> {
    let asked = "import pathlib, pinocchio; print(pathlib.Path(pinocchio.__file__).parents[4])";
    let folder = run(python().args(["-c", asked])).ok()?.trim().to_owned();
    Path::new(&folder)
        .join("include/eigen3")
        .is_dir()
        .then_some(folder)
}

/// Compiles a program with Pinocchio's `aba` (forward dynamics) and `rnea` (inverse dynamics) of the arm.
fn compile_peer(sources: &Path, folder: &Path, package: &str) -> Outcome<()> {
    std::fs::write(folder.join("arm.h"), ARM)?;
    let include = |name: &str| format!("-I{package}/include{name}");
    run(Command::new("c++")
        .args(["-std=c++17", "-O3", "-DNDEBUG"])
        .args(LIMITS)
        .arg(format!("-DARM=\"{}\"", folder.join("arm.h").display()))
        .args([include(""), include("/eigen3")])
        .arg("-c")
        .arg(sources.join("pinocchio.cpp"))
        .arg("-o")
        .arg(folder.join("peer.o")))?;
    Ok(())
}

/// Measures the shortest times of a call in ns: forward and then inverse dynamics of emitted code, CasADi and Pinocchio
/// (0 if missing).
fn measure(model: &Model, program: &Program, peer: Option<&str>) -> Outcome<[f64; 6]> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("rigid_trees");
    let folder = tempfile::tempdir()?;
    let folder = folder.path();
    let name = &model.name;
    let files = c::emit(program)?;
    std::fs::write(folder.join(format!("{name}.h")), files.header)?;
    std::fs::write(folder.join(format!("{name}.c")), files.source)?;
    let module = definitions(model).ok_or("an expression that CasADi does not support")?;
    std::fs::write(folder.join("definitions.py"), module)?;
    std::fs::copy(sources.join("contender.py"), folder.join("contender.py"))?;
    run(python().arg("contender.py").current_dir(folder))?;
    let mut compiler = Command::new("cc");
    compiler
        .args(["-O3", "-I"])
        .arg(folder)
        .arg(format!("-DMODEL={name}"))
        .arg(format!("-DHEADER=\"{name}.h\""))
        .arg(format!("-DDEGREES={}", model.coordinates.len()))
        .arg(sources.join("turns.c"))
        .args([folder.join(format!("{name}.c")), folder.join("contender.c")]);
    if let Some(package) = peer {
        compile_peer(&sources, folder, package)?;
        let libraries = format!("{package}/lib");
        // Linkers expect objects before libraries.
        compiler
            .arg("-DPEER")
            .arg(folder.join("peer.o"))
            .args(["-L", &libraries, "-lpinocchio_default", "-lstdc++"])
            .arg(format!("-Wl,-rpath,{libraries}"));
    }
    run(compiler.args(["-lm", "-o"]).arg(folder.join("turns")))?;
    let printed = run(&mut Command::new(folder.join("turns")))?;
    let found: Result<Vec<f64>, _> = printed.split_whitespace().map(str::parse).collect();
    let &[a, b, c, d, e, f, apart] = found?.as_slice() else {
        return Err(format!("not seven numbers: {printed}").into());
    };
    if apart.is_nan() || apart > MAX_DIFFERENCE {
        return Err(format!("{name}: the contenders differ by {apart:e}").into());
    }
    Ok([a, b, c, d, e, f])
}

/// Formats a ratio, or returns an empty text if there is no measurement.
fn ratio(a: f64, b: f64) -> String {
    match b > 0.0 {
        true => format!("{:.2}", a / b),
        false => "-".to_owned(),
    }
}

/// Prints the times of all trees.
fn times() -> Outcome<()> {
    if run(python().args(["-c", "import casadi"])).is_err() {
        println!("no times: the Python package `casadi` is missing (pip install casadi)");
        return Ok(());
    }
    let package = pinocchio();
    if package.is_none() {
        println!(
            "no Pinocchio: the Python packages `pin` and `cmeel-eigen` are missing (pip install pin cmeel-eigen)"
        );
    }
    println!(
        "| | operations | forward, ns | : CasADi | : aba | operations | inverse, ns | : CasADi | : rnea | : forward |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let trees = [
        specifications::planar_arm(2),
        specifications::planar_arm(3),
        specifications::puma(4),
        specifications::puma(5),
        specifications::puma(6),
        specifications::chain(10),
        specifications::chain(20),
    ];
    for text in trees {
        let (model, program) = derive_text(text)?;
        let peer = package.as_deref().filter(|_| model.name == "puma_6");
        let [rates, casadi, aba, inverse, casadi_inverse, rnea] = measure(&model, &program, peer)?;
        let (forward_operations, inverse_operations) = operations(&program);
        println!(
            "| {} | {forward_operations} | {rates:.0} | {} | {} | {inverse_operations} | {inverse:.0} | {} | {} | {} |",
            model.name,
            ratio(rates, casadi),
            ratio(rates, aba),
            ratio(inverse, casadi_inverse),
            ratio(inverse, rnea),
            ratio(inverse, rates),
        );
    }
    Ok(())
}

fn main() -> Outcome<()> {
    println!("| operations of a call | Cartesian | by hand | ratio |");
    println!("| --- | --- | --- | --- |");
    let pairs = [
        (
            specifications::spherical_pendulum(),
            specifications::spherical_pendulum_by_hand(),
        ),
        (
            specifications::planar_arm(2),
            specifications::planar_arm_by_hand(2),
        ),
        (
            specifications::planar_arm(3),
            specifications::planar_arm_by_hand(3),
        ),
    ];
    for (cartesian, by_hand) in pairs {
        let (model, program) = derive_text(cartesian)?;
        let (cartesian, by_hand) = (
            operations(&program).0,
            operations(&derive_text(by_hand)?.1).0,
        );
        let ratio = cartesian as f64 / by_hand as f64;
        println!("| {} | {cartesian} | {by_hand} | {ratio:.2} |", model.name);
    }
    println!();
    times()
}
