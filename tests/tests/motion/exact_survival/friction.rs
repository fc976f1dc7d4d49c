//! Comparison of Coulomb friction with sticking with closed forms and with steep smooth friction.

use eomgen_model_spec::check;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::project;
use eomgen_tests::motions::{Spec, TestMotion, difference, grid};

/// Returns a block with dry friction T, pushed by F sin(omega t).
fn pushed_block(force: f64, start: [f64; 2]) -> TestMotion {
    let spec = Spec::default()
        .parameter("m", 2.0, "kg")
        .parameter("T_c", 3.0, "N")
        .parameter("F", force, "N")
        .parameter("omega", 5.0, "rad/s")
        .coordinate("x", start)
        .kinetic("1/2*m*dot(x)^2")
        .force("x", "F*sin(omega*t) - T_c*sign(dot(x))");
    TestMotion::new(spec.model(), 0)
}

#[test]
fn sticking_block_stays_at_rest() {
    for force in [0.0, 1.0, 2.999, 3.0 * (1.0 - 1e-15), 3.0, -3.0, -1.0] {
        let motion = pushed_block(force, [0.25, 0.0]).simulate_exactly((0.0, 1e3), &grid(1e3, 10));
        for state in &motion.states {
            assert_eq!(state, &[0.25, 0.0], "F = {force}");
        }
    }
    // The block stops at the finite time v0 m/T_c.
    let motion = pushed_block(0.0, [0.0, 1.5]).simulate_exactly((0.0, 1e3), &[0.5, 1.0, 2.0, 1e3]);
    assert!((motion.states[0][1] - 0.75).abs() < 1e-14);
    for state in &motion.states[1..] {
        assert!(
            (state[0] - 0.75).abs() < 1e-14 && state[1].abs() < 1e-15,
            "{state:?}"
        );
    }
    assert!((motion.events[0].t - 1.0).abs() < 1e-14);
}

fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(f(low) * f(high) < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    low
}

#[test]
fn pushed_block_slides_and_sticks_as_closed_form() {
    let (m, dry, omega) = (2.0_f64, 3.0_f64, 5.0_f64);
    for force in [3.0001_f64, 3.3, 4.0, 5.0] {
        let leaves = (dry / force).asin() / omega;
        let speed = |t: f64| {
            force / (m * omega) * ((omega * leaves).cos() - (omega * t).cos())
                - dry / m * (t - leaves)
        };
        let path = |t: f64| {
            let gone = t - leaves;
            force / (m * omega)
                * ((omega * leaves).cos() * gone
                    - ((omega * t).sin() - (omega * leaves).sin()) / omega)
                - 0.5 * dry / m * gone * gone
        };
        let turn = std::f64::consts::PI / omega;
        let rests = bisect(speed, 0.5 * turn, leaves + 1.2 * turn);
        assert!(
            (force * (omega * rests).sin()).abs() < dry,
            "it sticks at {force}"
        );
        let times = grid(8.0 * turn, 333);
        let motion = pushed_block(force, [0.0, 0.0]).simulate_exactly((0.0, 8.0 * turn), &times);
        // A breakaway with sticking again within rounding of the time is not counted as motion.
        let mut switches = motion.events.clone();
        switches.dedup_by(|a, b| (a.t - b.t).abs() < 1e-9);
        for (k, switch) in switches.iter().enumerate() {
            let base = if k % 2 == 0 { leaves } else { rests };
            let wanted = base + (k / 2) as f64 * turn;
            // The rate grows quadratically when the block breaks away or stops.
            assert!(
                (switch.t - wanted).abs() < 1e-11,
                "F = {force}, {k}: {}, expected {wanted}",
                switch.t
            );
        }
        let expected = times
            .last()
            .map_or(0, |end| 2 * ((end - leaves) / turn) as usize + 1);
        println!("F = {force}: {} switches", switches.len());
        assert!(switches.len().abs_diff(expected) <= 1, "{expected}");
        let mut worst = 0.0_f64;
        for (t, state) in times.iter().zip(&motion.states) {
            let half = ((t - leaves) / turn).floor();
            let sign = if half.rem_euclid(2.0) == 0.0 {
                1.0
            } else {
                -1.0
            };
            let within = (t - half * turn).min(rests);
            let before = if half.rem_euclid(2.0) == 0.0 {
                0.0
            } else {
                path(rests)
            };
            let (x, v) = if half < 0.0 {
                (0.0, 0.0)
            } else {
                (before + sign * path(within), sign * speed(within))
            };
            worst = worst.max((state[0] - x).abs()).max((state[1] - v).abs());
        }
        println!("F = {force}: {worst:.1e}");
        assert!(worst < 1e-12, "F = {force}: {worst:e}");
    }
}

