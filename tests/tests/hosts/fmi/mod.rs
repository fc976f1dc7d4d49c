//! Functional mock-up units: their sources compile without a warning, the same specification gives
//! the same bytes, FMPy validates them and simulates both kinds like `simulate`, CasADi's
//! `DaeBuilder` differentiates them, and invalid calls return an error status.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_tests::models::path;
use eomgen_tests::program::{eomgen, run_accepted, run_rejected};

const VERSIONS: [&str; 2] = ["fmu2", "fmu3"];

fn write_unit(name: &str, order: Option<&str>, target: &str, folder: &Path) -> PathBuf {
    let out = folder.join(target);
    let mut command = eomgen();
    command
        .arg("generate")
        .arg(path(name))
        .arg("--out")
        .arg(&out);
    command.args(["--target", target]);
    if let Some(order) = order {
        command.args(["--order", order]);
    }
    let output = command.output().expect("the program can be run");
    assert!(output.status.success(), "{output:?}");
    out.join(format!("{name}.fmu"))
}

fn succeeds(command: &mut Command) -> bool {
    command.output().is_ok_and(|output| output.status.success())
}

/// Returns true if there are a C compiler and a Python with these packages; otherwise reports the
/// skip.
fn is_available(packages: &str, what: &str) -> bool {
    let python = succeeds(Command::new("python3").args(["-c", &format!("import {packages}")]));
    let compiler = succeeds(Command::new("cc").arg("--version"));
    if !(python && compiler) {
        skips::skip(&format!(
            "{what}: cc or python3 with {packages} is missing (pip install fmpy casadi numpy)"
        ));
    }
    python && compiler
}

fn run_python(script: &str, arguments: &[&str]) {
    let place = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hosts/fmi")).join(script);
    let output = Command::new("python3")
        .arg(place)
        .args(arguments)
        .output()
        .expect("python can be run");
    assert!(
        output.status.success(),
        "{script} {arguments:?}: {}\n{}\n{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn sources_compile_without_a_warning() {
    if !is_available(
        "zipfile",
        "the sources of functional mock-up units were not compiled",
    ) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (name, order) in [
        ("pendulum", None),
        ("emps", None),
        ("planetary_arm", Some("1")),
    ] {
        for target in VERSIONS {
            let unit = write_unit(name, order, target, folder.path());
            let out = folder.path().join(format!("{target}_{name}"));
            let arguments = ["-m", "zipfile", "-e"];
            assert!(succeeds(
                Command::new("python3").args(arguments).arg(&unit).arg(&out)
            ));
            let output = Command::new("cc")
                .args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"])
                .args(["-O1", "-fPIC", "-c", "fmu.c", "-o", "fmu.o"])
                .current_dir(out.join("sources"))
                .output()
                .expect("cc can be run");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{name} {target}: {said}");
        }
    }
}

#[test]
fn units_are_reproducible() {
    let folders = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    for target in VERSIONS {
        let [one, other] = folders.each_ref().map(|folder| {
            std::fs::read(write_unit("furuta_pendulum", None, target, folder.path()))
                .expect("a unit")
        });
        assert!(one == other, "{target}");
    }
}

#[test]
fn both_kinds_of_units_match_simulate() {
    let what = "functional mock-up units were not simulated";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (name, order, until, tolerance, limit) in [
        ("pendulum", None, "2", "1e-9", "1e-6"),
        ("furuta_pendulum", None, "1", "1e-9", "1e-5"),
        ("hub_beam_tip_mass", Some("2"), "0.05", "1e-10", "1e-4"),
        // Deflections are some micrometres, so an absolute tolerance relative to 1 m must be small.
        ("planetary_arm", Some("2"), "0.05", "1e-11", "1e-4"),
    ] {
        let table = folder.path().join(format!("{name}.csv"));
        let (spec, out) = (path(name), table.to_string_lossy().into_owned());
        let spec = spec.to_string_lossy();
        let sample = until.parse::<f64>().expect("a time") / 100.0;
        let sample = sample.to_string();
        let mut arguments = vec!["simulate", &spec, "--until", until, "--out", &out];
        arguments.extend(["--interval", &sample]);
        if let Some(order) = order {
            arguments.extend(["--order", order]);
        }
        run_accepted(&arguments);
        for target in VERSIONS {
            let unit = write_unit(name, order, target, folder.path());
            let unit = unit.to_string_lossy();
            run_python("motion.py", &[&unit, &out, tolerance, limit]);
        }
    }
}

#[test]
fn casadi_differentiates_unit() {
    let what = "CasADi did not import functional mock-up units";
    if !is_available("casadi, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (name, order) in [
        ("furuta_pendulum", None),
        ("emps", None),
        ("planetary_arm", Some("1")),
    ] {
        for target in VERSIONS {
            let unit = write_unit(name, order, target, folder.path());
            run_python("derivatives.py", &[&unit.to_string_lossy()]);
        }
    }
}

#[test]
fn invalid_calls_return_error_status() {
    let what = "functional mock-up units were not called wrongly";
    if !is_available("ctypes, zipfile", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for target in VERSIONS {
        for (name, order) in [("furuta_pendulum", None), ("planetary_arm", Some("1"))] {
            let unit = write_unit(name, order, target, folder.path());
            run_python("hostile.py", &[&unit.to_string_lossy(), target]);
        }
    }
}

#[test]
fn unit_without_compiler_contains_sources_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = eomgen()
        .arg("generate")
        .arg(path("pendulum"))
        .args(["--target", "fmu3", "--out"])
        .arg(folder.path())
        .env("PATH", folder.path())
        .output()
        .expect("the program can be run");
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("contains sources but no binary"), "{said}");
    assert!(folder.path().join("pendulum.fmu").is_file());
}

#[test]
fn with_is_rejected_for_units() {
    let spec = path("pendulum");
    let spec = spec.to_string_lossy();
    for (options, reason) in [
        (
            ["--with", "jacobians"],
            "the standard defines its functions",
        ),
        (["--with", "lanes"], "needs --target rust"),
    ] {
        let mut arguments = vec!["generate", &spec, "--target", "fmu2", "--out", "x"];
        arguments.extend(options);
        let said = run_rejected(&arguments);
        assert!(said.contains(reason), "{said}");
    }
}
