//! Tests that every SIMD lane is bit-identical to a scalar computation on all instruction sets: all functions of the
//! language, and a model with contacts whose regimes differ between lanes.

use eomgen_lanes::{LANES, Lanes, Registers, Task, Vector};
use proptest::prelude::*;

mod functions {
    eomgen::model! { spec = "../features/functions.toml", order = 0, with = [lanes] }
}
eomgen_lanes::scalar!(functions);

mod arm {
    eomgen::model! { spec = "../../model-spec/models/planetary_arm.toml", order = 9, with = [lanes] }
}
eomgen_lanes::scalar!(arm);

/// Runs `run` on a thread with a large stack, because unoptimised builds need separate stack slots for all inlined
/// functions.
fn run_with_large_stack<T: Send>(run: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(1 << 28);
        let thread = thread.spawn_scoped(scope, run).expect("a thread");
        thread.join().expect("no panic")
    })
}

macro_rules! bits {
    ($module:ident, $test:ident, $scale:literal) => {
        proptest! {
            #[test]
            fn $test(numbers in prop::collection::vec(-1.0..1.0_f64, LANES * ($module::STATES + 1))) {
                struct All {
                    t: [f64; LANES],
                    state: [[f64; LANES]; $module::STATES],
                    coefficients: $module::Coefficients,
                }
                impl Task for All {
                    type Output = Vec<[f64; LANES]>;
                    #[inline(always)]
                    fn run<V: Vector>(self) -> Self::Output {
                        let (t, state) = (Lanes::<V>::from_array(self.t), Lanes::from_arrays(&self.state));
                        let (inputs, c) = ($module::Inputs::default(), &self.coefficients);
                        let rates = $module::inlined_rates(t, &state, &inputs, c);
                        let observables = $module::inlined_observables(t, &state, &inputs, c);
                        rates.iter().chain(&observables).map(|lanes| lanes.to_array()).collect()
                    }
                }
                let lane = |i: usize| -> [f64; LANES] {
                    // The magnitudes are on both sides of every threshold.
                    std::array::from_fn(|k| {
                        let number = numbers[i * LANES + k];
                        $scale * number * 10_f64.powf(4.0 * number)
                    })
                };
                let coefficients = $module::Coefficients::prepare(&$module::Parameters::default());
                let all = || All { t: lane($module::STATES), state: std::array::from_fn(lane), coefficients };
                let mut expected = vec![[0.0; LANES]; $module::STATES + $module::OBSERVABLES];
                for k in 0..LANES {
                    let state = all().state.map(|numbers| numbers[k]);
                    let (t, inputs) = (all().t[k], $module::Inputs::default());
                    let rates = $module::rates(t, &state, &inputs, &coefficients);
                    let observables = $module::observables(t, &state, &inputs, &coefficients);
                    for (place, number) in rates.iter().chain(&observables).enumerate() {
                        expected[place][k] = *number;
                    }
                }
                for registers in Registers::ALL.into_iter().filter(|r| r.are_available()) {
                    let task = all();
                    let found = run_with_large_stack(move || eomgen_lanes::run_with(registers, task));
                    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                        let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
                        prop_assert!(same, "{registers:?}: {found:e} and {expected:e}");
                    }
                }
            }
        }
    };
}

bits!(functions, functions_in_lanes_match_scalars, 1.0);
bits!(arm, arm_in_lanes_matches_scalars, 1e-3);
