//! The example controller and its observer on emulated microcontrollers: `examples/bare_metal/run` with
//! the arm as it is emitted now, in Rust and in C, and `examples/bare_metal/observe`. Skipped, loudly, where the emulator or the
//! compiler's target is missing, and what is in C where its compiler is; a machine that has them
//! may not fail.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use eomgen_codegen::c;
use eomgen_codegen::program::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_tests::models::{load, project, variant};

/// What the runs are to print, refreshed with EOMGEN_REFRESH.
const KEPT: &str = "examples/bare_metal/counts.txt";
const KEPT_OF_THE_OBSERVER: &str = "examples/bare_metal/observer_counts.txt";

/// A rise of a count above what is kept that fails, in percent: compilers differ a little.
const RISE: u64 = 5;

/// Whether a program is there.
fn works(program: &str) -> bool {
    let output = Command::new(program).arg("--version").output();
    output.is_ok_and(|output| output.status.success())
}

/// Whether what is in C can be compiled; says so if not.
fn compilers_of_c() -> bool {
    let there = works("arm-none-eabi-gcc") && works("cc");
    if !there {
        skips::skip(
            "the controller in C was not run on microcontrollers, for want of \
             arm-none-eabi-gcc and cc (Debian: apt-get install gcc-arm-none-eabi gcc)",
        );
    }
    there
}

/// What is missing for the run, if anything is.
fn missing() -> Option<&'static str> {
    if !works("qemu-system-arm") {
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

/// Name and number of each line.
fn counts(text: &str) -> Vec<(&str, u64)> {
    let parts = text.lines().filter_map(|line| line.rsplit_once(' '));
    parts
        .map(|(name, number)| (name, number.parse().expect("a number")))
        .collect()
}

/// What a script of the example prints and what it says besides, given the emitted arm.
fn printed(script: &str, arm: &Path) -> (String, String) {
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

/// Asserts that no count has risen above what is kept; without what is in C where that was not run.
fn no_count_has_risen(kept_at: &str, printed: &str, with_c: bool) {
    let path = project().join(kept_at);
    if with_c && std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, printed.as_bytes()).expect("written");
    }
    let kept = std::fs::read_to_string(path).expect("the counts as kept");
    let (mut kept, now) = (counts(&kept), counts(printed));
    if !with_c {
        kept.retain(|(name, _)| !name.ends_with(" in C"));
    }
    assert_eq!(kept.len(), now.len(), "{printed}");
    let mut risen = String::new();
    for ((name, kept), (same, now)) in kept.iter().zip(&now) {
        assert_eq!(name, same);
        if 100 * now > (100 + RISE) * kept {
            writeln!(risen, "{name}: {now} instead of {kept}").expect("a string");
        }
    }
    assert!(
        risen.is_empty(),
        "{risen}if that is meant: EOMGEN_REFRESH=1 cargo test --release -p eomgen-tests --test emission bare_metal"
    );
}

/// The motion's bits are compared, and a panic or an allocator left in the program refused,
/// by the run itself.
#[test]
fn the_controller_runs_on_microcontrollers_with_the_bits_of_this_machine() {
    if let Some(missing) = missing() {
        skips::skip(&format!(
            "the controller was not run on microcontrollers, for want of {missing}"
        ));
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let arm = folder.path().join("arm.rs");
    let derived = variant(&load("planetary_arm_rig"), 4);
    let source = emit(derived.evaluator.program(), Packaging::Crate).expect("emitted");
    std::fs::write(&arm, source).expect("written");
    let with_c = compilers_of_c();
    if with_c {
        let files = c::emit(derived.evaluator.program()).expect("emitted");
        for (ending, text) in [("h", files.header), ("c", files.source)] {
            let path = folder.path().join(format!("planetary_arm_rig.{ending}"));
            std::fs::write(path, text).expect("written");
        }
    }
    no_count_has_risen(KEPT, &printed("run", &arm).0, with_c);
}

/// Half a second of the arm, which the observer sees by sensors that fail at times. Its bits are compared by
/// the run itself, and where the estimate ends asserted by the program that runs on this machine.
#[test]
fn the_observer_runs_on_a_microcontroller_with_the_bits_of_this_machine() {
    if let Some(missing) = missing() {
        skips::skip(&format!(
            "the observer was not run on a microcontroller, for want of {missing}"
        ));
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let arm = folder.path().join("arm.rs");
    let outputs = [Output::Jacobians];
    let derived = Variant::derive_with(&load("planetary_arm_rig"), &[4], &outputs);
    let source = emit(&derived.expect("derived").program, Packaging::Crate).expect("emitted");
    std::fs::write(&arm, source).expect("written");
    let (printed, said) = printed("observe", &arm);
    no_count_has_risen(KEPT_OF_THE_OBSERVER, &printed, true);
    let page = std::fs::read_to_string(project().join("docs/controllers.md")).expect("the page");
    let errors: Vec<&str> = said.lines().filter(|line| !line.is_empty()).collect();
    assert!(page.contains(&errors.join("\n")), "not on the page: {said}");
}
