//! Runs the controller on a Cortex-M without operating system, standard library or allocator. It prints the bits of the
//! motion, the instructions per call and the stack depth. The crate `controller` is the version in Rust or in C.
#![no_std]
#![no_main]

mod cortex;

use core::hint::black_box;

use controller::{
    Coefficients, Inputs, Parameters, Real, State, displaced, prepared, rates_into, step,
};
use cortex::{end, instructions, print, stack_depth};

/// Number of steps.
const STEPS: u32 = 250;
/// Number of steps between printed states.
const SHOWN: u32 = 50;
/// Number of hexadecimal digits.
const DIGITS: usize = 2 * size_of::<Real>();

/// The function is separate, so that its stack can be measured.
#[inline(never)]
fn prepared_from(parameters: &Parameters) -> Coefficients {
    controller::prepared_from(parameters)
}

#[unsafe(no_mangle)]
extern "C" fn run() -> ! {
    let coefficients = prepared();
    let mut state: State = displaced();
    for count in 1..=STEPS {
        let t = (count - 1) as Real * controller::STEP;
        state = step(t, &state, &coefficients);
        if count % SHOWN == 0 {
            for number in state {
                print(b"state           ", u64::from(number.to_bits()), DIGITS);
            }
        }
    }
    let inputs = Inputs { u: 0.1 };
    let mut rates = state;
    let mut rate = || {
        rates_into(
            black_box(0.1),
            black_box(&state),
            &inputs,
            black_box(&coefficients),
            black_box(&mut rates),
        );
    };
    let closed = || {
        black_box(step(
            black_box(0.1),
            black_box(&state),
            black_box(&coefficients),
        ));
    };
    let parameters = Parameters::default();
    let prepare = || {
        black_box(prepared_from(black_box(&parameters)));
    };
    print(b"count rates     ", u64::from(instructions(&mut rate)), 8);
    print(b"count step      ", u64::from(instructions(closed)), 8);
    print(b"stack rates     ", u64::from(stack_depth(&mut rate)), 8);
    print(b"stack step      ", u64::from(stack_depth(closed)), 8);
    print(b"stack prepare   ", u64::from(stack_depth(prepare)), 8);
    end()
}
