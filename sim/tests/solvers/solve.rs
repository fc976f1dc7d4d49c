//! The general solver on problems with known solutions, and its errors.

use std::cell::Cell;
use std::f64::consts::PI;

use super::systems::{FixedSides, Functions, dead_zone, dry_friction, smooth, smooth_between};
use eomgen_sim::ode::{
    Method, Names, Settings, SolveError, Surface, SurfaceKind, SurfaceMode, System, Trajectory,
    simulate, simulate_into,
};

fn run(
    system: &dyn System,
    initial: &[f64],
    until: f64,
    tolerance: f64,
) -> Result<Trajectory, SolveError> {
    let settings = Settings::with_tolerance(tolerance);
    simulate(system, initial, (0.0, until), &[], &settings, &mut |_| {})
}

#[test]
fn error_follows_tolerance_and_work_follows_order() {
    // y' = y cos t has the solution y = exp(sin t).
    let system = smooth(1, |t, y, out| out[0] = y[0] * t.cos());
    let mut evaluations = Vec::new();
    for tolerance in [1e-5, 1e-9, 1e-13] {
        let trajectory = run(&system, &[1.0], 20.0, tolerance).expect("a trajectory");
        let error = (trajectory.final_state[0] - 20.0_f64.sin().exp()).abs();
        // The error of each step is at most twice the tolerance times e, and y grows by at most e^2.
        let steps = trajectory.statistics.steps as f64;
        let bound = 2.0 * tolerance * steps * 3.0_f64.exp();
        assert!(error < bound, "{error:e} at {tolerance:e}");
        evaluations.push(trajectory.statistics.evaluations as f64);
    }
    // Order 8: four more digits need 10^(4/8) = 3.2 times the number of steps.
    for pair in evaluations.windows(2) {
        assert!((2.0..4.5).contains(&(pair[1] / pair[0])), "{evaluations:?}");
    }
}

#[test]
fn samples_are_as_accurate_as_steps_and_do_not_change_them() {
    let system = smooth(2, |_, y, out| out.copy_from_slice(&[y[1], -y[0]]));
    let samples: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
    let settings = Settings::with_tolerance(1e-12);
    let mut last = 0.0;
    let with = simulate(
        &system,
        &[0.0, 1.0],
        (0.0, 10.0),
        &samples,
        &settings,
        &mut |t| {
            assert!(t >= last, "progress goes back from {last} to {t}");
            last = t;
        },
    )
    .expect("a trajectory");
    assert_eq!((with.times.as_slice(), last), (samples.as_slice(), 10.0));
    for (t, state) in with.times.iter().zip(&with.states) {
        // The motion takes a few dozen steps, each with an error of the tolerance.
        assert!(
            (state[0] - t.sin()).abs() < 1e-10,
            "at {t}: {}",
            state[0] - t.sin()
        );
    }
    let without = run(&system, &[0.0, 1.0], 10.0, 1e-12).expect("a trajectory");
    assert_eq!(with.final_state, without.final_state);
    assert_eq!(with.final_state, with.states[1000]);
}

#[test]
fn small_and_large_components_have_equal_relative_accuracy() {
    let rates = |_: f64, y: &[f64], out: &mut [f64]| {
        out.copy_from_slice(&[y[1], -y[0], y[3], -y[2]]);
    };
    let last = run(&smooth(4, rates), &[1e-6, 0.0, 1.0, 0.0], 2.0 * PI, 1e-10)
        .expect("a trajectory")
        .final_state;
    let relative = [last[0] / 1e-6 - 1.0, last[2] - 1.0];
    assert!((relative[0] - relative[1]).abs() < 1e-14, "{relative:?}");
}

#[test]
fn dead_zone_oscillator_keeps_its_period() {
    let (b, frequency, speed) = (25e-6, 3e4, 0.02);
    let period = 2.0 * (PI / frequency + 2.0 * b / speed);
    let cycles = 200.0;
    let trajectory = run(
        &dead_zone(b, frequency),
        &[0.0, speed],
        cycles * period,
        1e-12,
    )
    .expect("a trajectory");
    assert_eq!(trajectory.events.len(), 800);
    let first = trajectory.events[0];
    assert!(first.guard == 0 && first.to == SurfaceMode::Positive);
    // The free flight is exact up to rounding.
    assert!((first.t - b / speed).abs() < 1e-12 * first.t, "{first:?}");
    // Bound: a few thousand steps with an error of 1e-12, as a drift of the speed over the whole time.
    let drift = 1e-10 * speed;
    assert!(
        (trajectory.final_state[1] - speed).abs() < drift,
        "{:?}",
        trajectory.final_state
    );
    assert!(
        trajectory.final_state[0].abs() < drift * cycles * period,
        "{:?}",
        trajectory.final_state
    );
}

