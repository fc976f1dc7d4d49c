//! Tests of the properties of a flow: a continued motion equals the uninterrupted motion, repeated requests are
//! bit-identical, and tangent vectors match difference quotients of motions.

use eomgen_sim::piecewise_linear::LyapunovRequest;
use eomgen_tests::models::load;
use eomgen_tests::motions::{Spec, TestMotion, difference, grid};

fn arm(order: usize, b: f64) -> TestMotion {
    let model = load("planetary_arm").with_parameters(&[("b_sp", b), ("b_pr", b)]);
    TestMotion::new(model.expect("values"), order)
}

fn rough_system() -> TestMotion {
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("T_c", 0.7, "N")
        .parameter("k", 30.0, "N/m")
        .parameter("F", 2.0, "N")
        .parameter("b", 0.02, "m")
        .parameter("omega", 4.0, "rad/s")
        .coordinate("x", [0.0, 0.1])
        .coordinate("y", [0.05, 0.0])
        .kinetic("1/2*m*dot(x)^2 + 1/2*m*dot(y)^2")
        .potential("1/2*k*(x - y)^2 + 5*k*deadzone(y, b)^2")
        .force("x", "F*sin(omega*t) - T_c*sign(dot(x))");
    TestMotion::new(spec.model(), 0)
}

#[test]
fn continued_motion_equals_whole_motion() {
    for (name, subject, until, tolerance) in [
        // Collisions amplify a rounding error about tenfold per millisecond.
        ("S = 0", arm(0, 25e-6), 0.02, 1e-9),
        ("S = 4", arm(4, 25e-6), 0.02, 1e-9),
        ("S = 4, b = 0", arm(4, 0.0), 0.02, 1e-9),
        ("rough", rough_system(), 3.0, 1e-12),
    ] {
        let times = grid(until, 60);
        let mut propagator = subject.propagator().expect("a propagator");
        let mut run = |from: &[f64], span: (f64, f64), times: &[f64]| {
            propagator
                .simulate(from, span, times, &subject.inputs, &mut |_| {})
                .expect("a motion")
        };
        let whole = run(&subject.initial, (0.0, until), &times);
        let mut switches = 0;
        let mut parts = vec![subject.initial.clone()];
        for pair in times.windows(2) {
            let last = parts.last().expect("a state").clone();
            let part = run(&last, (pair[0], pair[1]), &[pair[1]]);
            assert_eq!(
                part.states[0], part.final_state,
                "the sample at the end is the last state"
            );
            switches += part.events.len();
            parts.push(part.final_state);
        }
        let found = difference(&parts, &whole.states, 1e-6);
        println!("{name}: {found:.1e}, {} switches", whole.events.len());
        assert!(found < tolerance, "{name}: {found:e}");
        // A sticking mass may break away and stick again at the same time.
        assert!(name == "rough" || switches == whole.events.len(), "{name}");
        assert_eq!(whole.states.last(), Some(&whole.final_state));
    }
}

#[test]
fn sampling_does_not_change_the_motion() {
    for subject in [arm(4, 25e-6), rough_system()] {
        let none = subject.simulate_exactly((0.0, 0.1), &[]);
        let many = subject.simulate_exactly((0.0, 0.1), &grid(0.1, 1000));
        assert_eq!(none.events, many.events);
        assert_eq!(none.final_state, many.final_state);
    }
}

#[test]
fn repeated_requests_give_the_same_bits() {
    for subject in [arm(4, 25e-6), arm(0, 1e-9), rough_system()] {
        let times = grid(0.1, 50);
        let first = subject.simulate_exactly((0.0, 0.1), &times);
        assert_eq!(first, subject.simulate_exactly((0.0, 0.1), &times));
        // The results of a propagator are bit-identical after it has computed other motions.
        let mut propagator = subject.propagator().expect("a propagator");
        let other: Vec<f64> = subject.initial.iter().map(|y| y + 1e-5).collect();
        for from in [
            &other,
            &subject.initial,
            &other,
            &subject.initial,
            &subject.initial,
        ] {
            let again = propagator.simulate(from, (0.0, 0.1), &times, &subject.inputs, &mut |_| {});
            if *from == subject.initial {
                assert_eq!(again.expect("a motion"), first);
            }
        }
    }
}

