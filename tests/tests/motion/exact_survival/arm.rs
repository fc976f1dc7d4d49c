//! Comparison of the exact solver with the general solver for the shipped arm with extreme parameters.

use eomgen_sim::ode::Trajectory;
use eomgen_tests::models::load;
use eomgen_tests::motions::{TestMotion, difference, grid};
use eomgen_validate::variant::Variant;

use eomgen_tests::models::variant;
use eomgen_validate::derived::Derived;

/// Magnitude in m or m/s below which the deviation of a state is absolute. Deflections are about 1e-4 m.
const SMALLEST: f64 = 1e-6;

fn arm(order: usize, values: &[(&str, f64)]) -> TestMotion {
    let model = load("planetary_arm").with_parameters(values);
    TestMotion::new(model.expect("the values are within their bounds"), order)
}

/// Returns the arm with initial mesh deflections `x` in m and rates `v` in m/s.
fn moving_arm(
    order: usize,
    values: &[(&str, f64)],
    [x_sp, x_pr]: [f64; 2],
    v: [f64; 2],
) -> TestMotion {
    let subject = arm(order, values);
    let mut initial = subject.initial.clone();
    let half = initial.len() / 2;
    (initial[0], initial[1]) = (x_sp, x_pr);
    (initial[half], initial[half + 1]) = (v[0], v[1]);
    subject.with_initial_state(&initial)
}

/// Simulates with the general solver at two tolerances. If it cannot leave the surface on which the motion starts,
/// exact motions replace the results. They start on both sides of the surface at a relative distance of 1e-12, so that
/// their initial regime is unambiguous.
fn simulate_generally(subject: &TestMotion, until: f64, times: &[f64]) -> (Trajectory, Trajectory) {
    let run = |subject: &TestMotion, tolerance: f64| {
        subject.simulate_generally((0.0, until), times, tolerance)
    };
    if let (Ok(fine), Ok(coarse)) = (run(subject, 1e-12), run(subject, 1e-11)) {
        return (fine, coarse);
    }
    let mut beside = arm(subject.order, &[]);
    beside.model = subject.model.clone();
    let mut from = |factor: f64| {
        beside.initial = subject.initial.iter().map(|y| y * factor).collect();
        beside.simulate_exactly((0.0, until), times)
    };
    (from(1.0 - 1e-12), from(1.0 + 1e-12))
}

/// Compares with the general solver over `until` s; returns the number of switches.
fn assert_matches_general_solver(name: &str, subject: &TestMotion, until: f64) -> usize {
    let times = grid(until, 64);
    let exact = subject.simulate_exactly((0.0, until), &times);
    let (general, coarse) = simulate_generally(subject, until, &times);
    let doubt = difference(&coarse.states, &general.states, SMALLEST);
    let found = difference(&exact.states, &general.states, SMALLEST);
    println!(
        "{name}: {found:.1e}, general {doubt:.1e}, {} switches",
        exact.events.len()
    );
    // The bound is ten times the difference between the tolerances, plus rounding errors that grow with the number of
    // switches. Rounding matters because the forces are differences of nearly equal numbers.
    assert!(
        found < 10.0 * doubt + 1e-9,
        "{name}: difference {found:e}, uncertainty {doubt:e}"
    );
    exact.events.len()
}

#[test]
fn arm_with_zero_or_tiny_play_matches_general_solver() {
    for order in [0, 4] {
        for b in [0.0, 1e-15, 1e-12, 1e-9] {
            let values = [("b_sp", b), ("b_pr", b)];
            assert_matches_general_solver(
                &format!("S = {order}, b = {b:e}"),
                &arm(order, &values),
                0.02,
            );
        }
        assert_matches_general_solver("b = 0 in one", &arm(order, &[("b_sp", 0.0)]), 0.02);
    }
}

#[test]
fn arm_with_little_play_and_strong_excitation_matches_general_solver() {
    for b in [1e-9, 1e-7] {
        let values = [
            ("b_sp", b),
            ("b_pr", b),
            ("a_m", 0.0),
            ("F_w", 0.0),
            ("c_sp", 0.0),
            ("c_pr", 0.0),
        ];
        let subject = moving_arm(0, &values, [0.0, 0.0], [1e-3, -2e-3]);
        let switches =
            assert_matches_general_solver(&format!("b = {b:e}, no damping"), &subject, 0.005);
        assert!(switches > 20);
    }
}

