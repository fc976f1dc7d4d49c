//! Derivatives at the zero of a root: the limit if it exists, else a value that is not finite.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::variant::Variant;

/// Returns a mass in space with this force along x.
pub(crate) fn pushed(force: &str) -> String {
    format!(
        r#"
[model]
name = "pushed"
[parameters]
m = {{ value = 1, unit = "kg" }}
l = {{ value = 1, unit = "m" }}
s = {{ value = 1, unit = "m/s" }}
F = {{ value = 2, unit = "N" }}
n = {{ value = 1.5, unit = "1" }}
[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}
z = {{ unit = "m" }}
[definitions]
r = "[x, y, z]"
v = "[dot(x), dot(y), dot(z)]"
plane = "[dot(x), dot(y)]"
[kinetic]
mass = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[forces]
push = {{ on = "x", value = "F*({force})" }}
"#
    )
}

pub(crate) fn evaluator(text: &str, outputs: &[Output]) -> Evaluator {
    let model = crate::support::model(text);
    let orders = vec![2; model.fields.len()];
    let variant = Variant::derive_with(&model, &orders, outputs)
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    Evaluator::new(variant.program)
}

/// Returns the structural nonzeros of the Jacobian of the rates with respect to the state.
pub(crate) fn jacobian(evaluator: &mut Evaluator, state: &[f64]) -> Vec<f64> {
    let jacobians = &evaluator.program().outputs.jacobians;
    let place = jacobians
        .iter()
        .position(|known| known.name == "rates_by_state")
        .expect("the Jacobian");
    let mut nonzeros = vec![f64::NAN; jacobians[place].nonzeros()];
    let point = Point {
        t: 0.0,
        state,
        inputs: &[],
    };
    assert!(evaluator.jacobian(place, point, &mut nonzeros));
    nonzeros
}

/// Returns the gradient of the acceleration of x with respect to the state, computed by reverse accumulation.
pub(crate) fn gradient(evaluator: &mut Evaluator, state: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; state.len()];
    weights[state.len() / 2] = 1.0;
    let mut gradient = vec![f64::NAN; state.len()];
    let point = Point {
        t: 0.0,
        state,
        inputs: &[],
    };
    assert!(evaluator.vector_jacobian_product(point, &weights, (&mut gradient, &mut [])));
    gradient
}

pub(crate) fn acceleration(evaluator: &mut Evaluator, state: &[f64]) -> f64 {
    let mut rates = vec![f64::NAN; state.len()];
    let point = Point {
        t: 0.0,
        state,
        inputs: &[],
    };
    evaluator.rates(point, &mut rates);
    rates[state.len() / 2]
}

/// Forces whose derivatives are zero at 0.
const SMOOTH_ENOUGH: [&str; 26] = [
    "-norm(v)*dot(x)/s^2",
    "-norm(plane)*dot(x)/s^2",
    "norm(v)*dot(v, v)/s^3",
    "-(norm(r)/l)^3",
    "-(norm(r)/l)^3*x/l",
    "norm(v)*dot(v, r)/(l*s^2)",
    "sqrt(x^2 + y^2)*x/l^2",
    "sqrt(x^2)*x/l^2",
    "abs(x)*x/l^2",
    "((x/l)^2)^1.5",
    "((x^2 + y^2)/l^2)^0.7*x/l",
    "max(x/l, 0)^1.5",
    "max(x/l, 0)^n",
    "(norm(v)/s + (dot(x)/s)^2)*dot(x)/s",
    "sin(norm(v)/s)*tanh(dot(x)/s)",
    "(1 - exp(-norm(v)/s))*dot(x)/s",
    "norm(plane)*dot(z)/s^2",
    "norm(plane)*sin(z/l)/s",
    "norm(plane)*abs(dot(z))/s^2",
    "norm([x, y])*norm([y, z])/l^2",
    "(norm(plane)*z + norm(v)*x)/(l*s)",
    "sqrt(norm(v)/s)*dot(x)/s",
    "sqrt(sqrt(norm(v)/s))*dot(y)/s",
    "((dot(x)^4 + dot(y)^4)/s^4)^(1/4)*dot(y)/s",
    "(abs(dot(x)/s)^1.5 + abs(dot(y)/s)^1.5)^(2/3)*dot(y)/s",
    "sqrt(norm(v)/s + norm(plane)/s)*dot(x)/s",
];

