//! Throughput of a task that calls the rates several times, as a Runge-Kutta method does. A function that is not inlined
//! would be compiled for the baseline instruction set, and lanes would be slower than scalars.

use std::hint::black_box;
use std::ops::{Add, Mul};
use std::time::Instant;

use eomgen_lanes::{LANES, Lanes, Registers, Task, Vector};

mod arm {
    eomgen::model! {
        spec = "../model-spec/models/planetary_arm.toml", order = 16, with = [lanes]
    }
}
eomgen_lanes::scalar!(arm);

/// Minimum number of measurements. The fastest counts: other work disturbs it least.
const ROUNDS: usize = 300;
/// Longest time for repeated measurements of slow lanes, s: a machine can be slow for a while.
const PATIENCE: f64 = 3.0;
const STEPS: usize = 10;
const STEP: f64 = 1e-6;

type State<T> = [T; arm::STATES];

/// Returns x + h y.
#[inline(always)]
fn moved<T: Copy + Add<Output = T> + Mul<Output = T>>(
    x: &State<T>,
    h: T,
    y: &State<T>,
) -> State<T> {
    let mut moved = *x;
    for i in 0..arm::STATES {
        moved[i] = x[i] + h * y[i];
    }
    moved
}

/// Computes a step of the classical Runge-Kutta method over `h`.
macro_rules! step {
    ($rates:path, $t:expr, $state:expr, $c:expr, $h:expr, $half:expr, $sixth:expr, $third:expr) => {{
        let inputs = arm::Inputs::default();
        let a = $rates($t, &$state, &inputs, $c);
        let b = $rates($t, &moved(&$state, $half, &a), &inputs, $c);
        let c = $rates($t, &moved(&$state, $half, &b), &inputs, $c);
        let d = $rates($t, &moved(&$state, $h, &c), &inputs, $c);
        $state = moved(&$state, $sixth, &a);
        $state = moved(&$state, $third, &b);
        $state = moved(&$state, $third, &c);
        $state = moved(&$state, $sixth, &d);
    }};
}

struct Motion<'a> {
    states: &'a mut State<[f64; LANES]>,
    coefficients: &'a arm::Coefficients,
}

impl Task for Motion<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: Vector>(self) {
        let mut state = Lanes::<V>::from_arrays(self.states);
        let number = |number| Lanes::splat(number);
        let (t, h, half) = (number(0.3), number(STEP), number(STEP / 2.0));
        let (sixth, third) = (number(STEP / 6.0), number(STEP / 3.0));
        for _ in 0..STEPS {
            step!(
                arm::inlined_rates,
                t,
                state,
                self.coefficients,
                h,
                half,
                sixth,
                third
            );
        }
        *self.states = Lanes::to_arrays(&state);
    }
}

fn scalar(state: &mut State<f64>, coefficients: &arm::Coefficients) {
    let (half, sixth, third) = (STEP / 2.0, STEP / 6.0, STEP / 3.0);
    for _ in 0..STEPS {
        step!(
            arm::rates,
            0.3,
            *state,
            coefficients,
            STEP,
            half,
            sixth,
            third
        );
    }
}

fn seconds(call: impl FnOnce()) -> f64 {
    let start = Instant::now();
    call();
    start.elapsed().as_secs_f64()
}

#[test]
fn eight_wide_steps_are_faster_than_scalar_steps() {
    if cfg!(debug_assertions) {
        skips::skip(
            "lanes were not timed, because this build is not optimised: cargo test --release",
        );
        return;
    }
    let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
    let begin = [1e-5; arm::STATES];
    for registers in [Registers::Wide, Registers::Pair] {
        if !registers.are_there() {
            skips::skip(&format!(
                "{registers:?} was not timed: this machine lacks the registers"
            ));
            continue;
        }
        let (mut eight, mut one) = (f64::INFINITY, f64::INFINITY);
        let (mut rounds, begun) = (0, Instant::now());
        while rounds < ROUNDS
            || (LANES as f64 * one <= eight && begun.elapsed().as_secs_f64() < PATIENCE)
        {
            rounds += 1;
            let (mut state, mut states) = (begin, begin.map(|number| [number; LANES]));
            let coefficients = black_box(&coefficients);
            one = one.min(seconds(|| scalar(black_box(&mut state), coefficients)));
            let states_here = black_box(&mut states);
            let task = Motion {
                states: states_here,
                coefficients,
            };
            eight = eight.min(seconds(|| eomgen_lanes::run_with(registers, task)));
            assert_eq!(states.map(|numbers| numbers[3]), state);
        }
        let times = LANES as f64 * one / eight;
        // Measured: 2.7 and 1.6 times; 0.8 and 0.4 times with a sum that is not inlined.
        assert!(
            times > 1.0,
            "{registers:?}: {times:.2} times the throughput"
        );
    }
}
