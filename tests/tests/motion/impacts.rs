//! Tests of machines with impacts: comparison of jumps with dense algebra and textbook formulas, of bouncing with its
//! closed form; resting contacts, lift-off, and rejected models.

use std::path::Path;

use eomgen_codegen::program::evaluator::{Evaluator, ImpactValues, Point};
use eomgen_compiled_model::{CompiledModel, Error, Motion, Orders, Request, Solver};
use eomgen_sim::cubic_spline::CubicSpline;
use eomgen_sim::inputs::HeldInputs;
use eomgen_tests::program::run_rejected;
use eomgen_tests::random_numbers::Numbers;
use nalgebra::{DMatrix, DVector};

fn compile_example(name: &str, orders: Orders<'_>) -> CompiledModel {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/impacts");
    CompiledModel::load(folder.join(format!("{name}.toml")), orders)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn compile_with_impacts(name: &str, impacts: &str, order: usize) -> CompiledModel {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models");
    let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).expect("a model");
    let orders = match order {
        0 => Orders::Declared,
        order => Orders::Uniform(order),
    };
    CompiledModel::from_text("hitting.toml", &(text + impacts), orders)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn simulate_with(model: &CompiledModel, settings: &[(&str, f64)], times: &[f64]) -> Motion {
    let run = model.with_parameters(settings).unwrap();
    let motion = run.simulate(
        run.initial_state(),
        times,
        &run.default_inputs(),
        Solver::Auto,
    );
    motion.unwrap_or_else(|error| panic!("{settings:?}: {error}"))
}

/// Returns the height of a ball at the time `since` after it left the floor. The flights start with the speeds v, e v,
/// e^2 v.
fn height_after_launch(g: f64, e: f64, mut since: f64, mut v: f64) -> f64 {
    while v > 1e-9 && 2.0 * v / g < since {
        since -= 2.0 * v / g;
        v *= e;
    }
    match v > 1e-9 {
        true => v * since - 0.5 * g * since * since,
        false => 0.0,
    }
}

/// Returns the height at time t of a ball released from 1 m.
fn height_after_drop(g: f64, e: f64, t: f64) -> f64 {
    let v = (2.0 * g).sqrt();
    height_after_launch(g, e, t + v / g, v)
}

#[test]
fn bouncing_ball_matches_closed_form_and_comes_to_rest() {
    let model = compile_example("bouncing_ball", Orders::Declared);
    let g = 9.81;
    for e in [0.0, 0.2, 0.5, 0.8, 0.9, 0.97, 1.0] {
        let times: Vec<f64> = (0..=40).map(|step| f64::from(step) * 0.1).collect();
        let motion = simulate_with(&model, &[("e", e)], &times);
        for (t, state) in times.iter().zip(&motion.trajectory.states) {
            let height = height_after_drop(g, e, *t);
            assert!(
                (state[0] - height).abs() < 1e-10,
                "{e} {t}: {} {height}",
                state[0]
            );
        }
    }
}

fn simulate_with_all_solvers(model: &CompiledModel, initial: &[f64], times: &[f64]) -> Vec<Motion> {
    let run = model.with_declared_parameters().unwrap();
    let solvers = [Solver::Rk, Solver::Radau].into_iter();
    let motions = solvers.map(|solver| {
        let motion = run.simulate(initial, times, &run.default_inputs(), solver);
        let motion = motion.unwrap_or_else(|error| panic!("{solver} {initial:?}: {error}"));
        let overlap = run.find_first_overlap(&motion, 1e-9).unwrap();
        assert!(overlap.is_none(), "{solver} {initial:?}: {overlap:?}");
        motion
    });
    motions.collect()
}

/// Rounding errors of an impact must not reduce the energy. The masses and speeds include values that are rounded up.
#[test]
fn elastic_bodies_keep_their_energy() {
    for (mass, height) in [(0.17, 0.8), (1.0, 0.8), (2.3, 0.31), (1e-3, 4.7)] {
        let text = format!(
            r#"
[model]
name = "elastic_bodies"
[parameters]
m = {{ value = {mass}, unit = "kg" }}
g = {{ value = 9.81, unit = "m/s^2" }}
w = {{ value = 0.788, unit = "m" }}
[coordinates]
x = {{ unit = "m", initial = {height} }}
y = {{ unit = "m", initial = 0.3, initial_rate = -1.3032 }}
[kinetic]
T = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
V = "m*g*x"
[impacts]
floor = {{ when = "x", restitution = 1 }}
left = {{ when = "y", restitution = 1 }}
right = {{ when = "w - y", restitution = 1 }}
"#
        );
        let model = CompiledModel::from_text("elastic.toml", &text, Orders::Declared)
            .unwrap_or_else(|error| panic!("{error}"));
        let times: Vec<f64> = (0..=10).map(|k| 20.0 * f64::from(k)).collect();
        let motion = simulate_with(&model, &[], &times);
        let (g, width) = (9.81_f64, 0.788);
        let period = 2.0 * (2.0 * height / g).sqrt();
        for (t, state) in times.iter().zip(&motion.trajectory.states) {
            let since = (t + 0.5 * period) % period;
            let x = 0.5 * g * since * (period - since);
            let along = (0.3 - 1.3032 * t).rem_euclid(2.0 * width);
            let y = along.min(2.0 * width - along);
            let place = format!("{mass} {height} {t}: {state:?}, right {x} {y}");
            assert!((state[0] - x).abs() < 1e-5 * height, "{place}");
            assert!((state[1] - y).abs() < 1e-8, "{place}");
            let energy = 0.5 * state[2] * state[2] + g * state[0];
            assert!((energy - g * height).abs() < 1e-7 * g * height, "{place}");
            assert!((state[3].abs() - 1.3032).abs() < 1e-9, "{place}");
        }
    }
}

#[test]
fn ball_starting_on_floor_rests_or_bounces() {
    let model = compile_example("bouncing_ball", Orders::Declared);
    let (g, e) = (9.81, 0.8);
    for begin in [0.0, 5.0] {
        for speed in [0.0, 1.0, -1.0] {
            let times: Vec<f64> = (0..=20).map(|step| begin + f64::from(step) * 0.1).collect();
            let first = if speed < 0.0 { -e * speed } else { speed };
            for motion in simulate_with_all_solvers(&model, &[0.0, speed], &times) {
                for (t, state) in times.iter().zip(&motion.trajectory.states) {
                    let height = height_after_launch(g, e, t - begin, first);
                    assert!(
                        (state[0] - height).abs() < 1e-9,
                        "{begin} {speed} {t}: {state:?} {height}"
                    );
                }
            }
        }
    }
}

#[test]
fn mass_starting_in_several_contacts_rests() {
    let text = |potential: &str, impacts: &str| {
        format!(
            r#"
[model]
name = "contacts"
[parameters]
m = {{ value = 1, unit = "kg" }}
g = {{ value = 9.81, unit = "m/s^2" }}
[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
p = "{potential}"
[impacts]
{impacts}
"#
        )
    };
    for (potential, impacts) in [
        (
            "m*g*y",
            "floor = { when = \"y\", restitution = 0.5 }\nwall = { when = \"x\", restitution = 0.5 }",
        ),
        (
            "m*g*(x + y)",
            "lower = { when = \"y\", restitution = 0.5 }\nupper = { when = \"x - y\", restitution = 0.3 }",
        ),
        (
            "m*g*(0.6*y + 0.8*x)",
            "floor = { when = \"0.6*y + 0.8*x\", restitution = 0.5 }\nwall = { when = \"0.8*y - 0.6*x\", restitution = 0.5 }",
        ),
        (
            "m*g*y",
            "floor = { when = \"y\", restitution = 0.5 }\nroof = { when = \"-y\", restitution = 0.5 }",
        ),
    ] {
        let model =
            CompiledModel::from_text("contacts.toml", &text(potential, impacts), Orders::Declared)
                .unwrap();
        for begin in [0.0, 3.0] {
            let times: Vec<f64> = (0..=10).map(|step| begin + f64::from(step) * 0.1).collect();
            for motion in simulate_with_all_solvers(&model, &[0.0; 4], &times) {
                for state in &motion.trajectory.states {
                    let most = state
                        .iter()
                        .fold(0.0_f64, |most, entry| entry.abs().max(most));
                    assert!(most < 1e-12, "{impacts}: {state:?}");
                }
            }
        }
    }
}

#[test]
fn ball_leaves_table_that_falls_faster() {
    // With e = 0, the ball remains on the table until a omega^2 sin(omega t) = g.
    let model = compile_example("bouncing_ball", Orders::Declared);
    let (a, omega, g) = (0.03, 20.0_f64, 9.81);
    let run = model.with_parameters(&[("a", a), ("e", 0.0)]).unwrap();
    let mut initial = run.initial_state().to_vec();
    initial[0] = 0.0;
    initial[1] = a * omega;
    let leaves = (g / (a * omega * omega)).asin() / omega;
    let (y0, v0) = (
        a * (omega * leaves).sin(),
        a * omega * (omega * leaves).cos(),
    );
    let times: Vec<f64> = (0..20).map(|step| f64::from(step) * 0.01).collect();
    let motion = run.simulate(&initial, &times, &run.default_inputs(), Solver::Rk);
    let mut flew = 0;
    for (t, state) in times.iter().zip(&motion.unwrap().trajectory.states) {
        let since = t - leaves;
        let free = y0 + v0 * since - 0.5 * g * since * since;
        let table = a * (omega * t).sin();
        let expected = match since > 0.0 && free > table {
            true => free,
            false => table,
        };
        flew += usize::from(expected > table);
        assert!(
            (state[0] - expected).abs() < 1e-9,
            "{t}: {} {expected}",
            state[0]
        );
    }
    assert!(flew > 3);
}

#[test]
fn colliding_carts_conserve_momentum_and_lose_energy_by_restitution() {
    let text = |e: f64| {
        format!(
            r#"
[model]
name = "carts"
[parameters]
m = {{ value = 2, unit = "kg" }}
M = {{ value = 5, unit = "kg" }}
e = {{ value = {e:?}, unit = "1" }}
[coordinates]
x = {{ unit = "m", initial_rate = 3 }}
z = {{ unit = "m", initial = 1, initial_rate = -1 }}
[kinetic]
both = "1/2*m*dot(x)^2 + 1/2*M*dot(z)^2"
[impacts]
bumper = {{ when = "z - x", restitution = "e" }}
"#
        )
    };
    for e in [0.0, 0.25, 1.0] {
        let model = CompiledModel::from_text("carts.toml", &text(e), Orders::Declared).unwrap();
        let state = simulate_with(&model, &[], &[0.0, 1.0]).trajectory.states[1].clone();
        let centre = (2.0 * 3.0 - 5.0) / 7.0;
        let (x, z) = (centre - 5.0 / 7.0 * 4.0 * e, centre + 2.0 / 7.0 * 4.0 * e);
        assert!(
            (state[2] - x).abs() < 1e-12 && (state[3] - z).abs() < 1e-12,
            "{e}: {state:?}"
        );
        // The carts collide at t = 1/4 s at x = 3/4 m.
        assert!((state[0] - 0.75 - 0.75 * x).abs() < 1e-12, "{e}: {state:?}");
    }
}

/// Compiles two balls above each other on a floor.
fn compile_stack(between: f64) -> CompiledModel {
    let text = format!(
        r#"
[model]
name = "stack"
[parameters]
m = {{ value = 1, unit = "kg" }}
M = {{ value = 100, unit = "kg" }}
g = {{ value = 9.81, unit = "m/s^2" }}
e = {{ value = 0.9, unit = "1" }}
[coordinates]
y = {{ unit = "m", initial = 1 }}
z = {{ unit = "m", initial = {between:?} }}
[kinetic]
both = "1/2*M*dot(y)^2 + 1/2*m*dot(z)^2"
[potential]
weight = "M*g*y + m*g*z"
[impacts]
floor = {{ when = "y", restitution = "e" }}
balls = {{ when = "z - y", restitution = 0.8 }}
"#
    );
    CompiledModel::from_text("stack.toml", &text, Orders::Declared).unwrap()
}

#[test]
fn touching_balls_bounce_like_one_ball() {
    // By Moreau's impact law, balls that touch while they fall have no relative speed to restore, so they move together
    // like a single ball.
    let model = compile_stack(1.0);
    for (light, e) in [
        (100.0, 0.9),
        (1.0, 0.5),
        (0.01, 0.5),
        (1e6, 0.0),
        (1e6, 0.7),
    ] {
        let times: Vec<f64> = (0..=60).map(|step| f64::from(step) * 0.05).collect();
        let motion = simulate_with(&model, &[("M", light), ("e", e)], &times);
        for (t, state) in times.iter().zip(&motion.trajectory.states) {
            let height = height_after_drop(9.81, e, *t);
            let off = (state[0] - height).abs().max((state[1] - height).abs());
            assert!(off < 1e-10, "{light} {e} {t}: {state:?} {height}");
        }
    }
}

#[test]
fn random_stacks_of_balls_gain_no_energy_and_do_not_penetrate() {
    let mut numbers = Numbers(0x5eed);
    for case in 0..40 {
        let mut text = String::from("[model]\nname = \"stack\"\n[parameters]\n");
        let (mut coordinates, mut kinetic, mut weight) = (String::new(), Vec::new(), Vec::new());
        let restitution = (0.5 + 0.5 * numbers.symmetric()).min(0.98);
        let mut impacts = format!("floor = {{ when = \"y0\", restitution = {restitution:?} }}\n");
        let mut height = 1.0;
        for ball in 0..4 {
            let mass = 10.0_f64.powf(3.0 * numbers.symmetric());
            text += &format!("m{ball} = {{ value = {mass:?}, unit = \"kg\" }}\n");
            coordinates += &format!("y{ball} = {{ unit = \"m\", initial = {height:?} }}\n");
            kinetic.push(format!("1/2*m{ball}*dot(y{ball})^2"));
            weight.push(format!("m{ball}*g*y{ball}"));
            if ball > 0 {
                let below = ball - 1;
                let restitution = (0.5 + 0.5 * numbers.symmetric()).min(0.98);
                impacts += &format!(
                    "c{ball} = {{ when = \"y{ball} - y{below}\", restitution = {restitution:?} }}\n"
                );
            }
            // Some balls touch at the start.
            height += 0.02 * numbers.symmetric().max(0.0);
        }
        text += "g = { value = 9.81, unit = \"m/s^2\" }\n[coordinates]\n";
        text += &coordinates;
        text += &format!("[kinetic]\nall = \"{}\"\n", kinetic.join(" + "));
        text += &format!("[potential]\nweight = \"{}\"\n", weight.join(" + "));
        text += &format!("[impacts]\n{impacts}");
        let model = CompiledModel::from_text("stack.toml", &text, Orders::Declared).unwrap();
        let times: Vec<f64> = (0..=30).map(|step| f64::from(step) * 0.1).collect();
        let run = model.with_parameters(&[]).unwrap();
        let motion = run.simulate(
            run.initial_state(),
            &times,
            &run.default_inputs(),
            Solver::Auto,
        );
        let motion = motion.unwrap_or_else(|error| panic!("{case}: {error}\n{text}"));
        let mut own = run.evaluator().unwrap();
        let names = model.observable_names();
        let place = names.iter().position(|name| name == "energy").unwrap();
        let mut observables = vec![0.0; names.len()];
        let mut before = f64::INFINITY;
        for (t, state) in times.iter().zip(&motion.trajectory.states) {
            let point = Point {
                t: *t,
                state,
                inputs: &[],
            };
            own.observables(point, &mut observables);
            let energy = observables[place];
            assert!(
                energy <= before * (1.0 + 1e-9) + 1e-12,
                "{case} {t}: {energy} {before}\n{text}"
            );
            before = energy;
            let heights = [0.0, state[0], state[1], state[2], state[3]];
            assert!(
                heights.windows(2).all(|pair| pair[1] - pair[0] > -1e-9),
                "{case} {t}: {state:?}"
            );
        }
    }
}

/// A bead slides down a disc and leaves it within a step.
#[test]
fn bead_leaves_a_disc_at_the_same_time_at_all_tolerances() {
    let text = r#"
[model]
name = "bead"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
R = { value = 1, unit = "m" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[impacts]
disc = { when = "norm([x, y]) - R", restitution = 0 }
"#;
    let model = CompiledModel::from_text("bead.toml", text, Orders::Declared);
    let model = model.unwrap_or_else(|error| panic!("{error}"));
    let run = model.with_declared_parameters().unwrap();
    let times: Vec<f64> = (0..=150).map(|step| 0.01 * f64::from(step)).collect();
    for speed in [0.3, 0.5, 1.0, 2.0] {
        // The bead leaves where v^2/R = g cos(angle), with v^2 = speed^2 + 2 g R (1 - cos(angle)).
        let cosine = (speed * speed + 2.0 * 9.81) / (3.0 * 9.81);
        for solver in [Solver::Rk, Solver::Radau] {
            for exponent in 4..=12 {
                let inputs = run.default_inputs();
                let request = Request {
                    initial: &[0.0, 1.0, speed, 0.0],
                    times: &times,
                    inputs: &inputs,
                    solver,
                    tolerance: 10.0_f64.powi(-exponent),
                    max_step: f64::INFINITY,
                    audit: true,
                };
                let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
                let stop = motion.early_stop.as_ref().map(|stop| &stop.reason);
                assert!(stop.is_none(), "{speed} {solver} 1e-{exponent}: {stop:?}");
                let states = &motion.trajectory.states;
                let left = states
                    .iter()
                    .find(|state| state[0].hypot(state[1]) > 1.0 + 1e-6);
                let height = left.expect("the bead leaves")[1];
                // The first sample after the lift-off is up to 10 ms later.
                assert!(
                    (-0.05..=1e-3).contains(&(height - cosine)),
                    "{speed} {solver} 1e-{exponent}: {height}, expected {cosine}"
                );
            }
        }
    }
}

#[test]
fn stack_comes_to_rest_after_infinitely_many_impacts() {
    // Impacts at the floor and between the balls alternate until both distances are rounding errors. Then one contact
    // closes, and its correction changes the other distance by a rounding error.
    let text = r#"
[model]
name = "stack"
[parameters]
g = { value = 9.81, unit = "m/s^2" }
r = { value = 0.1, unit = "m" }
m = { value = 0.68, unit = "kg" }
M = { value = 1.47, unit = "kg" }
[coordinates]
y = { unit = "m", initial = 0.302 }
z = { unit = "m", initial = 0.655 }
[kinetic]
both = "1/2*m*dot(y)^2 + 1/2*M*dot(z)^2"
[potential]
weight = "g*(m*y + M*z)"
[impacts]
floor = { when = "y - r", restitution = 0.43 }
balls = { when = "z - y - 2*r", restitution = 0.08 }
"#;
    let model = CompiledModel::from_text("stack.toml", text, Orders::Declared).unwrap();
    let run = model.with_declared_parameters().unwrap();
    let times: Vec<f64> = (0..=20).map(|step| f64::from(step) * 0.1).collect();
    for motion in simulate_with_all_solvers(&model, run.initial_state(), &times) {
        for state in &motion.trajectory.states[4..] {
            let rest = [0.1, 0.3, 0.0, 0.0];
            let off = state.iter().zip(rest).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12, "{state:?}");
        }
        assert!(motion.trajectory.statistics.steps < 1000);
    }
}

#[test]
fn light_ball_on_heavy_ball_rebounds_by_textbook_formula() {
    // With a small gap, the heavy ball rebounds before the balls collide. Then the textbook formula for the collision
    // of two bodies applies.
    let (e, apart, g) = (0.9, 1e-6, 9.81);
    let motion = simulate_with(&compile_stack(1.0 + apart), &[], &[0.0, 0.46]);
    let v = (2.0_f64 * g).sqrt();
    let meets = (1.0 + 0.8) * 100.0 / 101.0;
    let after = -v + meets * (v + e * v) - g * (0.46 - v / g);
    let state = &motion.trajectory.states[1];
    assert!((state[3] - after).abs() < 1e-4, "{} {after}", state[3]);
}

#[test]
fn dropped_box_hits_with_both_edges_or_one() {
    let model = compile_example("dropped_box", Orders::Declared);
    let (m, inertia, b, h, g, e) = (2.0, 0.0867, 0.3, 0.2, 9.81, 0.3);
    let run = model.with_declared_parameters().unwrap();
    let flat = run.simulate(
        &[0.0, 0.7, 0.0, 0.0, 0.0, 0.0],
        &[0.0, 0.33],
        &run.default_inputs(),
        Solver::Rk,
    );
    let state = flat.unwrap().trajectory.states[1].clone();
    let hit = (2.0_f64 * 0.5 / g).sqrt();
    let since = 0.33 - hit;
    assert!(
        (state[4] - (e * g * hit - g * since)).abs() < 1e-9,
        "{state:?}"
    );
    assert!(
        state[2].abs() < 1e-12 && state[5].abs() < 1e-10,
        "{state:?}"
    );
    // For an impact at one edge, the impulse on the rigid body is P = (1 + e) v / (1/m + r^2/I).
    let phi = 0.2_f64;
    let height = h * phi.cos() + b * phi.sin();
    let fallen = (2.0 * (0.7 - height) / g).sqrt();
    let arm = h * phi.sin() - b * phi.cos();
    let impulse = (1.0 + e) * g * fallen / (1.0 / m + arm * arm / inertia);
    let t = fallen + 0.005;
    let leaning = simulate_with(&model, &[], &[0.0, t]).trajectory.states[1].clone();
    let expected = (-g * t + impulse / m, arm * impulse / inertia);
    assert!(
        (leaning[4] - expected.0).abs() < 1e-9,
        "{leaning:?} {expected:?}"
    );
    assert!(
        (leaning[5] - expected.1).abs() < 1e-9,
        "{leaning:?} {expected:?}"
    );
}

#[test]
fn box_comes_to_rest_for_all_restitutions_and_widths() {
    let model = compile_example("dropped_box", Orders::Declared);
    let mut numbers = Numbers(0x1234_5678_9abc_def1);
    for _ in 0..60 {
        let (b, e) = (
            0.25 + 0.2 * numbers.symmetric(),
            0.35 + 0.3 * numbers.symmetric(),
        );
        let motion = simulate_with(&model, &[("b", b), ("e", e)], &[0.0, 20.0]);
        let state = &motion.trajectory.states[1];
        // The box must lie flat on one of its sides.
        let height = 0.2 * state[2].cos().abs() + b * state[2].sin().abs();
        assert!((state[1] - height).abs() < 1e-9, "{b} {e}: {state:?}");
        assert!((2.0 * state[2]).sin().abs() < 1e-9, "{b} {e}: {state:?}");
        assert!(
            state[3..].iter().all(|rate| rate.abs() < 1e-9),
            "{b} {e}: {state:?}"
        );
    }
}

/// Returns the gradient of a distance with respect to the coordinates, by central differences.
fn gradient(own: &mut Evaluator, state: &[f64], degrees: usize, place: usize) -> DVector<f64> {
    let mut at = |index: usize, step: f64| {
        let mut moved = state.to_vec();
        moved[index] += step;
        let mut all = vec![0.0; own.program().impacts.len()];
        let point = Point {
            t: 0.3,
            state: &moved,
            inputs: &[],
        };
        own.distances(point, &mut all);
        all[place]
    };
    let step = 1e-4;
    DVector::from_fn(degrees, |index, _| {
        let first = at(index, step) - at(index, -step);
        let second = at(index, 2.0 * step) - at(index, -2.0 * step);
        (8.0 * first - second) / (12.0 * step)
    })
}

/// Compares impulses and rates with dense algebra on the mass matrix and difference quotients.
fn assert_matches_dense_algebra(model: &CompiledModel, settings: &[(&str, f64)], seed: u64) {
    let run = model.with_parameters(settings).unwrap();
    let mut own = run.evaluator().unwrap();
    let degrees = own.program().degrees_of_freedom();
    let mut numbers = Numbers(seed);
    let count = own.program().impacts.len();
    assert!(count > 0);
    for _ in 0..20 {
        let states = own.program().states();
        let state: Vec<f64> = (0..states).map(|_| 0.4 * numbers.symmetric()).collect();
        let point = Point {
            t: 0.3,
            state: &state,
            inputs: &[],
        };
        let mut at: Vec<ImpactValues> = Vec::new();
        own.impacts(point, &mut at);
        let mut mass = vec![0.0; degrees * degrees];
        own.mass_matrix(point, &mut mass);
        let mass = DMatrix::from_row_slice(degrees, degrees, &mass);
        let mut rates = vec![0.0; states];
        own.rates(point, &mut rates);
        let gradients: Vec<DVector<f64>> = (0..count)
            .map(|place| gradient(&mut own, &state, degrees, place))
            .collect();
        for (place, impact) in at.iter().enumerate() {
            let column = DVector::from_column_slice(&impact.column);
            let row = &gradients[place];
            let off = (&mass * &column - row).norm();
            assert!(off < 1e-8 * row.norm(), "column {place}: {off}");
            for (other, entry) in impact.delassus.iter().enumerate() {
                let expected = row.dot(&DVector::from_column_slice(&at[other].column));
                let size = row.norm() * DVector::from_column_slice(&at[other].column).norm();
                assert!((entry - expected).abs() < 1e-8 * size, "{entry} {expected}");
            }
            let along = |step: f64, own: &mut Evaluator| {
                let moved: Vec<f64> = state
                    .iter()
                    .zip(&rates)
                    .map(|(x, r)| x + step * r)
                    .collect();
                let point = Point {
                    t: 0.3 + step,
                    state: &moved,
                    inputs: &[],
                };
                let mut there = Vec::new();
                own.impacts(point, &mut there);
                [there[place].distance, there[place].rate]
            };
            let size = rates
                .iter()
                .fold(1.0_f64, |most, rate| most.max(rate.abs()));
            let step = 1e-3 / size;
            let [near, far] = [step, 2.0 * step].map(|step| {
                let (after, before) = (along(step, &mut own), along(-step, &mut own));
                [after[0] - before[0], after[1] - before[1]]
            });
            let slope = |index: usize| (8.0 * near[index] - far[index]) / (12.0 * step);
            let wrong = (impact.rate - slope(0)).abs();
            assert!(
                wrong < 1e-8 * size,
                "rate {place}: {} {}",
                impact.rate,
                slope(0)
            );
            let wrong = (impact.acceleration - slope(1)).abs();
            let bound = 1e-8 * size * size.max(1.0);
            assert!(
                wrong < bound,
                "acceleration {place}: {} {}",
                impact.acceleration,
                slope(1)
            );
        }
    }
}

#[test]
fn jumps_match_dense_algebra_for_rigid_and_flexible_machines() {
    let walls = "\n[impacts]\nwall = { when = \"l_1 - l_1*sin(theta_1) - l_2*sin(theta_2)\", restitution = 0.5 }\n\
                 knee = { when = \"2 + theta_2 - theta_1\", restitution = 0 }\n";
    assert_matches_dense_algebra(&compile_with_impacts("double_pendulum", walls, 0), &[], 3);
    let stops = "\n[impacts]\ntip = { when = \"l + at(w, l) + l*theta\", restitution = 0.5 }\n\
                 middle = { when = \"l - at(w, l/2) - cos(theta)*at(w, l)\", restitution = 1 }\n";
    for order in [1, 3, 12] {
        assert_matches_dense_algebra(
            &compile_with_impacts("hub_beam_tip_mass", stops, order),
            &[],
            5,
        );
    }
    assert_matches_dense_algebra(&compile_example("dropped_box", Orders::Declared), &[], 7);
    let shaken = [("a", 0.05)];
    assert_matches_dense_algebra(
        &compile_example("bouncing_ball", Orders::Declared),
        &shaken,
        9,
    );
}

#[test]
fn impact_satisfies_constraints() {
    // A pendulum with a rod as constraint hits a wall. Its speed is multiplied by -e, and the constraint remains
    // satisfied.
    let text = r#"
[model]
name = "rod"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x = { unit = "m", initial = "l" }
y = { unit = "m" }
[kinetic]
load = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
[impacts]
wall = { when = "x", restitution = 0.5 }
"#;
    let model = CompiledModel::from_text("rod.toml", text, Orders::Declared).unwrap();
    let times: Vec<f64> = (0..=100).map(|step| f64::from(step) * 0.02).collect();
    let motion = simulate_with(&model, &[], &times);
    let run = model.with_declared_parameters().unwrap();
    let energy =
        |state: &[f64]| state[2].powi(2) + state[3].powi(2) + 2.0 * 9.81 * (state[1] + 0.7);
    let first = energy(run.initial_state());
    let states = &motion.trajectory.states;
    for state in states {
        assert!((state[0].hypot(state[1]) - 0.7).abs() < 1e-12, "{state:?}");
        assert!(state[0] > -1e-9, "{state:?}");
        let part = energy(state) / first;
        let bounces = (part.ln() / 0.25_f64.ln()).round();
        assert!((part / 0.25_f64.powf(bounces) - 1.0).abs() < 1e-7, "{part}");
    }
    assert!(energy(&states[100]) < 0.1 * first);
}

#[test]
fn stiff_contact_spring_converges_to_impact() {
    // With e = 1, the motion with a stiff contact spring converges to the motion with an impact.
    let hitting = compile_example("beam_stop", Orders::Uniform(2));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/impacts");
    let text = std::fs::read_to_string(folder.join("beam_stop.toml")).expect("an example");
    let (before, after) = text.split_once("[impacts]").expect("impacts");
    let after = &after[after.find("[observables]").expect("observables")..];
    let before = before.replace(
        "[coordinates]",
        "k_c = { value = 1e8, unit = \"N/m\" }\n\n[coordinates]",
    );
    let spring = "stop = \"1/2*k_c*max(0, -at(w, l) - d)^2\"\n\n";
    let soft = [&before, spring, after].concat();
    let soft = CompiledModel::from_text("soft.toml", &soft, Orders::Uniform(2))
        .unwrap_or_else(|error| panic!("{error}"));
    let times = [0.0, 0.04, 0.05];
    let hard = simulate_with(&hitting, &[("e", 1.0)], &times);
    let distances = [1e8, 1e10].map(|stiffness| {
        let soft = simulate_with(&soft, &[("k_c", stiffness)], &times);
        let pairs = hard.trajectory.states.iter().zip(&soft.trajectory.states);
        let distances = pairs.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()));
        distances.fold(0.0, f64::max)
    });
    assert!(distances[1] < 3e-4, "{distances:?}");
    assert!(distances[1] < 0.15 * distances[0], "{distances:?}");
}

