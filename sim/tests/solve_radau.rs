//! Radau's method on stiff problems with known solutions, and against Runge-Kutta.

#[allow(dead_code)]
mod systems;

use eomgen_sim::ode::{Method, Settings, SolveError, System, Trajectory, simulate};
use systems::{dead_zone, smooth};

fn radau(tolerance: f64) -> Settings {
    Settings {
        method: Method::Radau,
        ..Settings::with_tolerance(tolerance)
    }
}

fn run(
    system: &dyn System,
    initial: &[f64],
    samples: &[f64],
    settings: &Settings,
) -> Result<Trajectory, SolveError> {
    let until = samples[samples.len() - 1];
    simulate(
        system,
        initial,
        (0.0, until),
        samples,
        settings,
        &mut |_| {},
    )
}

/// The end values that Hairer and Wanner give for their problem VDPOL ("Solving Ordinary
/// Differential Equations II", section IV.10), which the test set for IVP solvers took over.
#[test]
fn van_der_pols_relaxation_is_that_of_the_literature() {
    let van_der_pol = smooth(2, |_, y, out| {
        out.copy_from_slice(&[y[1], ((1.0 - y[0] * y[0]) * y[1] - y[0]) / 1e-6]);
    });
    for (tolerance, most) in [(1e-5, 20_000), (1e-8, 80_000)] {
        let settings = radau(tolerance);
        let found = run(&van_der_pol, &[2.0, 0.0], &[1.0, 2.0], &settings).expect("a motion");
        let expected = [1.706_167_732_170_483, -0.892_809_701_024_797_5];
        println!("{tolerance:e}: {:?}, {:?}", found.last, found.work);
        for (value, right) in found.last.iter().zip(expected) {
            assert!(
                (value - right).abs() < 10.0 * tolerance * right.abs(),
                "{tolerance:e}: {value}"
            );
        }
        assert!(found.work.evaluations < most, "{:?}", found.work);
    }
}

/// y' = -1e6 (y - cos t) - sin t with y(0) = 0 meets cos t within microseconds.
#[test]
fn what_decays_fast_does_not_keep_steps_short() {
    let settles = smooth(1, |t, y, out| out[0] = -1e6 * (y[0] - t.cos()) - t.sin());
    let times: Vec<f64> = (0..=100).map(|i| 0.1 * f64::from(i)).collect();
    let found = run(&settles, &[0.0], &times, &radau(1e-8)).expect("a motion");
    for (t, state) in found.times.iter().zip(&found.states).skip(1) {
        assert!((state[0] - t.cos()).abs() < 1e-7, "{t}: {}", state[0]);
    }
    println!("{:?}", found.work);
    assert!(found.work.evaluations < 5000, "{:?}", found.work);
}

#[test]
fn the_error_follows_the_tolerance_inside_steps_too() {
    let growth = smooth(1, |t, y, out| out[0] = y[0] * t.cos());
    let times: Vec<f64> = (0..=1000).map(|i| 0.01 * f64::from(i)).collect();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let found = run(&growth, &[1.0], &times, &radau(tolerance)).expect("a motion");
        let errors = found.times.iter().zip(&found.states);
        let error = |(t, state): (&f64, &Vec<f64>)| (state[0] - t.sin().exp()).abs();
        let worst = errors.map(error).fold(0.0, f64::max);
        println!("{tolerance:e}: {worst:e}, {:?}", found.work);
        assert!(worst < 20.0 * tolerance, "{worst:e} at {tolerance:e}");
        let without = run(&growth, &[1.0], &[10.0], &radau(tolerance)).expect("a motion");
        assert_eq!(
            found.work.evaluations, without.work.evaluations,
            "rows cost nothing"
        );
    }
}

#[test]
fn switches_are_located_as_by_runge_kutta() {
    let system = dead_zone(0.3, 20.0);
    let times: Vec<f64> = (0..=50).map(|i| 0.2 * f64::from(i)).collect();
    let by_radau = run(&system, &[0.0, 0.7], &times, &radau(1e-10)).expect("a motion");
    let settings = Settings::with_tolerance(1e-12);
    let by_runge_kutta = run(&system, &[0.0, 0.7], &times, &settings).expect("a motion");
    assert_eq!(by_radau.switches.len(), by_runge_kutta.switches.len());
    assert!(!by_radau.switches.is_empty());
    for (one, other) in by_radau.switches.iter().zip(&by_runge_kutta.switches) {
        assert!((one.t - other.t).abs() < 1e-8 && one.guard == other.guard);
    }
    for (one, other) in by_radau.states.iter().zip(&by_runge_kutta.states) {
        for (a, b) in one.iter().zip(other) {
            assert!((a - b).abs() < 1e-8, "{a} {b}");
        }
    }
}

#[test]
fn rates_that_are_no_numbers_stop_it_with_what_was_found() {
    let system = smooth(1, |t, y, out| out[0] = (0.5 - t).sqrt() * y[0]);
    let stopped = run(&system, &[1.0], &[0.1, 1.0], &radau(1e-6));
    assert!(
        matches!(stopped, Err(SolveError::NotFinite { t, state: 0 }) if (0.49..0.51).contains(&t)),
        "{stopped:?}"
    );
}
