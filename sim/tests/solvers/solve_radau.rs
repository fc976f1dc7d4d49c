//! The implicit Radau method on stiff problems with known or published solutions.

#[allow(dead_code)]
use std::f64::consts::PI;

use super::systems::{FixedSides, dead_zone};
use eomgen_sim::ode::{Method, Settings, SolveError, System, Trajectory, simulate, simulate_into};

/// A system of closures, with its Jacobian.
struct Stiff<R, J> {
    states: usize,
    rates: R,
    jacobian: J,
    breakpoints: Vec<f64>,
}

impl<R: Fn(f64, &[f64], &mut [f64]), J: Fn(f64, &[f64], &mut [f64])> System for Stiff<R, J> {
    fn state_count(&self) -> usize {
        self.states
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (self.rates)(t, y, out);
    }

    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (self.jacobian)(t, y, out);
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.breakpoints.iter().copied().find(|next| *next > t)
    }
}

fn stiff<R, J>(states: usize, rates: R, jacobian: J) -> Stiff<R, J>
where
    R: Fn(f64, &[f64], &mut [f64]),
    J: Fn(f64, &[f64], &mut [f64]),
{
    Stiff {
        states,
        rates,
        jacobian,
        breakpoints: Vec::new(),
    }
}

fn by(method: Method, tolerance: f64) -> Settings {
    Settings {
        method,
        ..Settings::with_tolerance(tolerance)
    }
}

fn radau(tolerance: f64) -> Settings {
    by(Method::Radau, tolerance)
}

fn run(
    system: &dyn System,
    initial: &[f64],
    samples: &[f64],
    settings: &Settings,
) -> Result<Trajectory, SolveError> {
    let span = (0.0, *samples.last().expect("an end"));
    simulate(system, initial, span, samples, settings, &mut |_| {})
}

/// Returns the largest difference between a component of the rows and its expected value.
fn find_largest_error(found: &Trajectory, component: usize, expected: impl Fn(f64) -> f64) -> f64 {
    let rows = found.times.iter().zip(&found.states);
    let errors = rows.map(|(t, state)| (state[component] - expected(*t)).abs());
    errors.fold(0.0, f64::max)
}

fn grid(until: f64, count: u32) -> Vec<f64> {
    let all = 0..=count;
    all.map(|k| until * f64::from(k) / f64::from(count))
        .collect()
}

/// m x'' = (1 - x^2) x' - x.
fn van_der_pol(m: f64) -> impl System {
    stiff(
        2,
        move |_, y: &[f64], out: &mut [f64]| {
            out[0] = y[1];
            out[1] = ((1.0 - y[0] * y[0]) * y[1] - y[0]) / m;
        },
        move |_, y: &[f64], out: &mut [f64]| {
            out[0] = 0.0;
            out[1] = 1.0;
            out[2] = (-2.0 * y[0] * y[1] - 1.0) / m;
            out[3] = (1.0 - y[0] * y[0]) / m;
        },
    )
}

#[test]
fn van_der_pol_matches_test_set() {
    // VDPOL of the Test Set for IVP Solvers (Mazzia and Magherini, Bari) with 1e6 and its
    // reference solution at t = 2.
    let reference = [1.706_167_732_170_469, -0.892_809_701_024_812_5];
    // x passes a jump within 1e-6, so its timing magnifies errors by a few hundred.
    for (tolerance, most) in [(1e-6, 5_000), (1e-8, 12_000), (1e-10, 35_000)] {
        let found = run(&van_der_pol(1e-6), &[2.0, 0.0], &[2.0], &radau(tolerance));
        let found = found.expect("an end");
        for (y, reference) in found.final_state.iter().zip(reference) {
            let error = (y / reference - 1.0).abs();
            assert!(error < 10.0 * tolerance, "{error:e} at {tolerance:e}");
        }
        let evaluations = found.statistics.evaluations;
        assert!(evaluations < most, "{evaluations} at {tolerance:e}");
    }
}

