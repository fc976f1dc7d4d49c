//! Comparison of the derivation with the printed equations, row by row. It agrees with the rows that are consistent
//! with the energies and differs from the misprints. To print the table, run `cargo test --release -p eomgen-tests
//! --test paper errata -- --nocapture`.
//!
//! `measure` computes every coefficient of a derived right-hand side from differences between states. The differences
//! are exact up to rounding, because the model is linear in a regime. `rigid` (Eq. 10, 12, 16), `flexible` (Eq. 22) and
//! `consequences` (scales, mode shapes, Table I) contain the printed and the corrected values; `table` compares them.
//! Accelerations determine only ratios of coefficients, such as a_35/a_30.

mod consequences;
mod flexible;
mod measure;
mod rigid;
mod sources;
mod table;

use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::model::Model;
use eomgen_tests::models::{load, variant};
use eomgen_validate::references::planetary_arm::equation_12::EquivalentMasses;
use eomgen_validate::references::planetary_arm::equation_22::Coefficients;
use eomgen_validate::references::planetary_arm::mesh::f_c;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

use measure::DerivedModel;
use sources::Sources;
use table::ErrataTable;

/// Compares a derived model of the arm with the printed and the corrected equations.
fn errata_table(derived: &DerivedModel<'_>) -> ErrataTable {
    let sources = Sources::measure(derived);
    let mut table = ErrataTable::default();
    rigid::add_rows(&sources, &mut table);
    flexible::add_rows(&sources, &mut table);
    consequences::add_rows(&sources, derived, &mut table);
    table
}

/// Returns the model with the parameters of the hand-written equations.
fn with_parameters(model: &Model, parameters: &PlanetaryArmParameters) -> Model {
    let mut changed = model.clone();
    for (name, value) in parameters.named_values() {
        let known = model
            .parameters
            .iter()
            .find(|parameter| parameter.name == name);
        let unit = &known.expect("a parameter of the specification").unit;
        changed = changed
            .with_parameter(name, unit.from_si(value))
            .expect("a valid value");
    }
    changed
}

fn corrected(parameters: &PlanetaryArmParameters, order: usize, t: f64, state: &[f64]) -> Vec<f64> {
    let evaluation = Coefficients::new(parameters, order).evaluate(t, state);
    evaluation.map_or_else(Vec::new, |evaluation| evaluation.accelerations)
}

#[test]
fn derivation_matches_corrected_rows_and_differs_from_misprints() {
    let model = load("planetary_arm");
    let derived = |parameters: &PlanetaryArmParameters, order: usize, t: f64, state: &[f64]| {
        let mut evaluator = variant(&with_parameters(&model, parameters), order).evaluator;
        let mut rates = vec![f64::NAN; state.len()];
        let point = Point {
            t,
            state,
            inputs: &[],
        };
        evaluator.rates(point, &mut rates);
        rates.split_off(state.len() / 2)
    };
    let table = errata_table(&derived);
    println!("{table}");
    for row in &table.rows {
        assert!(
            row.agrees_with_corrected(),
            "differs from the correction: {row:?}"
        );
        assert!(
            row.differs_from_printed(),
            "agrees with the misprint: {row:?}"
        );
    }
    let misprints = table
        .rows
        .iter()
        .filter(|row| row.printed.is_some())
        .count();
    // The table must contain misprinted rows and correct rows of the paper.
    assert!(
        misprints >= 35 && table.rows.len() >= 90,
        "{misprints} of {}",
        table.rows.len()
    );
}

#[test]
fn printed_damping_fails_its_row_of_errata() {
    let printed = |parameters: &PlanetaryArmParameters, order: usize, t: f64, state: &[f64]| {
        let mut accelerations = corrected(parameters, order, t, state);
        let [x_sp, _, _, x_sp_dot, x_pr_dot, x_c_dot] = *state else {
            return accelerations;
        };
        let masses = EquivalentMasses::new(parameters);
        // Seeded fault: the motor damping acts only on x_sp' and with the factor 1 on x_c'; the factor D of F_csp is
        // missing in the second row.
        accelerations[0] += masses.B_m / masses.M_s * (x_pr_dot + x_c_dot);
        let damping = parameters.c_sp * f_c(x_sp, x_sp_dot, parameters.b_sp);
        accelerations[1] += (masses.D - 1.0) / masses.M_pr * damping;
        accelerations
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
fn missing_accelerations_fail_every_row() {
    let table = errata_table(&|_, _, _, _| Vec::new());
    let from_the_model = table
        .rows
        .iter()
        .filter(|row| !row.place.starts_with("Eq. (23)") && !row.place.starts_with("Eq. (24)"));
    for row in from_the_model {
        assert!(!row.agrees_with_corrected(), "{row:?}");
    }
}