#[test]
fn block_on_belt_matches_closed_form() {
    let (m, k, dry, belt) = (1.0_f64, 100.0_f64, 2.0_f64, 0.1_f64);
    let subject = |start: [f64; 2]| {
        let spec = Spec::default()
            .parameter("m", m, "kg")
            .parameter("k", k, "N/m")
            .parameter("T_c", dry, "N")
            .parameter("V", belt, "m/s")
            .coordinate("x", start)
            .kinetic("1/2*m*dot(x)^2")
            .potential("1/2*k*x^2")
            .force("x", "T_c*sign(V - dot(x))");
        TestMotion::new(spec.model(), 0)
    };
    // The belt accelerates the block from rest to the belt's speed. The block sticks to the belt until the spring force
    // reaches T_c at x = T_c/k. Then it oscillates about this position and reaches the belt's speed once per period.
    let (w, still) = (10.0, dry / k);
    let caught = (belt / (still * w)).asin() / w;
    let x_caught = still * (1.0 - (w * caught).cos());
    let free = caught + (still - x_caught) / belt;
    let closed = |t: f64| {
        if t < caught {
            vec![still * (1.0 - (w * t).cos()), still * w * (w * t).sin()]
        } else if t < free {
            vec![x_caught + belt * (t - caught), belt]
        } else {
            let (sine, cosine) = (w * (t - free)).sin_cos();
            vec![still + belt / w * sine, belt * cosine]
        }
    };
    let times = grid(6.0, 300);
    let motion = subject([0.0, 0.0]).simulate_exactly((0.0, 6.0), &times);
    let wanted: Vec<Vec<f64>> = times.iter().map(|t| closed(*t)).collect();
    let error = difference(&motion.states, &wanted, 0.0);
    println!("from rest: {error:.1e}, {} switches", motion.events.len());
    assert!(error < 1e-12, "{error:e}");
    assert!((motion.events[0].t - caught).abs() < 1e-14);
    assert!((motion.events[1].t - free).abs() < 1e-13);
    let riding = subject([0.0, belt]).simulate_exactly((0.0, 0.15), &[0.15]);
    assert!(riding.events.is_empty() && (riding.final_state[0] - 0.015).abs() < 1e-16);
    assert_eq!(riding.final_state[1], belt);
}

/// Returns two stacked blocks with friction T_1 on the ground and T_2 between them; a force pushes the upper block.
fn stacked_blocks(dry: [f64; 2], force: f64, sign: impl Fn(&str) -> String) -> TestMotion {
    let spec = Spec::default()
        .parameter("m_1", 2.0, "kg")
        .parameter("m_2", 1.0, "kg")
        .parameter("T_1", dry[0], "N")
        .parameter("T_2", dry[1], "N")
        .parameter("F", force, "N")
        .parameter("k", 40.0, "N/m")
        .parameter("omega", 5.0, "rad/s")
        .parameter("eps", 1e-5, "m/s")
        .coordinate("x", [0.0, 0.0])
        .coordinate("y", [0.0, 0.0])
        .kinetic("1/2*m_1*dot(x)^2 + 1/2*m_2*dot(y)^2")
        .potential("1/2*k*y^2")
        .force(
            "x",
            &format!("-T_1*{} + T_2*{}", sign("dot(x)"), sign("dot(y) - dot(x)")),
        )
        .force(
            "y",
            &format!("F*sin(omega*t) - T_2*{}", sign("dot(y) - dot(x)")),
        );
    TestMotion::new(spec.model(), 0)
}

