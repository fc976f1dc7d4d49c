//! Compilation of emitted code with the oldest supported compiler; `docs/embedding.md` states its version.

use std::process::Command;

use eomgen_codegen::program::Program;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_model_spec::model::Model;

use crate::support::{compile_by, program, program_with_all, shipped};

/// Name of the toolchain for `rustup`.
const OLDEST: &str = "1.77";

/// Returns true if `rustup` has this toolchain.
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
             `rustup toolchain install {OLDEST} --profile minimal` installs it"
        ));
        return;
    }
    // All optional outputs are compiled for two models only, because the emission of outputs does not depend on the
    // model.
    std::thread::scope(|scope| {
        scope.spawn(|| {
            assert_compiles("planetary_arm", "", program);
            assert_compiles("planetary_arm", "_with_all", program_with_all);
        });
        for name in ["pendulum", "hub_beam_tip_mass", "two_link_arm"] {
            assert_compiles(name, "", program);
        }
        assert_compiles("hub_beam_tip_mass", "_with_all", program_with_all);
    });
}

fn assert_compiles(name: &str, what: &str, program: fn(&Model, usize) -> Program) {
    let source = emit(&program(&shipped(name), 2), Packaging::Crate).unwrap();
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
