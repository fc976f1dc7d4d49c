//! Tests of controllers in a shared library (`simulate --controller`). Skipped with a message if there is no C
//! compiler.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use eomgen_tests::models::{path, project};
use eomgen_tests::program::{self, run_accepted, run_rejected, text};

fn has_compiler() -> bool {
    let output = Command::new("cc").arg("--version").output();
    let there = output.is_ok_and(|output| output.status.success());
    if !there {
        skips::skip(
            "controllers in libraries were not run: cc is missing (Debian: apt-get install gcc)",
        );
    }
    there
}

/// Compiles a library and returns its path.
fn compile(folder: &Path, name: &str, source: &Path) -> String {
    let library = folder.join(format!("lib{name}.so")).display().to_string();
    let output = Command::new("cc")
        .args([
            "-std=c99", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-O1", "-I",
        ])
        .arg(project().join("examples/controllers"))
        .arg(source)
        .args(["-o", &library])
        .output()
        .expect("cc");
    assert!(output.status.success(), "{name}: {}", text(&output.stderr));
    library
}

/// Valid controller library; tests replace single lines of it.
const SIMPLE: &str = r#"
#include "eomgen_controller.h"
uint32_t eomgen_controller_abi(void) { return EOMGEN_CONTROLLER_ABI; }
int32_t eomgen_controller_start(const eomgen_controller_model *model, eomgen_controller_schedule *schedule) {
    schedule->period = 0.01;
    schedule->outputs = 1;
    schedule->driven[0] = 0;
    return model->inputs == 1 ? 0 : 7;
}
int32_t eomgen_controller_sample(
    double t, const double *state, const double *observables, const double *inputs, double *outputs) {
    (void)state, (void)observables, (void)inputs;
    outputs[0] = 0.01 * t;
    return 0;
}
"#;

fn compile_changed(folder: &Path, name: &str, (line, other): (&str, &str)) -> String {
    assert!(SIMPLE.contains(line), "{line}");
    let source = folder.join(format!("{name}.c"));
    std::fs::write(&source, SIMPLE.replace(line, other)).expect("a file");
    compile(folder, name, &source)
}

#[test]
fn library_gives_the_motion_of_the_declared_controller() {
    if !has_compiler() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let source = project().join("examples/controllers/upright.c");
    let library = compile(folder.path(), "upright", &source);
    let pendulum = path("furuta_pendulum").display().to_string();
    std::fs::copy(path("furuta_pendulum"), file("furuta_pendulum.toml")).expect("a copy");
    let declared = "[model]\nname = \"declared\"\nextends = \"furuta_pendulum.toml\"\n[parameters]\nk_1 = { value = -0.3811, unit = \"N m/rad\" }\n\
         k_2 = { value = 3.3202, unit = \"N m/rad\" }\nk_3 = { value = -0.2212, unit = \"N m s/rad\" }\n\
         k_4 = { value = 0.3626, unit = \"N m s/rad\" }\nu_max = { value = 0.5, unit = \"N m\" }\n\
         [controllers.c]\nperiod = 2e-3\ndelay = 1e-3\n\
         outputs = { u = \"clamp(-k_1*phi - k_2*(theta - pi) - k_3*dot(phi) - k_4*dot(theta), -u_max, u_max)\" }\n";
    std::fs::write(file("declared.toml"), declared).expect("a file");
    for solver in [
        &["--solver", "rk"][..],
        &["--solver", "fixed", "--step", "1e-4"],
    ] {
        let rest = ["--until", "1", "--interval", "0.01", "--out"];
        let (own, other) = (file("own.csv"), file("other.csv"));
        let given = [
            &["simulate", &pendulum, "--controller", &library][..],
            &rest,
            &[&own],
            solver,
        ]
        .concat();
        let said = run_accepted(&given);
        assert!(!said.contains("is not driven"), "{said}");
        run_accepted(
            &[
                &["simulate", &file("declared.toml")][..],
                &rest,
                &[&other],
                solver,
            ]
            .concat(),
        );
        let [own, other] =
            [own, other].map(|table| std::fs::read_to_string(table).expect("a table"));
        let mut largest = 0.0_f64;
        for (own, other) in own.lines().zip(other.lines()).skip(1) {
            for (own, other) in own.split(',').zip(other.split(',')).take(5) {
                let number = |text: &str| text.parse::<f64>().expect("a number");
                assert!(
                    (number(own) - number(other)).abs() < 1e-9,
                    "{solver:?}: {own}, {other}"
                );
                largest = largest.max(number(own).abs());
            }
        }
        assert_eq!(own.lines().count(), other.lines().count());
        assert!(largest > 3.0);
    }
}

