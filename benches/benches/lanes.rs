//! Benchmark of the arm at many states, scalar and 8-wide with every SIMD instruction set of this machine. It prints
//! nanoseconds per state and the throughput relative to scalar calls. The fastest of many rounds counts, because other
//! work can only lengthen a round.

use std::hint::black_box;
use std::time::Instant;

use eomgen_benches::{generated, state};
use eomgen_lanes::{LANES, Lanes, Registers, Task, Vector};

/// The variants are emitted in this crate, because `scalar!` implements traits of the emitted module, which must be
/// local.
#[allow(dead_code)]
mod variants {
    include!(concat!(env!("OUT_DIR"), "/variants.rs"));
}

::eomgen_lanes::scalar!(variants::full_order_4);
::eomgen_lanes::scalar!(variants::full_order_16);
::eomgen_lanes::scalar!(variants::full_order_64);

/// Number of states.
const STATES: usize = 16;

/// Number of calls per state in a round. The states remain in SIMD vectors, as in the integration of a motion.
const PASSES: usize = 32;

/// Number of rounds; the fastest counts.
const ROUNDS: usize = 2000;

fn measure_shortest(mut round: impl FnMut()) -> f64 {
    let seconds = |_| {
        let start = Instant::now();
        round();
        start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(seconds).fold(f64::INFINITY, f64::min) / (PASSES * STATES) as f64 * 1e9
}

/// Returns slightly different times for the lanes.
fn times(place: usize) -> [f64; LANES] {
    std::array::from_fn(|k| 0.3 + 1e-3 * (LANES * place + k) as f64)
}

macro_rules! compare {
    ($($order:literal $module:ident),*) => {$({
        use variants::$module as arm;
        type OfEight = [[f64; LANES]; arm::STATES];

        struct All<'a> {
            states: &'a [OfEight],
            rates: &'a mut [OfEight],
            coefficients: &'a arm::Coefficients,
        }

        impl Task for All<'_> {
            type Output = ();
            #[inline(always)]
            fn run<V: Vector>(self) {
                for (place, (numbers, out)) in self.states.iter().zip(self.rates).enumerate() {
                    let state = Lanes::<V>::from_arrays(numbers);
                    let t = Lanes::from_array(times(place));
                    let mut rates = state;
                    for _ in 0..PASSES {
                        let (state, coefficients) = (black_box(&state), black_box(self.coefficients));
                        arm::inlined_rates_into(t, state, &arm::Inputs::default(), coefficients, &mut rates);
                        black_box(&rates);
                    }
                    *out = Lanes::to_arrays(&rates);
                }
            }
        }

        generated!(arm);

        let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
        let single = [state::<{ arm::STATES }>(); STATES];
        let mut single_rates = single;
        let alone = measure_shortest(|| {
            for (place, (state, found)) in single.iter().zip(&mut single_rates).enumerate() {
                let t = times(place / LANES)[place % LANES];
                for _ in 0..PASSES {
                    generated(t, black_box(state), black_box(&coefficients), found);
                    black_box(&found);
                }
            }
            black_box(&single_rates);
        });
        let states = [state::<{ arm::STATES }>().map(|number| [number; LANES]); STATES / LANES];
        let mut lane_rates = states;
        print!("order {:>2}: one by one {alone:6.1} ns", $order);
        for registers in Registers::ALL.into_iter().filter(|kind| kind.are_available()) {
            let time = measure_shortest(|| {
                eomgen_lanes::run_with(registers, All {
                    states: black_box(&states),
                    rates: &mut lane_rates,
                    coefficients: black_box(&coefficients),
                });
                black_box(&lane_rates);
            });
            print!(", {registers:?} {time:6.1} ns ({:.2} times)", alone / time);
            for (place, rates) in single_rates.iter().enumerate() {
                let found = lane_rates[place / LANES].map(|numbers| numbers[place % LANES]);
                assert_eq!(rates, &found, "lanes and scalars differ");
            }
        }
        println!();
    })*};
}

fn main() {
    compare!(4 full_order_4, 16 full_order_16, 64 full_order_64);
}