#[test]
fn dry_friction_reduces_amplitude_equally_per_half_cycle() {
    let trajectory = run(&dry_friction(0.05), &[1.0, 0.0], 4.0 * PI, 1e-11).expect("a trajectory");
    // The turning points are at multiples of pi, each closer to the middle by twice the friction.
    let turns: Vec<f64> = trajectory.events.iter().map(|switch| switch.t).collect();
    assert!((3..=4).contains(&turns.len()), "{turns:?}");
    for (number, turn) in (1..).zip(turns) {
        assert!(
            (turn - PI * f64::from(number)).abs() < 1e-9,
            "turn {number} at {turn}"
        );
    }
    // Bound: two dozen steps with an error of 1e-11.
    assert!(
        (trajectory.final_state[0] - 0.6).abs() < 1e-9,
        "{:?}",
        trajectory.final_state
    );
}

#[test]
fn sticking_without_support_is_an_error() {
    // The motion turns at pi and stops at 2 pi, because the spring force there is below the friction.
    let error = run(&dry_friction(0.3), &[1.0, 0.0], 100.0, 1e-9).expect_err("it stops");
    let SolveError::Sticking { t, guard: 0 } = error else {
        panic!("{error:?}")
    };
    assert!((t - 2.0 * PI).abs() < 1e-6, "{t}");
    let surface = |kind| Surface {
        formula: "v".to_owned(),
        kind,
    };
    let said = |surface: Surface| {
        error.format_named(&Names {
            surfaces: &[surface],
            ..Names::default()
        })
    };
    assert!(said(surface(SurfaceKind::Speed)).contains("on which `v` is zero: it sticks"));
    // The message names the method `adams` only if the method cannot compute sticking.
    assert!(!said(surface(SurfaceKind::Speed)).contains("adams"));
    // If sticking is supported, chattering at the speed 0 is not reported as missing support.
    let message = said(surface(SurfaceKind::HeldSpeed));
    assert!(
        message.contains("without end") && !message.contains("piecewise"),
        "{message}"
    );
    // A position is not reported as friction.
    assert!(
        said(surface(SurfaceKind::Function)).contains("chatters")
            && !said(surface(SurfaceKind::Function)).contains("tanh")
    );
    assert!(!error.to_string().contains("friction"));
}

#[test]
fn no_step_crosses_a_breakpoint() {
    // The rate is a staircase, the number of whole tenths.
    let breakpoints: Vec<f64> = (1..=10).map(|i| f64::from(i) / 10.0).collect();
    let stairs = breakpoints.clone();
    let staircase = smooth_between(breakpoints, 1, move |t, _, out| {
        out[0] = stairs.iter().filter(|stair| **stair <= t).count() as f64;
    });
    let trajectory = run(&staircase, &[0.0], 1.0, 1e-9).expect("a trajectory");
    // Constant rates are integrated exactly up to rounding.
    assert!(
        (trajectory.final_state[0] - 4.5).abs() < 1e-14,
        "{:?}",
        trajectory.final_state
    );
    assert_eq!(trajectory.statistics.rejected_steps, 0);
}

#[test]
fn stiff_system_is_slow_but_no_error() {
    // y' = -2e4 (y - cos t): steps are limited by stability, y follows cos t.
    let system = smooth(1, |t, y, out| out[0] = -2e4 * (y[0] - t.cos()));
    let trajectory = run(&system, &[1.0], 2.0, 1e-6).expect("a trajectory");
    // The solver takes a few thousand steps at the stability limit, each about 6/2e4 long.
    assert!(
        (5_000..20_000).contains(&trajectory.statistics.steps),
        "{:?}",
        trajectory.statistics
    );
    // y lags behind cos t by (sin t)/2e4; the tolerance is added.
    let followed = 2.0_f64.cos() + 2.0_f64.sin() / 2e4;
    assert!(
        (trajectory.final_state[0] - followed).abs() < 1e-5,
        "{:?}",
        trajectory.final_state
    );
}