#[test]
fn rows_of_stiff_systems_meet_tolerance_without_evaluations() {
    // The second state follows a cosine with a decay time of 1e-7 s.
    let system = stiff(
        2,
        |t: f64, y: &[f64], out: &mut [f64]| {
            out[0] = -y[0];
            out[1] = -1e7 * (y[1] - t.cos());
        },
        |_, _: &[f64], out: &mut [f64]| out.copy_from_slice(&[-1.0, 0.0, 0.0, -1e7]),
    );
    let rows = grid(10.0, 1000);
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-13] {
        let found = run(&system, &[1.0, 1.0], &rows, &radau(tolerance)).expect("an end");
        let error = find_largest_error(&found, 0, |t| (-t).exp());
        assert!(error < 3.0 * tolerance, "{error:e} at {tolerance:e}");
        let error = find_largest_error(&found, 1, |t| t.cos() + 1e-7 * t.sin());
        assert!(error < 3.0 * tolerance, "{error:e} at {tolerance:e}");
        let without = run(&system, &[1.0, 1.0], &[10.0], &radau(tolerance)).expect("an end");
        assert_eq!(without.statistics.evaluations, found.statistics.evaluations);
        assert_eq!(without.final_state, found.final_state);
    }
}

#[test]
fn steps_have_order_5_and_error_estimates_order_3() {
    let system = stiff(
        2,
        |_: f64, y: &[f64], out: &mut [f64]| out.copy_from_slice(&[y[1], -y[0]]),
        |_, _: &[f64], out: &mut [f64]| out.copy_from_slice(&[0.0, 1.0, -1.0, 0.0]),
    );
    let end = [20.0 * PI];
    let at = |tolerance| run(&system, &[1.0, 0.0], &end, &radau(tolerance)).expect("an end");
    let (rough, fine) = (at(1e-5), at(1e-9));
    let steps = (fine.statistics.steps as f64 / rough.statistics.steps as f64).log10();
    // For order 5, four more digits in the tolerance multiply the steps by 10, which gives five digits.
    assert!((0.8..1.2).contains(&steps), "{steps}");
    let error = |found: &Trajectory| (found.final_state[0] - 1.0).hypot(found.final_state[1]);
    let order = (error(&rough) / error(&fine)).log10() / steps;
    assert!((4.5..6.0).contains(&order), "order {order}");
    assert!(error(&fine) < 1e-9);
}

/// A pendulum (1/s^2) with dry friction (1/s^2) that is smoothed over a range of speeds (rad/s).
fn smoothed_friction(friction: f64, speed: f64) -> impl System {
    stiff(
        2,
        move |_: f64, y: &[f64], out: &mut [f64]| {
            let smooth = (y[1] / speed).tanh();
            out.copy_from_slice(&[y[1], -9.81 * y[0].sin() - friction * smooth]);
        },
        move |_, y: &[f64], out: &mut [f64]| {
            let smooth = (y[1] / speed).tanh();
            let slope = -friction * (1.0 - smooth * smooth) / speed;
            out.copy_from_slice(&[0.0, 1.0, -9.81 * y[0].cos(), slope]);
        },
    )
}

