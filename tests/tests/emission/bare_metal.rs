//! Tests of the example controller and observer on emulated microcontrollers. `examples/bare_metal/run` and
//! `examples/bare_metal/observe` run with the currently emitted arm in Rust and in C. A test is skipped with a message
//! if the emulator or the compiler's target is missing; the C part is skipped if its compiler is missing.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use eomgen_codegen::c;
use eomgen_codegen::program::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_tests::models::{load, project, variant};
use eomgen_tests::program::eomgen;

/// File with recorded counts; EOMGEN_REFRESH rewrites it.
const COUNTS: &str = "examples/bare_metal/counts.txt";
const OBSERVER_COUNTS: &str = "examples/bare_metal/observer_counts.txt";
const MACHINE_COUNTS: &str = "examples/bare_metal/machine_counts.txt";

/// Maximum increase of a count in percent; compilers differ slightly.
const MAX_RISE_PERCENT: u64 = 5;

fn is_available(program: &str) -> bool {
    let output = Command::new(program).arg("--version").output();
    output.is_ok_and(|output| output.status.success())
}

/// Returns true if the C part can be compiled; otherwise reports the skip.
fn has_c_compilers() -> bool {
    let there = is_available("arm-none-eabi-gcc") && is_available("cc");
    if !there {
        skips::skip(
            "the controller in C was not run on microcontrollers: \
             arm-none-eabi-gcc or cc is missing (Debian: apt-get install gcc-arm-none-eabi gcc)",
        );
    }
    there
}

fn missing_tool() -> Option<&'static str> {
    if !is_available("qemu-system-arm") {
        return Some("qemu-system-arm (Debian: apt-get install qemu-system-arm)");
    }
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let libraries = Command::new(rustc)
        .args([
            "--print",
            "target-libdir",
            "--target",
            "thumbv7em-none-eabihf",
        ])
        .output();
    let there = libraries.is_ok_and(|output| {
        let folder = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        std::path::Path::new(&folder).is_dir()
    });
    (!there).then_some("the target (rustup target add thumbv7em-none-eabihf)")
}

fn parse_counts(text: &str) -> Vec<(&str, u64)> {
    let parts = text.lines().filter_map(|line| line.rsplit_once(' '));
    parts
        .map(|(name, number)| (name, number.parse().expect("a number")))
        .collect()
}

/// Runs a script of the example with the emitted arm; returns its stdout and stderr.
fn run_script(script: &str, arm: &Path) -> (String, String) {
    let output = Command::new("bash")
        .arg(project().join("examples/bare_metal").join(script))
        .arg(arm)
        .arg(arm.parent().expect("a folder"))
        .output()
        .expect("bash");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{printed}{said}");
    (printed, said)
}

/// Asserts that no count exceeds its recorded value by more than [`MAX_RISE_PERCENT`] percent. Without
/// `with_c`, lines of the C part are ignored.
fn assert_no_count_has_risen(kept_at: &str, printed: &str, with_c: bool) {
    let path = project().join(kept_at);
    if with_c && std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, printed.as_bytes()).expect("written");
    }
    let kept = std::fs::read_to_string(path).expect("the recorded counts");
    let (mut kept, now) = (parse_counts(&kept), parse_counts(printed));
    if !with_c {
        kept.retain(|(name, _)| !name.ends_with(" in C"));
    }
    assert_eq!(kept.len(), now.len(), "{printed}");
    let mut risen = String::new();
    for ((name, kept), (same, now)) in kept.iter().zip(&now) {
        assert_eq!(name, same);
        if 100 * now > (100 + MAX_RISE_PERCENT) * kept {
            writeln!(risen, "{name}: {now} instead of {kept}").expect("a string");
        }
    }
    assert!(
        risen.is_empty(),
        "{risen}if this is intended: EOMGEN_REFRESH=1 cargo test --release -p eomgen-tests --test emission bare_metal"
    );
}

