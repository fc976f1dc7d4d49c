//! What generated code is compared with, each as one call that is not inlined: emitted
//! functions are not inlined into other crates, so neither are the others. All write their
//! result to where the caller wants it.

use eomgen_paper::reference::equation_22::{Equation22, copy_in_pairs};

/// Calls a macro with every order that is compared and the module of [`crate::variants`]
/// that holds it.
#[macro_export]
macro_rules! at_all_orders {
    ($with:ident) => {
        $with!(
            0 order_0, 1 order_1, 2 order_2, 4 order_4, 8 order_8, 16 order_16, 32 order_32,
            64 order_64, 128 order_128
        )
    };
}

/// Defines `generated`, one call of the rates of the emitted module in scope under this name.
#[macro_export]
macro_rules! generated {
    ($arm:ident) => {
        #[inline(never)]
        fn generated(
            t: f64,
            state: &[f64; $arm::STATES],
            coefficients: &$arm::Coefficients,
            rates: &mut [f64; $arm::STATES],
        ) {
            $arm::rates_into(t, state, &$arm::Inputs::default(), coefficients, rates);
        }
    };
}

/// What nobody can go below: one sine, and the rates as they stand in the state.
#[inline(never)]
pub fn floor<const N: usize>(t: f64, state: &[f64; N], omega: f64, rates: &mut [f64; N]) {
    copy_in_pairs(&state[N / 2..], &mut rates[..N / 2]);
    rates[N / 2] = eomgen_elementary::sin(omega * t);
}

/// Hand-assembled Eq. (22).
#[inline(never)]
pub fn equation_22<const S: usize, const N: usize>(
    arm: &Equation22<S>,
    t: f64,
    state: &[f64; N],
    rates: &mut [f64; N],
) {
    arm.rates(t, state, rates);
}
