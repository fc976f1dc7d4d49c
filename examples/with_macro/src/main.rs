//! Simulates a pendulum that is damped by a motor.

use with_macro::pendulum::{Coefficients, Inputs, Parameters, energy, rates};

fn main() {
    let coefficients = Coefficients::prepare(&Parameters::default()); // once, outside the loop
    assert!(coefficients.positive_definite);
    let (mut state, h) = ([1.0, 0.0], 1e-3);
    for step in 0..2000 {
        let inputs = Inputs {
            u: -0.05 * state[1],
        };
        let rate = rates(step as f64 * h, &state, &inputs, &coefficients);
        for i in 0..state.len() {
            state[i] += h * rate[i];
        }
    }
    let joules = energy(2.0, &state, &Inputs::default(), &coefficients);
    println!("theta = {:.6} rad, {joules:.6} J after 2 s", state[0]);
}
