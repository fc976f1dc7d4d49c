//! The controller in C (`controller.c`) with the names of the one in Rust, so that one board and
//! one host program run either.
#![no_std]

use core::ffi::c_int;

/// What all numbers are: `f64`, or `f32` with `--cfg single`.
#[cfg(not(single))]
pub type Real = f64;
/// What all numbers are: `f64`, or `f32` with `--cfg single`.
#[cfg(single)]
pub type Real = f32;

/// Numbers in the state.
pub const STATES: usize = 14;

/// The state: deflections, the carrier's path, the modes, and the rates of all.
pub type State = [Real; STATES];

/// Length of a step, s.
pub const STEP: Real = 20e-6;

/// How many numbers a structure of the emitted C has, as `run` asked the C compiler.
const fn count(text: &str) -> usize {
    match usize::from_str_radix(text, 10) {
        Ok(count) => count,
        Err(_) => panic!("no number"),
    }
}

/// The arm's parameters.
#[repr(C)]
pub struct Parameters([f64; count(env!("ARM_PARAMETERS"))]);

/// The arm's coefficients.
#[repr(C)]
pub struct Coefficients {
    numbers: [Real; count(env!("ARM_COEFFICIENTS"))],
    /// Whether the mass matrix is positive definite: 1 or 0.
    pub positive_definite: c_int,
}

/// The arm's inputs.
#[repr(C)]
pub struct Inputs {
    /// Torque of the motor, N m.
    pub u: Real,
}

unsafe extern "C" {
    fn controller_default_parameters(parameters: *mut Parameters);
    fn controller_prepare(parameters: *const Parameters, prepared: *mut Coefficients);
    fn controller_displaced(state: *mut Real);
    fn controller_step(t: Real, state: *const Real, arm: *const Coefficients, next: *mut Real);
    fn planetary_arm_rig_rates(
        t: Real,
        state: *const Real,
        inputs: *const Inputs,
        coefficients: *const Coefficients,
        rates: *mut Real,
    );
}

impl Default for Parameters {
    fn default() -> Self {
        let mut parameters = Self([0.0; _]);
        // SAFETY: the structure in C holds as many doubles.
        unsafe { controller_default_parameters(&mut parameters) };
        parameters
    }
}

/// The coefficients of parameters, prepared in double precision.
#[inline]
pub fn prepared_from(parameters: &Parameters) -> Coefficients {
    let mut prepared = Coefficients {
        numbers: [0.0; _],
        positive_definite: 0,
    };
    // SAFETY: the structure in C holds as many numbers and the flag.
    unsafe { controller_prepare(parameters, &mut prepared) };
    prepared
}

/// The coefficients of the specification's parameters.
pub fn prepared() -> Coefficients {
    prepared_from(&Parameters::default())
}

/// Where a run begins.
pub fn displaced() -> State {
    let mut state = [0.0; STATES];
    // SAFETY: the state in C is as long.
    unsafe { controller_displaced(state.as_mut_ptr()) };
    state
}

/// The emitted rates.
#[inline]
pub fn rates_into(
    t: Real,
    state: &State,
    inputs: &Inputs,
    coefficients: &Coefficients,
    rates: &mut State,
) {
    let (state, rates) = (state.as_ptr(), rates.as_mut_ptr());
    // SAFETY: arrays and structures in C are as long.
    unsafe { planetary_arm_rig_rates(t, state, inputs, coefficients, rates) };
}

/// One step of the closed loop at time `t`, s.
#[inline]
pub fn step(t: Real, state: &State, coefficients: &Coefficients) -> State {
    let mut next = [0.0; STATES];
    // SAFETY: arrays and the structure in C are as long.
    unsafe { controller_step(t, state.as_ptr(), coefficients, next.as_mut_ptr()) };
    next
}
