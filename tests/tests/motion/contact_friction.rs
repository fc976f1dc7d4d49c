//! Tests of contacts with friction: comparison of sliding, sticking, rolling, rocking and impacts with closed forms,
//! random drops of a box, and rejected models.

use eomgen_codegen::program::evaluator::{Evaluator, ImpactValues, Point};
use eomgen_compiled_model::{CompiledModel, Motion, Orders, Request, Solver};
use nalgebra::{DMatrix, DVector};

const SOLVERS: [Solver; 2] = [Solver::Rk, Solver::Radau];

const G: f64 = 9.81;

/// Returns a block on a plane inclined by `alpha`; `impact` is appended to the entry of the contact.
fn block(coordinates: &str, forces: &str, impact: &str) -> String {
    format!(
        r#"
[model]
name = "block"
[parameters]
m = {{ value = 2, unit = "kg" }}
g = {{ value = 9.81, unit = "m/s^2" }}
mu = {{ value = 0.3, unit = "1" }}
e = {{ value = 0, unit = "1" }}
alpha = {{ value = 0, unit = "rad" }}
f = {{ value = 0, unit = "N" }}
w = {{ value = 3, unit = "1/s" }}
[coordinates]
{coordinates}
y = {{ unit = "m" }}
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
p = "m*g*(y*cos(alpha) - x*sin(alpha))"
[forces]
{forces}
[impacts]
floor = {{ when = "y", restitution = "e", {impact} }}
"#
    )
}

