//! Tests of sampled-and-held inputs: their jumps change forces, switching surfaces and sticking.

use eomgen_model_spec::model::Model;
use eomgen_records::read_inputs;
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::models::load;
use eomgen_tests::motions::{Spec, TestMotion, difference, grid};

fn held_input(model: &Model, name: &str, unit: &str, steps: &[(f64, f64)]) -> HeldInputs {
    let folder = tempfile::tempdir().expect("a folder");
    let rows: String = steps
        .iter()
        .map(|(t, u)| format!("{t:?},{u:?}\n"))
        .collect();
    std::fs::write(folder.path().join("a.csv"), format!("t,u\n{rows}")).expect("a file");
    let description = format!(
        "[records]\ntrain = [\"a.csv\"]\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\
         [inputs.{name}]\ncolumn = \"u\"\nunit = \"{unit}\"\nhold = \"zero-order\"\n"
    );
    let path = folder.path().join("dataset.toml");
    std::fs::write(&path, description).expect("a file");
    read_inputs(&path, "train[0]", (model, &[]))
        .expect("inputs")
        .inputs
}

#[test]
fn rig_driven_by_record_matches_general_solver() {
    let model = load("planetary_arm_rig");
    // The torque jumps every 0.1 ms and is sometimes constant for longer.
    let steps: Vec<(f64, f64)> = (0..110)
        .filter(|k| k % 7 != 3)
        .map(|k| {
            (
                f64::from(k) * 1e-4,
                4.0 * (0.7 * f64::from(k * k)).sin() + 2.0,
            )
        })
        .collect();
    for (order, b) in [(0, 25e-6), (4, 25e-6), (4, 0.0), (4, 1e-9)] {
        let model = model
            .with_parameters(&[("b_sp", b), ("b_pr", b)])
            .expect("values");
        let inputs = held_input(&model, "u", "N m", &steps);
        let subject = TestMotion {
            inputs,
            ..TestMotion::new(model, order)
        };
        let times = grid(0.01, 40);
        let exact = subject.simulate_exactly((0.0, 0.01), &times);
        let general = subject
            .simulate_generally((0.0, 0.01), &times, 1e-12)
            .expect("a motion");
        let found = difference(&exact.states, &general.states, 1e-6);
        println!(
            "S = {order}, b = {b:e}: {found:.1e}, {} switches",
            exact.events.len()
        );
        assert!(found < 1e-8, "S = {order}, b = {b:e}: {found:e}");
    }
}

#[test]
fn input_jump_releases_sticking_block() {
    let spec = Spec::default()
        .parameter("m", 2.0, "kg")
        .parameter("T_c", 3.0, "N")
        .coordinate("x", [0.0, 0.0])
        .input("u", "N")
        .kinetic("1/2*m*dot(x)^2")
        .force("x", "u - T_c*sign(dot(x))");
    let model = spec.model();
    // Phases: sticking; acceleration of 2 m/s^2 for 0.5 s; deceleration of 2.5 m/s^2 for 0.4 s; sticking; sliding to
    // the other side; sticking under a force equal to the friction level.
    let steps = [
        (0.0, 1.5),
        (1.0, 7.0),
        (1.5, -2.0),
        (3.0, -5.0),
        (3.5, -2.0),
        (6.0, 3.0),
    ];
    let inputs = held_input(&model, "u", "N", &steps);
    let subject = TestMotion {
        inputs,
        ..TestMotion::new(model, 0)
    };
    let times = [
        0.5, 1.0, 1.25, 1.5, 1.7, 1.9, 2.9, 3.0, 3.25, 3.5, 4.5, 5.5, 7.0, 9.0,
    ];
    let motion = subject.simulate_exactly((0.0, 9.0), &times);
    let wanted = [
        [0.0, 0.0],
        [0.0, 0.0],
        [0.0625, 0.5],
        [0.25, 1.0],
        [0.4, 0.5],
        [0.45, 0.0],
        [0.45, 0.0],
        [0.45, 0.0],
        [0.41875, -0.25],
        [0.325, -0.5],
    ];
    for ((t, state), wanted) in times.iter().zip(&motion.states).zip(wanted) {
        println!("{t}: {state:?}, expected {wanted:?}");
        assert!(
            (state[0] - wanted[0]).abs() < 1e-14 && (state[1] - wanted[1]).abs() < 1e-14,
            "{t}: {state:?}"
        );
    }
    // After 3.5 s the block decelerates at (-2 + 3)/2 = 0.5 m/s^2 for 1 s.
    for state in &motion.states[10..] {
        assert!(
            (state[0] - 0.075).abs() < 1e-14 && state[1].abs() < 1e-14,
            "{state:?}"
        );
    }
}

#[test]
fn input_jump_moves_a_stop() {
    // The input moves the stops.
    for damped in [0.0, 5.0] {
        let spec = Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("k", 1e4, "N/m")
            .parameter("k_0", 100.0, "N/m")
            .parameter("c", damped, "N s/m")
            .parameter("b", 1e-2, "m")
            .coordinate("x", [0.0, 0.1])
            .input("u", "m")
            .kinetic("1/2*m*dot(x)^2")
            .potential("1/2*k_0*x^2")
            .force("x", "-k*deadzone(x - u, b) - c*contact(x - u, b)*dot(x)");
        let model = spec.model();
        let steps: Vec<(f64, f64)> = (0..60)
            .map(|k| (f64::from(k) * 0.05, 0.03 * f64::from(k * k).sin()))
            .collect();
        let inputs = held_input(&model, "u", "m", &steps);
        let subject = TestMotion {
            inputs,
            ..TestMotion::new(model, 0)
        };
        let times = grid(2.0, 100);
        let exact = subject.simulate_exactly((0.0, 2.0), &times);
        let general = subject
            .simulate_generally((0.0, 2.0), &times, 1e-12)
            .expect("a motion");
        let found = difference(&exact.states, &general.states, 1e-6);
        println!(
            "moved stops, c = {damped}: {found:.1e}, {} and {} switches",
            exact.events.len(),
            general.events.len()
        );
        assert!(found < 1e-10, "{found:e}");
    }
}

#[test]
fn input_jump_at_a_switch_matches_closed_form() {
    // The mass reaches the stop at 1 s. The force starts at this time, or one floating-point number before or after it.
    for at in [1.0_f64.next_down(), 1.0, 1.0_f64.next_up()] {
        let spec = Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("k", 100.0, "N/m")
            .parameter("b", 1.0, "m")
            .coordinate("x", [0.0, 1.0])
            .input("u", "N")
            .kinetic("1/2*m*dot(x)^2")
            .potential("1/2*k*deadzone(x, b)^2")
            .force("x", "u");
        let model = spec.model();
        let inputs = held_input(&model, "u", "N", &[(0.0, 0.0), (at, 50.0)]);
        let subject = TestMotion {
            inputs,
            ..TestMotion::new(model, 0)
        };
        let motion = subject.simulate_exactly((0.0, 1.2), &[1.0, 1.1, 1.2]);
        for (t, state) in [0.0, 0.1_f64, 0.2].iter().zip(&motion.states) {
            let x = 1.5 - 0.5 * (10.0 * t).cos() + 0.1 * (10.0 * t).sin();
            assert!(
                (state[0] - x).abs() < 1e-14,
                "{t}: {}, expected {x}",
                state[0]
            );
        }
    }
}