/// The script compares the motion bit for bit and rejects panics and allocators in the program.
#[test]
fn controller_on_microcontrollers_matches_this_machine_bitwise() {
    if let Some(missing) = missing_tool() {
        skips::skip(&format!(
            "the controller was not run on microcontrollers: {missing} is missing"
        ));
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let arm = folder.path().join("arm.rs");
    let derived = variant(&load("planetary_arm_rig"), 4);
    let source = emit(derived.evaluator.program(), Packaging::Crate).expect("emitted");
    std::fs::write(&arm, source).expect("written");
    let with_c = has_c_compilers();
    if with_c {
        let files = c::emit(derived.evaluator.program()).expect("emitted");
        for (ending, text) in [("h", files.header), ("c", files.source)] {
            let path = folder.path().join(format!("planetary_arm_rig.{ending}"));
            std::fs::write(path, text).expect("written");
        }
    }
    assert_no_count_has_risen(COUNTS, &run_script("run", &arm).0, with_c);
}

/// The observer runs for half a second with sensors that fail temporarily. The script compares the estimates bit for
/// bit; the program on this machine asserts the final estimate.
#[test]
fn observer_on_microcontroller_matches_this_machine_bitwise() {
    if let Some(missing) = missing_tool() {
        skips::skip(&format!(
            "the observer was not run on a microcontroller: {missing} is missing"
        ));
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let arm = folder.path().join("arm.rs");
    let outputs = [Output::Jacobians];
    let derived = Variant::derive_with(&load("planetary_arm_rig"), &[4], &outputs);
    let source = emit(&derived.expect("derived").program, Packaging::Crate).expect("emitted");
    std::fs::write(&arm, source).expect("written");
    let (printed, said) = run_script("observe", &arm);
    assert_no_count_has_risen(OBSERVER_COUNTS, &printed, true);
    let page = std::fs::read_to_string(project().join("docs/controllers.md")).expect("the page");
    let errors: Vec<&str> = said.lines().filter(|line| !line.is_empty()).collect();
    assert!(
        page.contains(&errors.join("\n")),
        "docs/controllers.md does not print: {said}"
    );
}

/// Largest relative difference of a machine's instruction counts between states, in percent.
const MAX_SPREAD_PERCENT: u64 = 5;

/// Machines with angles run in single precision. The firmware contains its identity and passes its self-test, the rates
/// are bit-identical to this machine, and no count increases.
#[test]
fn machines_with_angles_on_microcontrollers_match_this_machine_bitwise() {
    if let Some(missing) = missing_tool() {
        skips::skip(&format!(
            "machines with angles were not run on microcontrollers: {missing} is missing"
        ));
        return;
    }
    if !has_c_compilers() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new("bash");
    command.arg(project().join("examples/bare_metal/count"));
    let gimbal = project().join("tests/features/gimbal.toml");
    for (name, specification) in [
        ("gimbal", gimbal),
        (
            "puma_560",
            project().join("model-spec/models/puma_560.toml"),
        ),
        (
            "planetary_arm",
            project().join("model-spec/models/planetary_arm.toml"),
        ),
    ] {
        let out = folder.path().join(name);
        for target in ["rust", "c99"] {
            let output = eomgen()
                .args([
                    "generate",
                    "--with",
                    "self_test",
                    "--target",
                    target,
                    "--out",
                ])
                .args([&out, &specification])
                .output();
            assert!(output.expect("eomgen").status.success());
        }
        command.arg(out);
    }
    let output = command.output().expect("bash");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success(),
        "{printed}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let path = project().join(MACHINE_COUNTS);
    if std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, &printed).expect("written");
    }
    let kept = std::fs::read_to_string(path).expect("the recorded counts");
    assert_eq!(kept.lines().count(), printed.lines().count(), "{printed}");
    for (kept, now) in kept.lines().zip(printed.lines()) {
        let [_, most_before, _] = machine_counts(kept);
        let [least, most, _] = machine_counts(now);
        assert!(
            100 * most <= (100 + MAX_RISE_PERCENT) * most_before,
            "{kept}\n{now}"
        );
        assert!(100 * (most - least) <= MAX_SPREAD_PERCENT * least, "{now}");
    }
}

/// Returns the smallest and the largest number of instructions, and the stack in bytes.
fn machine_counts(line: &str) -> [u64; 3] {
    let mut words = line.rsplit(' ').map(|word| word.parse().expect("a number"));
    let mut next = || words.next().expect("three numbers");
    let [stack, most, least] = [next(), next(), next()];
    [least, most, stack]
}