fn sliding_block() -> String {
    let push = r#"push = { on = "x", value = "f*sin(w*t)" }"#;
    let friction = r#"friction = "mu", slip = "dot(x)""#;
    block(r#"x = { unit = "m" }"#, push, friction)
}

const BALL: &str = r#"
[model]
name = "ball"
[parameters]
m = { value = 0.6, unit = "kg" }
r = { value = 0.12, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
mu = { value = 0.2, unit = "1" }
e = { value = 0.7, unit = "1" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
phi = { unit = "rad" }
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/5*m*r^2*dot(phi)^2"
[potential]
p = "m*g*y"
[impacts]
floor = { when = "y - r", restitution = "e", friction = "mu", slip = "dot(x) - r*dot(phi)" }
"#;

fn compile(text: &str) -> CompiledModel {
    CompiledModel::from_text("contact.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Simulates and asserts that the energy audit gives no warning.
fn simulate(
    model: &CompiledModel,
    settings: &[(&str, f64)],
    (initial, times): (&[f64], &[f64]),
    solver: Solver,
) -> Motion {
    let run = model.with_parameters(settings).unwrap();
    let inputs = run.default_inputs();
    let request = Request {
        initial,
        times,
        inputs: &inputs,
        solver,
        tolerance: 1e-10,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
    let stop = motion.early_stop.as_ref().map(|stop| &stop.reason);
    assert!(stop.is_none(), "{solver}: {stop:?}");
    let audit = motion.audit.as_ref().expect("an audit");
    assert_eq!(audit.fault_count, 0, "{solver}: {audit:?}");
    let overlap = run.find_first_overlap(&motion, 1e-9).unwrap();
    assert!(overlap.is_none(), "{solver}: {overlap:?}");
    motion
}

fn final_state(
    model: &CompiledModel,
    settings: &[(&str, f64)],
    initial: &[f64],
    until: f64,
    solver: Solver,
) -> Vec<f64> {
    let motion = simulate(model, settings, (initial, &[0.0, until]), solver);
    motion.trajectory.final_state
}

#[test]
fn sliding_block_comes_to_rest_at_expected_position_and_time() {
    let model = compile(&sliding_block());
    let (v, mu) = (2.0, 0.3);
    let stop = v / (mu * G);
    for solver in SOLVERS {
        let times = [0.0, 0.5 * stop, stop * (1.0 + 1e-9), 1.5];
        let motion = simulate(&model, &[], (&[0.0, 0.0, v, 0.0], &times), solver);
        let states = &motion.trajectory.states;
        assert!(
            (states[1][2] - 0.5 * v).abs() < 1e-9,
            "{solver}: {states:?}"
        );
        for state in &states[2..] {
            assert!(
                (state[0] - v * v / (2.0 * mu * G)).abs() < 1e-9,
                "{solver}: {state:?}"
            );
            assert!(state[2].abs() < 1e-15, "{solver}: {state:?}");
        }
        let switch = motion.trajectory.events[0].t;
        assert!((switch - stop).abs() < 1e-9, "{solver}: {switch}");
    }
}

#[test]
fn block_on_incline_rests_below_the_angle_of_friction_and_slides_above() {
    let model = compile(&sliding_block());
    let limit = 0.3_f64.atan();
    for solver in SOLVERS {
        for (alpha, acceleration) in [
            (0.2, 0.0),
            (limit - 1e-6, 0.0),
            (
                limit + 1e-6,
                G * ((limit + 1e-6).sin() - 0.3 * (limit + 1e-6).cos()),
            ),
            (0.4, G * (0.4_f64.sin() - 0.3 * 0.4_f64.cos())),
        ] {
            let state = final_state(&model, &[("alpha", alpha)], &[0.0; 4], 1.0, solver);
            assert!(
                (state[0] - 0.5 * acceleration).abs() < 1e-9,
                "{solver} {alpha}: {state:?}"
            );
        }
    }
}

#[test]
fn block_thrown_up_an_incline_turns_or_stays() {
    let model = compile(&sliding_block());
    let (mu, v) = (0.3, 1.0);
    for solver in SOLVERS {
        for alpha in [0.2_f64, 0.5] {
            let (s, c) = alpha.sin_cos();
            let up = G * (s + mu * c);
            let (stop, highest) = (v / up, v * v / (2.0 * up));
            let down = (G * (s - mu * c)).max(0.0);
            let rest = 2.0 - stop;
            let expected = -highest + 0.5 * down * rest * rest;
            let settings = [("alpha", alpha)];
            let state = final_state(&model, &settings, &[0.0, 0.0, -v, 0.0], 2.0, solver);
            assert!(
                (state[0] - expected).abs() < 1e-9,
                "{solver} {alpha}: {state:?} {expected}"
            );
        }
    }
}

/// Returns position and speed at the time `until` of a block under the force f sin(w t), computed phase by phase
/// (sticking, sliding).
fn pushed_block(f: f64, w: f64, until: f64) -> [f64; 2] {
    let (m, level) = (2.0, 0.3 * 2.0 * G);
    let (mut x, mut t) = (0.0, 0.0);
    let root = |low: f64, high: f64, of: &dyn Fn(f64) -> f64| {
        let (mut low, mut high) = (low, high);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            match of(low) * of(middle) <= 0.0 {
                true => high = middle,
                false => low = middle,
            }
        }
        0.5 * (low + high)
    };
    // In each half period, the force exceeds the friction once, and the block stops before the next half period.
    for half in 0.. {
        let side = if half % 2 == 0 { 1.0 } else { -1.0 };
        let phase = (level / f).asin() / w;
        let start = std::f64::consts::PI * f64::from(half) / w + phase;
        if start >= until {
            break;
        }
        let moved = |t: f64| {
            let push = side * f / (m * w) * ((w * start).cos() - (w * t).cos());
            push - level / m * (t - start)
        };
        let place = |t: f64| {
            let push = side * f / (m * w)
                * ((w * start).cos() * (t - start) - ((w * t).sin() - (w * start).sin()) / w);
            push - 0.5 * level / m * (t - start).powi(2)
        };
        let last = std::f64::consts::PI * f64::from(half + 1) / w + phase;
        let stop = root(start + 0.3 / w, last, &moved);
        assert!(stop < last, "the phases must not overlap");
        if until < stop {
            return [x + side * place(until), side * moved(until)];
        }
        x += side * place(stop);
        t = stop;
    }
    assert!(t <= until);
    [x, 0.0]
}

#[test]
fn block_pushed_by_varying_force_sticks_and_slips() {
    let model = compile(&sliding_block());
    let (f, w) = (6.2, 3.0);
    for solver in SOLVERS {
        for until in [0.7, 2.0, 5.0] {
            let [x, v] = pushed_block(f, w, until);
            let settings = [("f", f), ("w", w)];
            let state = final_state(&model, &settings, &[0.0; 4], until, solver);
            assert!(
                (state[0] - x).abs() < 1e-9,
                "{solver} {until}: {state:?} {x}"
            );
            assert!(
                (state[2] - v).abs() < 1e-9,
                "{solver} {until}: {state:?} {v}"
            );
        }
    }
}

#[test]
fn sliding_ball_begins_to_roll() {
    let model = compile(BALL);
    let (v, mu, r) = (3.0, 0.2, 0.12);
    let begins = 2.0 / 7.0 * v / (mu * G);
    let expected = v * begins - 0.5 * mu * G * begins * begins + (2.0 - begins) * 5.0 / 7.0 * v;
    for solver in SOLVERS {
        let initial = [0.0, r, 0.0, v, 0.0, 0.0];
        let motion = simulate(&model, &[], (&initial, &[0.0, 2.0]), solver);
        let state = &motion.trajectory.final_state;
        assert!(
            (state[0] - expected).abs() < 1e-9,
            "{solver}: {state:?} {expected}"
        );
        assert!(
            (state[3] - 5.0 / 7.0 * v).abs() < 1e-9,
            "{solver}: {state:?}"
        );
        let switch = motion.trajectory.events[0].t;
        assert!(
            (switch - begins).abs() < 1e-9,
            "{solver}: {switch} {begins}"
        );
    }
}

#[test]
fn ball_with_spin_bounces_with_sliding_or_rolling_impulse() {
    let model = compile(BALL);
    let (r, mu, e, height) = (0.12, 0.2, 0.7, 1.0);
    let fall = (2.0 * G * height).sqrt();
    for solver in SOLVERS {
        for (v, spin) in [(1.0, -30.0), (1.0, 5.0), (-2.0, 60.0), (0.5, 0.5 / 0.12)] {
            let slip: f64 = v - r * spin;
            let impulse = (mu * (1.0 + e) * fall).min(2.0 / 7.0 * slip.abs()) * -slip.signum();
            let initial = [0.0, height + r, 0.0, v, 0.0, spin];
            let state = final_state(&model, &[], &initial, 0.6, solver);
            assert!(
                (state[3] - (v + impulse)).abs() < 1e-9,
                "{solver} {v} {spin}: {state:?}"
            );
            let turned = spin - 2.5 * impulse / r;
            assert!(
                (state[5] - turned).abs() < 1e-8,
                "{solver} {v} {spin}: {state:?}"
            );
        }
    }
}

/// Slender block that rocks on two edges.
const ROCKING: &str = r#"
[model]
name = "rocking"
[parameters]
m = { value = 2, unit = "kg" }
b = { value = 0.1, unit = "m" }
h = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
mu = { value = 0.8, unit = "1" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
phi = { unit = "rad" }
[definitions]
left_x = "x + h*sin(phi) - b*cos(phi)"
right_x = "x + h*sin(phi) + b*cos(phi)"
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/6*m*(b^2 + h^2)*dot(phi)^2"
[potential]
p = "m*g*y"
[impacts]
left = { when = "y - h*cos(phi) - b*sin(phi)", restitution = 0, friction = "mu", slip = "dot(left_x)" }
right = { when = "y - h*cos(phi) + b*sin(phi)", restitution = 0, friction = "mu", slip = "dot(right_x)" }
"#;

#[test]
fn rocking_block_loses_energy_by_housners_ratio() {
    let model = compile(ROCKING);
    let (m, b, h) = (2.0, 0.1_f64, 0.5_f64);
    let slope = b.atan2(h).sin();
    // Ratio of the kinetic energies after and before an impact.
    let ratio = (1.0 - 1.5 * slope * slope).powi(2);
    let phi = 0.1_f64;
    let initial = [0.0, h * phi.cos() + b * phi.sin(), phi, 0.0, 0.0, 0.0];
    let times: Vec<f64> = (0..=400).map(|step| f64::from(step) * 0.01).collect();
    for solver in SOLVERS {
        let motion = simulate(&model, &[], (&initial, &times), solver);
        let run = model.with_declared_parameters().unwrap();
        let rows = run.observables(&motion).unwrap();
        let names = run.model().observable_names();
        let place = names.iter().position(|name| name == "energy").unwrap();
        let flat = m * G * h;
        let mut levels: Vec<f64> = rows.iter().map(|row| row[place] - flat).collect();
        levels.dedup_by(|a, b| (*a - *b).abs() < 1e-8);
        assert!(levels.len() >= 5, "{solver}: {levels:?}");
        for pair in levels.windows(2) {
            assert!(
                (pair[1] / pair[0] - ratio).abs() < 1e-7,
                "{solver}: {levels:?} {ratio}"
            );
        }
    }
}

#[test]
fn box_at_rest_on_two_edges_of_a_slope_stays_without_switches() {
    let text = ROCKING
        .replace("p = \"m*g*y\"", "p = \"m*g*(y*cos(alpha) - x*sin(alpha))\"")
        .replace("mu = {", "alpha = { value = 0.15, unit = \"rad\" }\nmu = {");
    let model = compile(&text);
    for solver in SOLVERS {
        let initial = [0.0, 0.5, 0.0, 0.0, 0.0, 0.0];
        let motion = simulate(&model, &[("mu", 0.16)], (&initial, &[0.0, 50.0]), solver);
        let state = &motion.trajectory.final_state;
        assert!(state[0].abs() < 1e-12, "{solver}: {state:?}");
        let switches = motion.trajectory.events.len();
        assert!(switches <= 2, "{solver}: {switches} switches");
    }
}

#[test]
fn steeper_box_tips_about_its_lower_edge() {
    let text = ROCKING
        .replace("p = \"m*g*y\"", "p = \"m*g*(y*cos(alpha) - x*sin(alpha))\"")
        .replace("mu = {", "alpha = { value = 0.3, unit = \"rad\" }\nmu = {");
    let model = compile(&text);
    // tan(0.3) > b/h, so the block tips. `expected` is the initial angular acceleration about the edge.
    let (b, h) = (0.1, 0.5);
    let (s, c) = 0.3_f64.sin_cos();
    let acceleration = G * (h * s - b * c) / (4.0 / 3.0 * (b * b + h * h));
    for solver in SOLVERS {
        let t = 1e-3;
        let state = final_state(&model, &[], &[0.0, h, 0.0, 0.0, 0.0, 0.0], t, solver);
        let expected = -0.5 * acceleration * t * t;
        assert!(
            (state[2] - expected).abs() < 1e-4 * expected.abs(),
            "{solver}: {state:?}"
        );
    }
}

const ROD: &str = r#"
[model]
name = "rod"
[parameters]
m = { value = 1, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
mu = { value = 1.5, unit = "1" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
phi = { unit = "rad" }
[definitions]
tip_x = "x + l*cos(phi)"
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/6*m*l^2*dot(phi)^2"
[potential]
p = "m*g*y"
[impacts]
tip = { when = "y - l*sin(phi)", restitution = 0, friction = "mu", slip = "dot(tip_x)" }
"#;

#[test]
fn painleve_rod_is_rejected_only_within_its_cone() {
    let model = compile(ROD);
    let phi = 2.0_f64.atan();
    let initial = [0.0, 0.5 * phi.sin(), phi, 5.0, 0.0, 0.0];
    for solver in SOLVERS {
        // W_nn - mu W_nt is zero at mu = 4/3 for tan(phi) = 2.
        let state = final_state(&model, &[("mu", 1.3)], &initial, 0.01, solver);
        assert!(state.iter().all(|entry| entry.is_finite()));
        let run = model.with_parameters(&[("mu", 1.35)]).unwrap();
        let found = run.simulate(&initial, &[0.0, 0.1], &run.default_inputs(), solver);
        let reason = match found {
            Err(error) => error.to_string(),
            Ok(motion) => motion.early_stop.expect("a stop").reason,
        };
        for said in ["t = 0", "`tip`", "Painlev", "Lower the friction"] {
            assert!(reason.contains(said), "{solver}: {reason}");
        }
    }
}

fn dropped_box() -> CompiledModel {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/impacts");
    CompiledModel::load(folder.join("box_with_friction.toml"), Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn dropped_boxes_with_friction_never_stop_and_gain_no_energy() {
    let model = dropped_box();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut between = |low: f64, high: f64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let times: Vec<f64> = (0..=60).map(|step| f64::from(step) * 0.1).collect();
    for case in 0..200 {
        let settings = [
            ("e", between(0.0, 0.7)),
            ("b", between(0.1, 0.4)),
            ("mu", between(0.0, 1.5)),
        ];
        let initial = [
            0.0,
            between(0.5, 1.0),
            between(-3.2, 3.2),
            between(-2.0, 2.0),
            between(-2.0, 1.0),
            between(-8.0, 8.0),
        ];
        let motion = simulate(&model, &settings, (&initial, &times), Solver::Rk);
        let run = model.with_parameters(&settings).unwrap();
        let rows = run.observables(&motion).unwrap();
        let names = run.model().observable_names();
        let place = names.iter().position(|name| name == "energy").unwrap();
        for pair in rows.windows(2) {
            let rise = pair[1][place] - pair[0][place];
            assert!(rise <= 1e-8 * pair[0][place].abs(), "{case}: {rise:e}");
        }
    }
}

#[test]
fn box_dropped_flat_bounces_evenly() {
    let model = dropped_box();
    for solver in SOLVERS {
        let settings = [("e", 0.5), ("mu", 0.4)];
        let initial = [0.0, 0.7, 0.0, 3.0, 0.0, 0.0];
        let fall = (2.0 * G * 0.5_f64).sqrt();
        let t = fall / G + 0.1;
        let state = final_state(&model, &settings, &initial, t, solver);
        assert!(
            (state[4] - (0.5 * fall - 0.1 * G)).abs() < 1e-9,
            "{solver}: {state:?}"
        );
        let slowed = 3.0 - 0.4 * 1.5 * fall;
        assert!(
            (state[3] - slowed).abs() < 1e-9,
            "{solver}: {state:?} {slowed}"
        );
        assert!(state[5].abs() < 1e-9, "{solver}: {state:?}");
    }
}

/// A rotating disc stops in a groove after sliding, or after rocking from wall to wall. The machine is formulated in
/// coordinate systems at several angles.
#[test]
fn disc_comes_to_rest_in_a_groove_at_any_angle() {
    let model = compile(
        r#"
[model]
name = "disc"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
r = { value = 0.2, unit = "m" }
mu = { value = 0.3, unit = "1" }
e = { value = 0, unit = "1" }
alpha = { value = 0, unit = "rad" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
phi = { unit = "rad" }
[definitions]
a = "x*cos(alpha) + y*sin(alpha)"
b = "y*cos(alpha) - x*sin(alpha)"
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/4*m*r^2*dot(phi)^2"
[potential]
weight = "m*g*(a + b)/sqrt(2)"
[impacts]
floor = { when = "b - r", restitution = "e", friction = "mu", slip = "dot(a) + r*dot(phi)" }
wall = { when = "a - r", restitution = "e", friction = "mu", slip = "r*dot(phi) - dot(b)" }
"#,
    );
    for (mu, e, height, spin) in [
        (0.3, 0.0, 0.0, 5.0),
        (1.2, 0.0, 0.0, 5.0),
        (1.2, 0.0, 0.0, -30.0),
        (0.3, 0.2, 0.3, 30.0),
        (1.2, 0.2, 0.1, 0.0),
    ] {
        let rest = |alpha: f64, solver: Solver| {
            let (a, b) = (0.2 + height, 0.2);
            let start = [
                a * alpha.cos() - b * alpha.sin(),
                a * alpha.sin() + b * alpha.cos(),
                0.0,
                0.0,
                0.0,
                spin,
            ];
            let settings = [("mu", mu), ("e", e), ("alpha", alpha)];
            let end = final_state(&model, &settings, &start, 8.0, solver);
            assert!(
                end[3..].iter().all(|rate| rate.abs() < 1e-9),
                "{mu} {e} {alpha} {solver}: {end:?}"
            );
            end[2]
        };
        let expected = rest(0.0, Solver::Rk);
        for solver in SOLVERS {
            for alpha in [0.3, std::f64::consts::FRAC_PI_4, 2.0] {
                let found = rest(alpha, solver);
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{mu} {e} {alpha} {solver}: {found}, at 0 rad {expected}"
                );
            }
        }
    }
}

/// Links on a hinge fall on a floor, bounce infinitely often while they slide, and stick. The expected final state is
/// from SciPy (DOP853, 1e-13) with impacts down to 1e-7 m/s.
#[test]
fn links_that_stop_bouncing_while_they_slide_keep_their_momentum() {
    let model = compile(
        r#"
[model]
name = "links"
[parameters]
m = { value = 1, unit = "kg" }
l = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
h = { value = 1.2, unit = "m" }
[coordinates]
a = { unit = "rad" }
b = { unit = "rad" }
[definitions]
x = "l*sin(a)"
y = "h - l*cos(a)"
u = "x + l*sin(b)"
v = "y - l*cos(b)"
[kinetic]
k = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(v)^2)"
[potential]
weight = "m*g*(y + v)"
[impacts]
floor = { when = "v", restitution = 0.2, friction = 0.8, slip = "dot(u)" }
"#,
    );
    for solver in SOLVERS {
        let end = final_state(&model, &[], &[1.2, 2.0, 0.0, 0.0], 2.5, solver);
        let u = end[0].sin() + end[1].sin();
        assert!((u - 1.233_391_277_7).abs() < 1e-8, "{solver}: {u}");
    }
}

#[test]
fn block_on_moving_belt_is_carried_along() {
    let friction = r#"friction = "mu", slip = "dot(x) - w*u""#;
    let text = block(r#"x = { unit = "m" }"#, "", friction)
        .replace(
            "w = { value = 3",
            "u = { value = 0.5, unit = \"m\" }\nw = { value = 3",
        )
        .replace("[forces]\n", "");
    let model = compile(&text);
    let (v, mu, m) = (1.5, 0.3, 2.0);
    let begins = v / (mu * G);
    for solver in SOLVERS {
        let motion = simulate(&model, &[], (&[0.0; 4], &[0.0, 2.0]), solver);
        let state = &motion.trajectory.final_state;
        let expected = 0.5 * mu * G * begins * begins + v * (2.0 - begins);
        assert!(
            (state[0] - expected).abs() < 1e-9,
            "{solver}: {state:?} {expected}"
        );
        let work = motion.audit.as_ref().map_or(f64::NAN, |audit| audit.work);
        assert!((work - 0.5 * m * v * v).abs() < 1e-8, "{solver}: {work}");
    }
}

#[test]
fn slip_that_is_not_linear_and_wrong_coefficients_are_rejected() {
    let text = sliding_block().replace("slip = \"dot(x)\"", "slip = \"sqrt(dot(x)^2 + dot(y)^2)\"");
    let refusal = CompiledModel::from_text("contact.toml", &text, Orders::Declared);
    let refusal = refusal.err().expect("refused").to_string();
    assert!(refusal.contains("not linear in the rates"), "{refusal}");
    assert!(refusal.contains("contact.toml:"), "{refusal}");
    let model = compile(&sliding_block());
    let refusal = model
        .with_parameters(&[("mu", -0.1)])
        .err()
        .expect("refused")
        .to_string();
    assert!(
        refusal.contains("the friction of `floor` is -0.1"),
        "{refusal}"
    );
    assert!(model.with_parameters(&[("mu", f64::NAN)]).is_err());
}

/// Compares generalised force directions, Delassus' matrix and the accelerations of slips with dense algebra and finite
/// differences.
fn assert_slips_match_dense_algebra(model: &CompiledModel) {
    let run = model.with_declared_parameters().unwrap();
    let mut own = run.evaluator().unwrap();
    let (degrees, states) = (own.program().degrees_of_freedom(), own.program().states());
    let state: Vec<f64> = (0..states)
        .map(|k| 0.3 * (1.7 * k as f64 + 0.4).sin())
        .collect();
    let at = |own: &mut Evaluator, t: f64, state: &[f64]| {
        let mut found = Vec::new();
        let inputs = &[];
        own.impacts(Point { t, state, inputs }, &mut found);
        found
    };
    let here = at(&mut own, 0.0, &state);
    let mut mass = vec![0.0; degrees * degrees];
    let point = Point {
        t: 0.0,
        state: &state,
        inputs: &[],
    };
    own.mass_matrix(point, &mut mass);
    let mass = DMatrix::from_row_slice(degrees, degrees, &mass);
    let mut rates = vec![0.0; states];
    own.rates(point, &mut rates);
    let normal = here.iter().map(|impact| impact.column.clone());
    let slips = here.iter().filter_map(|impact| impact.friction.as_ref());
    let columns: Vec<Vec<f64>> = normal.chain(slips.map(|one| one.column.clone())).collect();
    for (place, impact) in here.iter().enumerate() {
        let Some(friction) = &impact.friction else {
            continue;
        };
        let slip =
            |found: &[ImpactValues]| found[place].friction.as_ref().map_or(f64::NAN, |f| f.slip);
        let row = DVector::from_fn(degrees, |entry, _| {
            let mut moved = state.clone();
            moved[degrees + entry] += 1.0;
            slip(&at(&mut own, 0.0, &moved)) - friction.slip
        });
        let column = DVector::from_column_slice(&friction.column);
        let off = (&mass * &column - &row).norm();
        assert!(off < 1e-9 * row.norm(), "column {place}: {off:e}");
        for (entry, column) in friction.delassus.iter().zip(&columns) {
            let column = DVector::from_column_slice(column);
            let off = (entry - row.dot(&column)).abs();
            assert!(off < 1e-9 * row.norm() * column.norm(), "{place}: {off:e}");
        }
        let size = rates
            .iter()
            .fold(1.0_f64, |most, rate| most.max(rate.abs()));
        let step = 1e-4 / size;
        let [after, before] = [step, -step].map(|step| {
            let pairs = state.iter().zip(&rates);
            let moved: Vec<f64> = pairs.map(|(x, rate)| x + step * rate).collect();
            slip(&at(&mut own, step, &moved))
        });
        let off = ((after - before) / (2.0 * step) - friction.acceleration).abs();
        assert!(off < 1e-6 * size * size, "acceleration {place}: {off:e}");
    }
}

#[test]
fn slips_match_dense_algebra_for_rigid_and_flexible_machines() {
    assert_slips_match_dense_algebra(&dropped_box());
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models");
    let text = std::fs::read_to_string(folder.join("hub_beam_tip_mass.toml")).expect("a model");
    let stop = "\n[impacts]\nmiddle = { when = \"l - at(w, l/2)\", restitution = 0 }\n\
                tip = { when = \"l + at(w, l) + l*theta\", restitution = 0.5, friction = 0.3, \
                slip = \"dot(at(w, l/2)) + l*dot(theta)*cos(theta)\" }\n";
    for order in [1, 3, 8] {
        let orders = Orders::Uniform(order);
        let model = CompiledModel::from_text("hub.toml", &(text.clone() + stop), orders);
        assert_slips_match_dense_algebra(&model.unwrap_or_else(|error| panic!("{error}")));
    }
}

/// Wheel on a rough floor with dry friction F_c in its bearing; a torque M acts from t_0 on.
const WHEEL: &str = r#"
[model]
name = "wheel"
[parameters]
m = { value = 2, unit = "kg" }
I = { value = 0.01, unit = "kg*m^2" }
r = { value = 0.1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
F_c = { value = 0.05, unit = "N m" }
mu = { value = 0.5, unit = "1" }
M = { value = 1, unit = "N m" }
t_0 = { value = 0.1, unit = "s" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
phi = { unit = "rad" }
[kinetic]
T = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*I*dot(phi)^2"
[potential]
weight = "m*g*y"
[forces]
drive = { on = "phi", value = "M*above(t - t_0) - F_c*sign(dot(phi))" }
[impacts]
floor = { when = "y", restitution = 0, friction = "mu", slip = "dot(x) - r*dot(phi)" }
"#;

#[test]
fn wheel_with_bearing_friction_rests_rolls_or_slips() {
    let model = compile(WHEEL);
    let (m, inertia, r, friction) = (2.0, 0.01, 0.1, 0.05);
    for torque in [0.04, 0.051, 0.1, 1.0, 1.4, 1.6, 3.0, -1.0, -3.0_f64] {
        for mu in [0.1, 0.5] {
            let left = torque.signum() * (torque.abs() - friction).max(0.0);
            let rolling = left * r / (inertia + m * r * r);
            let limit = torque.signum() * mu * G;
            let (a, alpha) = match rolling.abs() <= limit.abs() {
                true => (rolling, rolling / r),
                false => (limit, (left - limit * m * r) / inertia),
            };
            for solver in SOLVERS {
                let settings = [("M", torque), ("mu", mu)];
                let end = final_state(&model, &settings, &[0.0; 6], 1.0, solver);
                for (value, right) in [
                    (end[0], 0.405 * a),
                    (end[2], 0.405 * alpha),
                    (end[3], 0.9 * a),
                    (end[5], 0.9 * alpha),
                ] {
                    let error = (value - right).abs();
                    assert!(
                        error < 1e-9 * (1.0 + right.abs()),
                        "{solver} {torque} {mu}: {end:?} {right}"
                    );
                }
            }
        }
    }
}

#[test]
fn bounds_of_dry_friction_and_contact_friction_add_up() {
    let text = |friction: &str, impact: &str| {
        let force = format!(
            r#"push = {{ on = "x", value = "f*sin(w*t)" }}
friction = {{ on = "x", value = "-{friction}*sign(dot(x))" }}"#
        );
        let all = block(r#"x = { unit = "m" }"#, &force, impact);
        let c = "F_c = { value = 2, unit = \"N\" }\n[coordinates]";
        all.replace("[coordinates]", c).replace(", }", " }")
    };
    let both = compile(&text("F_c", r#"friction = "mu", slip = "dot(x)""#));
    let one = compile(&text("(F_c + mu*m*g)", ""));
    for limit in [0.5, 2.0, 6.0, 8.0] {
        for speed in [0.0, 1.0, -0.5] {
            let settings = [("F_c", limit), ("f", 15.0), ("w", 2.0)];
            let initial = [0.0, 0.0, speed, 0.0];
            for solver in SOLVERS {
                let times: Vec<f64> = (0..=20).map(|step| f64::from(step) * 0.5).collect();
                let [both, one] = [&both, &one]
                    .map(|model| simulate(model, &settings, (&initial, &times), solver));
                let states = both.trajectory.states.iter().zip(&one.trajectory.states);
                for (both, one) in states {
                    let gap = (both[0] - one[0]).abs().max((both[2] - one[2]).abs());
                    assert!(gap < 1e-7, "{solver} {limit} {speed}: {both:?} {one:?}");
                }
            }
        }
    }
}

/// A mass on a rough floor is pushed against a smooth wall, with dry friction along z; `slip` is the slip on the floor.
#[test]
fn dry_friction_at_a_smooth_wall_rests_on_a_rough_floor() {
    let text = |slip: &str| {
        format!(
            r#"
[model]
name = "corner"
[parameters]
m = {{ value = 1, unit = "kg" }}
F = {{ value = 20, unit = "N" }}
F_c = {{ value = 3, unit = "N" }}
g = {{ value = 9.81, unit = "m/s^2" }}
mu = {{ value = 0.3, unit = "1" }}
[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}
z = {{ unit = "m" }}
[kinetic]
T = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[potential]
weight = "m*g*y"
[forces]
push = {{ on = "z", value = "-F" }}
friction = {{ on = "z", value = "-F_c*sign(dot(z))" }}
[impacts]
floor = {{ when = "y", restitution = 0, friction = "mu", slip = "{slip}" }}
wall = {{ when = "z", restitution = 0 }}
"#
        )
    };
    let g_mu = 0.3 * G;
    for (slip, along_z) in [("dot(x)", 3.0), ("dot(z)", 3.0 + g_mu)] {
        let model = compile(&text(slip));
        for push in [5.0, 7.0, 20.0] {
            for z in [0.0, 0.5] {
                let a = push - along_z;
                // The block does not reach a wall.
                let moved = 0.5 * a.max(0.0) * 0.04;
                for solver in SOLVERS {
                    let initial = [0.0, 0.0, z, 0.4, 0.0, 0.0];
                    let times = [0.0, 0.2, 2.0];
                    let motion = simulate(&model, &[("F", push)], (&initial, &times), solver);
                    let states = &motion.trajectory.states;
                    let end = if a > 0.0 { 0.0 } else { z };
                    let early = if z > 0.0 { z - moved } else { 0.0 };
                    assert!(
                        (states[1][2] - early).abs() < 1e-9,
                        "{slip} {push}: {states:?}"
                    );
                    assert!(
                        (states[2][2] - end).abs() < 1e-9,
                        "{slip} {push}: {states:?}"
                    );
                    assert!(states[2][5].abs() < 1e-12, "{slip} {push}: {states:?}");
                    let x = match slip {
                        "dot(x)" => 0.16 / (2.0 * g_mu),
                        _ => 0.8,
                    };
                    assert!((states[2][0] - x).abs() < 1e-9, "{slip} {push}: {states:?}");
                }
            }
        }
    }
}

/// Blocks stick to each other on a floor that oscillates sideways; they slide on it together as one block.
#[test]
fn stack_on_a_shaking_floor_moves_as_one_block() {
    let text = |blocks: usize| {
        let mut text = String::from(
            r#"
[model]
name = "shaken"
[parameters]
h = { value = 0.1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
mu = { value = 0.3, unit = "1" }
b = { value = 0.005, unit = "m" }
w = { value = 30, unit = "1/s" }
m = { value = 1, unit = "kg" }
[definitions]
side = "b*sin(w*t)"
"#,
        );
        let mut add = |header: &str, entry: &dyn Fn(usize) -> String| {
            text.push_str(header);
            (1..=blocks).for_each(|block| text.push_str(&entry(block)));
        };
        add("[coordinates]\n", &|i| {
            format!(
                "x{i} = {{ unit = \"m\" }}\ny{i} = {{ unit = \"m\", initial = \"{}*h\" }}\n",
                i - 1
            )
        });
        add("[kinetic]\n", &|i| {
            format!("k{i} = \"1/2*m*(dot(x{i})^2 + dot(y{i})^2)\"\n")
        });
        add("[potential]\n", &|i| format!("w{i} = \"m*g*y{i}\"\n"));
        add("[impacts]\n", &|i| {
            let (when, slip) = match i {
                1 => ("y1".to_owned(), "dot(x1) - dot(side)".to_owned()),
                _ => (
                    format!("y{i} - y{} - h", i - 1),
                    format!("dot(x{i}) - dot(x{})", i - 1),
                ),
            };
            format!(
                "c{i} = {{ when = \"{when}\", restitution = 0, friction = \"{i}*mu\", slip = \"{slip}\" }}\n"
            )
        });
        text
    };
    let one = compile(&text(1));
    for blocks in [2, 3, 5] {
        let stack = compile(&text(blocks));
        for (b, mu) in [(0.005, 0.3), (0.01, 0.3), (0.01, 0.8), (0.02, 0.2)] {
            for solver in SOLVERS {
                for tolerance in [1e-3, 1e-9] {
                    let end = |model: &CompiledModel| {
                        let run = model.with_parameters(&[("b", b), ("mu", mu)]).unwrap();
                        let inputs = run.default_inputs();
                        let request = Request {
                            initial: run.initial_state(),
                            times: &[0.0, 3.0],
                            inputs: &inputs,
                            solver,
                            tolerance,
                            max_step: f64::INFINITY,
                            audit: false,
                        };
                        let motion = run.simulate_until_stop(&request, &mut |_| {}).unwrap();
                        let stop = motion.early_stop.as_ref().map(|stop| &stop.reason);
                        assert!(stop.is_none(), "{solver} {blocks} {b} {mu}: {stop:?}");
                        motion.trajectory.final_state
                    };
                    let (right, found) = (end(&one), end(&stack));
                    let allowed = 1e-7_f64.max(0.1 * tolerance);
                    for block in 0..blocks {
                        let gap = (found[2 * block] - right[0]).abs();
                        assert!(
                            gap < allowed,
                            "{solver} {blocks} {b} {mu} {tolerance}: {gap:e}"
                        );
                    }
                }
            }
        }
    }
}

/// A rod slides over a rough floor, and a force lifts it. Above a critical coefficient of friction, both lift-off and
/// jamming are solutions (Painleve's paradox).
#[test]
fn several_solutions_are_noted_and_the_smallest_forces_are_used() {
    for (friction, is_noted) in [
        (0.5, false),
        (1.0, false),
        (1.5, true),
        (2.0, true),
        (3.0, true),
    ] {
        let text = format!(
            "[model]\nname = \"rod\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             l = {{ value = 1, unit = \"m\" }}\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n\
             F = {{ value = 12, unit = \"N\" }}\nmu = {{ value = {friction}, unit = \"1\" }}\n[coordinates]\n\
             x = {{ unit = \"m\", initial_rate = -1 }}\ny = {{ unit = \"m\", initial = \"l*sin(pi/3)\" }}\n\
             phi = {{ unit = \"rad\", initial = \"pi/3\" }}\n[kinetic]\n\
             rod = \"1/2*m*(dot(x)^2 + dot(y)^2) + 1/6*m*l^2*dot(phi)^2\"\n[potential]\nweight = \"m*g*y\"\n\
             [forces]\nlift = {{ on = \"y\", value = \"F\" }}\n[impacts]\n\
             floor = {{ when = \"y - l*sin(phi)\", restitution = 0, friction = \"mu\", \
             slip = \"dot(x) + l*sin(phi)*dot(phi)\" }}\n"
        );
        let model = CompiledModel::from_text("rod.toml", &text, Orders::Declared);
        let model = model.unwrap_or_else(|error| panic!("{error}\n{text}"));
        let run = model.with_declared_parameters().expect("an instance");
        let times = [0.0, 0.1];
        let motion = run.simulate(
            run.initial_state(),
            &times,
            &run.default_inputs(),
            Solver::Rk,
        );
        let motion = motion.unwrap_or_else(|error| panic!("{friction}: {error}"));
        let choices = &motion.friction_choices;
        assert_eq!(!choices.is_empty(), is_noted, "{friction}: {choices:?}");
        if let Some(choice) = choices.first() {
            assert_eq!(choice.t, 0.0);
            assert_eq!(choice.impacts, ["floor"]);
            assert!(choice.motions > 1);
        }
        let risen = motion.trajectory.final_state[1] - (std::f64::consts::PI / 3.0).sin();
        let expected = 0.5 * (12.0 - 9.81) * 0.01;
        assert!((risen - expected).abs() < 1e-9, "{friction}: {risen}");
    }
}