#[test]
fn singularity_is_reported_at_its_time() {
    // y' = y^2 from 1 is infinite at t = 1.
    let error = run(
        &smooth(1, |_, y, out| out[0] = y[0] * y[0]),
        &[1.0],
        2.0,
        1e-9,
    )
    .expect_err("a pole");
    let (SolveError::StepTooSmall { t, .. } | SolveError::NotFinite { t, .. }) = error else {
        panic!("{error:?}")
    };
    assert!((t - 1.0).abs() < 1e-6, "{error:?}");
}

#[test]
fn non_finite_rates_are_reported() {
    let from_the_start = smooth(2, |_, _, out| out.copy_from_slice(&[0.0, f64::NAN]));
    let error = run(&from_the_start, &[0.0, 0.0], 1.0, 1e-9).expect_err("no number");
    assert_eq!(error, SolveError::NotFinite { t: 0.0, state: 1 });
    // A square root whose argument is negative after t = 0.5.
    let later = smooth(1, |t, _, out| out[0] = (0.5 - t).sqrt());
    let error = run(&later, &[0.0], 1.0, 1e-9).expect_err("no number");
    let SolveError::NotFinite { t, state: 0 } = error else {
        panic!("{error:?}")
    };
    assert!((t - 0.5).abs() < 1e-3, "{error:?}");
}

#[test]
fn step_limit_stops_simulation() {
    let system = smooth(2, |_, y, out| out.copy_from_slice(&[y[1], -1e6 * y[0]]));
    let settings = Settings {
        max_steps: 1000,
        ..Settings::with_tolerance(1e-9)
    };
    let error = simulate(
        &system,
        &[1.0, 0.0],
        (0.0, 1e3),
        &[],
        &settings,
        &mut |_| {},
    )
    .expect_err("too long");
    assert!(
        matches!(error, SolveError::TooManySteps { steps: 1000, .. }),
        "{error:?}"
    );
}

#[test]
fn event_rate_limit_stops_simulation() {
    let settings = Settings {
        max_switch_rate: 100.0,
        ..Settings::with_tolerance(1e-9)
    };
    // About 800 events per second.
    let system = dead_zone(25e-6, 3e4);
    let error = simulate(
        &system,
        &[0.0, 0.02],
        (0.0, 10.0),
        &[],
        &settings,
        &mut |_| {},
    )
    .expect_err("too many");
    let SolveError::TooManySwitches { t, rate: 100.0, .. } = error else {
        panic!("{error:?}")
    };
    assert!(t < 1.0, "{t}");
}

#[test]
fn invalid_requests_are_rejected() {
    let system = smooth(1, |_, _, out| out[0] = 1.0);
    let refused = |initial: &[f64], span, samples: &[f64], tolerance, word: &str| {
        let settings = Settings::with_tolerance(tolerance);
        let error =
            simulate(&system, initial, span, samples, &settings, &mut |_| {}).expect_err(word);
        let SolveError::Request { problem } = &error else {
            panic!("{error:?}")
        };
        assert!(problem.contains(word), "{problem}");
    };
    refused(&[0.0, 0.0], (0.0, 1.0), &[], 1e-9, "entries");
    refused(&[f64::INFINITY], (0.0, 1.0), &[], 1e-9, "finite");
    refused(&[0.0], (0.0, 0.0), &[], 1e-9, "later");
    refused(&[0.0], (0.0, f64::NAN), &[], 1e-9, "later");
    refused(&[0.0], (0.0, 1.0), &[0.5, 0.2], 1e-9, "ascend");
    refused(&[0.0], (0.0, 1.0), &[1.5], 1e-9, "ascend");
    refused(&[0.0], (0.0, 1.0), &[], 1.0, "tolerance");
    refused(&[0.0], (0.0, 1.0), &[], f64::NAN, "tolerance");
}

