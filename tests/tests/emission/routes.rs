//! Test that macro, build script and command line give code with bit-identical results and add no dependencies.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use eomgen_tests::models::{load, path, project, samples};
use eomgen_tests::pages::{blocks, pages};
use eomgen_tests::program::{eomgen, run};

const ORDER: usize = 4;

const SEED: u64 = 0x5eed_0400;

const STATES_PER_REGIME: usize = 20;

/// Bits of a time and a state, then of the results.
type Bits = Vec<u64>;

fn points() -> Vec<(f64, [f64; 14])> {
    let drawn = samples(&load("planetary_arm"), ORDER, SEED, STATES_PER_REGIME);
    let point = |sample: &eomgen_validate::sampler::Sample| {
        let state = sample.state.as_slice().try_into();
        (sample.time, state.expect("a state of the arm"))
    };
    drawn.iter().map(point).collect()
}

macro_rules! bits {
    ($module:path) => {{
        use $module as module;
        let coefficients = module::Coefficients::prepare(&module::Parameters::default());
        let inputs = module::Inputs::default();
        let all = points().into_iter().map(|(t, state)| {
            let numbers = [
                module::rates(t, &state, &inputs, &coefficients).to_vec(),
                module::observables(t, &state, &inputs, &coefficients).to_vec(),
                module::guards(t, &state, &inputs, &coefficients).to_vec(),
            ];
            numbers.concat().into_iter().map(f64::to_bits).collect()
        });
        all.collect::<Vec<Bits>>()
    }};
}

/// Program around the file written by `eomgen generate`. Each input line holds the bits of a time
/// and a state, each output line the bits of the results.
const PROBE: &str = r#"
use arm4::*;

fn main() {
    let coefficients = Coefficients::prepare(&Parameters::default());
    let inputs = Inputs::default();
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let numbers: Vec<f64> = line
            .split(' ')
            .map(|bits| f64::from_bits(u64::from_str_radix(bits, 16).unwrap()))
            .collect();
        let (t, state) = (numbers[0], numbers[1..].try_into().unwrap());
        let rates = rates(t, &state, &inputs, &coefficients);
        let observables = observables(t, &state, &inputs, &coefficients);
        let guards = guards(t, &state, &inputs, &coefficients);
        for number in rates.iter().chain(&observables).chain(&guards) {
            print!("{:x} ", number.to_bits());
        }
        println!();
    }
}
"#;

fn rustc(arguments: &[&str], folder: &Path) {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let status = Command::new(rustc)
        .args(["--edition", "2024", "-O"])
        .args(arguments)
        .current_dir(folder)
        .status()
        .expect("rustc can be run");
    assert!(status.success(), "{arguments:?}");
}

fn compile_arm4(folder: &Path) {
    let status = eomgen()
        .args(["generate", "--order", "4", "--out", "arm4"])
        .arg(path("planetary_arm"))
        .current_dir(folder)
        .ok();
    status.expect("the arm is emitted");
    let library = ["--crate-type", "lib", "--crate-name", "arm4"];
    rustc(&[&library[..], &["arm4/lib.rs"]].concat(), folder);
}

fn run_probe(folder: &Path) -> Vec<Bits> {
    compile_arm4(folder);
    std::fs::write(folder.join("probe.rs"), PROBE).expect("writable");
    rustc(&["probe.rs", "--extern", "arm4=libarm4.rlib"], folder);
    let mut input = String::new();
    for (t, state) in points() {
        let bits = state.iter().map(|x| format!(" {:x}", x.to_bits()));
        writeln!(input, "{:x}{}", t.to_bits(), bits.collect::<String>()).expect("written");
    }
    let mut probe = Command::new(folder.join("probe"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the probe can be run");
    let mut stdin = probe.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()));
    let output = probe.wait_with_output().expect("the probe ends");
    writer.join().expect("no panic").expect("the probe reads");
    let text = String::from_utf8(output.stdout).expect("digits");
    let number = |bits: &str| u64::from_str_radix(bits, 16).expect("digits");
    let line = |line: &str| line.split_whitespace().map(number).collect();
    text.lines().map(line).collect()
}

