//! Tests of redundant constraints: comparison of motions with the machines without redundant constraints, and of
//! multipliers of least norm with a dense pseudo-inverse.

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{CompiledModel, Instance, Motion, Orders, Request, Solver};
use eomgen_tests::certified::{certify, check_model};
use nalgebra::{DMatrix, DVector};

/// Platform that swings on three parallel rods; the third rod is redundant.
const THREE_RODS: &str = r#"
[model]
name = "three_rods"
[parameters]
m = { value = 2, unit = "kg" }
J = { value = 0.1, unit = "kg m^2" }
g = { value = 9.81, unit = "m/s^2" }
l = { value = 1, unit = "m" }
l_r = { value = 1, unit = "m" }
a = { value = 0.5, unit = "m" }
w = { value = 0, unit = "rad/s" }
[coordinates]
x = { unit = "m", initial = "l*sin(0.4)", initial_rate = "l*w*cos(0.4)" }
y = { unit = "m", initial = "-l*cos(0.4)", initial_rate = "l*w*sin(0.4)" }
phi = { unit = "rad" }
[kinetic]
body = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*J*dot(phi)^2"
[potential]
g = "m*g*y"
[constraints]
left   = { zero = "((x - a*cos(phi) + a)^2 + (y - a*sin(phi))^2 - l^2)/l" }
middle = { zero = "(x^2 + y^2 - l^2)/l" }
right  = { zero = "((x + a*cos(phi) - a)^2 + (y + a*sin(phi))^2 - l_r^2)/l" }
"#;

/// Bead that turns a shaft. Any two of the three constraints imply the third. `circle` and any other constraint are
/// dependent at some angle.
const BEAD: &str = r#"
[model]
name = "bead"
[parameters]
m = { value = 1, unit = "kg" }
J = { value = 0.05, unit = "kg m^2" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
w = { value = 9, unit = "rad/s" }
[coordinates]
x = { unit = "m", initial = "l*cos(0.1)", initial_rate = "-l*w*sin(0.1)" }
y = { unit = "m", initial = "l*sin(0.1)", initial_rate = "l*w*cos(0.1)" }
p = { unit = "rad", initial = 0.1, initial_rate = "w" }
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2)"
shaft = "1/2*J*dot(p)^2"
[potential]
weight = "m*g*y"
[constraints]
"#;

const ALONG: &str = "along = { zero = \"x - l*cos(p)\" }\n";
const UP: &str = "up = { zero = \"y - l*sin(p)\" }\n";
const CIRCLE: &str = "circle = { zero = \"(x^2 + y^2 - l^2)/l\" }\n";