#[test]
fn arm_without_motor_damping_matches_general_solver() {
    for order in [0, 4] {
        for b_m in [0.0, 1e-12, 1e-6] {
            assert_matches_general_solver(
                &format!("S = {order}, b_m = {b_m:e}"),
                &arm(order, &[("b_m", b_m)]),
                0.02,
            );
            let values = [("b_m", b_m), ("F_w", 0.0), ("b_sp", 1e-9), ("b_pr", 1e-9)];
            assert_matches_general_solver(
                &format!("S = {order}, b_m = {b_m:e}, no ripple"),
                &arm(order, &values),
                0.02,
            );
        }
    }
}

#[test]
fn arm_with_any_number_of_modes_matches_general_solver() {
    for (order, until) in [
        (0, 0.02),
        (1, 0.02),
        (2, 0.02),
        (4, 0.02),
        (8, 0.02),
        (16, 0.02),
        (32, 0.004),
        (64, 0.001),
    ] {
        assert_matches_general_solver(&format!("S = {order}"), &arm(order, &[]), until);
        let hit = moving_arm(order, &[], [26e-6, -24e-6], [-1.0, 0.5]);
        assert_matches_general_solver(&format!("S = {order}, hit"), &hit, until.min(0.004));
    }
}

#[test]
fn simultaneous_switches_of_both_meshes_match_general_solver() {
    // Both meshes are 1 nm beyond the backlash and lose contact, one `delay` after the other.
    for delay in [0.0, 1e-16, 1e-14, 1e-12, 1e-11, 1e-9] {
        for speed in [-1.0, -1e-3] {
            let x = [25e-6 + 1e-9, 25e-6 + 1e-9 - delay * speed];
            let subject = moving_arm(4, &[], x, [speed, speed]);
            let name = format!("delay {delay:e}, {speed} m/s");
            assert!(assert_matches_general_solver(&name, &subject, 0.002) >= 2);
            let opposite = moving_arm(4, &[], [x[0], -x[1]], [speed, -speed]);
            assert!(
                assert_matches_general_solver(&format!("{name}, opposite"), &opposite, 0.002) >= 2
            );
        }
    }
}

#[test]
fn start_on_a_surface_matches_general_solver() {
    let b = 25e-6;
    for order in [0, 4] {
        for x in [b, -b] {
            for speed in [1e-2, -1e-2, 1e-9, -1e-9, 0.0] {
                let both = moving_arm(order, &[], [x, x], [speed, -speed]);
                assert_matches_general_solver(
                    &format!("S = {order}, x = {x:e}, {speed:e} m/s"),
                    &both,
                    0.004,
                );
                let one = moving_arm(order, &[], [x, 0.0], [speed, 0.0]);
                assert_matches_general_solver(
                    &format!("S = {order}, one x = {x:e}, {speed:e} m/s"),
                    &one,
                    0.004,
                );
            }
        }
    }
}

#[test]
fn grazing_initial_rates_match_general_solver() {
    // Computes by bisection the initial rate at which x_sp, starting from the middle, just reaches b without forces.
    let values = [
        ("a_m", 0.0),
        ("F_w", 0.0),
        ("c_sp", 0.0),
        ("c_pr", 0.0),
        ("b_m", 0.0),
    ];
    let (until, times) = (0.004, grid(0.004, 64));
    let from = |rate: f64| moving_arm(2, &values, [0.0, 26e-6], [rate, 0.0]);
    let first = |rate: f64| {
        let switches = from(rate).simulate_exactly((0.0, until), &times).events;
        switches.iter().filter(|s| s.guard == 0).count()
    };
    let (mut low, mut high) = (0.0, 0.05);
    let (none, some) = (first(low), first(high));
    println!("{none} switches, {some} switches");
    assert!(some > none);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if first(middle) > none {
            high = middle
        } else {
            low = middle
        }
    }
    println!("grazes at {low:e} {high:e}");
    for rate in [
        low * (1.0 - 1e-6),
        low * (1.0 - 1e-12),
        low,
        high,
        high * (1.0 + 1e-12),
        high * (1.0 + 1e-6),
    ] {
        assert_matches_general_solver(&format!("grazing at {rate:e}"), &from(rate), until);
    }
    let (below, above) = (
        from(low).simulate_exactly((0.0, until), &times),
        from(high).simulate_exactly((0.0, until), &times),
    );
    let jump = difference(&below.states, &above.states, SMALLEST);
    println!("across the grazing rate: {jump:e}");
    assert!(jump < 1e-11);
}

