//! Emitted documentation of a mass matrix that can become indefinite.

use eomgen_codegen::program::evaluator::Point;

use crate::support::{emitted, evaluator, model, shipped};

/// Table whose inertia vanishes if a slider is at x = a.
const TABLE: &str = r#"
[model]
name = "table"
[parameters]
m = { value = 1, unit = "kg" }
J = { value = 1, unit = "kg m^2" }
a = { value = 0.5, unit = "m" }
[coordinates]
x = { unit = "m" }
phi = { unit = "rad" }
[kinetic]
slider = "1/2*m*dot(x)^2"
table = "1/2*J*(1 - x/a)*dot(phi)^2"
"#;

#[test]
fn documentation_names_states_with_nan_rates() {
    let model = model(TABLE);
    let mut evaluator = evaluator(&model, 0);
    assert!(evaluator.pivots_are_positive());
    let mut rates = [0.0; 4];
    for (x, right) in [(0.0, true), (0.6, false)] {
        let point = Point {
            t: 0.0,
            state: &[x, 0.0, 1.0, 0.1],
            inputs: &[],
        };
        evaluator.rates(point, &mut rates);
        assert_eq!(rates[3].is_finite(), right, "{rates:?}");
    }
    let source = emitted(&model, 0);
    for (item, said) in [
        ("    pub positive_definite: bool", "rates are NaN"),
        ("pub fn rates_into<", "[`Coefficients::positive_definite`]"),
        ("pub fn rates<", "[`Coefficients::positive_definite`]"),
    ] {
        let before = source.split(item).next().expect("a part");
        assert!(before.len() < source.len(), "no {item}");
        let documentation = before.lines().rev().take(9).collect::<Vec<_>>().join("\n");
        assert!(documentation.contains(said), "{item}: {documentation}");
    }
}

#[test]
fn constant_mass_matrix_has_no_such_documentation() {
    let source = emitted(&shipped("pendulum"), 0);
    assert!(!source.contains("rates are NaN") && !source.contains("varies with the state"));
}
