//! Number of instructions of a task that calls the rates several times, as a Runge-Kutta method does. A function that
//! is not inlined would be compiled for the baseline instruction set, and lanes would need as many instructions as
//! scalars.

use std::hint::black_box;
use std::ops::{Add, Mul};
use std::process::Command;

use eomgen_lanes::{LANES, Lanes, Registers, Task, Vector};

mod arm {
    eomgen::model! {
        spec = "../model-spec/models/planetary_arm.toml", order = 16, with = [lanes]
    }
}
eomgen_lanes::scalar!(arm);

/// Environment variable with the steps that [`counted_steps`] runs.
const COUNTED: &str = "EOMGEN_LANES_COUNTED";
const STEPS: usize = 2000;
const STEP: f64 = 1e-6;

type State<T> = [T; arm::STATES];

/// Returns x + h y.
#[inline(always)]
fn add_scaled<T: Copy + Add<Output = T> + Mul<Output = T>>(
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
        let b = $rates($t, &add_scaled(&$state, $half, &a), &inputs, $c);
        let c = $rates($t, &add_scaled(&$state, $half, &b), &inputs, $c);
        let d = $rates($t, &add_scaled(&$state, $h, &c), &inputs, $c);
        $state = add_scaled(&$state, $sixth, &a);
        $state = add_scaled(&$state, $third, &b);
        $state = add_scaled(&$state, $third, &c);
        $state = add_scaled(&$state, $sixth, &d);
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

fn coefficients() -> arm::Coefficients {
    arm::Coefficients::prepare(&arm::Parameters::default())
}

fn scalar_steps() -> State<f64> {
    let mut state = black_box([1e-5; arm::STATES]);
    scalar(&mut state, &coefficients());
    state
}

fn eight_wide_steps(registers: Registers) -> State<[f64; LANES]> {
    let mut states = black_box([[1e-5; LANES]; arm::STATES]);
    let task = Motion {
        states: &mut states,
        coefficients: &coefficients(),
    };
    eomgen_lanes::run_with(registers, task);
    states
}

#[test]
fn every_lane_equals_scalar_steps() {
    let expected = scalar_steps().map(|number| [number; LANES]);
    for registers in Registers::ALL {
        if registers.are_available() {
            assert_eq!(eight_wide_steps(registers), expected, "{registers:?}");
        }
    }
}

/// Runs the steps that the environment variable names; [`instructions`] counts them under callgrind.
#[test]
fn counted_steps() {
    match std::env::var(COUNTED).as_deref() {
        Ok("scalar") => drop(black_box(scalar_steps())),
        Ok("eight_wide") => drop(black_box(eight_wide_steps(Registers::Pair))),
        _ => {}
    }
}

/// Counts the instructions of [`counted_steps`], or returns `None` without valgrind.
fn instructions(counted: &str) -> Option<u64> {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let profile = folder.join(format!("callgrind.{counted}.{}", std::process::id()));
    let output = Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(std::env::current_exe().expect("the running test has a path"))
        .args(["--exact", "throughput::counted_steps"])
        .env(COUNTED, counted)
        .output()
        .ok()?;
    let _ = std::fs::remove_file(profile);
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{log}");
    let line = log.lines().find(|line| line.contains("Collected"));
    let count = line.and_then(|line| line.split_whitespace().last());
    Some(count.expect("a count").parse().expect("a number"))
}

#[test]
fn eight_wide_steps_take_fewer_instructions_than_scalar_steps() {
    if cfg!(debug_assertions) || !Registers::Pair.are_available() {
        skips::skip(
            "instructions of lanes were not counted: this takes an optimised build (cargo test --release) and \
             registers of 256 bits",
        );
        return;
    }
    let (Some(startup), Some(scalar), Some(eight)) = (
        instructions("nothing"),
        instructions("scalar"),
        instructions("eight_wide"),
    ) else {
        skips::skip("instructions of lanes were not counted: valgrind is missing");
        return;
    };
    let ratio = (LANES as u64 * (scalar - startup)) as f64 / (eight - startup) as f64;
    // Measured ratios: 1.6, 4.0 at optimisation level 1, and 0.4 if a sum is not inlined.
    assert!(ratio > 1.3, "{ratio:.2} times fewer");
}