/// Machine of [`BEAD`] with the angle of the shaft as the only coordinate.
const SHAFT: &str = r#"
[model]
name = "shaft"
[parameters]
m = { value = 1, unit = "kg" }
J = { value = 0.05, unit = "kg m^2" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
w = { value = 9, unit = "rad/s" }
[coordinates]
p = { unit = "rad", initial = 0.1, initial_rate = "w" }
[kinetic]
bead = "1/2*(m*l^2 + J)*dot(p)^2"
[potential]
weight = "m*g*l*sin(p)"
"#;

/// Three equal cranks with one coupler that does not rotate; there are more constraints than coordinates.
const CRANKS: &str = r#"
[model]
name = "cranks"
[parameters]
m = { value = 1, unit = "kg" }
J = { value = 0.05, unit = "kg m^2" }
l = { value = 0.7, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
w = { value = 9, unit = "rad/s" }
[coordinates]
p = { unit = "rad", initial = 0.1, initial_rate = "w" }
r = { unit = "rad", initial = 0.1, initial_rate = "w" }
s = { unit = "rad", initial = 0.1, initial_rate = "w" }
[kinetic]
cranks = "1/2*J*(0.5*dot(p)^2 + 0.2*dot(r)^2 + 0.3*dot(s)^2)"
coupler = "1/2*m*l^2*dot(p)^2"
[potential]
weight = "m*g*l*sin(p)"
[constraints]
x_r = { zero = "l*(cos(p) - cos(r))" }
y_r = { zero = "l*(sin(p) - sin(r))" }
x_s = { zero = "l*(cos(p) - cos(s))" }
y_s = { zero = "l*(sin(p) - sin(s))" }
"#;

/// Planar four-bar linkage of point masses in three dimensions.
const SPATIAL: &str = r#"
[model]
name = "spatial"
[parameters]
m = { value = 1, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
x_a = { unit = "m", initial = 0.3 }
y_a = { unit = "m", initial = -0.4 }
z_a = { unit = "m" }
x_b = { unit = "m", initial = 1.1 }
y_b = { unit = "m", initial = -0.4 }
z_b = { unit = "m" }
[kinetic]
masses = "1/2*m*(dot(x_a)^2 + dot(y_a)^2 + dot(z_a)^2) + 1/2*m*(dot(x_b)^2 + dot(y_b)^2 + dot(z_b)^2)"
[potential]
weight = "m*g*(y_a + 2*y_b)"
[constraints]
crank = { zero = "x_a^2 + y_a^2 + z_a^2 - l^2" }
coupler = { zero = "(x_b - x_a)^2 + (y_b - y_a)^2 + (z_b - z_a)^2 - (1.6*l)^2" }
rocker = { zero = "(x_b - 2.2*l)^2 + y_b^2 + z_b^2 - (0.8*l)^2" }
plane_a = { zero = "z_a" }
plane_b = { zero = "z_b" }
hinge = { zero = "3*z_b - 2*z_a" }
"#;

fn compile(text: &str) -> CompiledModel {
    CompiledModel::from_text("redundant.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn remove_constraint(text: &str, constraint: &str) -> String {
    let kept = text.lines().filter(|line| !line.starts_with(constraint));
    kept.collect::<Vec<_>>().join("\n")
}

fn move_until(run: &Instance<'_>, until: f64, solver: Solver, tolerance: f64) -> Motion {
    let times: Vec<f64> = (0..=60).map(|k| until * f64::from(k) / 60.0).collect();
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &run.default_inputs(),
        solver,
        tolerance,
        max_step: f64::INFINITY,
        audit: false,
    };
    run.simulate_until_stop(&request, &mut |_| {})
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Compares states of two motions; `pairs` contains the indices of corresponding entries.
fn assert_same(one: &Motion, other: &Motion, pairs: &[(usize, usize)], tolerance: f64) {
    assert_eq!(one.early_stop.is_none(), other.early_stop.is_none());
    let states = &one.trajectory.states;
    assert_eq!(states.len(), other.trajectory.states.len());
    for (one, other) in states.iter().zip(&other.trajectory.states) {
        for (left, right) in pairs {
            let (left, right) = (one[*left], other[*right]);
            assert!((left - right).abs() < tolerance, "{left} {right}");
        }
    }
}

#[test]
fn third_rod_leaves_motion_unchanged() {
    let all: Vec<(usize, usize)> = (0..6).map(|k| (k, k)).collect();
    let three = compile(THREE_RODS);
    let note = three.redundancy_notes().concat();
    assert!(
        note.contains("`left`, `middle`, `right` depend on each other")
            && note.contains("1 of them is redundant"),
        "{note}"
    );
    let three = three.with_declared_parameters().unwrap();
    for removed in ["left", "middle", "right"] {
        let two = compile(&remove_constraint(THREE_RODS, removed));
        assert!(two.redundancy_notes().is_empty());
        let two = two.with_declared_parameters().unwrap();
        for (solver, tolerance) in [(Solver::Rk, 1e-12), (Solver::Radau, 1e-11)] {
            let run = |instance| move_until(instance, 3.0, solver, tolerance);
            assert_same(&run(&three), &run(&two), &all, 1e-9);
        }
    }
}

/// Returns the multipliers of least norm by the pseudo-inverse of A M^-1 A^T, scaled to a unit diagonal.
fn least_norm_multipliers(state: &[f64]) -> DVector<f64> {
    let (m, inertia, g, l, a) = (2.0, 0.1, 9.81, 1.0, 0.5);
    let [x, y, phi, x_dot, y_dot, w] = state else {
        panic!("six states");
    };
    let mut rows = DMatrix::zeros(3, 3);
    let mut right = DVector::zeros(3);
    for (row, side) in [-1.0, 0.0, 1.0].into_iter().enumerate() {
        let arm = side * a;
        let (sine, cosine) = phi.sin_cos();
        let place = [x + arm * cosine - arm, y + arm * sine];
        let speed = [x_dot - arm * w * sine, y_dot + arm * w * cosine];
        let turning = [-arm * w * w * cosine, -arm * w * w * sine];
        let by_angle = place[0] * -arm * sine + place[1] * arm * cosine;
        for (column, entry) in [place[0], place[1], by_angle].into_iter().enumerate() {
            rows[(row, column)] = 2.0 / l * entry;
        }
        let second = speed[0] * speed[0] + speed[1] * speed[1];
        right[row] = -2.0 / l * (second + place[0] * turning[0] + place[1] * turning[1]);
    }
    let inverse = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0 / m, 1.0 / m, 1.0 / inertia]));
    let force = DVector::from_vec(vec![0.0, -m * g, 0.0]);
    let compliance = &rows * &inverse * rows.transpose();
    let scale = DMatrix::from_diagonal(&compliance.diagonal().map(|entry| entry.sqrt().recip()));
    let scaled = &scale * compliance * &scale;
    let gap = right - rows * inverse * force;
    &scale * scaled.pseudo_inverse(1e-9).unwrap() * &scale * gap
}

#[test]
fn multipliers_have_least_norm_in_every_unit() {
    let scaled = THREE_RODS.replace("middle = { zero = \"(x^2", "middle = { zero = \"1e4*(x^2");
    for (text, factors) in [(THREE_RODS, [1.0; 3]), (&scaled, [1.0, 1e-4, 1.0])] {
        let model = compile(text);
        let places: Vec<usize> = ["lambda_left", "lambda_middle", "lambda_right"]
            .into_iter()
            .map(|name| {
                model
                    .observable_names()
                    .iter()
                    .position(|own| own == name)
                    .unwrap()
            })
            .collect();
        let run = model.with_declared_parameters().unwrap();
        let motion = move_until(&run, 1.0, Solver::Rk, 1e-12);
        let mut evaluator = run.evaluator().unwrap();
        let mut observables = vec![0.0; model.observable_names().len()];
        for state in &motion.trajectory.states {
            evaluator.observables(
                Point {
                    t: 0.0,
                    state,
                    inputs: &[],
                },
                &mut observables,
            );
            let expected = least_norm_multipliers(state);
            for (row, place) in places.iter().enumerate() {
                let (found, right) = (observables[*place], factors[row] * expected[row]);
                assert!(
                    (found - right).abs() < 1e-9 * factors[row] * expected.amax(),
                    "{row}: {found} {right}"
                );
            }
        }
    }
}

#[test]
fn every_order_of_dependent_constraints_moves_through_all_angles() {
    let shaft = compile(SHAFT);
    let shaft = shaft.with_declared_parameters().unwrap();
    let expected = move_until(&shaft, 2.0, Solver::Rk, 1e-13);
    assert!(expected.trajectory.states[60][0] > 10.0, "several turns");
    for order in [
        [ALONG, UP, CIRCLE],
        [CIRCLE, ALONG, UP],
        [UP, CIRCLE, ALONG],
        [CIRCLE, UP, ALONG],
    ] {
        let model = compile(&format!("{BEAD}{}", order.concat()));
        assert_eq!(model.redundancy_notes().len(), 1);
        let run = model.with_declared_parameters().unwrap();
        let motion = move_until(&run, 2.0, Solver::Rk, 1e-12);
        assert_same(&motion, &expected, &[(2, 0), (5, 1)], 1e-9);
    }
}

#[test]
fn third_crank_leaves_motion_unchanged() {
    let shaft = compile(SHAFT);
    let shaft = shaft.with_declared_parameters().unwrap();
    let expected = move_until(&shaft, 2.0, Solver::Rk, 1e-13);
    let model = compile(CRANKS);
    assert_eq!(model.redundancy_notes().len(), 2);
    let run = model.with_declared_parameters().unwrap();
    let motion = move_until(&run, 2.0, Solver::Rk, 1e-12);
    assert_same(&motion, &expected, &[(0, 0), (1, 0), (2, 0), (5, 1)], 1e-9);
}

#[test]
fn planar_linkage_in_space_moves_like_that_without_redundant_plane() {
    let all: Vec<(usize, usize)> = (0..12).map(|k| (k, k)).collect();
    let model = compile(SPATIAL);
    let note = model.redundancy_notes().concat();
    assert!(
        note.contains("`plane_a`, `plane_b`, `hinge` depend"),
        "{note}"
    );
    let plain = compile(&remove_constraint(SPATIAL, "hinge"));
    let [one, other] = [&model, &plain].map(|model| {
        let run = model.with_declared_parameters().unwrap();
        move_until(&run, 1.0, Solver::Rk, 1e-12)
    });
    assert_same(&one, &other, &all, 1e-9);
}

#[test]
fn fold_of_redundant_rods_stops_at_the_same_time() {
    let fast = THREE_RODS.replace("w = { value = 0,", "w = { value = 7,");
    let stops = [fast.clone(), remove_constraint(&fast, "middle")].map(|text| {
        let model = compile(&text);
        let run = model.with_declared_parameters().unwrap();
        let motion = move_until(&run, 2.0, Solver::Rk, 1e-10);
        let stop = motion.early_stop.expect("a stop");
        assert!(stop.reason.contains("singular position"), "{}", stop.reason);
        stop.t.expect("a time")
    });
    assert!((stops[0] - stops[1]).abs() < 1e-7, "{stops:?}");
}

#[test]
fn contradictory_parameters_are_rejected() {
    let model = compile(THREE_RODS);
    let run = model.with_parameters(&[("l_r", 1.2)]).unwrap();
    let found = run.simulate(
        run.initial_state(),
        &[0.0, 0.1],
        &run.default_inputs(),
        Solver::Auto,
    );
    let error = found.expect_err("contradictory").to_string();
    assert!(
        error.contains("contradict each other at these parameters"),
        "{error}"
    );
    assert!(error.contains("`right`"), "{error}");
}

/// Bead on a circle with a wall and dry friction.
const RUBBED_BEAD: &str = r#"
[model]
name = "rubbed_bead"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
l = { value = 0.7, unit = "m" }
F = { value = 0.8, unit = "N" }
[coordinates]
x = { unit = "m", initial = "l*sin(1.2)" }
y = { unit = "m", initial = "-l*cos(1.2)" }
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[forces]
rubbing = { on = "x", value = "-F*sign(dot(x))" }
[impacts]
wall = { when = "x + 0.1*l", restitution = 0.5 }
[constraints]
circle = { zero = "(x^2 + y^2 - l^2)/l" }
again = { zero = "x^2 + y^2 - l^2" }
"#;

#[test]
fn friction_and_impacts_act_along_doubled_constraint() {
    let all: Vec<(usize, usize)> = (0..4).map(|k| (k, k)).collect();
    let motions = [
        RUBBED_BEAD.to_owned(),
        remove_constraint(RUBBED_BEAD, "again"),
    ]
    .map(|text| {
        let model = compile(&text);
        let run = model.with_declared_parameters().unwrap();
        move_until(&run, 4.0, Solver::Rk, 1e-12)
    });
    let [doubled, single] = &motions;
    assert!(doubled.trajectory.events.len() > 3);
    assert_eq!(
        doubled.trajectory.events.len(),
        single.trajectory.events.len()
    );
    assert_same(doubled, single, &all, 1e-9);
}

#[test]
fn certificate_accepts_dependent_constraints_and_finds_small_faults() {
    let spatial_plain = remove_constraint(SPATIAL, "hinge");
    let bead = format!("{BEAD}{ALONG}{UP}{CIRCLE}");
    for (text, faults) in [
        (
            CRANKS,
            [
                ("0.5*dot(p)^2", "0.50000001*dot(p)^2"),
                (
                    "x_r = { zero = \"l*(cos(p)",
                    "x_r = { zero = \"l*(cos(1.00000001*p)",
                ),
            ],
        ),
        (
            SPATIAL,
            [
                ("y_a + 2*y_b", "y_a + 2.00000001*y_b"),
                ("x_b - 2.2*l", "x_b - 2.20000001*l"),
            ],
        ),
        (
            &spatial_plain,
            [
                ("y_a + 2*y_b", "y_a + 2.00000001*y_b"),
                ("zero = \"z_b\"", "zero = \"z_b + 1e-8*x_b\""),
            ],
        ),
        (
            &bead,
            [
                ("J*dot(p)^2", "1.00000001*J*dot(p)^2"),
                ("x - l*cos(p)", "x - l*cos(p) + 1e-8*l*p^2"),
            ],
        ),
    ] {
        let model = check_model(text);
        let right = certify(&model, &model);
        let failed: Vec<_> = right.failures().collect();
        assert!(failed.is_empty(), "{failed:#?}");
        for (old, new) in faults {
            let wrong = text.replace(old, new);
            assert_ne!(wrong, text);
            let found = certify(&model, &check_model(&wrong));
            assert!(found.failures().count() > 0, "{new}");
        }
    }
}

/// Two masses on one spring, joined by a constraint that appears twice.
const PAIR: &str = r#"
[model]
name = "pair"
[parameters]
m_1 = { value = 1, unit = "kg" }
m_2 = { value = 2, unit = "kg" }
k = { value = 30, unit = "N/m" }
[coordinates]
x_1 = { unit = "m", initial = 0.1 }
x_2 = { unit = "m", initial = 0.1 }
[kinetic]
masses = "1/2*m_1*dot(x_1)^2 + 1/2*m_2*dot(x_2)^2"
[potential]
spring = "1/2*k*x_1^2"
[constraints]
joined = { zero = "x_1 - x_2" }
again = { zero = "3*(x_2 - x_1)" }
"#;

#[test]
fn linear_pair_with_doubled_constraint_moves_as_one_mass_without_exact_solver() {
    let model = compile(PAIR);
    let run = model.with_declared_parameters().unwrap();
    for solver in [Solver::Auto, Solver::Rk, Solver::Radau] {
        let motion = move_until(&run, 2.0, solver, 1e-10);
        for (t, state) in motion
            .trajectory
            .times
            .iter()
            .zip(&motion.trajectory.states)
        {
            let right = 0.1 * (10.0_f64.sqrt() * t).cos();
            for x in &state[..2] {
                assert!((x - right).abs() < 1e-8, "{solver:?} {t}: {x} {right}");
            }
        }
    }
    let exact = run.simulate(
        run.initial_state(),
        &[0.0, 0.1],
        &run.default_inputs(),
        Solver::Exact,
    );
    let error = exact.expect_err("constraints").to_string();
    assert!(error.contains("the model has constraints"), "{error}");
    assert!(error.contains("--solver rk"), "{error}");
}

#[test]
fn redundant_constraint_without_derivative_is_rejected_with_its_name() {
    let scaled = PAIR.replace("again = { zero = \"3*", "again = { zero = \"c*");
    let scaled = |c: f64| {
        scaled.replace(
            "k = {",
            &format!("c = {{ value = {c}, unit = \"1\" }}\nk = {{"),
        )
    };
    let zero = |text: &str| {
        let found = CompiledModel::from_text("zero.toml", text, Orders::Declared);
        found.err().expect("an error").to_string()
    };
    let square = format!("{PAIR}square = {{ zero = \"(x_1 - x_2)*(x_1 - x_2)*k/F\" }}\n")
        .replace("k = {", "F = { value = 1, unit = \"N\" }\nk = {");
    let nothing = format!("{PAIR}nothing = {{ zero = \"0*x_1\" }}\n");
    for (text, name) in [
        (scaled(0.0), "again"),
        (square, "square"),
        (nothing, "nothing"),
    ] {
        let error = zero(&text);
        assert!(
            error.contains(&format!("the constraint `{name}` has no effect"))
                && error.contains("zero.toml:"),
            "{error}"
        );
    }
    let model = compile(&scaled(3.0));
    let run = model.with_parameters(&[("c", 0.0)]).unwrap();
    let found = run.simulate(
        run.initial_state(),
        &[0.0, 0.1],
        &run.default_inputs(),
        Solver::Auto,
    );
    let error = found.expect_err("no effect").to_string();
    assert!(
        error.contains("the constraint `again` has no effect"),
        "{error}"
    );
}
