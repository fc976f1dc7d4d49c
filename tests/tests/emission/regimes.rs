//! Tests of regime kernels: at every state in the regime they are bit-identical to the general rates, and they extend
//! smoothly beyond the regime.

use proptest::prelude::*;

mod arm_rigid {
    eomgen::model! { spec = "../model-spec/models/planetary_arm.toml", order = 0, with = [regimes] }
}
mod arm {
    eomgen::model! { spec = "../model-spec/models/planetary_arm.toml", order = 4, with = [regimes] }
}
mod arm_of_nine_modes {
    eomgen::model! { spec = "../model-spec/models/planetary_arm.toml", order = 9, with = [regimes] }
}

/// Model with other switching functions, and with selections from the derivative of a maximum.
mod switches {
    eomgen::model! {
        with = [regimes],
        model { name: switches }
        parameters {
            m: { value: 2, unit: kg },
            k: { value: 30, unit: N/m },
            d: { value: 0.2, unit: m },
            F: { value: 3, unit: N },
            v: { value: 1, unit: m/s },
        }
        coordinates {
            x: { unit: m },
            y: { unit: m },
        }
        kinetic { all: 1/2*m*(dot(x)^2 + dot(y)^2) }
        potential { pieces: 1/2*k*max(x, y)^2 + 1/2*k*min(x, d)^2 + k*d*abs(x + y) }
        forces {
            friction: { on: x, value: -F*sign(dot(x)) },
            limited: { on: y, value: -F*min(max(dot(y)/v, -1), 1) },
        }
    }
}

/// Draws a coordinate relative to the half-width: inside, just outside or far outside.
fn deflection() -> impl Strategy<Value = f64> {
    let size = prop_oneof![0.0..0.9_f64, 1.1..1.2_f64, 2.0..50.0_f64];
    (size, any::<bool>()).prop_map(|(size, turned)| if turned { -size } else { size })
}

fn bits<const N: usize>(numbers: &[f64; N]) -> [u64; N] {
    numbers.map(f64::to_bits)
}

/// Returns the rates of the kernel whose regime number, known only at run time, is in the list.
macro_rules! in_regime {
    ($module:ident, $regime:expr, $t:expr, $state:expr, $coefficients:expr, [$($known:literal)*]) => {{
        let mut rates = [f64::NAN; $module::STATES];
        let inputs = $module::Inputs::default();
        let known = match $regime {
            $($known => {
                $module::rates_in_regime_into::<$known, _>($t, $state, &inputs, $coefficients, &mut rates);
                true
            })*
            _ => false,
        };
        known.then_some(rates)
    }};
}

macro_rules! arms {
    ($($module:ident $within:ident $beyond:ident),*) => {$(
        proptest! {
            #[test]
            fn $within(
                deflections in [deflection(), deflection()],
                numbers in prop::collection::vec(-1.0..1.0_f64, $module::STATES),
                t in 0.0..10.0_f64,
            ) {
                let parameters = $module::Parameters { b_sp: 20e-6, b_pr: 30e-6, ..Default::default() };
                let coefficients = $module::Coefficients::prepare(&parameters);
                let mut state: [f64; $module::STATES] = std::array::from_fn(|i| 1e-2 * numbers[i]);
                state[0] = deflections[0] * parameters.b_sp;
                state[1] = deflections[1] * parameters.b_pr;
                let inputs = $module::Inputs::default();
                let sides = deflections.map(|p| if p > 1.0 { 3 } else if p < -1.0 { 0 } else { 2 });
                let regime = $module::regime(t, &state, &inputs, &coefficients);
                prop_assert_eq!(regime, sides[0] + 4 * sides[1]);
                let found = in_regime!($module, regime, t, &state, &coefficients, [0 2 3 8 10 11 12 14 15]);
                let expected = $module::rates(t, &state, &inputs, &coefficients);
                prop_assert_eq!(found.map(|rates| bits(&rates)), Some(bits(&expected)));
            }

            /// The kernel of the regime with both meshes inside the backlash must not depend on the backlash.
            #[test]
            fn $beyond(
                numbers in prop::collection::vec(-1.0..1.0_f64, $module::STATES),
                t in 0.0..10.0_f64,
            ) {
                let state: [f64; $module::STATES] = std::array::from_fn(|i| numbers[i]);
                let narrow = $module::Coefficients::prepare(&Default::default());
                let found = in_regime!($module, 10, t, &state, &narrow, [10]);
                let wide = $module::Parameters { b_sp: 2.0, b_pr: 2.0, ..Default::default() };
                let wide = $module::Coefficients::prepare(&wide);
                let expected = $module::rates(t, &state, &$module::Inputs::default(), &wide);
                prop_assert_eq!(found.map(|rates| bits(&rates)), Some(bits(&expected)));
            }
        }
    )*};
}

arms!(
    arm_rigid rigid_arm_kernels_match_rates_within_regime rigid_arm_kernels_extend_beyond_regime,
    arm arm_kernels_match_rates_within_regime arm_kernels_extend_beyond_regime,
    arm_of_nine_modes nine_mode_kernels_match_rates_within_regime nine_mode_kernels_extend_beyond_regime
);

proptest! {
    #[test]
    fn kernels_match_rates_for_every_switching_function(
        state in [-1.0..1.0_f64, -1.0..1.0, -3.0..3.0, -3.0..3.0],
        t in 0.0..10.0_f64,
    ) {
        let coefficients = switches::Coefficients::prepare(&Default::default());
        let inputs = switches::Inputs::default();
        prop_assert_eq!(switches::GUARDS, 6);
        let regime = switches::regime(t, &state, &inputs, &coefficients);
        let found = in_regime!(switches, regime, t, &state, &coefficients, [
            0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31
            32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63
        ]);
        let expected = switches::rates(t, &state, &inputs, &coefficients);
        prop_assert_eq!(found.map(|rates| bits(&rates)), Some(bits(&expected)));
    }
}
