//! Prints nonzeros of a Jacobian with their indices, and rates in single precision.

/// The planetary arm with its Jacobians.
mod arm {
    eomgen::model! {
        spec = "../../model-spec/models/planetary_arm.toml", order = 4, with = [jacobians, products]
    }
}

use arm::{Coefficients, Inputs, Parameters, RATES_BY_STATE, STATES};

fn main() {
    let coefficients = Coefficients::prepare(&Parameters::default());
    let state = [1e-4; STATES];
    let nonzeros = arm::rates_by_state(0.0, &state, &Inputs::default(), &coefficients);
    for (k, number) in nonzeros.iter().enumerate() {
        let (row, column) = (RATES_BY_STATE.rows[k], RATES_BY_STATE.columns[k]);
        println!("{row:>3} {column:>3} {number:e}");
    }
    let dense: [[f64; STATES]; STATES] = RATES_BY_STATE.dense(&nonzeros);
    println!(
        "{} of {} numbers",
        nonzeros.len(),
        dense.as_flattened().len()
    );

    // Preparation in double precision gives correctly rounded coefficients in single precision.
    let single = coefficients.cast::<f32>();
    let rates = arm::rates(0.0_f32, &[1e-4; STATES], &Inputs::default(), &single);
    println!("{rates:?}");
}