#[test]
fn two_joints_can_stick_at_once() {
    let dry = |v: &str| format!("sign({v})");
    let at_rest =
        stacked_blocks([3.0, 3.0], 2.9, dry).simulate_exactly((0.0, 100.0), &grid(100.0, 7));
    assert!(
        at_rest
            .states
            .iter()
            .all(|y| y.iter().all(|y| y.abs() < 1e-13)),
        "{:?}",
        at_rest.final_state
    );
    // The motion with steep smooth friction converges to the motion with sticking.
    let steep = |v: &str| format!("(({v}) - deadzone({v}, eps))/eps");
    for (levels, force) in [
        ([1.0, 4.0], 6.0),
        ([4.0, 1.0], 6.0),
        ([2.0, 1.5], 5.0),
        ([1.5, 3.0], 4.0),
        ([0.5, 0.25], 9.0),
    ] {
        let times = grid(2.0, 50);
        let exact = stacked_blocks(levels, force, dry).simulate_exactly((0.0, 2.0), &times);
        let general = stacked_blocks(levels, force, steep).simulate_exactly((0.0, 2.0), &times);
        let found = difference(&exact.states, &general.states, 0.1);
        println!(
            "{levels:?} {force}: {found:.1e}, {} switches",
            exact.events.len()
        );
        // With steep smooth friction the block creeps with up to eps = 1e-5 m/s for 2 s; speeds reach 0.5 m/s.
        assert!(found < 2e-4, "{levels:?} {force}: {found:e}");
    }
}

#[test]
fn chain_of_blocks_comes_to_rest_block_by_block() {
    // A chain of blocks on rough ground is joined by springs, and the first block is pushed. The blocks stop one after
    // the other. The motion is compared with steep smooth friction.
    let subject = |sign: &dyn Fn(&str) -> String| {
        let mut spec = Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("T_c", 0.5, "N")
            .parameter("k", 30.0, "N/m")
            .parameter("eps", 1e-5, "m/s");
        for (place, start) in [[0.0, 1.0], [0.0, 0.0], [0.1, 0.0], [0.0, -0.4]]
            .into_iter()
            .enumerate()
        {
            let x = format!("x_{place}");
            spec = spec
                .coordinate(&x, start)
                .kinetic(&format!("1/2*m*dot({x})^2"));
            spec = spec.force(&x, &format!("-T_c*{}", sign(&format!("dot({x})"))));
            if place > 0 {
                spec = spec.potential(&format!("1/2*k*({x} - x_{})^2", place - 1));
            }
        }
        TestMotion::new(spec.model(), 0)
    };
    let times = grid(3.0, 60);
    let exact = subject(&|v| format!("sign({v})")).simulate_exactly((0.0, 3.0), &times);
    let steep = subject(&|v| format!("({v} - deadzone({v}, eps))/eps"));
    let general = steep.simulate_exactly((0.0, 3.0), &times);
    let found = difference(&exact.states, &general.states, 1e-2);
    println!(
        "chain: {found:.1e}, {} switches, at last {:?}",
        exact.events.len(),
        exact.final_state
    );
    assert!(found < 1e-3, "{found:e}");
}

/// Returns the shipped hub with a beam, with the force `force` on its angle and other parameter values.
fn hub_with_force(force: &str, values: &[(&str, f64)], order: usize) -> TestMotion {
    let path = project().join("model-spec/models/hub_beam_tip_mass.toml");
    let text = std::fs::read_to_string(path).expect("the shipped specification");
    let text = text.replace("value = \"u\"", &format!("value = \"u + {force}\""));
    let text = text.replace("\nc   =", "\nT_c = { value = 1, unit = \"N m\" }\nc   =");
    let model = check(Source::new("hub.toml", text.as_str()))
        .expect("a specification")
        .model;
    let model = model.with_parameters(values).expect("values");
    let subject = TestMotion::new(model, order);
    let mut initial = subject.initial.clone();
    initial[1] = 0.02;
    subject.with_initial_state(&initial)
}

