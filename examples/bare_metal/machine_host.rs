//! Computes rates of a machine on the development machine and prints their bits, for the same calls as on the board.

mod positions;

use machine::MOST_STATES;

fn main() {
    println!("self test       {:08x}", machine::self_test());
    let machine = machine::prepared();
    let mut rates = [0.0; MOST_STATES];
    for size in positions::SIZES {
        machine::rates(&machine, &positions::state(size), &mut rates);
        for rate in rates.iter().take(machine::states()) {
            println!("state           {:08x}", rate.to_bits());
        }
    }
}
