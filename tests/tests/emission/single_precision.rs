//! Comparison of emitted code in `f32` with double precision, within a bound of the accumulated `f32` rounding errors.

#[path = "../../requested/tests/requested/rounded.rs"]
mod rounded;

use proptest::prelude::*;

use rounded::Rounded;

/// Tolerance relative to the first-order bound. Products of two rounding errors, and rounding errors of double
/// precision, are about 1e-7 of the bound.
const FIRST_ORDER: f64 = 1.001;

/// Acceleration of the sun due to each of the motor's terms, in m/s^2. At rest the terms can cancel.
const MOTOR: f64 = 100.0;

/// Number in double precision with a bound of its error in single precision.
type Single = Rounded<24>;

/// Returns the error of an elementary function in addition to the rounding of its result. The sum of both is at most
/// two units in the last place.
fn function_error(value: f64) -> f64 {
    3.0 * value.abs() / f64::from(1 << 24)
}

macro_rules! agrees {
    ($($module:ident $order:literal $test:ident)*) => {$(
        mod $module {
            eomgen::model! { spec = "../model-spec/models/planetary_arm.toml", order = $order }
        }

        impl $module::Scalar for Single {
            fn number(value: f64) -> Self {
                Self::with_rounding(value, 0.0)
            }
            fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                if a.number > b.number { then } else { otherwise }
            }
            fn all_greater(a: Self, b: Self) -> bool {
                a.number > b.number
            }
            fn function<F: $module::Function>(self) -> Self {
                let value = F::value(self.number);
                Self::with_rounding(value, F::slope(self.number, value).abs() * self.error + function_error(value))
            }
            fn function_of_two<F: $module::FunctionOfTwo>(self, other: Self) -> Self {
                let value = F::value(self.number, other.number);
                let [first, second] = F::slopes(self.number, other.number, value);
                let error = first.abs() * self.error + second.abs() * other.error;
                Self::with_rounding(value, error + function_error(value))
            }
        }

        proptest! {
            /// Amplitudes of modes decrease with the mode number, as in a real motion. Deflections are far from the
            /// edge of the backlash, so both precisions see the same side.
            #[test]
            fn $test(
                numbers in prop::collection::vec(-1.0..1.0_f32, $module::STATES),
                deflections in [deflection(), deflection()],
                t in 0.0..1.0_f32,
            ) {
                let degrees = $module::DEGREES_OF_FREEDOM;
                let coefficients = $module::Coefficients::prepare(&$module::Parameters::default());
                let mut state: [f32; $module::STATES] = std::array::from_fn(|i| {
                    let mode = (i % degrees).saturating_sub(2).max(1) as f32;
                    1e-3 * numbers[i] / (mode * mode)
                });
                state[..2].copy_from_slice(&deflections);
                let inputs = $module::Inputs::default();
                let single = coefficients.cast::<f32>();
                let bounded = coefficients.cast::<Single>();
                let exact = state.map(Single::exact);
                let rates = $module::rates(t, &state, &inputs, &single);
                let expected = $module::rates(Single::exact(t), &exact, &inputs, &bounded);
                assert_within_bounds(&rates, &expected)?;
                assert_bounds_are_sharp(&expected)?;
                let exact_numbers = exact.map(|number| number.number);
                let (t_double, inputs_double) = (f64::from(t), $module::Inputs::default());
                let double = $module::rates(t_double, &exact_numbers, &inputs_double, &coefficients);
                prop_assert_eq!(double, expected.map(|rate| rate.number));
                let observables = $module::observables(t, &state, &inputs, &single);
                let expected = $module::observables(Single::exact(t), &exact, &inputs, &bounded);
                assert_within_bounds(&observables, &expected)?;
            }
        }
    )*};
}

/// Draws a deflection of a mesh in m; the backlash is 25e-6 m.
fn deflection() -> impl Strategy<Value = f32> {
    (prop_oneof![0.0..2e-5_f32, 3e-5..1e-3_f32], any::<bool>())
        .prop_map(|(size, turned)| if turned { -size } else { size })
}

fn assert_within_bounds(found: &[f32], expected: &[Single]) -> Result<(), TestCaseError> {
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (f64::from(*found) - expected.number).abs();
        prop_assert!(
            error <= FIRST_ORDER * expected.error,
            "number {i}: {found:e} and {expected:?}"
        );
    }
    Ok(())
}

/// Asserts that the bounds are tight: at most 1e-4 of the largest acceleration.
fn assert_bounds_are_sharp(rates: &[Single]) -> Result<(), TestCaseError> {
    let sizes = rates.iter().map(|rate| rate.number.abs());
    let largest = sizes.fold(MOTOR, f64::max);
    for rate in rates {
        prop_assert!(rate.error <= 1e-4 * largest, "{rate:?} of {largest:e}");
    }
    Ok(())
}

agrees! {
    rigid 0 rigid_arm_is_within_rounding_bounds
    one 1 arm_with_one_mode_is_within_rounding_bounds
    four 4 arm_with_four_modes_is_within_rounding_bounds
    sixty_four 64 arm_with_64_modes_is_within_rounding_bounds
    many 128 arm_with_128_modes_is_within_rounding_bounds
}