#[test]
fn initial_penetration_by_rounding_starts_on_contact() {
    let model = compile_example("bouncing_ball", Orders::Declared);
    let run = model.with_declared_parameters().unwrap();
    let times = [0.0, 0.3, 1.0];
    let from = |initial: &[f64]| run.simulate(initial, &times, &run.default_inputs(), Solver::Rk);
    let on = from(&[0.0, 2.0]).unwrap().trajectory.states;
    for height in [-1e-17, -1e-13, -1e-300] {
        let thrown = from(&[height, 2.0]).unwrap().trajectory.states;
        for (a, b) in thrown.iter().flatten().zip(on.iter().flatten()) {
            assert!((a - b).abs() < 1e-9, "{height}: {a} {b}");
        }
    }
    for height in [-1e-7, -0.1] {
        let refusal = from(&[height, 0.0]).expect_err("it overlaps").to_string();
        assert!(refusal.contains("is negative"), "{refusal}");
    }
}

#[test]
fn initial_rounding_error_below_a_stop_is_corrected_without_a_length_parameter() {
    for (height, starts) in [("-1e-17", true), ("-1e-300", true), ("-1e-12", false)] {
        let text = format!(
            "[model]\nname = \"block\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             k = {{ value = 10, unit = \"N/m\" }}\n[coordinates]\n\
             x = {{ unit = \"m\", initial = {height} }}\n[kinetic]\n\
             T = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"1/2*k*x^2\"\n[impacts]\n\
             stop = {{ when = \"x\", restitution = 0.5 }}\n"
        );
        let model = CompiledModel::from_text("block.toml", &text, Orders::Declared).expect(&text);
        let run = model.with_declared_parameters().unwrap();
        let motion = run.simulate(
            run.initial_state(),
            &[0.0, 1.0],
            &run.default_inputs(),
            Solver::Rk,
        );
        assert_eq!(motion.is_ok(), starts, "{height}: {motion:?}");
    }
}

