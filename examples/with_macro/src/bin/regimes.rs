//! Computes rates with the kernel of the regime of a state.

/// The planetary arm with its regimes.
mod arm {
    eomgen::model! {
        spec = "../../model-spec/models/planetary_arm.toml", order = 4, with = [regimes]
    }
}

use arm::{Coefficients, Inputs, Parameters, STATES};

/// Number of the regime with both meshes within their play.
const WITHIN: u32 = 0b1010;

fn main() {
    let coefficients = Coefficients::prepare(&Parameters::default());
    let (t, state, inputs) = (0.0, [1e-5; STATES], Inputs::default());
    let mut rates = [0.0; STATES];
    match arm::regime(t, &state, &inputs, &coefficients) {
        WITHIN => {
            arm::rates_in_regime_into::<WITHIN, _>(t, &state, &inputs, &coefficients, &mut rates)
        }
        _ => arm::rates_into(t, &state, &inputs, &coefficients, &mut rates),
    }
    println!("{rates:?}");
}
