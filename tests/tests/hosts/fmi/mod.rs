//! Tests of functional mock-up units. The same specification gives the same bytes. FMPy validates the units, and
//! simulations of both kinds agree with `simulate`, also with sticking, impacts, corners and constraints. CasADi's
//! `DaeBuilder` differentiates the units. Invalid calls return an error status.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_tests::models::{path, project};
use eomgen_tests::program::{eomgen, run_accepted, run_rejected};

const VERSIONS: [&str; 2] = ["fmu2", "fmu3"];

fn write_unit(name: &str, order: Option<&str>, target: &str, folder: &Path) -> PathBuf {
    write_unit_of(&path(name), order, target, folder)
}

fn write_unit_of(spec: &Path, order: Option<&str>, target: &str, folder: &Path) -> PathBuf {
    let out = folder.join(target);
    let mut command = eomgen();
    command.arg("generate").arg(spec).arg("--out").arg(&out);
    command.args(["--target", target]);
    if let Some(order) = order {
        command.args(["--order", order]);
    }
    let output = command.output().expect("the program can be run");
    assert!(output.status.success(), "{output:?}");
    let name = spec.file_stem().expect("a file").to_string_lossy();
    out.join(format!("{name}.fmu"))
}

fn succeeds(command: &mut Command) -> bool {
    command.output().is_ok_and(|output| output.status.success())
}

/// Returns true if a Python with these packages is installed; otherwise reports the skip.
fn is_available(packages: &str, what: &str) -> bool {
    let python = succeeds(Command::new("python3").args(["-c", &format!("import {packages}")]));
    if !python {
        skips::skip(&format!(
            "{what}: python3 with {packages} is missing (pip install fmpy casadi numpy)"
        ));
    }
    python
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
        // Deflections are some micrometres, so the tolerance must be small compared with the nominal values.
        ("planetary_arm", Some("2"), "0.05", "1e-11", "1e-4"),
    ] {
        compare_with_simulate(&path(name), order, until, (tolerance, limit), folder.path());
    }
}

#[test]
fn units_stick_bounce_and_start_on_constraints_like_simulate() {
    let what = "units with friction, impacts and constraints were not simulated";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let own = project().join("tests/tests/hosts/fmi/units");
    let examples = project().join("examples/impacts");
    for (spec, until, limit) in [
        (own.join("held_pendulum.toml"), "4", "1e-5"),
        (own.join("held_block.toml"), "4", "1e-5"),
        (own.join("slider_crank.toml"), "2", "1e-5"),
        (own.join("mass_step.toml"), "3", "1e-5"),
        (own.join("puck.toml"), "3", "1e-5"),
        (own.join("tabulated.toml"), "0.1", "1e-5"),
        // The ball stops bouncing after 4.06 s. Impacts amplify small differences.
        (examples.join("bouncing_ball.toml"), "5", "1e-4"),
        (examples.join("box_with_friction.toml"), "1.5", "1e-3"),
    ] {
        compare_with_simulate(&spec, None, until, ("1e-9", limit), folder.path());
    }
}

fn compare_with_simulate(
    spec: &Path,
    order: Option<&str>,
    until: &str,
    (tolerance, limit): (&str, &str),
    folder: &Path,
) {
    let name = spec
        .file_stem()
        .expect("a file")
        .to_string_lossy()
        .into_owned();
    let table = folder.join(format!("{name}.csv"));
    let (text, out) = (spec.to_string_lossy(), table.to_string_lossy().into_owned());
    let sample = until.parse::<f64>().expect("a time") / 100.0;
    let sample = sample.to_string();
    let mut arguments = vec!["simulate", &text, "--until", until, "--out", &out];
    arguments.extend(["--interval", &sample]);
    if let Some(order) = order {
        arguments.extend(["--order", order]);
    }
    run_accepted(&arguments);
    for target in VERSIONS {
        let unit = write_unit_of(spec, order, target, folder);
        let unit = unit.to_string_lossy();
        run_python("motion.py", &[&unit, &out, tolerance, limit, "1e-6"]);
    }
}

#[test]
fn friction_in_units_sticks_until_inputs_change() {
    let what = "units were not moved through rest";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (name, coordinate, input, strong) in [
        ("held_pendulum", "phi", "M", "4"),
        ("held_block", "x", "u", "20"),
    ] {
        let spec = project().join(format!("tests/tests/hosts/fmi/units/{name}.toml"));
        for target in VERSIONS {
            let unit = write_unit_of(&spec, None, target, folder.path());
            let unit = unit.to_string_lossy();
            run_python("rest.py", &[&unit, coordinate, input, strong, "4"]);
        }
    }
}

