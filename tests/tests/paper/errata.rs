//! The derivation against the paper, row by row: it agrees with the rows consistent with the
//! energies and differs from the misprints. To print the table, run `cargo test --release -p
//! eomgen-tests --test paper errata -- --nocapture`.

use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::model::Model;
use eomgen_paper::reference::PlanetaryArmParameters;
use eomgen_paper::reference::errata::errata_table;
use eomgen_tests::models::{load, variant};

/// Returns the model with the parameters of the hand-written equations.
fn with_parameters(model: &Model, parameters: &PlanetaryArmParameters) -> Model {
    let mut changed = model.clone();
    for (name, value) in fields_by_name(parameters) {
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

/// Returns every field with its name; a missing field does not compile.
#[allow(non_snake_case, reason = "names as in the paper's nomenclature")]
fn fields_by_name(parameters: &PlanetaryArmParameters) -> Vec<(&'static str, f64)> {
    macro_rules! fields {
        ($($field:ident)*) => {{
            let PlanetaryArmParameters { $($field),* } = *parameters;
            vec![$((stringify!($field), $field)),*]
        }};
    }
    fields!(k_sp k_pr c_sp c_pr b_sp b_pr m_p I_s I_p I_c rho A l E I alpha
            z_s z_p z_r m a_m b_m F_w omega)
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
    assert!(misprints >= 35, "only {misprints} misprints were compared");
}
