//! Tests of equilibria against closed-form solutions.

use crate::{CompiledModel, EquilibriumRequest, Error, Instance, Orders};

use super::Equilibrium;

/// Pendulum with a motor; its angle is measured from the lowest position.
const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { unit = "rad", initial = 2.8 }
[inputs]
u = { unit = "N m" }
[kinetic]
mass = "1/2*m*l^2*dot(theta)^2"
[potential]
weight = "-m*g*l*cos(theta)"
[forces]
motor = { on = "theta", value = "u" }
"#;

fn find_with_fixed_values(run: &Instance<'_>, fixed: &[(&str, f64)]) -> Result<Equilibrium, Error> {
    run.find_equilibrium(EquilibriumRequest {
        start_values: &[],
        fixed_values: fixed,
    })
}

fn find_from(run: &Instance<'_>, start: &[(&str, f64)]) -> Result<Equilibrium, Error> {
    run.find_equilibrium(EquilibriumRequest {
        start_values: start,
        fixed_values: &[],
    })
}

fn compile(text: &str) -> CompiledModel {
    CompiledModel::from_text("model.toml", text, Orders::Declared).expect("a model")
}

fn model() -> CompiledModel {
    CompiledModel::from_text("pendulum.toml", PENDULUM, Orders::Declared).expect("a model")
}

#[test]
fn pendulum_equilibria_match_closed_forms() {
    let model = model();
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_with_fixed_values(&run, &[]).expect("an equilibrium");
    assert!(
        (found.point.state[0] - std::f64::consts::PI).abs() < 1e-12,
        "{found:?}"
    );
    assert_eq!(found.point.inputs, [0.0]);
    let held = find_with_fixed_values(&run, &[("theta", 0.3)]).expect("a torque");
    let right = 2.0 * 9.81 * 0.5 * 0.3_f64.sin();
    assert!(
        (held.point.inputs[0] - right).abs() < 1e-12 * right,
        "{held:?}"
    );
    let loaded = find_with_fixed_values(&run, &[("u", 5.0)]).expect("an angle");
    assert!(
        (loaded.point.state[0].sin() * 9.81 - 5.0).abs() < 1e-11,
        "{loaded:?}"
    );
}

#[test]
fn impossible_equilibria_and_invalid_requests_are_rejected() {
    let model = model();
    let run = model.with_declared_parameters().expect("an instance");
    for given in [&[("u", 20.0)][..], &[("theta", 0.3), ("u", 0.0)]] {
        let found = find_with_fixed_values(&run, given);
        assert!(
            matches!(found, Err(Error::Stopped { .. })),
            "{given:?}: {found:?}"
        );
    }
    for given in [("theta_dot", 1.0), ("thta", 0.0), ("u", f64::NAN)] {
        let refused = find_with_fixed_values(&run, &[given]);
        assert!(
            matches!(refused, Err(Error::Request(_))),
            "{given:?}: {refused:?}"
        );
    }
}

#[test]
fn search_finds_nearer_equilibrium_of_pendulum() {
    use std::f64::consts::{FRAC_PI_2, PI};
    let model = model();
    let run = model.with_declared_parameters().expect("an instance");
    for (start, right) in [
        (1.5, 0.0),
        (1.57, 0.0),
        (1.58, PI),
        (1.7, PI),
        (4.5, PI),
        (4.8, 2.0 * PI),
    ] {
        let found = find_from(&run, &[("theta", start)]).expect("an equilibrium");
        assert!(
            (found.point.state[0] - right).abs() < 1e-9,
            "{start}: {found:?}"
        );
    }
    let found = find_from(&run, &[("theta", FRAC_PI_2)])
        .expect("an equilibrium")
        .point
        .state[0];
    assert!(found.abs() < 1e-9 || (found - PI).abs() < 1e-9, "{found}");
    // If the angle is measured from the horizontal, the slope of the force is exactly 0 at 0.
    let level = PENDULUM.replace("-m*g*l*cos(theta)", "m*g*l*sin(theta)");
    let model = compile(&level.replace("2.8", "0"));
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_from(&run, &[]).expect("an equilibrium").point.state[0];
    assert!((found + FRAC_PI_2).abs() < 1e-9, "it falls: {found}");
}

