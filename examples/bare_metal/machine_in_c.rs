//! Machine in C (`machine.c`) with the interface of the machine in Rust, for the same board and host programs.
#![no_std]

use core::ffi::c_int;

/// Maximum number of states.
pub const MOST_STATES: usize = 32;

/// State or rates; only the first numbers are used.
pub type Numbers = [f32; MOST_STATES];

/// Machine without data: its coefficients are constants of the C code.
pub struct Machine;

unsafe extern "C" {
    fn machine_self_test() -> c_int;
    fn machine_states() -> c_int;
    fn machine_rates(state: *const f32, rates: *mut f32);
}

/// Returns the machine with the default parameters.
pub fn prepared() -> Machine {
    Machine
}

/// Compares the emitted code with its test vectors in single precision. Returns 0 if all numbers are bit-identical,
/// otherwise the index of the first different number, counted from 1.
pub fn self_test() -> u32 {
    // SAFETY: the function only reads constants.
    unsafe { machine_self_test() as u32 }
}

/// Returns the number of states.
pub fn states() -> usize {
    // SAFETY: the function only returns a constant.
    unsafe { machine_states() as usize }
}

/// Computes the rates without inputs.
#[inline]
pub fn rates(_: &Machine, state: &Numbers, rates: &mut Numbers) {
    // SAFETY: both arrays have at least as many numbers as the machine has states.
    unsafe { machine_rates(state.as_ptr(), rates.as_mut_ptr()) };
}