#[test]
fn smoothed_dry_friction_needs_few_evaluations() {
    // The motion takes ten seconds, more than half of it at rest. An explicit method would need millions of
    // evaluations.
    let (friction, speed) = (2.0, 1e-6);
    let system = smoothed_friction(friction, speed);
    let found = run(&system, &[1.0, 0.0], &[10.0], &radau(1e-10)).expect("an end");
    assert!(
        found.statistics.evaluations < 10_000,
        "{:?}",
        found.statistics
    );
    // At rest the pendulum creeps at the speed at which the smoothed friction balances the weight.
    let creep = -speed * (9.81 * found.final_state[0].sin() / friction).atanh();
    assert!((found.final_state[1] - creep).abs() < 1e-2 * creep.abs());
    // Before the rest, the solution is compared with the explicit method of order 8; later there is only creep.
    let rests = 2.5;
    let explicit = Settings::with_tolerance(1e-10);
    let until = |settings| run(&system, &[1.0, 0.0], &[rests], settings).expect("an end");
    let (explicit, implicit) = (until(&explicit), until(&radau(1e-10)));
    let error = (implicit.final_state[0] / explicit.final_state[0] - 1.0).abs();
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn loudspeaker_with_small_inductance_matches_matrix_exponential() {
    // m x'' + c x' + k x = B q', L q'' + R q' + B x' = u with a current q' that settles within L/R
    // = 6e-8 s.
    let (m, c, k, b, l, r) = (0.02, 1.5, 2e3, 7.0, 0.5e-6, 8.0);
    let matrix = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [-k / m, 0.0, -c / m, b / m],
        [0.0, 0.0, -b / l, -r / l],
    ];
    let voltage = |t: f64| {
        if (100.0 * t).floor() % 2.0 < 0.5 {
            5.0
        } else {
            -5.0
        }
    };
    let system = Stiff {
        breakpoints: (1..10).map(|k| f64::from(k) / 100.0).collect(),
        ..stiff(
            4,
            move |t: f64, y: &[f64], out: &mut [f64]| {
                for (out, row) in out.iter_mut().zip(&matrix) {
                    *out = row.iter().zip(y).map(|(a, y)| a * y).sum();
                }
                out[3] += voltage(t) / l;
            },
            move |_, _: &[f64], out: &mut [f64]| out.copy_from_slice(matrix.as_flattened()),
        )
    };
    let found = run(&system, &[0.0; 4], &grid(0.1, 10), &radau(1e-9)).expect("an end");
    assert!(
        found.statistics.evaluations < 30_000,
        "{:?}",
        found.statistics
    );
    // Reference: matrix exponentials over intervals of 0.01 s, with the voltage as a fifth, constant state.
    let mut augmented = nalgebra::Matrix5::<f64>::zeros();
    for (i, row) in matrix.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            augmented[(i, j)] = *entry;
        }
    }
    augmented[(3, 4)] = 1.0 / l;
    let over = (augmented * 0.01).exp();
    let mut state = nalgebra::Vector5::zeros();
    for (row, (t, found)) in found.times.iter().zip(&found.states).enumerate() {
        for (component, scale) in [(0, 2e-3), (2, 0.5), (3, 0.6)] {
            let error: f64 = (found[component] - state[component]) / scale;
            assert!(
                error.abs() < 1e-7,
                "component {component} at {t}: {error:e}"
            );
        }
        state[4] = if row % 2 == 0 { 5.0 } else { -5.0 };
        state = over * state;
    }
}

/// x'' = -g, and below 0 a spring (1/s^2) and a damper (1/s).
struct Fall {
    spring: f64,
    damper: f64,
    sides: FixedSides,
}

impl Fall {
    /// Returns 1 in contact, else 0.
    fn contact(&self, y: &[f64]) -> f64 {
        f64::from(u8::from(self.sides.side(0, y[0]) < 0.0))
    }
}

impl System for Fall {
    fn state_count(&self) -> usize {
        2
    }

    fn rates(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        let force = self.contact(y) * (self.spring * y[0] + self.damper * y[1]);
        out.copy_from_slice(&[y[1], -9.81 - force]);
    }

    fn jacobian(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        let contact = self.contact(y);
        let (spring, damper) = (contact * self.spring, contact * self.damper);
        out.copy_from_slice(&[0.0, 1.0, -spring, -damper]);
    }

    fn guard_count(&self) -> usize {
        1
    }

    fn guards(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        out[0] = y[0];
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        self.sides.fix(sides);
    }
}

fn falls_on(spring: f64, damper: f64) -> impl System {
    Fall {
        spring,
        damper,
        sides: FixedSides::default(),
    }
}

#[test]
fn nearly_rigid_contact_conserves_energy() {
    // Contacts of 3e-6 s between free flights of half a second.
    let (frequency, height, g) = (1e6, 0.3, 9.81_f64);
    let speed = (2.0 * g * height).sqrt();
    let contact = (PI + 2.0 * (g / (frequency * speed)).atan()) / frequency;
    let period = 2.0 * speed / g + contact;
    let system = falls_on(frequency * frequency, 0.0);
    let found = run(&system, &[height, 0.0], &[10.0 * period], &radau(1e-10)).expect("an end");
    assert_eq!(found.events.len(), 20);
    let error = (found.final_state[0] / height - 1.0).abs();
    assert!(error < 1e-6, "{error:e}");
    let first = found.events[0].t * g / speed - 1.0;
    assert!(first.abs() < 1e-12, "{first:e}");
}