#[test]
fn search_stays_within_declared_range() {
    let within = PENDULUM.replace("initial = 2.8", "range = [0.4, 4], initial = 1.2");
    let model = compile(&within);
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_from(&run, &[]);
    assert!(
        matches!(found, Err(Error::Stopped { .. })),
        "0 is outside: {found:?}"
    );
    let found = find_from(&run, &[("theta", 2.0)])
        .expect("an equilibrium")
        .point
        .state[0];
    assert!((found - std::f64::consts::PI).abs() < 1e-9, "{found}");
    assert!(matches!(
        find_from(&run, &[("theta", 5.0)]),
        Err(Error::Request(_))
    ));
}

#[test]
fn search_crosses_kink_of_bilinear_spring() {
    let text = PENDULUM
        .replace(
            "-m*g*l*cos(theta)",
            "1/2*c*(min(theta, 0)^2 + 100*max(theta, 0)^2) - p*theta",
        )
        .replace(
            "[coordinates]",
            "c = { value = 2, unit = \"N m\" }\np = { value = 3, unit = \"N m\" }\n[coordinates]",
        )
        .replace("2.8", "-1");
    let model = compile(&text);
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_from(&run, &[]).expect("an equilibrium").point.state[0];
    assert!((found - 0.015).abs() < 1e-12, "{found}");
}

/// Disc on a shaft with friction and a motor, and a bob that swings out as the shaft turns.
const GOVERNOR: &str = r#"
[model]
name = "governor"
[parameters]
J = { value = 2, unit = "kg m^2" }
m = { value = 0.5, unit = "kg" }
l = { value = 0.4, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 0.1, unit = "N m s" }
T = { value = 0.8, unit = "N m" }
[coordinates]
phi = { unit = "rad" }
theta = { unit = "rad", initial = 0.5 }
[inputs]
u = { unit = "N m" }
[kinetic]
all = "1/2*J*dot(phi)^2 + 1/2*m*l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)"
[potential]
weight = "-m*g*l*cos(theta)"
[dissipation]
bearing = "1/2*c*dot(phi)^2"
[forces]
motor = { on = "phi", value = "T + u" }
"#;

#[test]
fn governor_at_steady_speed_is_equilibrium() {
    let model = compile(GOVERNOR);
    let run = model.with_declared_parameters().expect("an instance");
    // The torque at 8 rad/s is c omega; the angle of the bob satisfies cos(theta) = g/(l omega^2).
    let right = (9.81 / (0.4 * 64.0_f64)).acos();
    let found = find_from(&run, &[("theta", 1.0)]).expect("steady running");
    assert!((found.point.state[2] - 8.0).abs() < 1e-8, "{found:?}");
    assert!((found.point.state[1] - right).abs() < 1e-8, "{found:?}");
    assert!(found.unknowns.contains(&"phi_dot".to_owned()), "{found:?}");
    assert!(run.is_equilibrium(&found.point).expect("an answer"));
    // At a fixed speed the motor input is an unknown.
    let found = run.find_equilibrium(EquilibriumRequest {
        start_values: &[("theta", 1.0)],
        fixed_values: &[("phi_dot", 10.0)],
    });
    let found = found.expect("steady running");
    assert_eq!(found.point.state[2], 10.0);
    assert!((found.point.inputs[0] - 0.2).abs() < 1e-9, "{found:?}");
    let mut slipping = found.point.clone();
    slipping.state[3] = 0.1;
    assert!(!run.is_equilibrium(&slipping).expect("an answer"));
}

/// Pendulum in Cartesian coordinates on a rod, with a spring.
const ROD: &str = r#"
[model]
name = "rod"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.3, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
k = { value = 0, unit = "N/m" }
start = { value = 90, unit = "deg" }
[coordinates]
x = { unit = "m", initial = "l*sin(start)" }
y = { unit = "m", initial = "-l*cos(start)" }
[kinetic]
all = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
spring = "1/2*k*(x - 0.1*l)^2"
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
"#;

