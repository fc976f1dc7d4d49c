//! Tests of motions with jumps of the energies: comparison with closed forms, with corner conditions solved by hand,
//! and with limits of smooth models; rejected models and hosts.

use std::sync::Arc;

use eomgen_compiled_model::{CompiledModel, Error, Motion, Orders, Request, Solver};
use eomgen_sim::inputs::{HeldInputs, InputFunction};
use eomgen_tests::program::run;
use eomgen_tests::random_numbers::Numbers;

const SOLVERS: [Solver; 2] = [Solver::Rk, Solver::Radau];

fn compile(text: &str) -> CompiledModel {
    CompiledModel::from_text("machine.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn simulate(text: &str, until: f64, solver: Solver) -> Motion {
    simulate_with(&compile(text), until, solver, None)
}

fn simulate_with(
    model: &CompiledModel,
    until: f64,
    solver: Solver,
    inputs: Option<&HeldInputs>,
) -> Motion {
    let instance = model.with_declared_parameters().unwrap();
    let inputs = inputs.cloned().unwrap_or_else(|| instance.default_inputs());
    let request = Request {
        initial: instance.initial_state(),
        times: &[0.0, until],
        inputs: &inputs,
        solver,
        tolerance: if solver == Solver::Radau {
            1e-11
        } else {
            1e-12
        },
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = instance.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.unwrap_or_else(|error| panic!("{error}"));
    assert!(motion.early_stop.is_none(), "{:?}", motion.early_stop);
    let audit = motion.audit.as_ref().expect("an audit");
    assert_eq!(audit.fault_count, 0, "{audit:?}");
    motion
}

fn last(motion: &Motion) -> &[f64] {
    motion.trajectory.states.last().expect("a sample")
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() <= tolerance,
            "{what}: {found:?}, expected {expected:?}"
        );
    }
}

/// Returns a model with one coordinate x that starts at -1 m with 1 m/s.
fn line(parameters: &str, definitions: &str, kinetic: &str, potential: &str) -> String {
    format!(
        "[model]\nname = \"line\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n{parameters}\n\
         [coordinates]\nx = {{ unit = \"m\", initial = -1, initial_rate = 1 }}\n\
         [definitions]\n{definitions}\n[kinetic]\nt = \"{kinetic}\"\n[potential]\nv = \"{potential}\"\n"
    )
}

#[test]
fn wire_with_corner_keeps_energy() {
    let text = line("", "y = \"max(x, 0)\"", "1/2*m*(dot(x)^2 + dot(y)^2)", "0");
    for solver in SOLVERS {
        let motion = simulate(&text, 2.0, solver);
        let speed = 0.5_f64.sqrt();
        assert_near(last(&motion), &[speed, speed], 1e-9, "corner");
        assert_eq!(motion.trajectory.events.len(), 1);
    }
}

#[test]
fn potential_step_is_climbed_or_reflects() {
    for (height, speed) in [(0.3, 0.4_f64.sqrt()), (1.0, -1.0), (-4.0, 3.0)] {
        let parameters = format!("U = {{ value = {height:?}, unit = \"J\" }}");
        let text = line(&parameters, "", "1/2*m*dot(x)^2", "U*above(x)");
        for solver in SOLVERS {
            let motion = simulate(&text, 2.0, solver);
            assert_near(last(&motion), &[speed, speed], 1e-9, "step");
        }
    }
}

#[test]
fn mass_jump_in_time_keeps_momentum_and_mass_jump_in_space_keeps_energy() {
    let parameters = "d = { value = 3, unit = \"kg\" }\nt_1 = { value = 1, unit = \"s\" }";
    for (when, speed) in [("t - t_1", 0.25), ("x", 0.5)] {
        let kinetic = format!("1/2*(m + d*above({when}))*dot(x)^2");
        for solver in SOLVERS {
            let motion = simulate(&line(parameters, "", &kinetic, "0"), 2.0, solver);
            assert_near(last(&motion), &[speed, speed], 1e-9, when);
        }
    }
}