#[test]
fn start_just_above_a_floor_needs_no_more_evaluations_than_start_on_it() {
    let starts = |height: &str, speed: &str| {
        let text = format!(
            "[model]\nname = \"ball\"\n[parameters]\nm = {{ value = 2, unit = \"kg\" }}\n\
             g = {{ value = 1, unit = \"m/s^2\" }}\nl = {{ value = 1, unit = \"m\" }}\n[coordinates]\n\
             x = {{ unit = \"m\", initial = {height}, initial_rate = {speed} }}\n[kinetic]\n\
             T = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"m*g*x\"\n[impacts]\n\
             floor = {{ when = \"x\", restitution = 0.5 }}\n"
        );
        let model = CompiledModel::from_text("ball.toml", &text, Orders::Declared).expect(&text);
        let run = model.with_declared_parameters().unwrap();
        [Solver::Rk, Solver::Radau].map(|solver| {
            let motion = run.simulate(
                run.initial_state(),
                &[0.0, 0.5, 1.0],
                &run.default_inputs(),
                solver,
            );
            let trajectory = motion.expect("a motion").trajectory;
            let last = trajectory.states.last().expect("a state");
            assert!(last[0].abs() < 1e-12, "{height} {speed}: {last:?}");
            trajectory.statistics.evaluations
        })
    };
    for height in [
        "1e-12", "1e-14", "1e-17", "1e-20", "1e-30", "1e-100", "1e-300",
    ] {
        for start in [
            [height, "0"],
            [&format!("-{height}"), "0"],
            ["0", height],
            ["0", &format!("-{height}")],
        ] {
            let evaluations = starts(start[0], start[1]);
            assert!(
                evaluations.iter().all(|count| *count < 5000),
                "{start:?}: {evaluations:?}"
            );
        }
    }
}