/// The same pendulum with the angle from the vertical as coordinate.
const ANGLE: &str = r#"
[model]
name = "angle"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.3, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
k = { value = 0, unit = "N/m" }
start = { value = 90, unit = "deg" }
[coordinates]
theta = { unit = "rad", initial = "start" }
[kinetic]
all = "1/2*m*l^2*dot(theta)^2"
[potential]
weight = "-m*g*l*cos(theta)"
spring = "1/2*k*(l*sin(theta) - 0.1*l)^2"
"#;

#[test]
fn equilibria_on_a_constraint_are_those_of_an_independent_coordinate() {
    for stiffness in ["0", "200"] {
        for start in ["5", "30", "45", "60", "90", "100", "135", "170", "-80"] {
            let [rod, angle] = [ROD, ANGLE].map(|text| {
                let text = text
                    .replace(
                        "value = 0, unit = \"N/m\"",
                        &format!("value = {stiffness}, unit = \"N/m\""),
                    )
                    .replace("value = 90", &format!("value = {start}"));
                let model = compile(&text);
                let run = model.with_declared_parameters().expect("an instance");
                find_from(&run, &[]).expect("an equilibrium").point.state
            });
            let found = rod[0].atan2(-rod[1]);
            let difference = (found - angle[0]).rem_euclid(std::f64::consts::TAU);
            assert!(
                difference.min(std::f64::consts::TAU - difference) < 1e-8,
                "{stiffness} N/m, {start} deg: {found}, {}",
                angle[0]
            );
        }
    }
}

#[test]
fn fixed_values_off_the_constraints_are_rejected() {
    let model = compile(ROD);
    let run = model.with_declared_parameters().expect("an instance");
    let found = run.find_equilibrium(EquilibriumRequest {
        start_values: &[],
        fixed_values: &[("x", 0.4)],
    });
    let said = found.expect_err("no such point").to_string();
    assert!(
        said.contains("satisfies the constraints at the fixed values"),
        "{said}"
    );
}

/// Slide on a table with dry friction; an actuator with a lag pushes it.
const SLIDE: &str = r#"
[model]
name = "slide"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 0, unit = "N/m" }
level = { value = 3, unit = "N" }
tau = { value = 5, unit = "ms" }
J = { value = 0.1, unit = "kg m^2" }
w = { value = 1, unit = "N m" }
[coordinates]
x = { unit = "m", initial = 0.05 }
theta = { unit = "rad", initial = 0.3 }
[inputs]
u = { unit = "N" }
T = { unit = "N m" }
[states]
z = { unit = "N", rate = "(u - z)/tau", initial = 2 }
[kinetic]
slide = "1/2*m*dot(x)^2 + 1/2*J*dot(theta)^2"
[potential]
spring = "1/2*k*x^2 - w*cos(theta)"
[forces]
push = { on = "x", value = "z - level*sign(dot(x))" }
motor = { on = "theta", value = "T" }
"#;