#[test]
fn products_that_vanish_with_a_root_have_zero_derivative() {
    for force in SMOOTH_ENOUGH {
        let mut evaluator = evaluator(&pushed(force), &[Output::Jacobians, Output::Products]);
        let found = jacobian(&mut evaluator, &[0.0; 6]);
        assert_eq!(found[..3], [1.0; 3], "{force}");
        assert!(
            found[3..].iter().all(|entry| *entry == 0.0),
            "{force}: {found:?}"
        );
        let found = gradient(&mut evaluator, &[0.0; 6]);
        assert!(
            found.iter().all(|entry| *entry == 0.0),
            "{force}: {found:?}"
        );
    }
}

#[test]
fn one_zero_alone_needs_no_limit() {
    for force in SMOOTH_ENOUGH {
        let mut evaluator = evaluator(&pushed(force), &[Output::Jacobians]);
        for place in 0..6 {
            let mut state = [0.3, -0.2, 0.4, 0.5, 0.7, -0.6];
            state[place] = 0.0;
            let found = jacobian(&mut evaluator, &state);
            assert!(
                found.iter().all(|entry| entry.is_finite()),
                "{force}: {found:?}"
            );
        }
    }
}

#[test]
fn guarded_derivatives_match_differences() {
    for force in SMOOTH_ENOUGH {
        let mut evaluator = evaluator(&pushed(force), &[Output::Products]);
        let state = [0.3, -0.2, 0.4, 0.5, 0.7, -0.6];
        let found = gradient(&mut evaluator, &state);
        for (place, found) in found.into_iter().enumerate() {
            let step = 1e-6;
            let mut at = |moved: f64| {
                let mut state = state;
                state[place] += moved;
                acceleration(&mut evaluator, &state)
            };
            let expected = (at(step) - at(-step)) / (2.0 * step);
            assert!(
                (found - expected).abs() < 1e-8,
                "{force}: {found} {expected}"
            );
        }
    }
}

#[test]
fn derivatives_without_a_limit_are_not_finite() {
    for force in [
        "dot(x)/norm(v)",
        "norm(v)/s",
        "norm(r)/l",
        "sqrt(x/l)",
        "abs(x/l)^0.5",
        "abs(x/l)^0.5*sign(x)",
        "abs(x/l)^0.3*sign(x)",
        "norm(v)*x/(norm(r)*s)",
        "norm(plane)*sign(z)/s",
        "norm(plane)*(z - l)/(l*s)",
        "norm(plane)*exp(z/l)/s",
        "norm(plane)*dot(z)/(s*norm(v))",
        "sqrt(norm(plane)/s)*sign(z)*dot(z)/s",
        "sqrt(norm(plane)/s)*sqrt(abs(dot(z))/s)",
        "cos(sqrt(norm(v)/s))",
        "sqrt(max(x/l, 0))",
    ] {
        let mut evaluator = evaluator(&pushed(force), &[Output::Jacobians]);
        let found = jacobian(&mut evaluator, &[0.0; 6]);
        assert!(
            found.iter().any(|entry| !entry.is_finite()),
            "{force}: {found:?}"
        );
    }
}

