//! Tests of `compare` with correct models of machines on a moving base, whose prescribed motion is recorded.

use eomgen_tests::moving_base::{Machine, Recording};
use eomgen_tests::moving_machines::{mast, pendulum, slider, tower};
use eomgen_tests::program::{Texts, run_on_texts};

const IN_M: (&str, f64) = ("m", 1.0);

fn assert_no_gap<const N: usize, const C: usize>(machine: &Machine<N, C>, recording: Recording) {
    let [train, test] = &machine.records(recording);
    let texts = Texts {
        specification: &machine.specification,
        dataset: &machine.dataset(recording),
        train,
        test,
    };
    let found = run_on_texts("compare", texts);
    assert_eq!(found["verdict"], "no_significant_gap", "{:#}", found["gap"]);
    for channel in machine.channels {
        for key in ["floor", "train", "test"] {
            let size = found["gap"][channel][key].as_f64().expect("a number") / machine.noise.0;
            assert!((0.95..1.05).contains(&size), "{channel} {key}: {size}");
        }
    }
}

#[test]
fn residual_of_tower_is_noise_in_any_unit_and_sampling() {
    for (step, parts, unit) in [(4e-3, 80, IN_M), (4e-3, 80, ("mm", 1e-3)), (2e-3, 40, IN_M)] {
        let recording = Recording { step, parts, unit };
        assert_no_gap(&tower(|_, _| 0.0), recording);
    }
}

#[test]
fn residual_of_pendulum_with_a_moving_pivot_is_noise() {
    let recording = Recording {
        step: 5e-3,
        parts: 100,
        unit: IN_M,
    };
    assert_no_gap(&pendulum(0.0), recording);
}

#[test]
fn residual_of_mass_with_friction_on_moving_base_is_noise() {
    let recording = Recording {
        step: 4e-3,
        parts: 100,
        unit: IN_M,
    };
    assert_no_gap(&slider(|_, _| 0.0), recording);
}

#[test]
fn residual_of_beam_on_a_moving_base_is_noise() {
    let recording = Recording {
        step: 1e-3,
        parts: 100,
        unit: IN_M,
    };
    assert_no_gap(&mast(|_, _| 0.0), recording);
}