/// Returns the lowest eigenfrequency above `from`, in rad/s, of the undamped arm with both meshes
/// closed, from det(K - w^2 M) = 0.
fn eigenfrequency(subject: &TestMotion, from: f64) -> f64 {
    let half = subject.initial.len() / 2;
    let mut derived = Derived::new(variant(&subject.model, subject.order).evaluator);
    let rest = vec![0.0; 2 * half];
    let mut mass = vec![0.0; half * half];
    derived
        .mass_matrix(0.0, &rest, &[], &mut mass)
        .expect("a mass matrix");
    let mut stiffness = vec![0.0; half * half];
    for column in 0..half {
        let mut state = rest.clone();
        state[column] = 1.0;
        let (mut bias, mut forces) = (vec![0.0; half], vec![0.0; half]);
        derived
            .bias_and_forces(0.0, &state, &[], &mut bias, &mut forces)
            .expect("forces");
        for row in 0..half {
            stiffness[row * half + column] = bias[row] - forces[row];
        }
    }
    let determinant = |omega: f64| {
        let matrix: Vec<f64> = stiffness
            .iter()
            .zip(&mass)
            .map(|(k, m)| k - omega * omega * m)
            .collect();
        determinant(matrix, half)
    };
    let (mut low, mut high) = (from, from * 1.01);
    while determinant(low) * determinant(high) > 0.0 {
        (low, high) = (high, high * 1.01);
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if determinant(low) * determinant(middle) > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    low
}

fn determinant(mut matrix: Vec<f64>, size: usize) -> f64 {
    let mut product = 1.0;
    for step in 0..size {
        let pivot = (step..size).max_by(|a, b| {
            matrix[a * size + step]
                .abs()
                .total_cmp(&matrix[b * size + step].abs())
        });
        let pivot = pivot.expect("a row");
        if pivot != step {
            product = -product;
            for column in 0..size {
                matrix.swap(pivot * size + column, step * size + column)
            }
        }
        product *= matrix[step * size + step];
        for row in step + 1..size {
            let factor = matrix[row * size + step] / matrix[step * size + step];
            for column in step..size {
                matrix[row * size + column] -= factor * matrix[step * size + column];
            }
        }
    }
    product
}

#[test]
fn ripple_at_an_eigenfrequency_matches_general_solver() {
    let undamped = [
        ("b_sp", 0.0),
        ("b_pr", 0.0),
        ("c_sp", 0.0),
        ("c_pr", 0.0),
        ("b_m", 0.0),
        ("a_m", 0.0),
    ];
    for order in [0, 1, 4] {
        let mut from = 10.0;
        for _ in 0..3 {
            let omega = eigenfrequency(&arm(order, &undamped), from);
            from = omega * 1.02;
            if from > 5e4 {
                break;
            }
            for distance in [0.0, 1e-12, 1e-9, 1e-6, 1e-4, -1e-3] {
                let values = [&undamped[..], &[("omega", omega * (1.0 + distance))]].concat();
                assert_matches_general_solver(
                    &format!("S = {order}, omega = {omega}(1 + {distance:e})"),
                    &arm(order, &values),
                    0.01,
                );
            }
        }
    }
}

#[test]
fn lossless_arm_conserves_energy() {
    let lossless = [
        ("F_w", 0.0),
        ("a_m", 0.0),
        ("b_m", 0.0),
        ("c_sp", 0.0),
        ("c_pr", 0.0),
    ];
    for (order, b) in [(0, 25e-6), (4, 25e-6), (4, 1e-6), (4, 0.0), (16, 25e-6)] {
        let values = [&lossless[..], &[("b_sp", b), ("b_pr", b)]].concat();
        let subject = moving_arm(order, &values, [1e-4, -3e-5], [0.0, 0.0]);
        let motion = subject.simulate_exactly((0.0, 1.0), &grid(1.0, 100));
        let before = subject.energies(&[0.0], std::slice::from_ref(&subject.initial))[0];
        let energies = subject.energies(&motion.times, &motion.states);
        let worst = energies.iter().fold(0.0_f64, |worst, energy| {
            worst.max((energy / before - 1.0).abs())
        });
        println!(
            "S = {order}, b = {b:e}: {worst:.1e}, {} switches",
            motion.events.len()
        );
        assert!(
            motion.events.len() > 500 && worst < 2e-14 * motion.events.len() as f64,
            "{worst:e}"
        );
    }
}