#[test]
fn input_behind_an_actuator_lag_holds_a_fixed_coordinate() {
    let model = compile(&SLIDE.replace("value = 0, unit = \"N/m\"", "value = 40, unit = \"N/m\""));
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_with_fixed_values(&run, &[("x", 0.1)])
        .expect("an equilibrium")
        .point;
    assert!((found.inputs[0] - 4.0).abs() < 1e-9, "{found:?}");
    assert!((found.state[4] - 4.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn machine_that_friction_holds_is_at_an_equilibrium() {
    let text = SLIDE.replace(
        "theta = { unit = \"rad\", initial = 0.3 }",
        "theta = { unit = \"rad\" }",
    );
    let model = compile(&text);
    let run = model.with_declared_parameters().expect("an instance");
    for (force, is_held) in [(2.0, true), (3.5, false)] {
        let start = run
            .operating_point(&[("u", force), ("z", force)])
            .expect("a point");
        assert_eq!(
            run.is_equilibrium(&start).expect("an answer"),
            is_held,
            "{force} N"
        );
        let found = find_from(&run, &[("u", force), ("z", force)]);
        assert_eq!(found.is_ok(), is_held, "{force} N: {found:?}");
        if let Ok(found) = found {
            assert_eq!(found.point.state[..1], [0.05]);
        }
    }
}

#[test]
fn search_from_far_away_ends_at_the_equilibrium() {
    // For V = -a x^2/2 + b x^4/4 the equilibria are 0 and +-sqrt(a/b), here 1e-3 m.
    let text = "[model]\nname = \"duffing\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                a = { value = 2, unit = \"N/m\" }\nb = { value = 2e6, unit = \"N/m^3\" }\n\
                [coordinates]\nx = { unit = \"m\" }\n[kinetic]\nT = \"1/2*m*dot(x)^2\"\n\
                [potential]\nV = \"-1/2*a*x^2 + 1/4*b*x^4\"\n";
    let model = compile(text);
    let run = model.with_declared_parameters().expect("an instance");
    for start in [2e-3, 1.0, 1e2, 1e4, 1e6, 1e8] {
        let found = find_from(&run, &[("x", start)]).expect("an equilibrium");
        let x = found.point.state[0];
        assert!((x / 1e-3 - 1.0).abs() < 1e-12, "{start:e}: {x:e}");
    }
}

#[test]
fn search_leaves_a_play() {
    let text = "[model]\nname = \"play\"\n[parameters]\nm = { value = 2, unit = \"kg\" }\n\
                k = { value = 300, unit = \"N/m\" }\nb = { value = 50, unit = \"mm\" }\n\
                g = { value = 9.81, unit = \"m/s^2\" }\n[coordinates]\nx = { unit = \"m\" }\n\
                [kinetic]\nT = \"1/2*m*dot(x)^2\"\n[potential]\nV = \"m*g*x\"\n\
                [forces]\nF = { on = \"x\", value = \"-k*deadzone(x, b)\" }\n";
    for (play, half_width) in [
        ("50, unit = \"mm\"", 0.05),
        ("1, unit = \"um\"", 1e-6),
        ("3, unit = \"m\"", 3.0),
    ] {
        let model = compile(&text.replace("50, unit = \"mm\"", play));
        let run = model.with_declared_parameters().expect("an instance");
        for start in [0.0, 0.9, -0.9] {
            let found = find_from(&run, &[("x", start * half_width)]).expect("an equilibrium");
            let right = -half_width - 2.0 * 9.81 / 300.0;
            let x = found.point.state[0];
            assert!((x / right - 1.0).abs() < 1e-12, "{play}, {start}: {x}");
        }
    }
}

/// Two wheels connected by an elastic gear of ratio n; both turn at the start.
const GEAR: &str = r#"
[model]
name = "gear"
[parameters]
J = { value = 2, unit = "kg m^2" }
n = { value = 5 }
k = { value = 10, unit = "N m" }
c = { value = 0.5, unit = "N m s" }
[coordinates]
motor = { unit = "rad", initial_rate = 100 }
load = { unit = "rad", initial_rate = 20 }
[inputs]
T = { unit = "N m" }
[kinetic]
wheels = "1/2*J*(dot(motor)^2 + dot(load)^2)"
[potential]
gear = "1/2*k*(motor/n - load)^2"
[dissipation]
load = "1/2*c*dot(load)^2"
[forces]
drive = { on = "motor", value = "T" }
"#;

#[test]
fn fixed_rate_of_a_steady_motion_determines_the_others() {
    let model = compile(GEAR);
    let run = model.with_declared_parameters().expect("an instance");
    for values in [
        &[("load_dot", 30.0)][..],
        &[("motor_dot", 150.0)],
        &[("load_dot", 30.0), ("motor_dot", 150.0)],
    ] {
        let found = find_with_fixed_values(&run, values)
            .expect("a steady motion")
            .point;
        assert_eq!(found.state[2..], [150.0, 30.0], "{values:?}");
        assert!((found.inputs[0] - 3.0).abs() < 1e-9, "{found:?}");
    }
    let stopped = find_with_fixed_values(&run, &[("load_dot", 0.0)])
        .expect("rest")
        .point;
    assert_eq!(stopped.state[2..], [0.0, 0.0]);
    let refused = find_with_fixed_values(&run, &[("load_dot", 30.0), ("motor_dot", 140.0)]);
    let message = refused.expect_err("no steady motion").to_string();
    assert!(
        message.contains("no steady motion has this rate"),
        "{message}"
    );
}

/// Mass on a spring with Dahl friction, whose state `z` keeps any value at rest.
const BRISTLE: &str = r#"
[model]
name = "bristle"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k = { value = 100, unit = "N/m", min = 0 }
F_c = { value = 3, unit = "N", min = 0 }
x_c = { value = 1e-3, unit = "m", min = 0 }
n = { value = 1 }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[states]
z = { unit = "N", initial = 1, rate = "F_c/x_c*(dot(x)/n - abs(dot(x))*z/F_c)" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
drive = { on = "x", value = "u" }
bristle = { on = "x", value = "-n*z" }
"#;

#[test]
fn state_of_hysteresis_keeps_its_value_at_equilibrium() {
    for size in [1.0, 1e3, 1e-3] {
        let text = BRISTLE
            .replace("n = { value = 1 }", &format!("n = {{ value = {size:e} }}"))
            .replace("initial = 1,", &format!("initial = {:e},", 1.0 / size));
        let model = compile(&text);
        let run = model.with_declared_parameters().expect("an instance");
        let found = find_from(&run, &[("u", 5.0)]).expect("an equilibrium");
        assert!(
            (size * found.point.state[2] - 1.0).abs() < 1e-14,
            "{size}: {found:?}"
        );
        assert!(
            (found.point.state[0] - 0.04).abs() < 1e-14,
            "{size}: {found:?}"
        );
        assert_eq!(found.unknowns, ["x"]);
    }
}

#[test]
fn state_of_hysteresis_balances_the_load_of_a_free_mass() {
    let model = compile(&BRISTLE.replace("1/2*k*x^2", "0*k*x^2"));
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_from(&run, &[("u", 2.5)]).expect("an equilibrium");
    assert!((found.point.state[2] - 2.5).abs() < 1e-12, "{found:?}");
    assert_eq!(found.unknowns, ["x", "z"]);
}

/// The tyres of the car just touch the ground at the start; on this surface the slope of their force is one-sided.
#[test]
fn car_settles_on_tyres_that_touch_at_the_start() {
    let model = compile(
        r#"
[model]
name = "car"
[parameters]
m = { value = 320, unit = "kg" }
J = { value = 430, unit = "kg m^2" }
m_w = { value = 35, unit = "kg" }
k = { value = 18, unit = "kN/m" }
k_t = { value = 160, unit = "kN/m" }
a = { value = 1.1, unit = "m" }
b = { value = 1.3, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
z = { unit = "m" }
th = { unit = "rad" }
z_f = { unit = "m" }
z_r = { unit = "m" }
[definitions]
front = "z - a*sin(th) - z_f"
rear = "z + b*sin(th) - z_r"
[kinetic]
body = "1/2*m*dot(z)^2 + 1/2*J*dot(th)^2"
wheels = "1/2*m_w*(dot(z_f)^2 + dot(z_r)^2)"
[potential]
weight = "g*(m*z + m_w*(z_f + z_r))"
springs = "1/2*k*(front^2 + rear^2)"
tyres = "1/2*k_t*(min(z_f, 0)^2 + min(z_r, 0)^2)"
"#,
    );
    let run = model.with_declared_parameters().expect("an instance");
    let found = find_with_fixed_values(&run, &[]).expect("an equilibrium");
    let weight = 320.0 * 9.81;
    let wheel = 35.0 * 9.81;
    for (wheel_place, share) in [(2, 1.3 / 2.4), (3, 1.1 / 2.4)] {
        let expected = -(weight * share + wheel) / 160e3;
        let place = found.point.state[wheel_place];
        assert!((place / expected - 1.0).abs() < 1e-9, "{place} {expected}");
    }
}
