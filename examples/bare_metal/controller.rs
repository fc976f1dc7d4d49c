//! State feedback for the planetary arm on its test rig, with the arm itself as emitted by
//! eomgen in the loop: the same on a microcontroller and on any other machine, to the bit.
//! Nothing of a board is here.
#![no_std]
#![forbid(unsafe_code)]

use arm::STATES;
pub use arm::{Parameters, rates_into};

/// What all numbers are: `f64`, or `f32` with `--cfg single`.
#[cfg(not(single))]
pub type Real = f64;
/// What all numbers are: `f64`, or `f32` with `--cfg single`.
#[cfg(single)]
pub type Real = f32;

/// The arm's coefficients.
pub type Coefficients = arm::Coefficients<Real>;

/// The arm's inputs.
pub type Inputs = arm::Inputs<Real>;

/// The state: deflections, the carrier's path, the modes, and the rates of all.
pub type State = [Real; STATES];

/// Length of a step, s.
pub const STEP: Real = 20e-6;

/// Torque per state, N m per m and N m per m/s: u = -GAIN x. The gain of the linear-quadratic
/// regulator of the arm with both meshes in contact on their positive sides, discretised over
/// a step, for costs of (x/1 mm)^2 for all positions, (rate/1 m/s)^2 for all rates, and
/// (u/1 N m)^2. The test `bare_metal_gain` computes it anew.
pub const GAIN: State = [
    192.6589, 456.0491, 998.8651, -312.1875, -105.3722, 20.75653, 457.063, 1.629354, 5.443445,
    23.76957, -1.397188, -0.8054563, -0.8642767, -0.8870597,
];

/// The coefficients of parameters, prepared in double precision.
#[inline]
pub fn prepared_from(parameters: &Parameters) -> Coefficients {
    arm::Coefficients::prepare(parameters).cast()
}

/// The coefficients of the specification's parameters.
pub fn prepared() -> Coefficients {
    prepared_from(&Parameters::default())
}

/// Where a run begins: the carrier displaced by 2 mm, at rest, the meshes loaded.
pub fn displaced() -> State {
    let mut state = [0.0; STATES];
    state[0] = 30e-6;
    state[1] = 30e-6;
    state[2] = 2e-3;
    state
}

/// The torque of the motor for a state, N m.
pub fn torque(state: &State) -> Real {
    let mut sum = 0.0;
    for i in 0..STATES {
        sum += GAIN[i] * state[i];
    }
    -sum
}

/// One step of the closed loop at time `t`, s: the torque for `state`, held.
pub fn step(t: Real, state: &State, coefficients: &Coefficients) -> State {
    driven(t, state, torque(state), coefficients)
}

/// Where the arm is a step after time `t`, s, under a torque that is held, N m, by the classical
/// method of Runge and Kutta.
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

/// state + h rate
fn moved(state: &State, h: Real, rate: &State) -> State {
    let mut moved = *state;
    for i in 0..STATES {
        moved[i] += h * rate[i];
    }
    moved
}
