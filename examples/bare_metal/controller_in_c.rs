//! Controller in C (`controller.c`) with the interface of the controller in Rust, for the same board and host programs.
#![no_std]

use core::ffi::c_int;

/// Number type: `f64`, or `f32` with `--cfg single`.
#[cfg(not(single))]
pub type Real = f64;
/// Number type: `f64`, or `f32` with `--cfg single`.
#[cfg(single)]
pub type Real = f32;

/// Number of states.
pub const STATES: usize = 14;

/// State: mesh deflections, displacement of the carrier, modes, and their rates.
pub type State = [Real; STATES];

/// Step size, in s.
pub const STEP: Real = 20e-6;

/// Parses the number of values in a structure of the emitted C. The script `run` obtains it from the C compiler.
const fn count(text: &str) -> usize {
    match usize::from_str_radix(text, 10) {
        Ok(count) => count,
        Err(_) => panic!("no number"),
    }
}

/// Parameters of the arm.
#[repr(C)]
pub struct Parameters([f64; count(env!("ARM_PARAMETERS"))]);

/// Coefficients of the arm.
#[repr(C)]
pub struct Coefficients {
    numbers: [Real; count(env!("ARM_COEFFICIENTS"))],
    /// 1 if the mass matrix is positive definite, otherwise 0.
    pub positive_definite: c_int,
}

/// Inputs of the arm.
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
    // The header adds the number type, unless it is double, to the external names.
    #[cfg_attr(single, link_name = "planetary_arm_rig_rates_float")]
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
        // SAFETY: the structure in C has the same number of doubles.
        unsafe { controller_default_parameters(&mut parameters) };
        parameters
    }
}

/// Prepares coefficients in double precision.
#[inline]
pub fn prepared_from(parameters: &Parameters) -> Coefficients {
    let mut prepared = Coefficients {
        numbers: [0.0; _],
        positive_definite: 0,
    };
    // SAFETY: the structure in C has the same number of values and the flag.
    unsafe { controller_prepare(parameters, &mut prepared) };
    prepared
}

/// Prepares the coefficients for the default parameters.
pub fn prepared() -> Coefficients {
    prepared_from(&Parameters::default())
}

/// Returns the initial state.
pub fn displaced() -> State {
    let mut state = [0.0; STATES];
    // SAFETY: the state in C has the same length.
    unsafe { controller_displaced(state.as_mut_ptr()) };
    state
}

/// Calls the emitted rates.
#[inline]
pub fn rates_into(
    t: Real,
    state: &State,
    inputs: &Inputs,
    coefficients: &Coefficients,
    rates: &mut State,
) {
    let (state, rates) = (state.as_ptr(), rates.as_mut_ptr());
    // SAFETY: arrays and structures in C have the same length.
    unsafe { planetary_arm_rig_rates(t, state, inputs, coefficients, rates) };
}

/// Computes one step of the closed loop at time `t` (in s).
#[inline]
pub fn step(t: Real, state: &State, coefficients: &Coefficients) -> State {
    let mut next = [0.0; STATES];
    // SAFETY: arrays and the structure in C have the same length.
    unsafe { controller_step(t, state.as_ptr(), coefficients, next.as_mut_ptr()) };
    next
}
