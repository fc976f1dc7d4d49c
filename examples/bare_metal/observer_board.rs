//! Runs the observer on a Cortex-M without operating system, standard library or allocator. It prints the bits of the
//! run, the instructions per step and per measurement, and the stack depth.
#![no_std]
#![no_main]

mod cortex;

use core::hint::black_box;

use controller::{Coefficients, prepared};
use cortex::{end, instructions, print, stack_depth};
use observed::{MEASUREMENTS, Rig, SHOWN};
use observer::{Observer, SENSORS};

/// The functions are separate, so that their stacks can be measured.
#[inline(never)]
fn step(observer: &mut Observer, coefficients: &Coefficients) {
    observer.step(black_box(0.1), black_box(0.1), coefficients);
}

#[inline(never)]
fn measured(observer: &mut Observer, coefficients: &Coefficients) {
    observer.measured(black_box(0.1), black_box(&[0.0; SENSORS]), coefficients);
}

#[unsafe(no_mangle)]
extern "C" fn run() -> ! {
    let coefficients = prepared();
    let mut rig = Rig::new(&coefficients);
    for count in 1..=MEASUREMENTS {
        rig.measure(&coefficients);
        if count % SHOWN == 0 {
            for number in rig.observer.state.iter().chain(&rig.arm) {
                print(b"state           ", number.to_bits(), 16);
            }
        }
    }
    let arm = black_box(&coefficients);
    let mut observer = Observer::new(arm);
    let number = u64::from;
    print(
        b"count step      ",
        number(instructions(|| step(&mut observer, arm))),
        8,
    );
    print(
        b"count measured  ",
        number(instructions(|| measured(&mut observer, arm))),
        8,
    );
    print(
        b"stack step      ",
        number(stack_depth(|| step(&mut observer, arm))),
        8,
    );
    print(
        b"stack measured  ",
        number(stack_depth(|| measured(&mut observer, arm))),
        8,
    );
    end()
}
