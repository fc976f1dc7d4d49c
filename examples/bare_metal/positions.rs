//! States at which the board and the host compute the rates.

use machine::{MOST_STATES, Numbers};

/// Magnitudes of the coordinates, from small angles to many turns.
pub const SIZES: [f32; 7] = [1e-3, 0.3, 1.0, 3.0, 10.0, 100.0, 3e4];

/// Returns a state with coordinates of magnitude `size` and rates of about one.
pub fn state(size: f32) -> Numbers {
    let half = machine::states() / 2;
    let mut state = [0.0; MOST_STATES];
    let mut factor = size;
    for (place, number) in state.iter_mut().enumerate() {
        if place == half {
            factor = 1.0;
        }
        *number = factor;
        factor = -1.1 * factor;
    }
    state
}
