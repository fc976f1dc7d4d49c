//! Contenders: code that generated code is compared with. Each contender is a call that is not inlined, because emitted
//! functions are not inlined into other crates either. All contenders write their result to memory of the caller.

use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;

use crate::eliminated_arm::copy_in_pairs;

/// Calls a macro for every compared order with the order's module of [`crate::variants`].
#[macro_export]
macro_rules! at_all_orders {
    ($with:ident) => {
        $with!(
            0 order_0, 1 order_1, 2 order_2, 4 order_4, 8 order_8, 16 order_16, 32 order_32,
            64 order_64, 128 order_128
        )
    };
}

/// Defines the function `generated`, which calls the rates of an emitted module in scope.
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

/// Computes the floor: one sine and a copy of the rates in the state.
#[inline(never)]
pub fn floor<const N: usize>(t: f64, state: &[f64; N], omega: f64, rates: &mut [f64; N]) {
    copy_in_pairs(&state[N / 2..], &mut rates[..N / 2]);
    rates[N / 2] = eomgen_elementary::sin(omega * t);
}

/// Computes the rates by the hand-assembled Eq. (22).
#[inline(never)]
pub fn equation_22<const S: usize, const N: usize>(
    arm: &Equation22<S>,
    t: f64,
    state: &[f64; N],
    rates: &mut [f64; N],
) {
    arm.rates(t, state, rates);
}
