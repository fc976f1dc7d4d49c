//! State feedback for the planetary arm on its test rig, in a loop with the emitted arm. The motion is bit-identical on
//! a microcontroller and on any other machine.
#![no_std]
#![forbid(unsafe_code)]

use arm::STATES;
pub use arm::{Parameters, rates_into};

/// Number type: `f64`, or `f32` with `--cfg single`.
#[cfg(not(single))]
pub type Real = f64;
/// Number type: `f64`, or `f32` with `--cfg single`.
#[cfg(single)]
pub type Real = f32;

/// Coefficients of the arm.
pub type Coefficients = arm::Coefficients<Real>;

/// Inputs of the arm.
pub type Inputs = arm::Inputs<Real>;

/// State: mesh deflections, displacement of the carrier, modes, and their rates.
pub type State = [Real; STATES];

/// Step size, in s.
pub const STEP: Real = 20e-6;

/// Gain of u = -GAIN x in N m per m and N m per m/s. It is the gain of the discrete linear-quadratic regulator for one
/// step of the arm with both meshes in contact on their positive sides. The costs are (x/1 mm)^2 of positions, (rate/1
/// m/s)^2 of rates, and (u/1 N m)^2. The test `bare_metal_gain` recomputes it.
pub const GAIN: State = [
    192.6589, 456.0491, 998.8651, -312.1875, -105.3722, 20.75653, 457.063, 1.629354, 5.443445,
    23.76957, -1.397188, -0.8054563, -0.8642767, -0.8870597,
];

/// Prepares coefficients in double precision.
#[inline]
pub fn prepared_from(parameters: &Parameters) -> Coefficients {
    arm::Coefficients::prepare(parameters).cast()
}

/// Prepares the coefficients for the default parameters.
pub fn prepared() -> Coefficients {
    prepared_from(&Parameters::default())
}

/// Returns the initial state: at rest, with the carrier displaced by 2 mm and loaded meshes.
pub fn displaced() -> State {
    let mut state = [0.0; STATES];
    state[0] = 30e-6;
    state[1] = 30e-6;
    state[2] = 2e-3;
    state
}

/// Returns the torque of the motor for a state, in N m.
pub fn torque(state: &State) -> Real {
    let mut sum = 0.0;
    for i in 0..STATES {
        sum += GAIN[i] * state[i];
    }
    -sum
}

/// Computes one step of the closed loop at time `t` (in s); the torque is constant during the step.
pub fn step(t: Real, state: &State, coefficients: &Coefficients) -> State {
    driven(t, state, torque(state), coefficients)
}

/// Returns the state one step after time `t` (in s) for a constant torque (in N m), by the classical Runge-Kutta
/// method.
#[inline(always)]
pub fn driven(t: Real, state: &State, torque: Real, coefficients: &Coefficients) -> State {
    let inputs = Inputs { u: torque };
    let half = 0.5 * STEP;
    let rates = |t: Real, state: &State| {
        let mut rates = [0.0; STATES];
        rates_into(t, state, &inputs, coefficients, &mut rates);
        rates
    };
    let at_begin = rates(t, state);
    let at_middle = rates(t + half, &moved(state, half, &at_begin));
    let again = rates(t + half, &moved(state, half, &at_middle));
    let at_end = rates(t + STEP, &moved(state, STEP, &again));
    let mut next = *state;
    for i in 0..STATES {
        let between = at_middle[i] + again[i];
        next[i] += STEP / 6.0 * (at_begin[i] + 2.0 * between + at_end[i]);
    }
    next
}

/// Returns state + h rate.
fn moved(state: &State, h: Real, rate: &State) -> State {
    let mut moved = *state;
    for i in 0..STATES {
        moved[i] += h * rate[i];
    }
    moved
}