#[test]
fn rows_before_a_stop_are_kept() {
    // y' = y^2 from 1 has the solution 1/(1 - t).
    let system = smooth(1, |_, y, out| out[0] = y[0] * y[0]);
    let samples: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
    for method in [Method::DormandPrince853, Method::Adams, Method::Radau] {
        let settings = Settings {
            method,
            ..Settings::with_tolerance(1e-9)
        };
        let mut found = Trajectory::default();
        let request = (&[1.0][..], (0.0, 2.0), samples.as_slice());
        let error = simulate_into(&mut found, &system, request, &settings, &mut |_| {})
            .expect_err("a pole");
        let t = error.time().expect("a time");
        assert!((t - 1.0).abs() < 1e-6, "{error}");
        assert!(found.times.len() >= 99 && found.times.len() == found.states.len());
        assert_eq!(found.times, samples[..found.times.len()]);
        assert!((found.states[98][0] * 0.02 - 1.0).abs() < 1e-6);
        assert!(found.final_state[0] > 1e5 && found.statistics.steps > 10);
    }
}

#[test]
fn stiffness_is_reported_before_step_limit() {
    // The first state follows a cosine with a decay time of 1e-7 s; the second is slow.
    let evaluations = Cell::new(0_u64);
    let system = smooth(2, |t, y, out| {
        evaluations.set(evaluations.get() + 1);
        out[0] = -y[0];
        out[1] = -1e7 * (y[1] - t.cos());
    });
    for method in [Method::DormandPrince853, Method::Adams] {
        let settings = Settings {
            method,
            ..Settings::with_tolerance(1e-9)
        };
        evaluations.set(0);
        let error = simulate(
            &system,
            &[1.0, 1.0],
            (0.0, 100.0),
            &[],
            &settings,
            &mut |_| {},
        );
        let SolveError::Stiff {
            state: 1,
            within,
            steps,
            ..
        } = error.expect_err("stiff")
        else {
            panic!("another reason")
        };
        assert!((5e-8..2e-7).contains(&within), "{within}");
        assert!(steps > 2e7, "{steps}");
        assert!(evaluations.get() < 1_000_000, "{evaluations:?}");
    }
}

#[test]
fn fast_vibration_is_not_stiff() {
    let system = smooth(2, |_, y, out| out.copy_from_slice(&[y[1], -1e14 * y[0]]));
    let settings = Settings {
        max_steps: 300_000,
        ..Settings::with_tolerance(1e-9)
    };
    let error = simulate(
        &system,
        &[1.0, 0.0],
        (0.0, 1.0),
        &[],
        &settings,
        &mut |_| {},
    );
    assert!(
        matches!(error, Err(SolveError::TooManySteps { steps: 300_000, .. })),
        "{error:?}"
    );
}

#[test]
fn stiff_system_with_few_steps_is_not_stopped() {
    let system = smooth(1, |t, y, out| out[0] = -1e6 * (y[0] - t.cos()));
    let found = run(&system, &[1.0], 1.0, 1e-9).expect("an end");
    assert!(found.statistics.steps > 65_536 * 2);
    assert!((found.final_state[0] - 1.0_f64.cos()).abs() < 1e-5);
}

/// A system whose mass matrix is not positive definite beyond y = 1.
struct Indefinite;

impl System for Indefinite {
    fn state_count(&self) -> usize {
        2
    }

    fn rates(&self, _: f64, y: &[f64], out: &mut [f64]) {
        out[0] = 1.0;
        out[1] = if y[0] < 1.0 { 0.0 } else { f64::NAN };
    }

    fn find_indefinite_coordinate(&self, _: f64, y: &[f64]) -> Option<usize> {
        (y[0] >= 1.0).then_some(1)
    }
}

#[test]
fn indefinite_mass_matrix_error_names_coordinate() {
    for method in [Method::DormandPrince853, Method::Adams, Method::Radau] {
        let settings = Settings {
            method,
            ..Settings::with_tolerance(1e-9)
        };
        let error = simulate(
            &Indefinite,
            &[0.0, 0.0],
            (0.0, 2.0),
            &[],
            &settings,
            &mut |_| {},
        );
        let Err(SolveError::NotPositiveDefinite { t, coordinate: 1 }) = error else {
            panic!("{error:?}")
        };
        assert!((t - 1.0).abs() < 1e-3, "{t}");
        let at_once = simulate(
            &Indefinite,
            &[2.0, 0.0],
            (0.0, 2.0),
            &[],
            &settings,
            &mut |_| {},
        );
        let wanted = SolveError::NotPositiveDefinite {
            t: 0.0,
            coordinate: 1,
        };
        assert_eq!(at_once, Err(wanted));
    }
}