/// At each zero of the root, the other factor determines whether the derivative has a limit.
#[test]
fn root_times_other_factor_has_a_limit_only_at_zeros_of_that_factor() {
    let at = |z: f64, z_rate: f64| [0.0, 0.0, z, 0.0, 0.0, z_rate];
    for (force, limit, none) in [
        ("norm(plane)*dot(z)/s^2", at(0.7, 0.0), at(0.7, 1.0)),
        ("norm(plane)*sin(z/l)/s", at(0.0, 0.3), at(1.0, 0.3)),
        ("norm(plane)*(z - l)/(l*s)", at(1.0, 0.0), at(0.0, 0.0)),
        ("norm([x, y])*norm([y, z])/l^2", at(0.0, 1.0), at(1.0, 1.0)),
        ("norm(plane)*z*dot(z)/(l*s^2)", at(0.0, 2.0), at(1.0, 2.0)),
        (
            "norm(plane)*(z^2 + l*dot(z)*abs(z)/s)/(l^2*s)",
            at(0.0, 1.0),
            at(1.0, 0.0),
        ),
    ] {
        let mut evaluator = evaluator(&pushed(force), &[Output::Jacobians, Output::Products]);
        let found = gradient(&mut evaluator, &limit);
        assert_eq!(found, [0.0; 6], "{force}");
        let found = jacobian(&mut evaluator, &limit);
        assert!(
            found[3..].iter().all(|entry| *entry == 0.0),
            "{force}: {found:?}"
        );
        let found = jacobian(&mut evaluator, &none);
        assert!(
            found.iter().any(|entry| !entry.is_finite()),
            "{force}: {found:?}"
        );
        // At a small distance from the zeros of the root, the derivative matches the formula.
        let mut near = none;
        let first = 3 * usize::from(force.contains("plane"));
        (near[first], near[first + 1]) = (3e-3, 4e-3);
        let found = gradient(&mut evaluator, &near);
        let step = 1e-7;
        let mut moved = |by: f64| {
            let mut state = near;
            state[first] += by;
            acceleration(&mut evaluator, &state)
        };
        let expected = (moved(step) - moved(-step)) / (2.0 * step);
        assert!(
            (found[first] - expected).abs() < 1e-6,
            "{force}: {found:?} {expected}"
        );
    }
}

/// The derivative of a root times a factor that vanishes with it is unbounded near 0. At 0 the product has the
/// derivative 0: it decreases faster than every linear function.
#[test]
fn root_times_smooth_factor_has_derivative_zero_at_zeros_of_both() {
    let at = |z: f64, z_rate: f64| [0.0, 0.0, z, 0.0, 0.0, z_rate];
    for (force, zero, none) in [
        ("sqrt(norm(plane)/s)*dot(z)/s", at(0.7, 0.0), at(0.7, 1.0)),
        ("(norm(plane)/s)^0.3*sin(z/l)", at(0.0, 0.3), at(1.0, 0.3)),
        ("sqrt(abs(dot(x))/s)*dot(z)/s", at(0.7, 0.0), at(0.7, 1.0)),
        ("sqrt(max(x/l, 0))*z/l", at(0.0, 1.0), at(1.0, 1.0)),
        ("sqrt(norm(plane)/s)*norm(v)/s", at(1.0, 0.0), at(1.0, 2.0)),
        (
            "sqrt(norm(plane)/s)*dot(z)*z/(l*s)",
            at(0.0, 2.0),
            at(1.0, 2.0),
        ),
        (
            "sqrt(sqrt(norm(plane)/s))*abs(z)*exp(z/l)/l",
            at(0.0, 1.0),
            at(1.0, 1.0),
        ),
        (
            "sqrt(norm(plane)/s)*sqrt(abs(z)/l)*dot(z)/s",
            at(1.0, 0.0),
            at(1.0, 2.0),
        ),
    ] {
        let mut evaluator = evaluator(&pushed(force), &[Output::Jacobians]);
        let found = jacobian(&mut evaluator, &zero);
        assert!(
            found[3..].iter().all(|entry| entry.is_finite()),
            "{force}: {found:?}"
        );
        let found = jacobian(&mut evaluator, &none);
        assert!(
            found.iter().any(|entry| !entry.is_finite()),
            "{force}: {found:?}"
        );
    }
}

