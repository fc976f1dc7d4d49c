//! Optional outputs that a model rejects, and outputs that it supports.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::variant::Variant;

/// Beam whose inertia grows with its deflection: its modal mass matrix is dense and depends on the state.
const SWELLING_BEAM: &str = r#"
[model]
name  = "swelling_beam"
title = "Beam that is heavier where it bends"

[parameters]
rho = { value = 2, unit = "kg/m" }
B   = { value = 5, unit = "N m^2" }
l   = { value = 1, unit = "m" }

[fields.w]
along = "x"
from = "0"
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 2
unit = "m"

[kinetic]
beam = "1/2*integral(rho*(1 + (w/l)^2)*dot(w)^2, w)"

[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
"#;

/// Coordinate and beam with a nonlinear spring and an inertia that grows with the deflection.
const NONLINEAR: &str = r#"
[model]
name  = "nonlinear_beam"
[parameters]
rho = { value = 2, unit = "kg/m" }
a   = { value = 40, unit = "N/m^2" }
B   = { value = 5, unit = "N m^2" }
l   = { value = 1, unit = "m" }
M   = { value = 3, unit = "kg" }
[coordinates]
z = { unit = "m" }
[fields.w]
along = "x"
from = "0"
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
base = "1/2*M*dot(z)^2"
beam = "1/2*integral(INERTIA*(dot(w) + dot(z))^2, w)"
[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
spring = "1/2*a*l*z^2 + integral(SPRING, w)"
"#;

/// Compares the Jacobians of forward and reverse mode at a state with difference quotients.
fn compare_with_differences(inertia: &str, spring: &str) {
    let text = NONLINEAR
        .replace("INERTIA", inertia)
        .replace("SPRING", spring);
    let model = crate::support::model(&text);
    let outputs = [Output::Jacobians, Output::Products];
    let variant = Variant::derive_with(&model, &[2], &outputs)
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    let mut evaluator = Evaluator::new(variant.program);
    let at = |state: &[f64; 6], evaluator: &mut Evaluator| {
        let mut rates = [f64::NAN; 6];
        let (t, inputs) = (0.0, &[][..]);
        evaluator.rates(Point { t, state, inputs }, &mut rates);
        rates
    };
    let state = [0.1, 0.3, -0.2, 0.4, 0.5, -0.6];
    for column in 0..6 {
        let moved = |step: f64, evaluator: &mut Evaluator| {
            let mut state = state;
            state[column] += step;
            at(&state, evaluator)
        };
        let step = 1e-6;
        let (above, below) = (moved(step, &mut evaluator), moved(-step, &mut evaluator));
        let expected: Vec<f64> = (0..6)
            .map(|row| (above[row] - below[row]) / (2.0 * step))
            .collect();
        let mut direction = [0.0; 6];
        direction[column] = 1.0;
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &[],
        };
        let mut forward = [f64::NAN; 6];
        assert!(evaluator.jacobian_vector_product(point, (&direction, &[]), &mut forward));
        let dense = dense_column(&mut evaluator, point, column);
        for row in 0..6 {
            let mut weights = [0.0; 6];
            weights[row] = 1.0;
            let mut backward = [f64::NAN; 6];
            assert!(evaluator.vector_jacobian_product(point, &weights, (&mut backward, &mut [])));
            let allowed = 1e-7 * expected[row].abs().max(1.0);
            for found in [forward[row], backward[column], dense[row]] {
                assert!(
                    (found - expected[row]).abs() < allowed,
                    "{inertia}, {spring}: row {row} by {column}: {found} {}",
                    expected[row]
                );
            }
        }
    }
}

/// Returns a column of the Jacobian of the rates with respect to the state.
fn dense_column(evaluator: &mut Evaluator, point: Point<'_>, column: usize) -> [f64; 6] {
    let jacobian = evaluator.program().outputs.jacobians[0].clone();
    assert_eq!(jacobian.name, "rates_by_state");
    let mut nonzeros = vec![f64::NAN; jacobian.nonzeros()];
    assert!(evaluator.jacobian(0, point, &mut nonzeros));
    let mut dense = [0.0; 6];
    for (entry, place) in jacobian.entries.iter().zip(jacobian.places()) {
        for row in 0..entry.rows {
            for k in 0..entry.width() {
                if entry.column + if entry.diagonal { row } else { k } == column {
                    dense[entry.row + row] = nonzeros[place.start + place.width * row + k];
                }
            }
        }
    }
    dense
}

#[test]
fn nonlinear_functions_of_a_field_have_jacobians() {
    for (inertia, spring) in [
        ("rho", "a*w^4/l^2"),
        ("rho", "a*w^3*z/l^2 + a*diff(w, x)^4*l^2"),
        ("rho", "a*l^2*(cosh(w/l) - cos(z/l)*exp(w/l))"),
        ("rho*(1 + (w/l)^2)", "a*w^4/l^2"),
        ("rho*(1 + (w/l)^2 + z/l)", "a*w^2"),
        ("rho*exp(w/l)", "a*l^2*sqrt(1 + (w/l)^2)"),
    ] {
        compare_with_differences(inertia, spring);
    }
}

#[test]
fn dense_state_dependent_mass_matrix_has_derivatives() {
    let model = crate::support::model(SWELLING_BEAM);
    for request in [Output::Jacobians, Output::Products, Output::Linearisation] {
        let found = Variant::derive_with(&model, &[2], &[request]);
        assert!(found.is_ok(), "{request:?}");
    }
}

#[test]
fn state_weighted_sum_of_squared_modes_is_rejected_at_its_place() {
    let losses = "1/2*c*sum(i, w, integral(exp(w/l)*phi[i]^2, w)*dot(q[i])^2)";
    let text = SWELLING_BEAM
        .replace("rho*(1 + (w/l)^2)", "rho")
        .replace(
            "[kinetic]",
            &format!("[dissipation]\nlosses = \"{losses}\"\n\n[kinetic]"),
        )
        .replace(
            "[fields.w]",
            "c = { value = 1, unit = \"kg/(m s)\" }\n\n[fields.w]",
        );
    let model = crate::support::model(&text);
    let Err(found) = Variant::derive_with(&model, &[2], &[Output::Jacobians]) else {
        panic!("derived");
    };
    let said = found.render(false);
    assert!(
        said.contains("no Jacobian") && said.contains(losses),
        "{said}"
    );
}

#[test]
fn outputs_without_derivatives_are_accepted() {
    let model = crate::support::model(SWELLING_BEAM);
    for request in [
        Output::BiasForces,
        Output::InverseDynamics,
        Output::GuardRates,
        Output::Regimes,
        Output::Lanes,
    ] {
        assert!(
            Variant::derive_with(&model, &[2], &[request]).is_ok(),
            "{request:?} was rejected"
        );
    }
}
