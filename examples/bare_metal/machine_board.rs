//! Computes rates of a machine on a Cortex-M without operating system, standard library or allocator. It prints the
//! result of the self-test, the bits of the rates and the instructions per call at several states. The crate `machine`
//! is the version in Rust or in C.
#![no_std]
#![no_main]

mod cortex;
mod positions;

use core::hint::black_box;

use cortex::{end, instructions, print, stack_depth};
use machine::MOST_STATES;

#[unsafe(no_mangle)]
extern "C" fn run() -> ! {
    print(b"self test       ", u64::from(machine::self_test()), 8);
    let machine = machine::prepared();
    let mut rates = [0.0; MOST_STATES];
    for size in positions::SIZES {
        let state = positions::state(size);
        let mut call = || machine::rates(black_box(&machine), black_box(&state), black_box(&mut rates));
        print(b"count rates     ", u64::from(instructions(&mut call)), 8);
        if size == 1.0 {
            print(b"stack rates     ", u64::from(stack_depth(&mut call)), 8);
        }
        for rate in rates.iter().take(machine::states()) {
            print(b"state           ", u64::from(rate.to_bits()), 8);
        }
    }
    end()
}
