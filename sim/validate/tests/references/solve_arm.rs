//! Comparison of simulations of Eq. (22) with a trajectory in quadruple precision.

mod arm;

use arm::Arm;
use eomgen_sim::ode::{Method, Settings, Trajectory, simulate};
use eomgen_validate::references::planetary_arm::mode_shapes::ModeShape;

const REFERENCE: &str = include_str!("../../../../tests/reference/trajectory_order4.csv");

/// Returns time, x_sp and tip of each row up to `until` seconds.
fn reference(until: f64) -> Vec<[f64; 3]> {
    let rows = REFERENCE.lines().skip(1).map(|line| {
        let fields: Vec<f64> = line
            .split(',')
            .map(|field| field.parse().expect("a number"))
            .collect();
        [fields[0], fields[1], fields[4]]
    });
    rows.take_while(|row| row[0] <= until).collect()
}

#[test]
fn arm_follows_the_reference_trajectory() {
    let rows = reference(1.0);
    assert_eq!(rows.len(), 101, "a row per hundredth of a second");
    let arm = Arm::<4>::default();
    let samples: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let trajectory = simulate(
        &arm,
        &[0.0; 14],
        (0.0, 1.0),
        &samples,
        &Settings::with_tolerance(1e-10),
        &mut |_| {},
    )
    .expect("a trajectory");
    let ends = [1, 2, 3, 4].map(|r| ModeShape::clamped_free(r).value(1.0));
    let mut worst = [0.0_f64; 2];
    assert_eq!(trajectory.times, samples);
    for (row, state) in rows.iter().zip(&trajectory.states) {
        let tip: f64 = ends.iter().zip(&state[3..7]).map(|(end, q)| end * q).sum();
        worst[0] = worst[0].max((state[0] - row[1]).abs());
        worst[1] = worst[1].max((tip - row[2]).abs());
    }
    println!(
        "x_sp within {:e} m, tip within {:e} m, {} switches, {:?}",
        worst[0],
        worst[1],
        trajectory.events.len(),
        trajectory.statistics
    );
    // Required accuracy of a simulation at this tolerance.
    assert!(worst[0] < 1e-8 && worst[1] < 1e-8, "{worst:?}");
}

#[test]
fn adams_matches_runge_kutta_on_the_arm() {
    let arm = Arm::<2>::default();
    let initial = [0.0; 10];
    let run = |method: Method| {
        let settings = Settings {
            method,
            ..Settings::with_tolerance(1e-9)
        };
        let span = (0.0, 0.2);
        simulate(&arm, &initial, span, &[], &settings, &mut |_| {}).expect("a trajectory")
    };
    let with_adams = run(Method::Adams);
    let with_runge_kutta = run(Method::DormandPrince853);
    let guards = |trajectory: &Trajectory| -> Vec<usize> {
        trajectory.events.iter().map(|s| s.guard).collect()
    };
    println!(
        "{:?} {:?}",
        with_adams.statistics, with_runge_kutta.statistics
    );
    assert!(with_adams.events.len() > 20);
    assert_eq!(guards(&with_adams), guards(&with_runge_kutta));
    let times = with_adams.events.iter().zip(&with_runge_kutta.events);
    for (one, other) in times {
        // Deflections agree to 1e-9 m, and the switching surfaces are crossed at about 0.01 m/s.
        assert!((one.t - other.t).abs() < 1e-7, "{one:?} {other:?}");
    }
    let deflections = with_adams
        .final_state
        .iter()
        .zip(&with_runge_kutta.final_state)
        .take(2);
    for (one, other) in deflections {
        println!("{:e}", one - other);
        assert!((one - other).abs() < 1e-9, "{one} {other}");
    }
}