#[test]
fn friction_in_hub_of_beam_matches_steep_friction() {
    let times = grid(0.5, 50);
    for order in [1, 3, 6] {
        // A sticking hub moves like one with a very large inertia.
        let held = hub_with_force("(-T_c*sign(dot(theta)))", &[("T_c", 1e3)], order)
            .simulate_exactly((0.0, 0.5), &times);
        let heavy =
            hub_with_force("0*T_c", &[("J_h", 1e14)], order).simulate_exactly((0.0, 0.5), &times);
        let found = difference(&held.states, &heavy.states, 1e-3);
        println!("held, order {order}: {found:.1e}");
        assert!(
            found < 1e-11 && held.final_state[0].abs() < 1e-15,
            "{found:e} {:e}",
            held.final_state[0]
        );
        assert!(held.events.is_empty());
        // The hub slides and sticks; the motion is compared with steep smooth friction.
        for level in [0.05, 0.5, 2.0] {
            let dry = hub_with_force("(-T_c*sign(dot(theta)))", &[("T_c", level)], order)
                .simulate_exactly((0.0, 0.2), &times[..20]);
            let steep = "(-T_c*(dot(theta) - deadzone(dot(theta), 1e-5*dot_1))/(1e-5*dot_1))"
                .replace("dot_1", "c/J_h");
            let steep = hub_with_force(&steep, &[("T_c", level)], order)
                .simulate_exactly((0.0, 0.2), &times[..20]);
            let found = difference(&dry.states, &steep.states, 1e-3);
            println!(
                "order {order}, {level} N m: {found:.1e}, {} switches",
                dry.events.len()
            );
            // With steep smooth friction the hub creeps. The bound allows for this creep.
            assert!(found < 2e-3, "order {order}, {level}: {found:e}");
        }
    }
}

#[test]
fn friction_at_tip_of_beam_matches_steep_friction() {
    // The sticking rate is a sum of all modes' rates.
    let times = grid(0.2, 20);
    let tip = "(l*dot(theta) + at(dot(w), l))";
    for (order, level) in [(1, 1.0), (3, 1.0), (3, 5.0)] {
        let subject = |sign: &str| {
            let path = project().join("model-spec/models/hub_beam_tip_mass.toml");
            let text = std::fs::read_to_string(path).expect("the shipped specification");
            let text = text.replace(
                "\nc   =",
                &format!("\nT_c = {{ value = {level:?}, unit = \"N\" }}\nc   ="),
            );
            let text = text.replace(
                "[forces]",
                &format!(
                    "[forces]\ndry = {{ on = \"l*theta + at(w, l)\", value = \"-T_c*{sign}\" }}"
                ),
            );
            let checked = check(Source::new("tip.toml", text.as_str()));
            let model = checked
                .unwrap_or_else(|e| panic!("{}", e.render(false)))
                .model;
            let subject = TestMotion::new(model, order);
            let mut initial = subject.initial.clone();
            initial[1] = 0.02;
            subject.with_initial_state(&initial)
        };
        let dry = subject(&format!("sign({tip})")).simulate_exactly((0.0, 0.2), &times);
        let steep = subject(&format!(
            "({tip} - deadzone({tip}, 1e-5*l*c/J_h))/(1e-5*l*c/J_h)"
        ));
        let steep = steep.simulate_exactly((0.0, 0.2), &times);
        let found = difference(&dry.states, &steep.states, 1e-3);
        println!(
            "order {order}, {level} N: {found:.1e}, {} switches",
            dry.events.len()
        );
        assert!(found < 2e-3, "order {order}, {level}: {found:e}");
    }
}