#[test]
fn faulty_libraries_are_rejected_with_their_cause() {
    if !has_compiler() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let file = |name: &str| folder.join(name).display().to_string();
    let pendulum = path("furuta_pendulum").display().to_string();
    let table = file("rows.csv");
    let simulate = |library: &str, more: &[&str]| -> Vec<String> {
        let rest = ["--until", "1", "--out", &table];
        let given = [
            &["simulate", &pendulum, "--controller", library][..],
            &rest,
            more,
        ]
        .concat();
        given.into_iter().map(str::to_owned).collect()
    };
    let rejected = |library: &str, more: &[&str], part: &str| {
        let given = simulate(library, more);
        let given: Vec<&str> = given.iter().map(String::as_str).collect();
        let said = run_rejected(&given);
        assert!(
            said.contains(part) && said.contains(library),
            "{part}: {said}"
        );
        assert!(!Path::new(&table).exists(), "{part}");
    };
    rejected(&file("none.so"), &[], "the controller cannot be read");
    std::fs::write(file("text.so"), "no library").expect("a file");
    rejected(&file("text.so"), &[], "not a library for this platform");
    let version = "return EOMGEN_CONTROLLER_ABI;";
    let driven = "schedule->driven[0] = 0;";
    for (place, (change, part)) in [
        (
            (version, "return 2;"),
            "version 2 of the interface, expected 1",
        ),
        (
            ("eomgen_controller_sample(", "sample("),
            "no function `eomgen_controller_sample`",
        ),
        (
            ("= 0.01;", "= 0;"),
            "the period of the controller is 0 s: expected a time above 0",
        ),
        (
            ("= 0.01;", "= 0.0/0.0;"),
            "the period of the controller is NaN s",
        ),
        (
            (driven, "schedule->driven[0] = 3; schedule->delay = 0;"),
            "the input with index 3",
        ),
        (
            (driven, "schedule->driven[0] = 0; schedule->delay = -1;"),
            "the delay of the controller is -1 s",
        ),
        (
            ("outputs = 1;", "outputs = 9;"),
            "drives 9 inputs, but the model has 1",
        ),
        (
            ("outputs = 1;", "delay = 0;"),
            "`outputs` of the controller is 0: the number of driven inputs must be set",
        ),
        (
            ("== 1 ? 0 : 7", "== 3 ? 0 : 7"),
            "rejects the model `furuta_pendulum`: eomgen_controller_start returned 7",
        ),
        (
            ("= 0.01 * t", "= 1 / (0.0 * t)"),
            "at t = 0.0 s the output `u` of the controller",
        ),
        (("return 0;\n}\n", "return t > 0.5 ? 4 : 0;\n}\n"), ""),
    ]
    .into_iter()
    .enumerate()
    {
        let library = compile_changed(folder, &format!("faulty_{place}"), change);
        if !part.is_empty() {
            rejected(&library, &[], part);
            continue;
        }
        // The rows before the stop are kept.
        let given = simulate(&library, &[]);
        let output = Command::new(program::path())
            .args(&given)
            .output()
            .expect("the program");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(
            said.contains("at t = 0.51 s the controller") && said.contains("status 4"),
            "{said}"
        );
        let rows = std::fs::read_to_string(&table).expect("rows");
        assert!(
            (500..520).contains(&rows.lines().count()),
            "{}",
            rows.lines().count()
        );
        std::fs::remove_file(&table).expect("removed");
    }
    let right = compile_changed(folder, "right", (version, version));
    rejected(
        &right,
        &["--input", "u=1"],
        "drives the input `u`, which --input also sets",
    );
    let regulator = project().join("examples/closed_loop/regulator.toml");
    let regulator = regulator.display().to_string();
    let said = run_rejected(&[
        "simulate",
        &regulator,
        "--controller",
        &right,
        "--until",
        "1",
        "--out",
        &table,
    ]);
    assert!(
        said.contains("two controllers drive the input `u`"),
        "{said}"
    );
}

#[test]
fn interrupt_ends_a_controller_that_does_not_return() {
    if !has_compiler() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let endless = (
        "outputs[0] = 0.01 * t;",
        "outputs[0] = t; for (volatile int i = 0;; ++i) {\n}",
    );
    let library = compile_changed(folder.path(), "endless", endless);
    let table = folder.path().join("rows.csv");
    let mut child = Command::new(program::path())
        .args([
            "simulate",
            &path("furuta_pendulum").display().to_string(),
            "--controller",
            &library,
        ])
        .args(["--until", "1", "--out", &table.display().to_string()])
        .stderr(Stdio::null())
        .spawn()
        .expect("the program");
    std::thread::sleep(Duration::from_millis(500));
    assert!(
        child.try_wait().expect("a status").is_none(),
        "the controller returned"
    );
    let interrupted = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupted.expect("kill").success());
    let status = child.wait().expect("a status");
    assert!(!status.success() && !table.exists());
}
