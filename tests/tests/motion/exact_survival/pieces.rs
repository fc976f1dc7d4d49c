//! Comparison of the exact solver with the general solver for min, max, abs, nested dead zones and several thresholds
//! of one coordinate.

use eomgen_sim::piecewise_linear::ExactError;
use eomgen_tests::motions::{Spec, TestMotion, difference, grid};

/// Returns two masses with the force `force` on the first mass and harmonic excitation.
fn with_force(force: &str) -> TestMotion {
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", 100.0, "N/m")
        .parameter("K", 3e3, "N/m")
        .parameter("c", 3.0, "N s/m")
        .parameter("b", 1e-2, "m")
        .parameter("d", 2.5e-2, "m")
        .parameter("F", 2.0, "N")
        .parameter("v", 0.2, "m/s")
        .parameter("omega", 13.0, "rad/s")
        .coordinate("x", [0.03, 0.0])
        .coordinate("y", [-0.02, 0.5])
        .kinetic("1/2*m*dot(x)^2 + m*dot(y)^2")
        .potential("1/2*k*(x^2 + y^2) + 1/4*k*(x - y)^2")
        .force("y", "F*sin(omega*t)")
        .force("x", force);
    TestMotion::new(spec.model(), 0)
}

/// Compares the motion under a force with the general solver, from several starts.
fn assert_matches_general_solver(force: &str) {
    let mut worst = 0.0_f64;
    let mut switches = 0;
    for start in [
        [0.03, -0.02, 0.0, 0.5],
        [0.0, 0.0, 0.3, -0.3],
        [-0.01, 0.02, -1.0, 0.0],
        [0.025, 0.0, 0.0, 0.0],
        [0.01, 0.01, 0.4, 0.2],
    ] {
        let subject = with_force(force).with_initial_state(&start);
        let times = grid(1.0, 40);
        let exact = subject.simulate_exactly((0.0, 1.0), &times);
        let general = subject
            .simulate_generally((0.0, 1.0), &times, 1e-12)
            .expect("a motion");
        worst = worst.max(difference(&exact.states, &general.states, 1e-4));
        switches += exact.events.len();
    }
    println!("{force}: {worst:.1e}, {switches} switches");
    assert!(worst < 1e-9, "{force}: {worst:e}");
    assert!(switches > 2, "{force}: {switches} switches");
}

#[test]
fn sums_of_piecewise_forces_match_general_solver() {
    for force in [
        "-K*min(x, b)",
        "-K*max(x, y)",
        "-K*max(x - b, -d)",
        "-K*abs(x) + F",
        "-K*abs(x - y)",
        "-K*deadzone(x + y, b)",
        "-K*deadzone(x, b) - K*deadzone(x, d)",
        "-K*deadzone(x, b) - c*contact(x, d)*dot(x)",
        "-K*max(x, b) - K*max(x, d) - K*max(x, -b)",
        "-K*max(x, b) - K*max(b, x)",
        "-K*deadzone(x, b) - K*deadzone(x - y, d)",
        "-K*deadzone(x - b, b)",
        "-K*deadzone(x, 0*b)",
        "-K*deadzone(2*x, d) - K*deadzone(x, b)",
        "-K*deadzone(-x, -b + d)",
        "-c*abs(dot(x))",
        "-c*max(dot(x), v) - c*min(dot(x), -v)",
        "-c*deadzone(dot(x), v)",
        "-K*deadzone(x + b*sin(omega*t), b)",
        "F*max(sin(omega*t), 0.5)",
        "F*sign(sin(omega*t))",
        "-F*sign(x)",
        "-F*sign(x - b*sin(omega*t))",
        "-F*contact(x, b)",
    ] {
        assert_matches_general_solver(force);
    }
}

#[test]
fn nested_piecewise_forces_match_general_solver() {
    for force in [
        "-K*deadzone(deadzone(x, b) - y, b)",
        "-K*abs(abs(x) - b)",
        "-K*abs(abs(x - y) - b)",
        "-K*max(min(x, b), -b)",
        "-K*max(-b, min(b, x - y))",
        "-K*max(x, max(y, b))",
        "-K*min(x, max(y, -x))",
        "-K*deadzone(max(x, y), b)",
        "-K*deadzone(abs(x), b)",
        "-K*abs(deadzone(x, b))",
        "-K*deadzone(x + abs(y), b)",
        "-K*deadzone(x, b)*contact(y, b)",
        "-F*sign(abs(x) - b)",
        "-c*contact(deadzone(x, b), b)*dot(x)",
    ] {
        match with_force(force).propagator() {
            Ok(_) => assert_matches_general_solver(force),
            // A force that is not recognised as piecewise linear must be rejected with its name.
            Err(error) => {
                println!("{force}: {error}");
                assert!(
                    matches!(error, ExactError::NotLinear { .. }),
                    "{force}: {error}"
                );
            }
        }
    }
}