#[test]
fn macro_build_script_and_command_line_give_same_bits() {
    let checked_in = bits!(eomgen_generated::planetary_arm_order_4);
    assert_eq!(checked_in.len(), 9 * STATES_PER_REGIME);
    assert!(checked_in == bits!(with_macro::arm), "the macro differs");
    assert!(
        checked_in == bits!(with_build_script::arm),
        "the build script differs"
    );
    let folder = tempfile::tempdir().expect("a folder");
    assert!(
        checked_in == run_probe(folder.path()),
        "the command line differs"
    );
}

#[test]
fn command_line_example_prints_documented_line() {
    let folder = tempfile::tempdir().expect("a folder");
    compile_arm4(folder.path());
    let example = project().join("examples/with_command_line/controller.rs");
    std::fs::copy(example, folder.path().join("controller.rs")).expect("copied");
    rustc(
        &["controller.rs", "--extern", "arm4=libarm4.rlib"],
        folder.path(),
    );
    let output = Command::new(folder.path().join("controller")).output();
    let output = output.expect("the controller runs").stdout;
    assert_eq!(
        String::from_utf8_lossy(&output),
        "x_c = 0.000437 m after 10 ms\n"
    );
}

#[test]
fn pages_show_the_code_of_the_examples() {
    let pages = pages();
    let blocks: Vec<&str> = pages
        .iter()
        .flat_map(|(_, text)| blocks(text, "rust"))
        .collect();
    let examples: Vec<String> = [
        "with_macro/src/lib.rs",
        "with_macro/src/main.rs",
        "with_macro/src/bin/jacobian.rs",
        "with_macro/src/bin/regimes.rs",
        "with_build_script/build.rs",
        "with_build_script/src/lib.rs",
        "with_command_line/controller.rs",
        "with_library/main.rs",
        "recipes/family_of_orders.rs",
    ]
    .iter()
    .map(|file| std::fs::read_to_string(project().join("examples").join(file)).expect("a file"))
    .collect();
    for block in &blocks {
        let shown = examples.iter().any(|example| example.contains(*block));
        assert!(shown, "no example contains:\n{block}");
    }
    for example in &examples {
        let shown = blocks.iter().any(|block| example.contains(*block));
        assert!(shown, "no page contains:\n{example}");
    }
}

#[test]
fn specification_inside_a_macro_can_be_certified() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("pendulum.toml");
    std::fs::write(&file, with_macro::pendulum::SPECIFICATION).expect("writable");
    let output = run(&["validate", &file.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

fn cargo_tree(package: &str, edges: &str) -> Vec<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["tree", "--offline", "--locked", "--prefix", "none"])
        .args(["--package", package, "--edges", edges, "--format", "{lib}"])
        .current_dir(project())
        .output()
        .expect("cargo can be run");
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).expect("names");
    text.lines().map(str::to_owned).collect()
}

#[test]
fn eomgen_has_no_runtime_dependencies() {
    assert_eq!(cargo_tree("eomgen", "normal,no-proc-macro"), ["eomgen"]);
    let example = cargo_tree("eomgen-example-with-build-script", "normal");
    assert_eq!(example, ["with_build_script"]);
}

#[test]
fn macro_and_build_script_depend_on_no_solver() {
    for package in ["eomgen", "eomgen-build"] {
        let packages = cargo_tree(package, "normal");
        let has = |name: &str| packages.iter().any(|package| package.starts_with(name));
        assert!(
            has("eomgen_codegen") && has("eomgen_model_spec"),
            "{packages:?}"
        );
        for heavy in [
            "clap",
            "cranelift",
            "parquet",
            "eomgen_sim",
            "rayon",
            "nalgebra",
        ] {
            assert!(!has(heavy), "{package} builds {heavy}");
        }
    }
}
