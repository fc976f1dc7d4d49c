//! Test of identification in MuJoCo and discovery with the same records: `examples/measured/identify.py` runs, and its
//! table agrees with the parameters of the simulated stage. Skipped with a message if MuJoCo is missing.

use std::process::{Command, Output};

use eomgen_tests::models::project;
use eomgen_tests::program::{self, text};

const NO_PYTHON: &str = "MuJoCo was not compared with discovery: python3 is missing";
const NO_TOOLBOX: &str = "MuJoCo was not compared with discovery: its toolbox sysid is missing \
                          (pip install 'mujoco[sysid]')";
/// RMS of the noise in the records, in mm.
const NOISE: f64 = 0.02;

fn run(options: &[&str]) -> Option<Output> {
    let output = Command::new("python3")
        .args(options)
        .arg(project().join("examples/measured/identify.py"))
        .env("EOMGEN_PROGRAM", program::path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("PYTHONIOENCODING", "utf-8")
        .output()
        .ok();
    if output.is_none() {
        skips::skip(NO_PYTHON);
    }
    output
}

/// Returns the cells of a table row.
fn cells<'a>(table: &'a str, title: &str) -> Vec<&'a str> {
    let start = format!("| {title} |");
    let row = table.lines().find(|line| line.starts_with(&start));
    row.expect(title).split('|').map(str::trim).collect()
}

fn number(cell: &str) -> f64 {
    let value = cell.split(" ±").next().unwrap_or_default();
    value.parse().unwrap_or_else(|_| panic!("{cell:?}"))
}

fn half_width(cell: &str) -> f64 {
    number(cell.split("± ").nth(1).expect("an interval"))
}

#[test]
fn missing_toolbox_is_an_error_with_the_command_that_installs_it() {
    // The options `-I -S` exclude all installed packages of this machine.
    let Some(output) = run(&["-I", "-S"]) else {
        return;
    };
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.contains("pip install \"mujoco[sysid]\""),
        "{message}"
    );
    assert!(!message.contains("Traceback"), "{message}");
    assert!(output.stdout.is_empty(), "{}", text(&output.stdout));
}

#[test]
fn identification_misses_the_effect_that_discovery_names() {
    let toolbox = ["-c", "from mujoco import sysid; sysid.optimize"];
    let found = Command::new("python3").args(toolbox).output();
    if !found.is_ok_and(|output| output.status.success()) {
        skips::skip(NO_TOOLBOX);
        return;
    }
    let Some(output) = run(&[]) else { return };
    let table = text(&output.stdout);
    assert!(output.status.success(), "{table}{}", text(&output.stderr));
    let identified = cells(&table, "MuJoCo, without dry friction");
    let [damping, first] = [3, 5].map(|column| number(identified[column]));
    assert!(damping - 12.0 > 10.0 * half_width(identified[3]), "{table}");
    assert!(first > 100.0 * NOISE, "{table}");
    let discovered = cells(&table, "`eomgen discover`");
    for (column, truth) in [(3, 12.0), (4, 2.5)] {
        let error = number(discovered[column]) - truth;
        assert!(
            error.abs() < 2.0 * half_width(discovered[column]),
            "{table}"
        );
    }
    for column in [5, 6] {
        assert!(number(discovered[column]) < 1.3 * NOISE, "{table}");
    }
}
