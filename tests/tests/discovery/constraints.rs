//! Tests of `discover` on machines with constraints. The records are computed in independent coordinates.

use eomgen_tests::constrained_machines::{pendulum, sleigh, slider_crank};
use eomgen_tests::constrained_records::{Machine, Sampling};
use eomgen_tests::program::{Texts, run_on_texts};
use serde_json::Value;

const WHOLE: Sampling = Sampling {
    samples: 250,
    step: 4e-3,
    window: None,
};

const WINDOWS: Sampling = Sampling {
    window: Some(0.25),
    ..WHOLE
};

/// Runs `discover` on the specification with constraints.
fn discover<const S: usize, const C: usize>(machine: &Machine<S, C>, sampling: Sampling) -> Value {
    let [train, test] = &machine.records(sampling);
    let texts = Texts {
        specification: &machine.specification,
        dataset: &machine.dataset(sampling, ""),
        train,
        test,
    };
    run_on_texts("discover", texts)
}

/// Asserts that only this effect is found, that its parameter is within 5 % and 4 standard deviations of `size`, and
/// that the extended specification passes the checks.
fn assert_found(found: &Value, (effect, on): (&str, &str), (parameter, size): (&str, f64)) {
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    let own = &effects[0];
    assert_eq!(own["effect"], effect, "{own:#}");
    assert_eq!(own["on"], on, "{own:#}");
    assert_eq!(own["status"], "named", "{own:#}");
    let [value, sd] = ["value", "sd"].map(|key| {
        let number = own["parameters"][parameter][key].as_f64();
        number.expect("a number")
    });
    assert!((value / size - 1.0).abs() < 0.05, "{value} for {size}");
    assert!((value - size).abs() < 4.0 * sd, "{value} {sd} for {size}");
    let failed = found["validation"]["failed"].as_array().expect("checks");
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn dry_friction_on_the_slider_of_a_crank_is_found() {
    let sampling = Sampling {
        samples: 400,
        window: Some(0.4),
        ..WHOLE
    };
    let found = discover(&slider_crank(0.4, 0.3, 0.0, false), sampling);
    assert_found(&found, ("coulomb_friction", "x"), ("T_c", 0.3));
}

#[test]
fn wrong_mass_of_a_slider_is_found() {
    let found = discover(&slider_crank(0.44, 0.0, 0.0, true), WINDOWS);
    assert_found(&found, ("parameter_shift", "m_s"), ("m_s", 0.44));
}

#[test]
fn damper_on_a_slider_is_found_in_whole_records() {
    let found = discover(&slider_crank(0.4, 0.0, 1.0, true), WHOLE);
    assert_found(&found, ("viscous_friction", "x"), ("c_v", 1.0));
}

#[test]
fn spring_on_a_coordinate_of_a_pendulum_is_found() {
    let found = discover(&pendulum(0.3, 3.0, true), WHOLE);
    assert_found(&found, ("elastic_restraint", "x"), ("k_r", 3.0));
}

#[test]
fn wrong_length_in_a_constraint_is_found() {
    // With shorter windows, the length and the gains of the sensors would be inseparable.
    let sampling = Sampling {
        samples: 600,
        window: Some(0.6),
        ..WHOLE
    };
    let found = discover(&pendulum(0.306, 0.0, false), sampling);
    assert_found(&found, ("parameter_shift", "l"), ("l", 0.306));
}

#[test]
fn rotational_damper_of_a_sleigh_is_found() {
    let sampling = Sampling {
        samples: 400,
        window: Some(0.8),
        ..WHOLE
    };
    let found = discover(&sleigh(0.15, true), sampling);
    assert_found(&found, ("viscous_friction", "theta"), ("c_v", 0.15));
}
