//! Requests that a model refuses: what is said, and what it still answers.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::variant::Variant;

/// A beam whose inertia grows where it bends: its modal mass matrix is dense and moves.
const SWELLING: &str = r#"
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

#[test]
fn a_dense_mass_matrix_that_moves_has_no_derivatives() {
    let model = crate::support::model(SWELLING);
    for request in [Output::Jacobians, Output::Products, Output::Linearisation] {
        let Err(found) = Variant::derive_with(&model, &[2], &[request]) else {
            panic!("{request:?} was derived");
        };
        let said = found.render(false);
        let expected = "no Jacobian: the modal mass matrix is dense and moves with the state";
        assert!(said.contains(expected), "{request:?}: {said}");
        let place = "beam = \"1/2*integral(rho*(1 + (w/l)^2)*dot(w)^2, w)\"";
        assert!(said.contains(place), "{request:?}: {said}");
    }
}

#[test]
fn what_needs_no_derivative_of_it_is_derived() {
    let model = crate::support::model(SWELLING);
    for request in [
        Output::BiasForces,
        Output::InverseDynamics,
        Output::GuardRates,
        Output::Regimes,
        Output::Lanes,
    ] {
        assert!(
            Variant::derive_with(&model, &[2], &[request]).is_ok(),
            "{request:?} was refused"
        );
    }
}