/// Returns a body above a floor with a force that depends on time, and an independent first-order state.
fn compile_body(height: &str, force: &str, pressure: &str) -> CompiledModel {
    let text = format!(
        "[model]\nname = \"body\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         g = {{ value = 10, unit = \"m/s^2\" }}\ns = {{ value = 1, unit = \"s\" }}\n\
         p = {{ value = {pressure}, unit = \"Pa\" }}\n[coordinates]\n\
         y = {{ unit = \"m\", initial = {height} }}\n[states]\n\
         P = {{ unit = \"Pa\", initial = \"p\", rate = \"(p - P)/s\" }}\n[kinetic]\n\
         T = \"1/2*m*dot(y)^2\"\n[potential]\nV = \"m*g*y\"\n[forces]\n\
         lift = {{ on = \"y\", value = \"m*g*({force})\" }}\n[impacts]\n\
         floor = {{ when = \"y\", restitution = \"0.5\" }}\n"
    );
    CompiledModel::from_text("body.toml", &text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn force_that_reaches_the_weight_lifts_a_resting_body() {
    // With u = 10 f, the body lifts off at f = 1, t = 1; then y'' = 10 (f - 1).
    for (force, height) in [
        ("t/s", 10.0 / 6.0),
        ("(t/s)^3", 8.0),
        ("2*t/s - 1", 10.0 / 3.0),
    ] {
        for start in [0.0, 1e-100, 1e-300] {
            let model = compile_body("0", force, "0");
            for motion in simulate_with_all_solvers(&model, &[start, 0.0, 0.0], &[0.0, 2.0]) {
                let found = motion.trajectory.states[1][0];
                assert!((found - height).abs() < 1e-7, "{force}, {start:e}: {found}");
            }
        }
    }
}

#[test]
fn large_independent_state_does_not_close_contacts() {
    for height in ["1e-3", "1e-5", "1e-6"] {
        let h: f64 = height.parse().expect("a number");
        let (fall, rebound) = ((2.0 * h / 10.0).sqrt(), 0.5 * (2.0 * 10.0 * h).sqrt());
        let until = fall + rebound / 10.0;
        for pressure in ["0", "1e5", "1e7", "1e12"] {
            let model = compile_body(height, "0", pressure);
            let p: f64 = pressure.parse().expect("a number");
            for motion in simulate_with_all_solvers(&model, &[h, 0.0, p], &[0.0, until]) {
                let found = motion.trajectory.states[1][0] / h;
                assert!(
                    (found - 0.25).abs() < 1e-6,
                    "{height} m, {pressure} Pa: {found}"
                );
            }
        }
    }
}

#[test]
fn invalid_impacts_are_rejected_with_reason() {
    let model = compile_example("bouncing_ball", Orders::Declared);
    let run = model.with_declared_parameters().unwrap();
    let at =
        |initial: &[f64], solver| run.simulate(initial, &[0.0, 1.0], &run.default_inputs(), solver);
    for (found, what) in [
        (
            at(&[-0.1, 0.0], Solver::Auto),
            "`table` is negative at the initial state (-1.000000e-1 m)",
        ),
        (at(&[1.0, 0.0], Solver::Adams), "rk or radau"),
        (at(&[1.0, 0.0], Solver::Exact), "rates jump"),
    ] {
        let message = found.expect_err(what).to_string();
        assert!(message.contains(what), "{message}");
    }
    let refusal = model
        .with_parameters(&[("e", 1.2)])
        .err()
        .expect("refused")
        .to_string();
    assert!(refusal.contains('1'), "{refusal}");
    // The distance does not depend on a coordinate.
    let text = r#"
[model]
name = "apart"
[parameters]
m = { value = 1, unit = "kg" }
[coordinates]
y = { unit = "m", initial = 1 }
[kinetic]
ball = "1/2*m*dot(y)^2"
[impacts]
nothing = { when = "0*y", restitution = 0.5 }
"#;
    let refusal = CompiledModel::from_text("apart.toml", text, Orders::Declared)
        .err()
        .expect("refused")
        .to_string();
    for said in ["depends on no coordinate", "`nothing`", "apart.toml:11:21"] {
        assert!(refusal.contains(said), "{refusal}");
    }
    // Two walls approach each other with a ball between them, so the impacts accumulate.
    let text = r#"
[model]
name = "closing"
[parameters]
m = { value = 1, unit = "kg" }
v = { value = 0.1, unit = "m/s" }
d = { value = 1, unit = "m" }
[coordinates]
y = { unit = "m", initial = 0.5, initial_rate = 1 }
[kinetic]
ball = "1/2*m*dot(y)^2"
[impacts]
floor = { when = "y", restitution = 1 }
ceiling = { when = "d - v*t - y", restitution = 1 }
"#;
    let model = CompiledModel::from_text("closing.toml", text, Orders::Declared).unwrap();
    let run = model.with_declared_parameters().unwrap();
    let found = run.simulate(
        run.initial_state(),
        &[0.0, 9.0, 12.0],
        &run.default_inputs(),
        Solver::Rk,
    );
    let Err(Error::Stopped { t, reason }) = found else {
        panic!("not stopped: {found:?}");
    };
    assert!(t.is_some_and(|t| (9.9..10.0).contains(&t)), "{t:?}");
    assert!(reason.contains("press them together"), "{reason}");
}

#[test]
fn measures_without_impacts_reject_them() {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/impacts/bouncing_ball.toml");
    let spec = spec.display().to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out").display().to_string();
    let message = run_rejected(&[
        "sweep",
        &spec,
        "--vary",
        "e=0:1:3",
        "--until",
        "1",
        "--measure",
        "lyapunov",
        "--out",
        &out,
    ]);
    assert!(message.contains("impacts (`table`)"), "{message}");
    assert!(!Path::new(&out).exists());
}

/// Sleigh whose blade can move only along its heading phi.
const SLEIGH: &str = r#"
[model]
name = "sleigh"
[parameters]
m = { value = 1, unit = "kg" }
I = { value = 0.2, unit = "kg*m^2" }
a = { value = 0.3, unit = "m" }
d = { value = 2, unit = "m" }
e = { value = 0.8, unit = "1" }
[coordinates]
x = { unit = "m", initial_rate = 1 }
y = { unit = "m" }
phi = { unit = "rad", initial_rate = 0.2 }
[kinetic]
T = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*I*dot(phi)^2"
[constraints]
blade = { zero = "-sin(phi)*dot(x) + cos(phi)*dot(y) - a*dot(phi)" }
[impacts]
wall = { when = "d - x", restitution = "e" }
"#;

/// Upright disc with the heading psi that rolls on a plane.
const ROLLING_DISC: &str = r#"
[model]
name = "disc"
[parameters]
m = { value = 1, unit = "kg" }
r = { value = 0.2, unit = "m" }
I = { value = 0.02, unit = "kg*m^2" }
J = { value = 0.01, unit = "kg*m^2" }
d = { value = 1, unit = "m" }
e = { value = 0.8, unit = "1" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
theta = { unit = "rad", initial_rate = 5 }
psi = { unit = "rad", initial = 0.3, initial_rate = 0.1 }
[kinetic]
T = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*I*dot(theta)^2 + 1/2*J*dot(psi)^2"
[constraints]
rolls_x = { zero = "dot(x) - r*cos(psi)*dot(theta)" }
rolls_y = { zero = "dot(y) - r*sin(psi)*dot(theta)" }
[impacts]
wall = { when = "d - x", restitution = "e" }
"#;

/// Asserts that the first impact at the wall x = d satisfies Newton's impact law. `inertias` and `rows` are the
/// inertias and the constraint gradients at an angle, which is the last coordinate.
fn assert_bounce_within_constraints(
    text: &str,
    inertias: &[f64],
    rows: impl Fn(f64) -> Vec<Vec<f64>>,
) {
    let model = CompiledModel::from_text("wall.toml", text, Orders::Declared).expect("a model");
    let count = inertias.len();
    let initial = model.with_declared_parameters().unwrap();
    let initial = initial.initial_state().to_vec();
    for motion in simulate_with_all_solvers(&model, &initial, &[0.0, 5.0]) {
        let jump = &motion.trajectory.jumps[0];
        let around = [jump.t * (1.0 - 1e-9), jump.t * (1.0 + 1e-9)];
        let times = [0.0, around[0], around[1]];
        let run = model.with_declared_parameters().unwrap();
        let inputs = run.default_inputs();
        let near = run
            .simulate(&initial, &times, &inputs, motion.solver)
            .unwrap();
        let [_, before, after] = &near.trajectory.states[..] else {
            panic!("three samples");
        };
        let rows = rows(before[count - 1]);
        let size = count + rows.len();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        right[0] = -1.0;
        for (place, inertia) in inertias.iter().enumerate() {
            matrix[(place, place)] = *inertia;
        }
        for (row, entries) in rows.iter().enumerate() {
            for (place, entry) in entries.iter().enumerate() {
                matrix[(count + row, place)] = *entry;
                matrix[(place, count + row)] = *entry;
            }
        }
        let column = matrix.lu().solve(&right).expect("independent constraints");
        let impulse = 1.8 * before[count] / -column[0];
        for place in 0..count {
            let expected = impulse * column[place];
            let found = jump.change[count + place];
            assert!(
                (found - expected).abs() < 1e-7,
                "{place}: {found} and {expected}"
            );
            let change = after[count + place] - before[count + place];
            assert!((change - expected).abs() < 1e-7, "{place}: {change}");
        }
    }
}

#[test]
fn sleigh_and_rolling_disc_bounce_within_their_constraints() {
    assert_bounce_within_constraints(SLEIGH, &[1.0, 1.0, 0.2], |phi| {
        vec![vec![-phi.sin(), phi.cos(), -0.3]]
    });
    assert_bounce_within_constraints(ROLLING_DISC, &[1.0, 1.0, 0.02, 0.01], |psi| {
        vec![
            vec![1.0, 0.0, -0.2 * psi.cos(), 0.0],
            vec![0.0, 1.0, -0.2 * psi.sin(), 0.0],
        ]
    });
}

/// A block rests at a stop, and another block slides on it. When the sliding block sticks, it pulls the first block
/// away from the stop.
#[test]
fn block_leaves_its_stop_when_the_upper_block_sticks() {
    let text = r#"
[model]
name = "pulled"
[parameters]
m = { value = 2, unit = "kg" }
F_c = { value = 4, unit = "N" }
u = { value = -2, unit = "N" }
d = { value = 0.05, unit = "m" }
[coordinates]
a = { unit = "m", initial = "d" }
b = { unit = "m", initial_rate = 1 }
[kinetic]
T = "1/2*m*(dot(a)^2 + dot(b)^2)"
[forces]
pull = { on = "b", value = "u" }
friction = { on = "a - b", value = "-F_c*sign(dot(a) - dot(b))" }
[impacts]
stop = { when = "d - a", restitution = 0 }
"#;
    let model = CompiledModel::from_text("pulled.toml", text, Orders::Declared).unwrap();
    for m in [0.5, 1.0, 1.5, 1.9, 2.0, 2.1, 2.5, 3.0, 5.0] {
        let run = model.with_parameters(&[("m", m)]).unwrap();
        // The block slides until t = m/6; then both blocks have the acceleration u/(2 m).
        let since = 1.0 - m / 6.0;
        let expected = 0.05 - since * since / (2.0 * m);
        for solver in [Solver::Rk, Solver::Radau] {
            let motion = run.simulate(
                run.initial_state(),
                &[0.0, 1.0],
                &run.default_inputs(),
                solver,
            );
            let found = motion.unwrap().trajectory.states[1][0];
            assert!(
                (found - expected).abs() < 1e-7,
                "{m}, {solver}: {found} and {expected}"
            );
        }
    }
}

/// Two bodies stick to each other and hit a stop repeatedly. After each impact both have 0.15 of the speed, so that
/// they come to rest at the stop after 0.33 s.
#[test]
fn bodies_sticking_together_come_to_rest_at_a_stop() {
    let text = r#"
[model]
name = "together"
[parameters]
m = { value = 1, unit = "kg" }
F_c = { value = 4, unit = "N" }
e = { value = 0.7, unit = "1" }
d = { value = 0.05, unit = "m" }
[coordinates]
a = { unit = "m", initial_rate = 0.5 }
b = { unit = "m", initial = 0.02 }
[kinetic]
T = "1/2*m*(dot(a)^2 + dot(b)^2)"
[forces]
friction = { on = "a - b", value = "-F_c*sign(dot(a) - dot(b))" }
[impacts]
stop = { when = "d - b", restitution = "e" }
"#;
    let model = CompiledModel::from_text("together.toml", text, Orders::Declared).unwrap();
    let run = model.with_declared_parameters().unwrap();
    for motion in simulate_with_all_solvers(&model, run.initial_state(), &[0.0, 0.35]) {
        let state = &motion.trajectory.states[1];
        assert!((state[1] - 0.05).abs() < 1e-9, "{state:?}");
        assert!(state[2].abs() < 1e-6 && state[3].abs() < 1e-6, "{state:?}");
    }
}

/// The force of a spring between two bodies equals the bound of the friction between them up to rounding. The bodies
/// continue to stick, and an independent ball bounces as in a separate simulation.
#[test]
fn ball_bounces_beside_friction_at_its_limit() {
    let text = r#"
[model]
name = "limit"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 70, unit = "N/m" }
d = { value = 0.2, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
e = { value = 0.5, unit = "1" }
[coordinates]
a = { unit = "m" }
b = { unit = "m", initial = "d" }
y = { unit = "m", initial = 1 }
[kinetic]
T = "1/2*m*(dot(a)^2/2 + dot(b)^2 + dot(y)^2)"
[potential]
spring = "1/2*k*(b - a)^2"
weight = "m*g*y"
[forces]
friction = { on = "b - a", value = "-k*d*sign(dot(b) - dot(a))" }
[impacts]
floor = { when = "y", restitution = "e" }
"#;
    let model = CompiledModel::from_text("limit.toml", text, Orders::Declared).unwrap();
    let times: Vec<f64> = (0..=50).map(|step| f64::from(step) * 0.1).collect();
    for (k, d, speed) in [(70.0, 0.2, 0.37), (100.0, 0.2, 1.0), (20.0, 0.13, 0.37)] {
        for e in [0.35, 0.429, 0.466, 0.522, 0.668, 0.8, 0.906, 0.928] {
            let run = model
                .with_parameters(&[("k", k), ("d", d), ("e", e)])
                .unwrap();
            for solver in [Solver::Rk, Solver::Radau] {
                let initial = [0.0, d, 1.0, speed, speed, 0.0];
                let motion = run.simulate(&initial, &times, &run.default_inputs(), solver);
                let motion = motion.unwrap_or_else(|error| panic!("{solver} {k} {e}: {error}"));
                for (t, state) in times.iter().zip(&motion.trajectory.states) {
                    let right = [speed * t, d + speed * t, height_after_drop(9.81, e, *t)];
                    for (value, right) in state.iter().zip(right) {
                        assert!(
                            (value - right).abs() < 1e-8,
                            "{solver} {k} {e} {t}: {state:?}"
                        );
                    }
                }
            }
        }
    }
}

/// A mass between two stops without play has no restitution.
#[test]
fn mass_between_stops_without_play_stays() {
    for (first, second) in [(0.5, 0.5), (0.0, 0.0), (0.9, 0.2)] {
        let text = format!(
            "[model]\nname = \"jam\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             k = {{ value = 1, unit = \"N/m\" }}\nd = {{ value = 0, unit = \"m\" }}\n[coordinates]\n\
             x = {{ unit = \"m\", initial_rate = 1 }}\n[kinetic]\nT = \"1/2*m*dot(x)^2\"\n[potential]\n\
             V = \"1/2*k*x^2\"\n[impacts]\na = {{ when = \"x + d\", restitution = {first} }}\n\
             b = {{ when = \"d - x\", restitution = {second} }}\n"
        );
        let model = CompiledModel::from_text("jam.toml", &text, Orders::Declared);
        let model = model.unwrap_or_else(|error| panic!("{error}"));
        for motion in simulate_with_all_solvers(&model, &[0.0, 1.0], &[0.0, 0.5, 1.0]) {
            let states = &motion.trajectory.states;
            assert_eq!(states.len(), 3, "{first}, {second}");
            assert_eq!(states[2], [0.0, 0.0], "{first}, {second}");
        }
    }
}

/// A ball bounces until it rests on a floor whose motion is a spline through samples. At each impact, the ball must be
/// at the floor's position of this time.
#[test]
fn ball_bounces_to_rest_on_a_floor_with_sampled_motion() {
    let times: Vec<f64> = (0..=100).map(|row| 0.01 * f64::from(row)).collect();
    for (frequency, amplitude, restitution, height) in [
        (12.3, 0.06, 0.3, 0.44),
        (17.0, 0.11, 0.3, 0.25),
        (21.7, 0.09, 0.1, 0.31),
        (14.1, 0.07, 0.1, 0.22),
        (26.2, 0.05, 0.5, 0.48),
        (29.3, 0.12, 0.0, 0.37),
    ] {
        let floor =
            |t: &f64| amplitude * ((frequency * t).sin() + 0.3 * (2.3 * frequency * t).sin());
        let spline = CubicSpline::fit(times.clone(), times.iter().map(floor).collect());
        let spline = spline.expect("a spline");
        let inputs = HeldInputs::constant(vec![0.0; 3]).with_prescribed(0, spline.clone());
        let text = format!(
            "[model]\nname = \"ball\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             g = {{ value = 9.81, unit = \"m/s^2\" }}\n[coordinates]\n\
             x = {{ unit = \"m\", initial = {height} }}\n[inputs]\ns = {{ unit = \"m\", rates = 2 }}\n\
             [kinetic]\nT = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"m*g*x\"\n\
             [impacts]\nfloor = {{ when = \"x - s\", restitution = {restitution} }}\n"
        );
        let model = CompiledModel::from_text("ball.toml", &text, Orders::Declared);
        let model = model.unwrap_or_else(|error| panic!("{error}"));
        let run = model.with_declared_parameters().expect("an instance");
        for solver in [Solver::Rk, Solver::Radau] {
            let motion = run.simulate(run.initial_state(), &times, &inputs, solver);
            let case = format!("{frequency} {amplitude} {restitution} {height} {solver}");
            let motion = motion.unwrap_or_else(|error| panic!("{case}: {error}"));
            let samples = motion
                .trajectory
                .times
                .iter()
                .zip(&motion.trajectory.states);
            for (t, state) in samples {
                let distance = state[0] - spline.evaluate(*t)[0];
                assert!(distance > -1e-9, "{case}: {distance} m at {t} s");
            }
        }
    }
}
