//! Tests of `compare` with correct models with constraints. The records are computed in independent coordinates.

use eomgen_tests::constrained_machines::{four_bar, gears, pendulum, sleigh, slider_crank};
use eomgen_tests::constrained_records::{Machine, Sampling};
use eomgen_tests::program::{Texts, run_on_texts};
use serde_json::Value;

const WHOLE: Sampling = Sampling {
    samples: 600,
    step: 4e-3,
    window: None,
};

const WINDOWS: Sampling = Sampling {
    window: Some(0.6),
    ..WHOLE
};

fn compare<const S: usize, const C: usize>(
    machine: &Machine<S, C>,
    sampling: Sampling,
    is_independent: bool,
) -> Value {
    let [train, test] = &machine.records(sampling);
    let (specification, suffix) = match is_independent {
        true => (&machine.independent, "_seen"),
        false => (&machine.specification, ""),
    };
    let texts = Texts {
        specification,
        dataset: &machine.dataset(sampling, suffix),
        train,
        test,
    };
    run_on_texts("compare", texts)
}

/// Returns noise floor, training residual and test residual of a channel, in standard deviations of the noise.
fn gap(found: &Value, (channel, noise): (&str, f64)) -> [f64; 3] {
    let of = &found["gap"][channel];
    ["floor", "train", "test"].map(|key| of[key].as_f64().expect("a number") / noise)
}

fn assert_no_gap<const S: usize, const C: usize>(machine: &Machine<S, C>, sampling: Sampling) {
    let found = compare(machine, sampling, false);
    assert_eq!(found["verdict"], "no_significant_gap", "{:#}", found["gap"]);
    for channel in &machine.channels {
        let sizes = gap(&found, (channel.name, channel.noise));
        let is_noise = sizes.iter().all(|size| (0.86..1.1).contains(size));
        assert!(is_noise, "{}: {sizes:?}", channel.name);
    }
}

#[test]
fn residual_of_pendulum_on_a_rod_is_noise() {
    assert_no_gap(&pendulum(0.3, 0.0, true), WHOLE);
    assert_no_gap(&pendulum(0.3, 0.0, false), WINDOWS);
}

#[test]
fn residual_of_slider_crank_is_noise() {
    assert_no_gap(&slider_crank(0.4, 0.0, 0.0, true), WHOLE);
    assert_no_gap(&slider_crank(0.4, 0.0, 0.0, false), WINDOWS);
}

#[test]
fn residual_of_four_bar_linkage_far_from_its_initial_state_is_noise() {
    assert_no_gap(&four_bar(0.0, true), WHOLE);
    assert_no_gap(&four_bar(0.0, false), WINDOWS);
}

#[test]
fn residual_of_gears_is_noise() {
    assert_no_gap(&gears(0.0, true), WHOLE);
    assert_no_gap(&gears(0.0, false), WINDOWS);
}

#[test]
fn residual_of_sleigh_is_noise() {
    assert_no_gap(&sleigh(0.0, true), WHOLE);
    assert_no_gap(&sleigh(0.0, false), WINDOWS);
}

/// Asserts that the specification with constraints and the one in independent coordinates have equal residuals.
fn assert_same<const S: usize, const C: usize>(machine: &Machine<S, C>, sampling: Sampling) {
    let [own, other] = [false, true].map(|which| compare(machine, sampling, which));
    for channel in &machine.channels {
        let of = (channel.name, channel.noise);
        let pairs = gap(&own, of).into_iter().zip(gap(&other, of));
        for (own, other) in pairs {
            assert!((own / other - 1.0).abs() < 0.02, "{}: {own} {other}", of.0);
        }
    }
}

#[test]
fn residuals_equal_those_in_independent_coordinates() {
    assert_same(&pendulum(0.3, 0.3, true), WINDOWS);
    assert_same(&slider_crank(0.4, 0.0, 0.3, true), WINDOWS);
}
