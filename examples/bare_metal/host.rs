//! Runs the controller on the development machine and prints the bits of the motion, for comparison with the board.

use controller::{Real, State, displaced, prepared, step};

fn main() {
    let coefficients = prepared();
    // The flag is `bool` in Rust and an integer in C.
    assert_eq!(i32::from(coefficients.positive_definite), 1);
    let mut state: State = displaced();
    for count in 1..=250_u32 {
        let t = (count - 1) as Real * controller::STEP;
        state = step(t, &state, &coefficients);
        if count % 50 == 0 {
            for number in state {
                let digits = 2 * size_of::<Real>();
                println!("state           {:0digits$x}", number.to_bits());
            }
        }
    }
}
