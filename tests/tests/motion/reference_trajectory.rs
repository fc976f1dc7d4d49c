//! Comparison of the arm with four modes, simulated by the program, with trajectories of higher precision than
//! required.

use std::collections::HashMap;
use std::path::Path;

use eomgen_tests::models::path;
use eomgen_tests::program::run_accepted;

/// Trajectory with a row every 0.01 s. Two codes in quadruple precision agree in all its digits.
const REFERENCE: &str = include_str!("../../reference/trajectory_order4.csv");

/// Simulated time, in s.
const UNTIL: f64 = 2.0;
const SWITCHES: u64 = 965;

/// Maximum deviations over two seconds, in m: rounding errors of the exact solver, amplified by 965 switches.
const TOLERANCES: [(&str, f64); 2] = [("x_sp", 1e-12), ("tip", 1e-11)];

/// Maximum deviation of the general solver over one second at a relative tolerance of 1e-10, in m. The actual deviation
/// is 6e-13 m; the documented one is 1e-8 m.
const GENERAL_TOLERANCE: f64 = 1e-11;

/// Regression data: t, x_sp, x_pr, x_c and tip, in s and m, from the general solver at `--tolerance
/// 1e-13`, rounded to 1e-12 m.
const REGRESSION: [[f64; 5]; 4] = [
    [
        0.1,
        -0.000019020130,
        -0.000005730122,
        0.061885813195,
        0.000025474410,
    ],
    [
        0.25,
        0.000025393122,
        0.000025304438,
        0.143584789566,
        -0.002412035439,
    ],
    [
        0.5,
        -0.000024339010,
        -0.000010518978,
        0.342015990910,
        0.000180874641,
    ],
    [
        1.0,
        0.000025128679,
        0.000004240045,
        0.702212743607,
        -0.000604270124,
    ],
];

type Columns = HashMap<String, Vec<f64>>;

fn columns(text: &str) -> Columns {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let mut columns: Columns = names
        .iter()
        .map(|name| ((*name).to_owned(), Vec::new()))
        .collect();
    for line in lines {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|field| field.parse().expect("a number"))
            .collect();
        assert_eq!(numbers.len(), names.len(), "{line}");
        for (name, number) in names.iter().zip(numbers) {
            columns.get_mut(*name).expect("a column").push(number);
        }
    }
    columns
}

/// Simulates the paper's case with one row every `sample` seconds; returns the columns and the report.
fn simulate(
    folder: &Path,
    until: f64,
    sample: &str,
    solver: &[&str],
) -> (Columns, serde_json::Value) {
    let file = folder.join("a.csv").display().to_string();
    let (arm, until) = (
        path("planetary_arm").display().to_string(),
        until.to_string(),
    );
    let case = ["--order", "4", "--until", &until, "--interval", sample];
    let play = ["--set", "b_sp=25e-6", "--set", "b_pr=25e-6"];
    let ripple = ["--set", "omega=31.41592653589793"];
    let mut arguments = vec!["simulate", &arm, "--json", "--out", &file];
    arguments.extend(case.iter().chain(&play).chain(&ripple).chain(solver));
    let work = serde_json::from_str(&run_accepted(&arguments)).expect("one document");
    let table = std::fs::read_to_string(&file).expect("a table");
    (columns(&table), work)
}

fn deviation(found: &[f64], expected: &[f64]) -> f64 {
    assert!(!expected.is_empty() && found.len() >= expected.len());
    let differences = found
        .iter()
        .zip(expected)
        .map(|(found, expected)| (found - expected).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn arm_matches_quadruple_precision_trajectory() {
    let expected = columns(REFERENCE);
    assert_eq!(expected["t"].len(), 201);
    let folder = tempfile::tempdir().expect("a folder");
    let (found, work) = simulate(folder.path(), UNTIL, "0.01", &[]);
    assert_eq!(work["solver"], "exact");
    assert_eq!(work["switches"], SWITCHES);
    // The times of the reference are multiples of the interval with an additional rounding.
    assert_eq!(found["t"].len(), expected["t"].len());
    assert!(deviation(&found["t"], &expected["t"]) <= 4.0 * f64::EPSILON);
    for (name, tolerance) in TOLERANCES {
        let worst = deviation(&found[name], &expected[name]);
        println!("{name}: {worst:.1e} m");
        assert!(worst <= tolerance, "{name} deviates by {worst:e} m");
    }
}

#[test]
fn both_solvers_match_regression_trajectory() {
    let folder = tempfile::tempdir().expect("a folder");
    for solver in [
        &["--solver", "exact"][..],
        &["--solver", "rk", "--tolerance", "1e-10"],
    ] {
        let (found, work) = simulate(folder.path(), 1.0, "0.001", solver);
        assert_eq!(work["solver"], solver[1]);
        assert_eq!(found["t"].len(), 1001);
        assert_matches_regression(&found);
    }
}

fn assert_matches_regression(found: &Columns) {
    for [t, expected @ ..] in REGRESSION {
        let row = (t * 1000.0).round() as usize;
        assert!((found["t"][row] - t).abs() < 1e-15);
        for (name, expected) in ["x_sp", "x_pr", "x_c", "tip"].into_iter().zip(expected) {
            let value = found[name][row];
            let deviation = (value - expected).abs();
            assert!(
                deviation <= GENERAL_TOLERANCE,
                "{name} at {t} s: {value}, expected {expected}"
            );
        }
    }
}