#[test]
fn units_sample_controllers_like_simulate() {
    let what = "units with sampled controllers were not simulated";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let spec = project().join("tests/tests/hosts/fmi/units/sampled_block.toml");
    let (text, table) = (spec.to_string_lossy(), folder.path().join("sampled.csv"));
    let table = table.to_string_lossy();
    // Steps of 20 ms end at samples of the controllers and between them; steps of 37 ms end mostly between samples.
    for interval in ["0.02", "0.037"] {
        let simulate = ["simulate", &text, "--until", "1.48", "--input", "r=0.2"];
        let rows = ["--interval", interval, "--out", &table];
        run_accepted(&[&simulate[..], &rows].concat());
        for target in VERSIONS {
            let unit = write_unit_of(&spec, None, target, folder.path());
            run_python("sampled.py", &[&unit.to_string_lossy(), &table, "1e-6"]);
        }
    }
}

#[test]
fn both_kinds_of_units_with_controllers_match_simulate() {
    let what = "units with sampled controllers were not simulated";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let own = project().join("tests/tests/hosts/fmi/units");
    let loops = project().join("examples/closed_loop");
    for (spec, until, (tolerance, limit)) in [
        // Dry friction, two periods, a quantised output, a delay longer than the period.
        (own.join("sampled_block.toml"), "1.5", ("1e-9", "1e-5")),
        (own.join("sampled_ball.toml"), "2", ("1e-9", "1e-5")),
        (loops.join("regulator.toml"), "0.2", ("1e-11", "1e-5")),
        (own.join("released_arm.toml"), "0.02", ("1e-12", "1e-4")),
    ] {
        compare_with_simulate(&spec, None, until, (tolerance, limit), folder.path());
    }
}

#[test]
fn controllers_are_sampled_at_time_events() {
    let what = "time events of units were not applied";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let spec = project().join("tests/tests/hosts/fmi/units/sampled_ball.toml");
    for target in VERSIONS {
        let unit = write_unit_of(&spec, None, target, folder.path());
        run_python("time_events.py", &[&unit.to_string_lossy()]);
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
    for name in ["held_pendulum", "slider_crank", "puck", "sampled_block"] {
        let spec = project().join(format!("tests/tests/hosts/fmi/units/{name}.toml"));
        for target in VERSIONS {
            let unit = write_unit_of(&spec, None, target, folder.path());
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
fn units_contain_settings_and_extended_specifications() {
    let what = "a unit with settings was not simulated";
    if !is_available("fmpy, numpy", what) {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let own = project().join("tests/tests/hosts/fmi/units/held_block.toml");
    std::fs::copy(own, folder.path().join("base.toml")).expect("a copy");
    let spec = folder.path().join("stiff_block.toml");
    let text = "[model]\nextends = \"base.toml\"\nname = \"stiff_block\"\n[parameters]\n\
                k = { value = 90, unit = \"N/m\" }\n";
    std::fs::write(&spec, text).expect("a file");
    let (text, table) = (spec.to_string_lossy(), folder.path().join("set.csv"));
    let table = table.to_string_lossy();
    let set = ["--set", "F=2", "--set", "m=1.3"];
    let simulate = [
        &["simulate", &text, "--until", "2", "--interval", "0.02"],
        &set[..],
    ]
    .concat();
    run_accepted(&[&simulate[..], &["--out", &table]].concat());
    for target in VERSIONS {
        let out = folder.path().join(target);
        let out = out.to_string_lossy();
        let generate = ["generate", &text, "--target", target, "--out", &out];
        run_accepted(&[&generate[..], &set[..]].concat());
        let unit = format!("{out}/stiff_block.fmu");
        run_python("motion.py", &[&unit, &table, "1e-9", "1e-5", "1e-6"]);
    }
}

/// The copy of the program has no library for units, as in an incomplete installation.
#[test]
fn missing_library_is_reported_with_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let program = folder.path().join("eomgen");
    std::fs::copy(eomgen_tests::program::path(), &program).expect("a copy");
    let output = Command::new(&program)
        .arg("generate")
        .arg(path("pendulum"))
        .args(["--target", "fmu3", "--out"])
        .arg(folder.path())
        .output()
        .expect("the program can be run");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("eomgen_unit"), "{message}");
    assert!(message.contains("copy it there"), "{message}");
    assert!(!folder.path().join("pendulum.fmu").exists());
}

#[test]
fn units_contain_tables_of_their_specification() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = project().join("tests/tests/hosts/fmi/units/tabulated.toml");
    let unit = std::fs::read(write_unit_of(&spec, None, "fmu3", folder.path())).expect("a unit");
    let text = String::from_utf8_lossy(&unit);
    for name in ["resources/tabulated.toml", "resources/tables/shapes.csv"] {
        assert!(text.contains(name), "{name}");
    }
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
