//! Tests that invalid requests and models that cannot be simulated are rejected with a message.

use eomgen_sim::ode::SolveError;
use eomgen_sim::piecewise_linear::ExactError;
use eomgen_tests::models::load;
use eomgen_tests::motions::{Spec, TestMotion};

fn mass(m: f64) -> TestMotion {
    let spec = Spec::default()
        .parameter("m", m, "kg")
        .parameter("k", 100.0, "N/m")
        .parameter("b", 1e-3, "m")
        .coordinate("x", [0.01, 0.0])
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k*deadzone(x, b)^2");
    TestMotion::new(spec.model(), 0)
}

fn rejection(subject: &TestMotion, span: (f64, f64), times: &[f64]) -> String {
    match subject.try_simulate_exactly(span, times) {
        Ok(motion) => panic!("went to {:?}", motion.final_state),
        Err(error) => {
            println!("{error}");
            error.to_string()
        }
    }
}

#[test]
fn non_finite_states_are_rejected() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for state in [[bad, 0.0], [0.0, bad]] {
            let message = rejection(&mass(1.0).with_initial_state(&state), (0.0, 1.0), &[]);
            assert!(message.contains("finite"), "{message}");
        }
    }
    for state in [vec![], vec![0.0], vec![0.0; 3]] {
        let message = rejection(&mass(1.0).with_initial_state(&state), (0.0, 1.0), &[]);
        assert!(message.contains('2'), "{message}");
    }
}

#[test]
fn invalid_times_are_rejected() {
    let subject = mass(1.0);
    for span in [
        (0.0, f64::NAN),
        (f64::NAN, 1.0),
        (0.0, f64::INFINITY),
        (1.0, 0.0),
    ] {
        rejection(&subject, span, &[]);
    }
    for times in [&[2.0][..], &[-0.1], &[0.5, 0.4], &[f64::NAN]] {
        rejection(&subject, (0.0, 1.0), times);
    }
    let still = subject.simulate_exactly((0.5, 0.5), &[0.5, 0.5]);
    assert_eq!(still.states, vec![subject.initial.clone(); 2]);
    assert_eq!(still.final_state, subject.initial);
    // Over the shortest time span, the change of the state is below its rounding error.
    let short = subject.simulate_exactly((0.0, 5e-324), &[0.0, 5e-324]);
    assert!((short.final_state[0] - 0.01).abs() < 1e-17);
    let late = subject.simulate_exactly((1e9, 1e9 + 1.0), &[1e9 + 1.0]);
    let early = subject.simulate_exactly((0.0, 1.0), &[1.0]);
    assert!((late.final_state[0] - early.final_state[0]).abs() < 1e-15);
}

#[test]
fn diverging_motions_are_rejected() {
    for state in [[1e308, 1e308], [1e200, 0.0], [0.0, -1e308]] {
        match mass(1.0)
            .with_initial_state(&state)
            .try_simulate_exactly((0.0, 10.0), &[10.0])
        {
            Ok(motion) => assert!(motion.final_state.iter().all(|y| y.is_finite())),
            Err(error) => println!("{error}"),
        }
    }
    // With negative stiffness, the motion grows as e^(1000 t).
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", -1e6, "N/m")
        .coordinate("x", [1.0, 0.0])
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k*x^2");
    let subject = TestMotion::new(spec.model(), 0);
    let near = subject.simulate_exactly((0.0, 0.1), &[0.1]);
    assert!((near.final_state[0] / 100.0_f64.cosh() - 1.0).abs() < 1e-12);
    let message = rejection(&subject, (0.0, 100.0), &[100.0]);
    assert!(message.contains("diverged"), "{message}");
}

#[test]
fn nonpositive_masses_are_rejected() {
    for m in [0.0, -0.0] {
        let message = rejection(&mass(m), (0.0, 1.0), &[1.0]);
        assert!(message.contains("mass"), "{message}");
    }
    let message = rejection(&mass(-1.0), (0.0, 1.0), &[1.0]);
    assert!(message.contains("mass"), "{message}");
    let model = load("planetary_arm");
    for (name, value) in [("M_s", 0.0), ("M_s", -0.39), ("rho", 0.0), ("M_p", -0.3)] {
        let model = model.with_parameter(name, value).expect("a value");
        let message = rejection(&TestMotion::new(model, 4), (0.0, 0.01), &[0.01]);
        assert!(message.contains("mass"), "{name}: {message}");
    }
    // Two coordinates describe the same motion, so the mass matrix is singular.
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", 100.0, "N/m")
        .coordinate("x", [0.1, 0.0])
        .coordinate("y", [0.0, 0.0])
        .kinetic("1/2*m*(dot(x) + dot(y))^2")
        .potential("1/2*k*(x - y)^2");
    rejection(&TestMotion::new(spec.model(), 0), (0.0, 1.0), &[1.0]);
}

#[test]
fn extreme_parameters_of_arm_are_rejected_or_solved() {
    let model = load("planetary_arm");
    for (name, value) in [
        ("k_sp", 1e300),
        ("k_sp", -1e8),
        ("c_sp", -650.0),
        ("omega", 1e300),
        ("omega", 1e12),
        ("F_w", 1e300),
        ("E", 0.0),
        ("a_m", 1e-300),
    ] {
        let Ok(model) = model.with_parameter(name, value) else {
            continue;
        };
        match TestMotion::new(model, 4).try_simulate_exactly((0.0, 1e-4), &[1e-4]) {
            Ok(motion) => {
                assert!(motion.final_state.iter().all(|y| y.is_finite()));
                assert!(motion.statistics.steps < 500_000, "{:?}", motion.statistics);
            }
            Err(error) => println!("{name} = {value:e}: {error}"),
        }
    }
}

#[test]
fn sticking_with_variable_friction_is_rejected() {
    // The friction level depends on a spring force, so the condition for sticking is not linear.
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("mu", 0.5, "1")
        .parameter("k", 100.0, "N/m")
        .parameter("w", 1.0, "kg")
        .coordinate("x", [0.0, 1.0])
        .coordinate("y", [0.5, 0.0])
        .kinetic("1/2*m*dot(x)^2 + 1/2*w*dot(y)^2")
        .potential("1/2*k*y^2")
        .force("x", "-mu*k*y*sign(dot(x))");
    match TestMotion::new(spec.model(), 0).try_simulate_exactly((0.0, 1.0), &[1.0]) {
        Ok(_) => {}
        Err(error @ ExactError::Sticking { .. }) => println!("{error}"),
        Err(error @ ExactError::Stopped(SolveError::TooManySwitches { .. })) => println!("{error}"),
        Err(error) => panic!("{error}"),
    }
}
