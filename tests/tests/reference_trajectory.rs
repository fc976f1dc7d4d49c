//! The arm with four modes, simulated by the program, against trajectories known to more
//! digits than it is asked for.

use std::collections::HashMap;
use std::path::Path;

use eomgen_tests::models::path;
use eomgen_tests::program::eomgen;

/// A trajectory from two codes in quadruple precision that agree to its last digit; lies
/// beside the project.
const REFERENCE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../shared/reference/trajectory_order4.csv"
);

/// Deviation allowed, in m. A relative tolerance of 1e-10 leaves 6e-13 m after a second and
/// four hundred and eighty switches; 1e-8 m is what users are promised.
const TOLERANCE: f64 = 1e-11;

/// The project's own regression: t, x_sp, x_pr, x_c and tip, in s and m, as this program
/// computes them at `--tolerance 1e-13`, rounded to 1e-12 m.
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

/// Columns by their names.
type Columns = HashMap<String, Vec<f64>>;

fn read(path: &Path) -> Columns {
    let text = std::fs::read_to_string(path).expect("a table");
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

/// The paper's case for one second, a row per millisecond.
fn simulated(folder: &Path) -> Columns {
    let file = folder.join("a.csv");
    let mut command = eomgen();
    command
        .arg("simulate")
        .arg(path("planetary_arm"))
        .args(["--order", "4", "--until", "1"]);
    command.args([
        "--sample",
        "0.001",
        "--set",
        "b_sp=25e-6",
        "--set",
        "b_pr=25e-6",
    ]);
    command.args([
        "--set",
        "omega=31.41592653589793",
        "--tolerance",
        "1e-10",
        "--out",
    ]);
    command.arg(&file).assert().success();
    read(&file)
}

/// The largest difference between two columns.
fn deviation(found: &[f64], expected: &[f64]) -> f64 {
    assert!(!expected.is_empty() && found.len() >= expected.len());
    let differences = found
        .iter()
        .zip(expected)
        .map(|(found, expected)| (found - expected).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn the_arm_follows_the_trajectory_computed_in_quadruple_precision() {
    let reference = Path::new(REFERENCE);
    if !reference.is_file() {
        let _ = std::io::Write::write_fmt(
            &mut std::io::stderr(),
            format_args!("SKIPPED: no reference trajectory at {REFERENCE}\n"),
        );
        return;
    }
    let mut expected = read(reference);
    let rows = expected["t"].iter().take_while(|t| **t <= 1.0).count();
    assert_eq!(rows, 1001, "a row per millisecond for a second");
    for column in expected.values_mut() {
        column.truncate(rows);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let found = simulated(folder.path());
    assert_eq!(found["t"][..rows], expected["t"][..]);
    for name in ["x_sp", "tip"] {
        let worst = deviation(&found[name], &expected[name]);
        println!("{name}: {worst:.1e} m");
        assert!(worst <= TOLERANCE, "{name} deviates by {worst:e} m");
    }
}

#[test]
fn the_arm_follows_its_own_earlier_trajectory() {
    let folder = tempfile::tempdir().expect("a folder");
    let found = simulated(folder.path());
    assert_eq!(found["t"].len(), 1001);
    for [t, expected @ ..] in REGRESSION {
        let row = (t * 1000.0).round() as usize;
        assert!((found["t"][row] - t).abs() < 1e-15);
        for (name, expected) in ["x_sp", "x_pr", "x_c", "tip"].into_iter().zip(expected) {
            let value = found[name][row];
            let deviation = (value - expected).abs();
            assert!(
                deviation <= TOLERANCE,
                "{name} at {t} s: {value} for {expected}"
            );
        }
    }
}
