//! The solver on Eq. (22) against a trajectory computed with quadruple precision.

#[path = "systems/arm.rs"]
mod arm;

use arm::Arm;
use sim::reference::mode_shapes::ModeShape;
use sim::solve::{Settings, simulate};

const REFERENCE: &str = include_str!("../../tests/reference/trajectory_order4.csv");

/// Time, x_sp and tip of each row up to `until` seconds.
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
fn the_arm_follows_the_reference_trajectory_for_a_second() {
    let rows = reference(1.0);
    assert_eq!(rows.len(), 101, "a row per hundredth of a second");
    let arm = Arm::<4>::default();
    let samples: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let begin = std::time::Instant::now();
    let trajectory = simulate(
        &arm,
        &[0.0; 14],
        (0.0, 1.0),
        &samples,
        &Settings::with_tolerance(1e-10),
        &mut |_| {},
    )
    .expect("a trajectory");
    let seconds = begin.elapsed().as_secs_f64();
    let ends = [1, 2, 3, 4].map(|r| ModeShape::clamped_free(r).value(1.0));
    let mut worst = [0.0_f64; 2];
    assert_eq!(trajectory.times, samples);
    for (row, state) in rows.iter().zip(&trajectory.states) {
        let tip: f64 = ends.iter().zip(&state[3..7]).map(|(end, q)| end * q).sum();
        worst[0] = worst[0].max((state[0] - row[1]).abs());
        worst[1] = worst[1].max((tip - row[2]).abs());
    }
    println!(
        "x_sp within {:e} m, tip within {:e} m, {} switches, {:?}, {seconds:.3} s",
        worst[0],
        worst[1],
        trajectory.switches.len(),
        trajectory.work
    );
    // What is asked of a simulation at this tolerance.
    assert!(worst[0] < 1e-8 && worst[1] < 1e-8, "{worst:?}");
}
