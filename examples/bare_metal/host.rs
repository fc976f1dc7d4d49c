//! The controller on the machine that it is developed on: prints the bits of the same motion.

use arm::{Coefficients, Parameters};
use controller::{State, displaced, step};

fn main() {
    let coefficients = Coefficients::prepare(&Parameters::default());
    assert!(coefficients.positive_definite);
    let mut state: State = displaced();
    for count in 1..=250_u32 {
        let t = f64::from(count - 1) * controller::STEP;
        state = step(t, &state, &coefficients);
        if count % 50 == 0 {
            for number in state {
                println!("state           {:016x}", number.to_bits());
            }
        }
    }
}
