//! Rates of an emitted machine in single precision, with an interface that does not depend on the number of states.
//! `machine.c` has the same interface for emitted C.
#![no_std]
#![forbid(unsafe_code)]

use arm::{Inputs, Parameters, STATES};

/// Maximum number of states.
pub const MOST_STATES: usize = 32;

/// State or rates; only the first numbers are used.
pub type Numbers = [f32; MOST_STATES];

/// Machine: coefficients, prepared in double precision.
pub struct Machine(arm::Coefficients<f32>);

/// Prepares the coefficients for the default parameters.
pub fn prepared() -> Machine {
    Machine(arm::Coefficients::prepare(&Parameters::default()).cast())
}

mod vectors {
    use arm as model;
    include!(concat!(env!("ARM_FOLDER"), "/vectors.rs"));
}

/// Compares the emitted code with its test vectors in single and in double precision. Returns 0 if all numbers are
/// bit-identical. Otherwise returns the index of the first different number, counted from 1, plus 1 000 000 for double
/// precision.
pub fn self_test() -> u32 {
    match (vectors::self_test_single(), vectors::self_test()) {
        (Some(place), _) => place as u32 + 1,
        (None, Some(place)) => place as u32 + 1_000_001,
        (None, None) => 0,
    }
}

/// Returns the number of states.
pub fn states() -> usize {
    STATES
}

/// Computes the rates without inputs.
#[inline]
pub fn rates(machine: &Machine, state: &Numbers, rates: &mut Numbers) {
    if let (Some(state), Some(rates)) = (state.first_chunk(), rates.first_chunk_mut()) {
        arm::rates_into(0.1, state, &Inputs::default(), &machine.0, rates);
    }
}
