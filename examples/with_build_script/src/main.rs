//! Simulates the arm from rest with twice the specified play.

use with_build_script::arm::{Coefficients, Inputs, Parameters, STATE_NAMES, STATES, rates};

fn main() {
    let parameters = Parameters {
        b_sp: 50e-6,
        b_pr: 50e-6,
        ..Parameters::default()
    };
    let coefficients = Coefficients::prepare(&parameters); // once, outside the loop
    assert!(coefficients.positive_definite);
    let (mut state, h) = ([0.0; STATES], 1e-6);
    for step in 0..10_000 {
        let rate = rates(step as f64 * h, &state, &Inputs::default(), &coefficients);
        for i in 0..STATES {
            state[i] += h * rate[i];
        }
    }
    println!("{} = {:.6} m after 10 ms", STATE_NAMES[2], state[2]);
}