#[test]
fn rows_between_steps_meet_tolerance_at_a_cost_per_step() {
    let system = smooth(2, |t, y, out| {
        out.copy_from_slice(&[y[0] * t.cos(), -y[0] * t.sin()]);
    });
    let rows: Vec<f64> = (0..=5000).map(|k| 0.002 * f64::from(k)).collect();
    let mut longest = 0.0;
    for tolerance in [1e-4, 1e-8, 1e-12] {
        let at = |samples: &[f64]| {
            let settings = Settings::with_tolerance(tolerance);
            let span = (0.0, 10.0);
            let found = simulate(&system, &[1.0, 0.0], span, samples, &settings, &mut |_| {});
            found.expect("a trajectory")
        };
        let (with, without) = (at(&rows), at(&[]));
        let (work, steps) = (with.statistics, without.statistics);
        let interiors = work.evaluations - steps.evaluations;
        // Three evaluations for the dense output, and about 40 if it is not accurate enough; rows need none.
        assert!(interiors <= 12 * steps.steps, "{work:?} for {steps:?}");
        assert_eq!(work.trial_steps, 0);
        assert_eq!(
            (work.steps, work.rejected_steps),
            (steps.steps, steps.rejected_steps)
        );
        assert_eq!(with.final_state, without.final_state);
        let errors = with.times.iter().zip(&with.states);
        let errors = errors.map(|(t, state)| (state[0] - t.sin().exp()).abs());
        let worst = errors.fold(0.0, f64::max);
        // Errors of the steps accumulate and grow by e^2.
        let bound = 2.0_f64.exp() * with.statistics.steps as f64 * tolerance;
        assert!(worst < bound, "{worst:e} at {tolerance:e}");
        let ends = (1..=100).map(|k| {
            let t = 0.1 * f64::from(k);
            let settings = Settings::with_tolerance(tolerance);
            let found = simulate(&system, &[1.0, 0.0], (0.0, t), &[], &settings, &mut |_| {});
            (found.expect("a trajectory").final_state[0] - t.sin().exp()).abs()
        });
        let ends = ends.fold(0.0, f64::max);
        // The dense output has one order less than the ends of the longest steps.
        assert!(
            worst < 20.0 * ends,
            "{worst:e} and {ends:e} at {tolerance:e}"
        );
        longest = f64::max(longest, 10.0 / with.statistics.steps as f64);
    }
    // Many output rows are in one step.
    assert!(longest > 0.2, "{longest}");
}

/// x'' = -c x' - k x with a switching surface that it never reaches.
fn swinging(c: f64, k: f64) -> impl System {
    Functions {
        guard_count: 1,
        guards: |y: &[f64], out: &mut [f64]| out[0] = 100.0 + y[0],
        states: 2,
        sides: FixedSides::default(),
        rates: move |_, y: &[f64], _: &[f64], out: &mut [f64]| {
            out.copy_from_slice(&[y[1], -c * y[1] - k * y[0]]);
        },
        breakpoints: Vec::new(),
    }
}

#[test]
fn samples_near_surface_are_as_accurate_as_steps() {
    let samples: Vec<f64> = (0..=20_000).map(|k| 0.001 * f64::from(k)).collect();
    let settings = Settings::with_tolerance(1e-9);
    let of = |system: &dyn System, start: [f64; 2], wanted: &dyn Fn(f64) -> f64| {
        let span = (0.0, 20.0);
        let found = simulate(system, &start, span, &samples, &settings, &mut |_| {});
        let found = found.expect("a trajectory");
        for (t, state) in found.times.iter().zip(&found.states) {
            let error = state[0] - wanted(*t);
            assert!(error.abs() < 2e-8, "{error:e} at {t}");
        }
        found.statistics
    };
    // Most steps that resolve an oscillation allow interpolation.
    let work = of(&swinging(0.0, 1.0), [1.0, 0.0], &|t| t.cos());
    assert!(work.trial_steps < samples.len() as u64 / 10, "{work:?}");
    // If stability limits the steps, as for x = 2 exp(-10 t) - exp(-20 t), they are accurate at their ends, but
    // the interpolation may oscillate.
    let decay = |t: f64| 2.0 * (-10.0 * t).exp() - (-20.0 * t).exp();
    of(&swinging(30.0, 200.0), [1.0, 0.0], &decay);
}