#[test]
fn base_that_starts_to_move_changes_relative_rate() {
    let text = "[model]\nname = \"base\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
        k = { value = 40, unit = \"N/m\" }\nv = { value = 0.5, unit = \"m/s\" }\n\
        t_0 = { value = 1, unit = \"s\" }\n[coordinates]\nx = { unit = \"m\" }\n[definitions]\n\
        place = \"v*max(t - t_0, 0) + x\"\n[kinetic]\nmass = \"1/2*m*dot(place)^2\"\n\
        [potential]\nspring = \"1/2*k*x^2\"\n";
    let omega = 40_f64.sqrt();
    let expected = [
        -0.5 / omega * (omega * 0.5).sin(),
        -0.5 * (omega * 0.5).cos(),
    ];
    for solver in SOLVERS {
        assert_near(last(&simulate(text, 1.5, solver)), &expected, 1e-9, "base");
    }
}

#[test]
fn start_on_a_surface_uses_the_side_of_the_first_row() {
    let step = |height: &str| {
        let parameters = format!("U = {{ value = {height}, unit = \"J\" }}");
        line(&parameters, "", "1/2*m*dot(x)^2", "U*above(x)")
    };
    let parameters = "d = { value = 3, unit = \"kg\" }\nt_1 = { value = 0, unit = \"s\" }";
    let mass = line(parameters, "", "1/2*(m + d*above(t - t_1))*dot(x)^2", "0");
    // The initial rate is 1 m/s towards the step, or -1 m/s away from it.
    for (text, rate, expected) in [
        (step("0.3"), 1.0, 0.4_f64.sqrt()),
        (step("1"), 1.0, -1.0),
        (step("-4"), 1.0, 3.0),
        (step("1"), -1.0, -1.0),
        (mass, 1.0, 0.25),
    ] {
        let start = format!("initial = 0, initial_rate = {rate:?}");
        let text = text.replace("initial = -1, initial_rate = 1", &start);
        for solver in SOLVERS {
            let motion = simulate(&text, 1.0, solver);
            assert_near(last(&motion), &[expected, expected], 1e-9, &text);
        }
    }
}

/// Input of a base that moves at 0.5 m/s from 1 s on: position, rate and second derivative.
#[derive(Debug)]
struct MovingBase;

impl InputFunction for MovingBase {
    fn write(&self, t: f64, out: &mut [f64]) {
        let rate = if t < 1.0 { 0.0 } else { 0.5 };
        out.copy_from_slice(&[rate * (t - 1.0), rate, 0.0]);
    }
}

#[test]
fn input_rate_that_jumps_keeps_momentum() {
    let text = "[model]\nname = \"base\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
        k = { value = 40, unit = \"N/m\" }\n[inputs]\ns = { unit = \"m\", rates = 2 }\n\
        [coordinates]\nx = { unit = \"m\" }\n[definitions]\nplace = \"x + s\"\n[kinetic]\n\
        mass = \"1/2*m*dot(place)^2\"\n[potential]\nspring = \"1/2*k*x^2\"\n";
    let omega = 40_f64.sqrt();
    let expected = [
        -0.5 / omega * (omega * 0.5).sin(),
        -0.5 * (omega * 0.5).cos(),
    ];
    let inputs = HeldInputs::zero(3).with_function(0, 3, Arc::new(MovingBase));
    let inputs = inputs.with_jump_times(vec![1.0]);
    for solver in SOLVERS {
        let motion = simulate_with(&compile(text), 1.5, solver, Some(&inputs));
        assert_near(last(&motion), &expected, 1e-9, "base");
    }
}

#[test]
fn cam_follows_corner_conditions_with_full_mass_matrix() {
    // The machine is a follower of mass m on a cam of inertia J with a corner at phi = 0, and a mass coupled to both.
    let text = "[model]\nname = \"cam\"\n[parameters]\nj = { value = 0.7, unit = \"kg m^2\" }\n\
        m = { value = 2, unit = \"kg\" }\nc = { value = 0.5, unit = \"kg m\" }\n\
        a = { value = 0.3, unit = \"m\" }\nb = { value = -0.2, unit = \"m\" }\n[coordinates]\n\
        phi = { unit = \"rad\", initial = -1, initial_rate = 1.5 }\n\
        z = { unit = \"m\", initial_rate = 0.4 }\n[definitions]\n\
        lift = \"a*phi + (b - a)*max(phi, 0) + z\"\n[kinetic]\nt = \"1/2*j*dot(phi)^2 + 1/2*m*dot(lift)^2 + \
        c*dot(phi)*dot(z) + 1/2*m*dot(z)^2\"\n";
    let mass = |slope: f64| {
        [
            [0.7 + 2.0 * slope * slope, 2.0 * slope + 0.5],
            [2.0 * slope + 0.5, 4.0],
        ]
    };
    let (near, far) = (mass(0.3), mass(-0.2));
    let times = |m: [[f64; 2]; 2], v: [f64; 2]| {
        [
            m[0][0] * v[0] + m[0][1] * v[1],
            m[1][0] * v[0] + m[1][1] * v[1],
        ]
    };
    let v = [1.5, 0.4];
    let p = times(near, v);
    // The momentum p_z is conserved. The energy (A phi'^2 + p_z^2/M_zz)/2 gives the rate of phi; A is the Schur
    // complement.
    let schur = |m: [[f64; 2]; 2]| m[0][0] - m[0][1] * m[0][1] / m[1][1];
    let phi_rate = v[0] * (schur(near) / schur(far)).sqrt();
    let z_rate = (p[1] - far[0][1] * phi_rate) / far[1][1];
    let hit = 1.0 / 1.5;
    let rest = 2.0 - hit;
    let expected = [phi_rate * rest, 0.4 * hit + z_rate * rest, phi_rate, z_rate];
    for solver in SOLVERS {
        assert_near(last(&simulate(text, 2.0, solver)), &expected, 1e-9, "cam");
    }
}

/// Returns a point mass in the plane with a potential step along a line. The axes of the step are rotated by `angle`.
/// In these axes the mass starts at (-1, 0) with the rates `(u, v)`.
fn plane(angle: f64, height: f64, (u, v): (f64, f64)) -> String {
    let (s, c) = angle.sin_cos();
    format!(
        "[model]\nname = \"plane\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         U = {{ value = {height:?}, unit = \"J\" }}\nc = {{ value = {c:?}, unit = \"1\" }}\n\
         s = {{ value = {s:?}, unit = \"1\" }}\n[coordinates]\n\
         x = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
         y = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
         [kinetic]\nt = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[potential]\nv = \"U*above(c*x + s*y)\"\n",
        -c,
        c * u - s * v,
        -s,
        s * u + c * v,
    )
}

#[test]
fn inclined_potential_step_refracts_and_reflects_in_every_frame() {
    for (height, u, beyond) in [
        (0.3, 1.0, 0.4_f64.sqrt()),
        (0.6, 1.0, -1.0),
        (-1.5, 1.0, 2.0),
    ] {
        for angle in [0.0_f64, 0.4, 2.0, -1.3] {
            let (s, c) = angle.sin_cos();
            for solver in SOLVERS {
                let motion = simulate(&plane(angle, height, (u, 0.7)), 2.5, solver);
                let [x, y, vx, vy] = *last(&motion) else {
                    panic!("four states");
                };
                let found = [
                    c * x + s * y,
                    c * y - s * x,
                    c * vx + s * vy,
                    c * vy - s * vx,
                ];
                let expected = [1.5 * beyond, 0.7 * 2.5, beyond, 0.7];
                assert_near(&found, &expected, 1e-9, "plane");
            }
        }
    }
}

/// Returns a machine whose masses, coupling, momenta and potential jump at a moving curved surface.
fn random_machine(seed: u64, side: &str) -> String {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15 ^ (seed * 0x1234_5678_9abc));
    let mut next = |middle: f64, width: f64| middle + width * numbers.symmetric();
    let names = ["a", "b", "c", "da", "dc", "k", "h"];
    let ranges = [
        (1.5, 0.5),
        (0.0, 0.6),
        (1.5, 0.5),
        (0.4, 0.5),
        (0.4, 0.5),
        (0.0, 0.5),
        (0.0, 0.5),
    ];
    let mut parameters = String::new();
    for (name, (middle, width)) in names.iter().zip(ranges) {
        parameters += &format!(
            "{name} = {{ value = {:?}, unit = \"kg m^2\" }}\n",
            next(middle, width)
        );
    }
    let [bend, drift, height] = [next(0.0, 0.4), next(0.0, 0.3), next(0.0, 0.6)];
    let [u, v] = [next(1.2, 0.4), next(0.0, 0.8)];
    format!(
        "[model]\nname = \"machine\"\n[parameters]\n{parameters}\
         bend = {{ value = {bend:?}, unit = \"1\" }}\ndrift = {{ value = {drift:?}, unit = \"1/s\" }}\n\
         height = {{ value = {height:?}, unit = \"J\" }}\nstiff = {{ value = 0.5, unit = \"J\" }}\n\
         eps = {{ value = 1e-3, unit = \"1\" }}\nw = {{ value = 0.3, unit = \"1/s\" }}\n[coordinates]\n\
         x = {{ unit = \"1\", initial = -0.5, initial_rate = {u:?} }}\n\
         y = {{ unit = \"1\", initial = 0.1, initial_rate = {v:?} }}\n[definitions]\n\
         g = \"x + bend*y^2 - drift*t\"\nside = \"{side}\"\n[kinetic]\n\
         t = \"1/2*(a + da*side)*dot(x)^2 + b*dot(x)*dot(y)*(1 + 0.3*side) + 1/2*(c + dc*side)*dot(y)^2 + \
         w*side*(k*dot(x) + h*dot(y))\"\n[potential]\nv = \"height*side + stiff*y^2\"\n"
    )
}

#[test]
fn random_machines_are_limits_of_smooth_ones() {
    for seed in 0..20 {
        let sharp = random_machine(seed, "above(g)");
        let smooth = compile(&random_machine(seed, "(1 + tanh(g/eps))/2"));
        for solver in SOLVERS {
            let found = simulate(&sharp, 1.2, solver);
            let at = |eps: f64| {
                let run = smooth.with_parameters(&[("eps", eps)]).unwrap();
                let times = [0.0, 1.2];
                let motion = run.simulate(
                    run.initial_state(),
                    &times,
                    &run.default_inputs(),
                    Solver::Rk,
                );
                last(&motion.unwrap_or_else(|error| panic!("{error}"))).to_vec()
            };
            let (coarse, fine) = (at(1e-4), at(5e-5));
            let limit: Vec<f64> = fine.iter().zip(&coarse).map(|(a, b)| 2.0 * a - b).collect();
            assert_near(
                last(&found),
                &limit,
                1e-6,
                &format!("machine {seed}, {solver}"),
            );
        }
    }
}

#[test]
fn continuous_energies_have_no_corners() {
    for potential in [
        "max(x, 0)*n",
        "abs(x)*n",
        "above(x)*x*n",
        "above(x)*max(x, 0)*n",
        "above(x/l)*sqrt(max(x/l, 0))*n*l",
        "above(x)*sin(x/l)*n*l",
        "above(t - t_1)*x*n",
    ] {
        let parameters = "n = { value = 1, unit = \"N\" }\nl = { value = 1, unit = \"m\" }\n\
            t_1 = { value = 1, unit = \"s\" }";
        let model = compile(&line(parameters, "", "1/2*m*dot(x)^2", potential));
        assert_eq!(model.first_corner(), None, "{potential}");
    }
}

#[test]
fn automatic_solver_applies_corners_and_others_reject_them() {
    let text = line(
        "U = { value = 0.3, unit = \"J\" }",
        "",
        "1/2*m*dot(x)^2",
        "U*above(x)",
    );
    let model = compile(&text);
    assert_eq!(model.first_corner(), Some("x"));
    assert_eq!(simulate(&text, 2.0, Solver::Auto).solver, Solver::Rk);
    let instance = model.with_declared_parameters().unwrap();
    for solver in [Solver::Exact, Solver::Adams] {
        let refused = instance.simulate(
            instance.initial_state(),
            &[0.0, 1.0],
            &instance.default_inputs(),
            solver,
        );
        let message = refused.expect_err("no support").to_string();
        assert!(message.contains("jump where `x` is zero"), "{message}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("step.toml");
    std::fs::write(&spec, text).unwrap();
    let spec = spec.display().to_string();
    let shown = run(&["validate", &spec]);
    let shown = String::from_utf8_lossy(&shown.stdout).into_owned();
    assert!(
        shown.contains("corners") && shown.contains("PARTIAL"),
        "{shown}"
    );
}

#[test]
fn corners_with_a_constraint_match_corners_in_an_angle() {
    // The pendulum is formulated as a point with a constraint, and with its angle from the lowest position.
    let head = |step: f64| {
        format!(
            "[model]\nname = \"pendulum\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             l = {{ value = 1, unit = \"m\" }}\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n\
             U = {{ value = {step:?}, unit = \"J\" }}\n"
        )
    };
    let start = 0.6_f64.asin();
    for (place, step) in [
        ("X - 0.1*l", 1.0),
        ("X - 0.1*l", 0.3),
        ("X - 0.1*l", -1.0),
        ("X - 0.1*l", 1.9),
        ("Y + 0.95*l", 0.25),
        ("Y + 0.95*l", -0.23),
    ] {
        let potential = format!("[potential]\nV = \"m*g*Y + U*above({place})\"\n");
        let written = |x: &str, y: &str| potential.replace('X', x).replace('Y', y);
        let by_point = head(step)
            + "[coordinates]\nx = { unit = \"m\", initial = -0.6 }\n\
               y = { unit = \"m\", initial = -0.8 }\n[kinetic]\n\
               T = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[constraints]\n\
               rod = { zero = \"x^2 + y^2 - l^2\" }\n"
            + &written("x", "y");
        let by_angle = head(step)
            + &format!(
                "[coordinates]\na = {{ unit = \"rad\", initial = {:?} }}\n",
                -start
            )
            + "[kinetic]\nT = \"1/2*m*l^2*dot(a)^2\"\n"
            + &written("l*sin(a)", "(-l*cos(a))");
        for solver in SOLVERS {
            let (point, angle) = (
                simulate(&by_point, 4.0, solver),
                simulate(&by_angle, 4.0, solver),
            );
            let angle = last(&angle)[0];
            let expected = [angle.sin(), -angle.cos()];
            let what = format!("{place}, {step} J, {solver:?}");
            assert_near(&last(&point)[..2], &expected, 1e-6, &what);
        }
    }
}

#[test]
fn intersecting_corner_surfaces_are_rejected_unless_all_crossing_orders_agree() {
    let text = plane(0.0, 0.2, (1.0, 0.0));
    let coupled = text
        .replace(
            "dot(x)^2 + dot(y)^2",
            "dot(x)^2 + dot(y)^2 + (dot(p) + dot(q))^2",
        )
        .replace(
            "[kinetic]",
            "[definitions]\np = \"max(x, 0)\"\nq = \"max(y + x + x, 0)\"\n[kinetic]",
        )
        .replace("initial = -0.0,", "initial = 0,");
    let model = compile(&coupled);
    let run = model.with_declared_parameters().unwrap();
    let mut state = run.initial_state().to_vec();
    state[3] = 0.0;
    state[1] = 0.0;
    let found = run.simulate(&state, &[0.0, 2.0], &run.default_inputs(), Solver::Rk);
    let Err(Error::Stopped { reason, .. }) = found else {
        panic!("not stopped: {found:?}");
    };
    assert!(
        reason.contains("`x`") && reason.contains("meets at one instant"),
        "{reason}"
    );
}

#[test]
fn positions_and_rates_that_jump_are_rejected_with_location() {
    let parameters = "h = { value = 1, unit = \"m\" }\nt_1 = { value = 1, unit = \"s\" }";
    let step = line(
        parameters,
        "road = \"h*above(t - t_1)\"\nplace = \"x + road\"",
        "1/2*m*dot(place)^2",
        "0",
    );
    let kink = line(
        "b = { value = 1, unit = \"kg m/s\" }",
        "",
        "1/2*m*dot(x)^2 + b*abs(dot(x))",
        "0",
    );
    for (text, place, message) in [
        (step, "machine.toml:13:", "position jumps"),
        (kink, "machine.toml:11:", "a rate changes its sign"),
    ] {
        let refused = CompiledModel::from_text("machine.toml", &text, Orders::Declared);
        let shown = refused.err().expect("rejected").to_string();
        assert!(shown.contains(message), "{shown}");
        assert!(shown.contains(place), "{shown}");
    }
    let absolute = line(
        parameters,
        "road = \"h*above(t - t_1)\"",
        "1/2*m*dot(x)^2",
        "(x - road)^2*m/t_1^2",
    );
    assert_eq!(compile(&absolute).first_corner(), None);
}