/// Returns two growth factors up to `until`: of the difference between two motions that start `step` apart along the
/// first tangent vector, and of the tangent vector.
fn growth_of_difference_and_tangent(
    subject: &TestMotion,
    until: f64,
    step: f64,
    felt: &[usize],
) -> (f64, f64) {
    let mut propagator = subject.propagator().expect("a propagator");
    let request = LyapunovRequest {
        transient: 0.0,
        interval: until,
        interval_count: 1,
        exponent_count: 1,
    };
    let growth =
        propagator.measure_lyapunov((0.0, &subject.initial), &subject.inputs, &request, &|| {});
    let growth = growth.expect("a growth").growth_exponents[0][0];
    // Initial tangent vector: 1 for the first relevant state, 0.1/(1 + k) for the others.
    let mut direction = vec![0.0; subject.initial.len()];
    for (k, state) in felt.iter().enumerate() {
        direction[*state] = if k == 0 { 1.0 } else { 0.1 / (1 + k) as f64 };
    }
    let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    let end = |sign: f64| {
        let shifted = subject.initial.iter().zip(&direction);
        let shifted: Vec<f64> = shifted.map(|(y, d)| y + sign * step * d / length).collect();
        let moved = propagator_of(subject).simulate(
            &shifted,
            (0.0, until),
            &[],
            &subject.inputs,
            &mut |_| {},
        );
        moved.expect("a motion").final_state
    };
    let (plus, minus) = (end(1.0), end(-1.0));
    let apart = felt
        .iter()
        .map(|s| ((plus[*s] - minus[*s]) / (2.0 * step)).powi(2))
        .sum::<f64>();
    (growth, 0.5 * apart.ln())
}

fn propagator_of(subject: &TestMotion) -> eomgen_sim::piecewise_linear::Propagator {
    subject.propagator().expect("a propagator")
}

#[test]
fn tangent_vectors_match_difference_quotients() {
    // The motion does not depend on x_c itself.
    let arm_felt =
        |order: usize| -> Vec<usize> { (0..2 * (3 + order)).filter(|state| *state != 2).collect() };
    for (order, b, until, step) in [
        (0, 25e-6, 0.002, 1e-10),
        (0, 25e-6, 0.01, 1e-11),
        (4, 25e-6, 0.002, 1e-10),
        (4, 25e-6, 0.01, 1e-11),
        (4, 1e-6, 0.005, 1e-11),
        (2, 0.0, 0.005, 1e-10),
    ] {
        let subject = arm(order, b);
        let mut initial = subject.initial.clone();
        let half = initial.len() / 2;
        (initial[0], initial[1], initial[half], initial[half + 1]) = (2e-5, -1.7e-5, 0.01, -0.02);
        let subject = subject.with_initial_state(&initial);
        let count = subject.simulate_exactly((0.0, until), &[]).events.len();
        let (vector, apart) =
            growth_of_difference_and_tangent(&subject, until, step, &arm_felt(order));
        println!("S = {order}, b = {b:e}, {until} s: {vector} and {apart}, {count} switches");
        // The difference quotients are central differences of motions with different switching times.
        assert!(
            (vector - apart).abs() < 1e-4,
            "S = {order}, b = {b:e}: {vector} and {apart}"
        );
        assert!(count > 0 || b == 0.0);
    }
    // Sticking projects the tangent space; the lost direction does not return.
    let subject = rough_system();
    for until in [0.05, 0.2, 0.5, 1.0, 2.0] {
        let count = subject.simulate_exactly((0.0, until), &[]).events.len();
        let (vector, apart) =
            growth_of_difference_and_tangent(&subject, until, 1e-7, &[0, 1, 2, 3]);
        println!("rough, {until} s: {vector} and {apart}, {count} switches");
        assert!(
            (vector - apart).abs() < 1e-4,
            "{until} s: {vector} and {apart}"
        );
    }
}
