//! Derivatives next to a switching surface at which the argument of a root, a power, an inverse sine or a logarithm
//! is clipped.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::Point;

use crate::limits::{evaluator, gradient, jacobian, pushed};

/// Force, a position at which the force is constant, another position, and the derivative at the latter.
const CLIPPED_FORCES: [(&str, f64, f64, f64); 15] = [
    ("sqrt(max(x/l - 0.5, 0))", 0.2, 1.5, 0.5),
    ("sqrt(max(0, x/l - 0.5))", 0.2, 1.5, 0.5),
    ("sqrt(max(1 - (x/l)^2, 0))", 2.0, 0.6, -0.75),
    ("sqrt(1 - min(x/l, 1)^2)", 2.0, 0.6, -0.75),
    ("asin(max(min(x/l, 1), -1))", 1.5, 0.6, 1.25),
    ("asin(max(min(x/l, 1), -1))", -1.5, -0.6, 1.25),
    ("acos(min(x/l, 1))", 2.0, 0.6, -1.25),
    ("max(x/l, 0)^(1/2)", -0.3, 0.25, 1.0),
    ("max(x/l, 0)^0.3", -0.3, 1.0, 0.3),
    ("max(x/l, 0)^(n - 1)", -0.3, 0.25, 1.0),
    ("exp(0.5*ln(max(x/l, 0)))", -0.3, 0.25, 1.0),
    ("sqrt(max(x/l, 0)*(2 + x/l))", -0.5, 1.0, 1.1547005383792515),
    (
        "sqrt(max(x/l - 1, 0)^2 + max(-1 - x/l, 0)^2)",
        0.3,
        2.0,
        1.0,
    ),
    ("sqrt(abs(deadzone(x/l, 0.5)))", 0.2, 0.75, 1.0),
    ("max(sqrt(max(x/l, 0)), 0.1)^0.5", -1.0, 0.0625, 2.0),
];

/// Returns the derivative of the acceleration with respect to x, computed in forward and in reverse mode.
fn slopes(text: &str, x: f64) -> [f64; 2] {
    let mut evaluator = evaluator(text, &[Output::Jacobians, Output::Products]);
    let state = [x, 0.0, 0.0, 0.0, 0.0, 0.0];
    let forward = jacobian(&mut evaluator, &state);
    assert_eq!(forward.len(), 4, "{text}");
    [forward[3], gradient(&mut evaluator, &state)[0]]
}

fn assert_close(found: [f64; 2], expected: f64, force: &str) {
    let is_close = |found: f64| (found - expected).abs() < 1e-12;
    assert!(
        found.into_iter().all(is_close),
        "{force}: {found:?}, not {expected}"
    );
}

#[test]
fn clipped_functions_have_the_derivative_0_on_the_flat_side() {
    for (force, flat, _, _) in CLIPPED_FORCES {
        assert_eq!(slopes(&pushed(force), flat), [0.0; 2], "{force}");
    }
}

#[test]
fn clipped_functions_keep_their_derivative_on_the_other_side() {
    for (force, _, place, slope) in CLIPPED_FORCES {
        assert_close(slopes(&pushed(force), place), 2.0 * slope, force);
    }
}

#[test]
fn roots_have_no_derivative_on_the_surface_that_clips_them() {
    for force in ["sqrt(max(x/l - 0.5, 0))", "sqrt(max(0, x/l - 0.5))"] {
        let [forward, _] = slopes(&pushed(force), 0.5);
        assert!(!forward.is_finite(), "{force}: {forward}");
    }
}

#[test]
fn clipped_functions_have_finite_derivatives_by_parameters() {
    for (force, flat, _, _) in CLIPPED_FORCES {
        let mut evaluator = evaluator(&pushed(force), &[Output::Products]);
        let state = [flat, 0.0, 0.0, 0.0, 0.0, 0.0];
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &[],
        };
        let weights = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let mut found = [f64::NAN; 5];
        assert!(evaluator.vector_jacobian_product_by_parameters(point, &weights, &mut found));
        // The derivatives with respect to l and n are zero because the force is constant.
        assert_eq!([found[1], found[4]], [0.0; 2], "{force}: {found:?}");
        assert!(
            found.iter().all(|entry| entry.is_finite()),
            "{force}: {found:?}"
        );
    }
}

#[test]
fn forces_of_clipped_potentials_have_the_derivative_0_on_the_flat_side() {
    for (potential, curvature) in [
        ("max(x/l, 0)^1.5", 1.5),
        ("max(x/l, 0)^1.7", 1.7 * 0.7 * 0.25_f64.powf(-0.3)),
        ("sqrt(max(x/l, 0))", -2.0),
    ] {
        let terms = format!("[potential]\nclipped = \"F*l*({potential})\"\n[forces]");
        let text = pushed("0").replace("[forces]", &terms);
        assert_eq!(slopes(&text, -0.3), [0.0; 2], "{potential}");
        assert_close(slopes(&text, 0.25), -2.0 * curvature, potential);
    }
}

/// String with an elastic stop along its length.
const STRING_WITH_STOP: &str = r#"
[model]
name = "stopped_string"
[parameters]
mu = { value = 1, unit = "kg/m" }
H = { value = 3, unit = "N" }
c = { value = 2, unit = "N/m^(1/2)" }
g = { value = 0.01, unit = "m" }
l = { value = 1, unit = "m" }
[fields.w]
along = "s"
from = 0
to = "l"
basis = "string"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
string = "1/2*integral(mu*dot(w)^2, w)"
[potential]
tension = "1/2*integral(H*diff(w, s)^2, w)"
"#;

#[test]
fn clipped_potentials_along_a_field_add_nothing_on_the_flat_side() {
    let mut free = evaluator(STRING_WITH_STOP, &[Output::Jacobians]);
    let state = [0.001, -0.0005, 0.0, 0.0];
    let sum = |nonzeros: Vec<f64>| nonzeros.iter().sum::<f64>();
    let expected = sum(jacobian(&mut free, &state));
    for stop in [
        "sqrt(max(w - g, 0))",
        "sqrt(max(w - g, 0)*(1 + w/l))",
        "(max(w - g, 0)/l)^0.7*l^0.5",
        "abs(deadzone(w, g))^1.5/l",
    ] {
        let text = format!("{STRING_WITH_STOP}stop = \"integral(c*({stop}), w)\"\n");
        let mut stopped = evaluator(&text, &[Output::Jacobians]);
        let found = sum(jacobian(&mut stopped, &state));
        assert!(
            (found - expected).abs() < 1e-9,
            "{stop}: {found}, not {expected}"
        );
    }
}
