//! Table of errata, with hand-written equations instead of a derived model.

use eomgen_paper::reference::equation_22::Coefficients;
use eomgen_paper::reference::errata::errata_table;
use eomgen_paper::reference::{PlanetaryArmParameters, equation_12};

fn corrected(parameters: &PlanetaryArmParameters, order: usize, t: f64, state: &[f64]) -> Vec<f64> {
    let coefficients = Coefficients::new(parameters, order);
    coefficients
        .evaluate(t, state)
        .map_or_else(Vec::new, |evaluation| evaluation.accelerations)
}

#[test]
fn rows_agree_with_corrections_and_differ_from_misprints() {
    let table = errata_table(&corrected);
    println!("{table}");
    assert!(table.passed(), "{table}");
    // Misprinted rows of the paper, and rows that are correct.
    let misprints = table
        .rows
        .iter()
        .filter(|row| row.printed.is_some())
        .count();
    assert!(
        misprints >= 35 && table.rows.len() >= 90,
        "{misprints} of {}",
        table.rows.len()
    );
}

#[test]
fn printed_damping_fails_in_its_row() {
    let printed = |parameters: &PlanetaryArmParameters, order: usize, t: f64, state: &[f64]| {
        match <&[f64; 6]>::try_from(state) {
            Ok(rigid) => equation_12::printed_accelerations(parameters, rigid).accelerations,
            Err(_) => corrected(parameters, order, t, state),
        }
    };
    let table = errata_table(&printed);
    let failed: Vec<&str> = table
        .rows
        .iter()
        .filter(|row| !row.passed())
        .map(|row| row.place.as_str())
        .collect();
    for place in [
        "Eq. (12), row 1: x_pr'",
        "Eq. (12), row 1: x_c'",
        "Eq. (12), row 2: F_csp",
    ] {
        assert!(failed.contains(&place), "{place} is not among {failed:?}");
    }
    assert!(!failed.contains(&"Eq. (12), row 1: F_ksp"), "{failed:?}");
    let unnoticed = table
        .rows
        .iter()
        .find(|row| row.place == "Eq. (12), row 1: x_pr'");
    assert!(unnoticed.is_some_and(|row| !row.differs_from_printed()));
}

#[test]
fn empty_accelerations_agree_with_no_row() {
    let table = errata_table(&|_, _, _, _| Vec::new());
    let from_the_model = table
        .rows
        .iter()
        .filter(|row| !row.place.starts_with("Eq. (23)") && !row.place.starts_with("Eq. (24)"));
    for row in from_the_model {
        assert!(!row.agrees_with_corrected(), "{row:?}");
    }
}
