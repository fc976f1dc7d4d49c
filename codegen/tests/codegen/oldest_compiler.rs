//! The oldest compiler that takes emitted code, as `docs/embedding.md` promises it.

use std::process::Command;

use eomgen_codegen::rust::{Packaging, emit};

use crate::support::{compile_by, program, program_with_all, shipped};

/// As `rustup` names it.
const OLDEST: &str = "1.77";

/// Whether `rustup` has that compiler here.
fn is_installed() -> bool {
    let listed = Command::new("rustup").args(["toolchain", "list"]).output();
    listed.is_ok_and(|output| {
        let text = String::from_utf8_lossy(&output.stdout);
        text.lines().any(|line| line.starts_with(OLDEST))
    })
}

#[test]
fn emitted_code_compiles_with_the_oldest_compiler() {
    if !is_installed() {
        skips::skip(&format!(
            "emitted code was not compiled with Rust {OLDEST}, which is not installed; \
             `rustup toolchain install {OLDEST} --profile minimal` gets it"
        ));
        return;
    }
    for name in [
        "pendulum",
        "hub_beam_tip_mass",
        "planetary_arm",
        "two_link_arm",
    ] {
        let model = shipped(name);
        for (what, program) in [
            ("", program(&model, 2)),
            ("_with_all", program_with_all(&model, 2)),
        ] {
            let source = emit(&program, Packaging::Crate).unwrap();
            for edition in ["2015", "2021"] {
                let mut compiler = Command::new("rustup");
                compiler.args(["run", OLDEST, "rustc"]);
                compile_by(
                    compiler,
                    &format!("oldest_{name}{what}"),
                    &source,
                    &["--edition", edition, "--emit=metadata"],
                );
            }
        }
    }
}
