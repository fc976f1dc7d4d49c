//! Adams method on problems with known solutions, and compared with Runge-Kutta.

use std::f64::consts::PI;

use super::systems::{dead_zone, dry_friction, smooth, smooth_between};
use eomgen_sim::ode::{Method, Settings, SolveError, SurfaceMode, System, Trajectory, simulate};

fn adams(tolerance: f64) -> Settings {
    Settings {
        method: Method::Adams,
        ..Settings::with_tolerance(tolerance)
    }
}

fn run(
    system: &dyn System,
    initial: &[f64],
    until: f64,
    settings: &Settings,
) -> Result<Trajectory, SolveError> {
    simulate(system, initial, (0.0, until), &[], settings, &mut |_| {})
}

#[test]
fn error_and_order_follow_tolerance() {
    let oscillator = smooth(2, |_, y, out| out.copy_from_slice(&[y[1], -y[0]]));
    let mut evaluations = Vec::new();
    for tolerance in [1e-4, 1e-8, 1e-12] {
        let until = 20.0 * PI;
        let trajectory =
            run(&oscillator, &[0.0, 1.0], until, &adams(tolerance)).expect("a trajectory");
        let Trajectory {
            final_state: last,
            statistics: work,
            ..
        } = trajectory;
        let error = last[0].hypot(last[1] - 1.0);
        println!("{tolerance:e}: {error:e}, {work:?}");
        // Errors accumulate in an undamped oscillator.
        let bound = 2.0 * tolerance * work.steps as f64;
        assert!(error < bound, "{error:e} at {tolerance:e}");
        evaluations.push(work.evaluations as f64);
    }
    // A method of fixed order p needs 10^(4/(p+1)) times the number of steps for four more digits. A factor
    // below 2.5 means that the final order exceeds 9.
    assert!(evaluations[1] < 4.0 * evaluations[0], "{evaluations:?}");
    assert!(evaluations[2] < 2.5 * evaluations[1], "{evaluations:?}");
}

#[test]
fn interpolated_states_meet_tolerance_without_evaluations() {
    let system = smooth(1, |t, y, out| out[0] = y[0] * t.cos());
    let samples: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
    let settings = adams(1e-11);
    let with = simulate(
        &system,
        &[1.0],
        (0.0, 10.0),
        &samples,
        &settings,
        &mut |_| {},
    )
    .expect("a trajectory");
    for (t, state) in with.times.iter().zip(&with.states) {
        // Bound: a few hundred steps with an error of twice the tolerance times e, which grows by at most e^2.
        let error = state[0] - t.sin().exp();
        assert!(error.abs() < 1e-8, "at {t}: {error:e}");
    }
    let without = run(&system, &[1.0], 10.0, &settings).expect("a trajectory");
    assert_eq!(with.final_state, without.final_state);
    assert_eq!(with.statistics.evaluations, without.statistics.evaluations);
}

#[test]
fn dead_zone_oscillator_keeps_its_period() {
    let (b, frequency, speed) = (25e-6, 3e4, 0.02);
    let period = 2.0 * (PI / frequency + 2.0 * b / speed);
    let cycles = 50.0;
    let system = dead_zone(b, frequency);
    let trajectory =
        run(&system, &[0.0, speed], cycles * period, &adams(1e-12)).expect("a trajectory");
    println!("{:?} {:?}", trajectory.final_state, trajectory.statistics);
    assert_eq!(trajectory.events.len(), 200);
    let first = trajectory.events[0];
    assert!(first.guard == 0 && first.to == SurfaceMode::Positive);
    // The free flight is exact up to rounding.
    assert!((first.t - b / speed).abs() < 1e-12 * first.t, "{first:?}");
    // Bound: about ten thousand steps with an error of 1e-12, as a drift of the speed over the whole time.
    let drift = 1e-8 * speed;
    assert!((trajectory.final_state[1] - speed).abs() < drift);
    assert!(trajectory.final_state[0].abs() < drift * cycles * period);
}

#[test]
fn dry_friction_turns_at_known_points_until_it_sticks() {
    let trajectory =
        run(&dry_friction(0.05), &[1.0, 0.0], 3.5 * PI, &adams(1e-11)).expect("a trajectory");
    let turns: Vec<f64> = trajectory.events.iter().map(|switch| switch.t).collect();
    assert_eq!(turns.len(), 3);
    for (number, turn) in (1..).zip(turns) {
        let error = turn - PI * f64::from(number);
        // Bound: about two hundred steps with an error of 1e-11.
        assert!(error.abs() < 1e-8, "turn {number} is late by {error:e}");
    }
    let error = run(&dry_friction(0.3), &[1.0, 0.0], 100.0, &adams(1e-9)).expect_err("it stops");
    let SolveError::Sticking { t, guard: 0 } = error else {
        panic!("{error:?}")
    };
    assert!((t - 2.0 * PI).abs() < 1e-6, "{t}");
}

#[test]
fn no_step_or_history_crosses_a_breakpoint() {
    // A piecewise linear rate that jumps at every tenth.
    let breakpoints: Vec<f64> = (1..=10).map(|i| f64::from(i) / 10.0).collect();
    let stairs = breakpoints.clone();
    let ramps = smooth_between(breakpoints, 1, move |t, _, out| {
        let passed = stairs.iter().filter(|stair| **stair <= t).count() as f64;
        out[0] = passed * t;
    });
    let trajectory = run(&ramps, &[0.0], 1.0, &adams(1e-9)).expect("a trajectory");
    // The sum of n (2 n + 1)/200 for n = 0 .. 9; linear rates are integrated exactly.
    assert!(
        (trajectory.final_state[0] - 3.075).abs() < 1e-13,
        "{trajectory:?}"
    );
}

#[test]
fn singularities_are_reported_at_their_times() {
    let settings = adams(1e-9);
    let pole = smooth(1, |_, y, out| out[0] = y[0] * y[0]);
    let error = run(&pole, &[1.0], 2.0, &settings).expect_err("a pole");
    let (SolveError::StepTooSmall { t, .. } | SolveError::NotFinite { t, .. }) = error else {
        panic!("{error:?}")
    };
    assert!((t - 1.0).abs() < 1e-6, "{error:?}");
    let root = smooth(1, |t, _, out| out[0] = (0.5 - t).sqrt());
    let error = run(&root, &[0.0], 1.0, &settings).expect_err("no number");
    let SolveError::NotFinite { t, state: 0 } = error else {
        panic!("{error:?}")
    };
    assert!((t - 0.5).abs() < 1e-3, "{error:?}");
}

#[test]
fn stiff_system_is_slow_but_no_error() {
    // y' = -1e4 (y - cos t): stability limits the steps, y follows cos t.
    let system = smooth(1, |t, y, out| out[0] = -1e4 * (y[0] - t.cos()));
    let trajectory = run(&system, &[1.0], 1.0, &adams(1e-6)).expect("a trajectory");
    // y lags behind cos t by (sin t)/1e4; the tolerance is added.
    let followed = 1.0_f64.cos() + 1.0_f64.sin() / 1e4;
    assert!((trajectory.final_state[0] - followed).abs() < 1e-5);
    // The step size is between 1/1e4 and 2/1e4.
    assert!((5_000..20_000).contains(&trajectory.statistics.steps));
}
