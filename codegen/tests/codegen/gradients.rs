//! Gradients by reverse accumulation through branches: an infinite or NaN value in an unused branch has no
//! effect.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::variant::Variant;

/// Mass with a constant force. At larger x another force acts, whose derivative is infinite at 0.
const PUSHED_MASS: &str = r#"
[model]
name  = "pushed_mass"
title = "Mass pushed by the larger of two forces"

[parameters]
m = { value = 2, unit = "kg" }
F = { value = 3, unit = "N" }
k = { value = 5, unit = "N" }
l = { value = 7, unit = "m" }

[coordinates]
x = { unit = "m" }

[kinetic]
mass = "1/2*m*dot(x)^2"

[forces]
push = { on = "x", value = "max(F, k*sqrt(x/l) + F*(x/l)^2)" }
"#;

/// Returns the gradients of 11 times the acceleration with respect to the state and to the parameters.
fn gradients(x: f64) -> ([f64; 2], [f64; 4]) {
    let model = crate::support::model(PUSHED_MASS);
    let variant = Variant::derive_with(&model, &[], &[Output::Products])
        .unwrap_or_else(|found| panic!("{}", found.render(false)));
    let mut evaluator = Evaluator::new(variant.program);
    let point = Point {
        t: 0.0,
        state: &[x, 0.0],
        inputs: &[],
    };
    let (mut state, mut parameters) = ([f64::NAN; 2], [f64::NAN; 4]);
    assert!(evaluator.vector_jacobian_product(point, &[0.0, 11.0], (&mut state, &mut [])));
    assert!(evaluator.vector_jacobian_product_by_parameters(point, &[0.0, 11.0], &mut parameters));
    (state, parameters)
}

#[test]
fn infinite_slope_of_unused_branch_has_no_effect() {
    let (state, parameters) = gradients(0.0);
    assert_eq!(state, [0.0, 0.0]);
    // Derivatives of 11 F/m with respect to m, F, k and l.
    assert_eq!(parameters, [-11.0 * 3.0 / 4.0, 11.0 / 2.0, 0.0, 0.0]);
}

#[test]
fn gradient_of_used_branch_matches_formula() {
    // At x/l = 4 the second force is 2 k + 16 F.
    let (state, parameters) = gradients(28.0);
    let slope = 5.0 / 4.0 + 3.0 * 8.0;
    let expected = [
        -11.0 * (2.0 * 5.0 + 16.0 * 3.0) / 4.0,
        11.0 * 16.0 / 2.0,
        11.0 * 2.0 / 2.0,
        -11.0 / 2.0 * slope * 28.0 / 49.0,
    ];
    let pairs = parameters.iter().zip(&expected);
    for (found, expected) in pairs.chain([(&state[0], &(11.0 / 2.0 * slope / 7.0))]) {
        assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
    }
    assert_eq!(state[1], 0.0);
}