#[test]
fn fall_on_stiff_damper_ends_at_rest() {
    // In contact, the position returns with the time constant damper/spring = 1e-4 s; the speed decays within
    // 1e-6 s.
    let system = falls_on(1e10, 1e6);
    let found = run(&system, &[0.1, 0.0], &[1.0], &radau(1e-9)).expect("an end");
    assert!((found.final_state[0] + 9.81e-10).abs() < 1e-13);
    assert!(
        found.statistics.evaluations < 10_000,
        "{:?}",
        found.statistics
    );
    let explicit = Settings {
        max_steps: 20_000,
        ..Settings::with_tolerance(1e-9)
    };
    let error = run(&system, &[0.1, 0.0], &[1.0], &explicit).expect_err("too many steps");
    assert!(matches!(error, SolveError::TooManySteps { .. }), "{error}");
}

#[test]
fn singularities_are_reported_at_their_times() {
    let none = |_: f64, _: &[f64], out: &mut [f64]| out.fill(0.0);
    for tolerance in [1e-3, 1e-9, 1e-13] {
        let pole = stiff(
            1,
            |_: f64, y: &[f64], out: &mut [f64]| out[0] = y[0] * y[0],
            |_, y: &[f64], out: &mut [f64]| out[0] = 2.0 * y[0],
        );
        let rows = grid(2.0, 200);
        let mut found = Trajectory::default();
        let asked = (&[1.0][..], (0.0, 2.0), rows.as_slice());
        let settings = radau(tolerance);
        let error = simulate_into(&mut found, &pole, asked, &settings, &mut |_| {});
        let t = error.expect_err("a pole").time().expect("a time");
        assert!((t - 1.0).abs() < 10.0 * tolerance.max(1e-6), "{t}");
        assert!((98..=101).contains(&found.times.len()));
        // The rates are NaN after a certain time, and the derivatives are infinite or NaN.
        let root = stiff(
            1,
            |t: f64, _: &[f64], out: &mut [f64]| out[0] = (0.5 - t).sqrt(),
            none,
        );
        let error = run(&root, &[0.0], &[1.0], &settings).expect_err("no number");
        let SolveError::NotFinite { t, state: 0 } = error else {
            panic!("{error:?}")
        };
        assert!((t - 0.5).abs() < 1e-3, "{t}");
    }
}

#[test]
fn singular_iteration_matrix_is_avoided() {
    // y' = a y. In the first step, a h equals the real eigenvalue of the method.
    let rate = 3.637_834_252_744_496 / 1e-6;
    let system = stiff(
        1,
        move |_: f64, y: &[f64], out: &mut [f64]| out[0] = rate * y[0],
        move |_, _: &[f64], out: &mut [f64]| out[0] = rate,
    );
    let mut found = Trajectory::default();
    let settings = Settings {
        max_steps: 100_000,
        ..radau(1e-6)
    };
    let asked = (&[1e-9][..], (0.0, 1.0), &[][..]);
    let error = simulate_into(&mut found, &system, asked, &settings, &mut |_| {});
    // The solution overflows: it grows by 1e317.
    let error = error.expect_err("no end");
    let t = rate * error.time().expect("a time");
    assert!((650.0..731.0).contains(&t), "{t}: {error}");
    assert!(!matches!(error, SolveError::TooManySteps { .. }), "{error}");
}

#[test]
fn event_times_match_runge_kutta() {
    let system = dead_zone(0.3, 20.0);
    let times: Vec<f64> = (0..=50).map(|i| 0.2 * f64::from(i)).collect();
    let by_radau = run(&system, &[0.0, 0.7], &times, &radau(1e-10)).expect("a motion");
    let settings = Settings::with_tolerance(1e-12);
    let by_runge_kutta = run(&system, &[0.0, 0.7], &times, &settings).expect("a motion");
    assert_eq!(by_radau.events.len(), by_runge_kutta.events.len());
    assert!(!by_radau.events.is_empty());
    for (one, other) in by_radau.events.iter().zip(&by_runge_kutta.events) {
        assert!((one.t - other.t).abs() < 1e-8 && one.guard == other.guard);
    }
    for (one, other) in by_radau.states.iter().zip(&by_runge_kutta.states) {
        for (a, b) in one.iter().zip(other) {
            assert!((a - b).abs() < 1e-8, "{a} {b}");
        }
    }
}
