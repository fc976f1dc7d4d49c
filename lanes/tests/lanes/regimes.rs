//! SIMD rates in one regime, bit-identical to a scalar evaluation.

use eomgen_lanes::{LANES, Lanes, Registers, Task, Vector};

mod arm {
    eomgen::model! {
        spec = "../model-spec/models/planetary_arm.toml", order = 9, with = [lanes, regimes]
    }
}
eomgen_lanes::scalar!(arm);

/// Regime with x_sp above its play and x_pr within it; the guards are x - b and x + b of each.
const REGIME: u32 = 0b1011;

struct All<'a> {
    states: &'a [[f64; LANES]; arm::STATES],
    coefficients: &'a arm::Coefficients,
}

impl Task for All<'_> {
    type Output = (u32, [[f64; LANES]; arm::STATES]);
    #[inline(always)]
    fn run<V: Vector>(self) -> Self::Output {
        let (t, state) = (Lanes::<V>::splat(0.3), Lanes::<V>::from_arrays(self.states));
        let (inputs, c) = (arm::Inputs::default(), self.coefficients);
        let regime = arm::inlined_regime(t, &state, &inputs, c);
        let mut rates = state;
        arm::inlined_rates_in_regime_into::<REGIME, _, _>(t, &state, &inputs, c, &mut rates);
        (regime, Lanes::to_arrays(&rates))
    }
}

#[test]
fn lanes_within_one_regime_match_scalars() {
    let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
    let mut states: [[f64; LANES]; arm::STATES] = std::array::from_fn(|i| {
        std::array::from_fn(|k| 1e-3 * (1.0 + i as f64) / (1.0 + k as f64))
    });
    states[1] = std::array::from_fn(|k| 3e-6 * k as f64);
    for registers in Registers::ALL.into_iter().filter(|r| r.are_available()) {
        let task = All {
            states: &states,
            coefficients: &coefficients,
        };
        let (regime, found) = eomgen_lanes::run_with(registers, task);
        assert_eq!(regime, REGIME);
        for k in 0..LANES {
            let state = states.map(|numbers| numbers[k]);
            let scalar = arm::rates(0.3, &state, &arm::Inputs::default(), &coefficients);
            let lane = found.map(|numbers| numbers[k].to_bits());
            assert_eq!(lane, scalar.map(f64::to_bits), "{registers:?}, lane {k}");
        }
    }
}