/// The product of two norms has the second derivative x y/(n_1 n_2) without a limit at 0, although each of its
/// quotients is bounded.
#[test]
fn each_factor_cancels_one_root_only() {
    let edged = second_derivatives("norm([x, y])*norm([y, z])/l^2");
    assert!(edged.iter().any(|entry| !entry.is_finite()), "{edged:?}");
}

/// Returns the Jacobian at 0 of the forces of a potential: its second derivatives.
fn second_derivatives(potential: &str) -> Vec<f64> {
    let forces = "[forces]\npush = { on = \"x\", value = \"F*(0)\" }\n";
    let potential = format!("[potential]\nv = \"F*l*({potential})\"\n");
    let text = pushed("0");
    assert!(text.contains(forces));
    let text = text.replace(forces, &potential);
    let mut evaluator = evaluator(&text, &[Output::Jacobians]);
    assert_eq!(acceleration(&mut evaluator, &[0.0; 6]), 0.0, "{potential}");
    jacobian(&mut evaluator, &[0.0; 6]).split_off(3)
}

#[test]
fn second_derivatives_have_limits_one_order_later() {
    for flat in [
        "(norm(r)/l)^3",
        "(norm(r)/l)^3*x/l",
        "norm(r)*dot(r, r)*x/l^4",
    ] {
        let found = second_derivatives(flat);
        assert!(found.iter().all(|entry| *entry == 0.0), "{flat}: {found:?}");
    }
    // The second derivative of |r| x with respect to x depends on the direction.
    let edged = second_derivatives("norm(r)*x/l^2");
    assert!(edged.iter().any(|entry| !entry.is_finite()), "{edged:?}");
}

#[test]
fn power_with_zero_base_has_derivative_by_exponent() {
    let mut evaluator = evaluator(&pushed("max(x/l, 0)^n"), &[Output::Products]);
    let mut weights = [0.0; 6];
    weights[3] = 1.0;
    let point = Point {
        t: 0.0,
        state: &[-0.3, 0.0, 0.0, 0.0, 0.0, 0.0],
        inputs: &[],
    };
    let mut found = [f64::NAN; 5];
    assert!(evaluator.vector_jacobian_product_by_parameters(point, &weights, &mut found));
    assert_eq!(found, [0.0; 5]);
}

/// String with drag, which depends on the speed in space of each point of the string.
const STRING_WITH_DRAG: &str = r#"
[model]
name = "dragged_string"
[parameters]
mu = { value = 1, unit = "kg/m" }
H = { value = 3, unit = "N" }
c = { value = 2, unit = "kg/m^2" }
M = { value = 1, unit = "kg" }
l = { value = 1, unit = "m" }
[coordinates]
x = { unit = "m" }
[fields.w]
along = "s"
from = 0
to = "l"
basis = "string"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
ends = "1/2*M*dot(x)^2"
string = "1/2*integral(mu*(dot(w)^2 + dot(x)^2), w)"
[potential]
tension = "1/2*integral(H*diff(w, s)^2, w)"
[dissipation]
drag = "1/3*integral(c*sqrt(dot(w)^2 + dot(x)^2)^3, w)"
"#;

#[test]
fn drag_along_a_field_has_a_jacobian_at_rest() {
    let mut evaluator = evaluator(STRING_WITH_DRAG, &[Output::Jacobians, Output::Products]);
    let found = jacobian(&mut evaluator, &[0.0; 6]);
    assert!(found.iter().all(|entry| entry.is_finite()), "{found:?}");
    let found = gradient(&mut evaluator, &[0.0; 6]);
    assert_eq!(found, [0.0; 6]);
    let moving = [0.1, 0.02, -0.03, 0.4, 0.2, -0.3];
    let found = gradient(&mut evaluator, &moving);
    for (place, found) in found.into_iter().enumerate() {
        let mut at = |step: f64| {
            let mut state = moving;
            state[place] += step;
            acceleration(&mut evaluator, &state)
        };
        let expected = (at(1e-6) - at(-1e-6)) / 2e-6;
        assert!(
            (found - expected).abs() < 1e-8,
            "{place}: {found} {expected}"
        );
    }
}
