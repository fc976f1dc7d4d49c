//! Tests of `discover` on machines with a moving base, whose prescribed motion is recorded.

use eomgen_tests::moving_base::{Machine, Recording};
use eomgen_tests::moving_machines::{slider, tower};
use eomgen_tests::program::{Texts, run_on_texts};
use serde_json::Value;

fn discover<const N: usize, const C: usize>(
    machine: &Machine<N, C>,
    recording: Recording,
) -> Value {
    let [train, test] = &machine.records(recording);
    let texts = Texts {
        specification: &machine.specification,
        dataset: &machine.dataset(recording),
        train,
        test,
    };
    run_on_texts("discover", texts)
}

/// Asserts that only this effect is found and that its parameter is within 3 % and 4 standard deviations of `size`.
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
    assert!((value / size - 1.0).abs() < 0.03, "{value} for {size}");
    assert!((value - size).abs() < 4.0 * sd, "{value} {sd} for {size}");
}

const RECORDING: Recording = Recording {
    step: 4e-3,
    parts: 80,
    unit: ("m", 1.0),
};

#[test]
fn cubic_spring_to_the_moving_base_is_found() {
    let machine = tower(|distance, _| -2e6 * distance.powi(3));
    let recording = Recording {
        unit: ("mm", 1e-3),
        ..RECORDING
    };
    let found = discover(&machine, recording);
    let effect = ("stiffness_nonlinearity", "column");
    assert_found(&found, effect, ("k_3", 2e6));
}

#[test]
fn damper_to_the_moving_base_is_found_beside_dry_friction() {
    let found = discover(&slider(|_, rate| -3.0 * rate), RECORDING);
    let effect = ("viscous_friction", "z");
    assert_found(&found, effect, ("c_v", 3.0));
}
