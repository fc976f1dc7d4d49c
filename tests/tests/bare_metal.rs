//! The example controller on emulated microcontrollers: `examples/bare_metal/run` with the
//! arm as it is emitted now. Skipped, loudly, where the emulator or the compiler's target is
//! missing; a machine that has them may not fail.

use std::fmt::Write;
use std::process::Command;

use eomgen_codegen::rust::{Packaging, emit};
use eomgen_tests::models::{load, project, variant};

/// What the run is to print, refreshed with EOMGEN_REFRESH.
const KEPT: &str = "examples/bare_metal/counts.txt";

/// A rise of a count above what is kept that fails, in percent: compilers differ a little.
const RISE: u64 = 5;

/// What is missing for the run, if anything is.
fn missing() -> Option<&'static str> {
    let works = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).output();
        output.is_ok_and(|output| output.status.success())
    };
    if !works("qemu-system-arm", &["--version"]) {
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
    let output = Command::new("bash")
        .arg(project().join("examples/bare_metal/run"))
        .arg(&arm)
        .arg(folder.path())
        .output()
        .expect("bash");
    let (printed, said) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{printed}{said}");
    let path = project().join(KEPT);
    if std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, printed.as_bytes()).expect("written");
    }
    let kept = std::fs::read_to_string(path).expect("the counts as kept");
    let (kept, now) = (counts(&kept), counts(&printed));
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
        "{risen}if that is meant: EOMGEN_REFRESH=1 cargo test --release -p eomgen-tests --test bare_metal"
    );
}
