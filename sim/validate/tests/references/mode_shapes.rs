//! Comparison of mode shapes with values of high precision.

use eomgen_validate::references::planetary_arm::mode_shapes::ModeShape;
use serde_json::Value;

const MODES: &str = include_str!("../../../../tests/reference/clamped_free_modes.json");

fn number(mode: &Value, name: &str) -> f64 {
    let text = mode[name]
        .as_str()
        .unwrap_or_else(|| panic!("{name} is missing"));
    text.parse().expect("a decimal number")
}

#[test]
fn modes_1_to_128_agree_with_high_precision() {
    let modes: Vec<Value> = serde_json::from_str(MODES).expect("a list of modes");
    assert_eq!(modes.len(), 128);
    for (r, mode) in (1..).zip(&modes) {
        let shape = ModeShape::clamped_free(r);
        let integrals = shape.integrals();
        let own = [
            ("beta_l", shape.beta_l),
            ("xi", shape.xi),
            ("int_phi2", integrals.phi_squared),
            ("int_s_phi", integrals.s_phi),
            ("int_phi_ss2", integrals.curvature_squared),
            ("phi_tip", shape.value(1.0)),
        ];
        for (name, value) in own {
            let exact = number(mode, name);
            let deviation = ((value - exact) / exact).abs();
            assert!(
                deviation < 1e-13,
                "mode {r}, {name}: {value}, deviates by {deviation:e}"
            );
        }
        // A node of the mode may be close to the middle, so the tolerance is absolute: the rounding of the phase, z
        // eps.
        let middle = (shape.value(0.5) - number(mode, "phi_mid")).abs();
        assert!(
            middle < 1e-15 + f64::EPSILON * shape.beta_l,
            "mode {r}: {middle:e}"
        );
    }
}
