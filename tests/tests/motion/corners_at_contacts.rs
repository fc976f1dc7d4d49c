//! Tests of jumps of energies in machines with closed contacts and sticking friction, compared with closed forms.

use eomgen_compiled_model::{CompiledModel, Orders, Request, Solver};

const SOLVERS: [Solver; 2] = [Solver::Rk, Solver::Radau];

/// Returns a body of 1 kg with the coordinates x and y under a gravity of 10 m/s^2.
fn body(parameters: &str, start: f64, potential: &str, contacts: &str) -> String {
    format!(
        r#"
[model]
name = "body"
[parameters]
m = {{ value = 1, unit = "kg" }}
g = {{ value = 10, unit = "m/s^2" }}
a = {{ value = 1, unit = "m" }}
{parameters}
[coordinates]
x = {{ unit = "m", initial_rate = {start:?} }}
y = {{ unit = "m" }}
[kinetic]
t = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
step = "{potential}"
[impacts]
{contacts}
"#
    )
}

/// Returns a body on a base that starts to move along `base` with the speed V at 0.5 s.
fn on_moving_base(speed: f64, base: &str, rest: &str) -> String {
    format!(
        r#"
[model]
name = "on_base"
[parameters]
m = {{ value = 1, unit = "kg" }}
g = {{ value = 10, unit = "m/s^2" }}
F = {{ value = 2, unit = "N" }}
V = {{ value = {speed:?}, unit = "m/s" }}
t_1 = {{ value = 0.5, unit = "s" }}
[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}
[definitions]
{base} = "{place} + V*max(t - t_1, 0)"
{rest}
"#,
        place = if base == "X" { "x" } else { "y" }
    )
}

/// Simulates, asserts that the energy audit gives no warning, and returns the last state.
fn end(text: &str, until: f64, solver: Solver) -> Vec<f64> {
    let model = CompiledModel::from_text("machine.toml", text, Orders::Declared)
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let run = model.with_declared_parameters().expect("an instance");
    let request = Request {
        initial: run.initial_state(),
        times: &[0.0, until],
        inputs: &run.default_inputs(),
        solver,
        tolerance: 1e-11,
        max_step: f64::INFINITY,
        audit: true,
    };
    let motion = run.simulate_until_stop(&request, &mut |_| {});
    let motion = motion.and_then(|motion| motion.into_complete());
    let motion = motion.unwrap_or_else(|error| panic!("{solver}: {error}\n{text}"));
    let audit = motion.audit.as_ref().expect("an audit");
    assert_eq!(audit.fault_count, 0, "{audit:?}\n{text}");
    motion.trajectory.states.last().expect("a sample").clone()
}

#[test]
fn friction_of_a_contact_follows_the_slip_that_a_step_reverses() {
    let step = "U = { value = 9, unit = \"J\" }";
    for friction in ["0.2", "0.4"] {
        let contact = format!(
            "floor = {{ when = \"y\", restitution = 0.3, friction = {friction}, slip = \"dot(x)\" }}"
        );
        let mu: f64 = friction.parse().expect("a number");
        for solver in SOLVERS {
            let found = end(&body(step, 4.0, "U*above(x - a)", &contact), 2.5, solver);
            // The energy at the step is 8 J minus the work of the friction over 1 m. The friction dissipates it on the
            // way back.
            let expected = 1.0 - (8.0 - 10.0 * mu) / (10.0 * mu);
            assert!((found[0] - expected).abs() < 1e-8, "{solver:?}: {found:?}");
            assert_eq!(found[2], 0.0, "{solver:?}");
        }
    }
}

#[test]
fn sticking_body_slips_after_its_base_starts() {
    let kinetic =
        "[kinetic]\nt = \"1/2*m*(dot(X)^2 + dot(y)^2)\"\n[potential]\nweight = \"m*g*y\"\n";
    let weightless = kinetic.replace("m*g*y", "0*m*g*y");
    let puck = "u = \"[x, y]\"\nv = \"dot(u)\"\n";
    for (definitions, energies, law) in [
        (
            "",
            kinetic,
            "[impacts]\nf = { when = \"y\", restitution = 0, friction = 0.2, slip = \"dot(x)\" }",
        ),
        (
            puck,
            &*weightless,
            "[forces]\nf = { on = \"u\", value = \"-F*v/norm(v)\" }",
        ),
        (
            "",
            &*weightless,
            "[forces]\nf = { on = \"x\", value = \"-F*sign(dot(x))\" }",
        ),
    ] {
        let text = on_moving_base(1.0, "X", &format!("{definitions}{energies}{law}\n"));
        for solver in SOLVERS {
            let found = end(&text, 1.5, solver);
            // The body moves backwards with 1 m/s and is decelerated by 2 m/s^2.
            assert!(
                (found[0] + 0.25).abs() < 1e-8,
                "{law} {solver:?}: {found:?}"
            );
            assert_eq!(found[2], 0.0, "{law} {solver:?}");
        }
    }
}

#[test]
fn falling_floor_loses_contact_and_rising_floor_lifts_the_body() {
    let rest = "[kinetic]\nt = \"1/2*m*(dot(x)^2 + dot(Y)^2)\"\n[potential]\nweight = \"m*g*y\"\n\
                [impacts]\nf = { when = \"y\", restitution = 0 }\n";
    for (speed, place) in [(-2.0, 2.0 * 0.25 - 5.0 * 0.25 * 0.25), (2.0, 0.0)] {
        let text = on_moving_base(speed, "Y", rest);
        for solver in SOLVERS {
            let found = end(&text, 0.75, solver);
            assert!(
                (found[1] - place).abs() < 1e-9,
                "{speed} {solver:?}: {found:?}"
            );
        }
    }
}

#[test]
fn contact_acts_in_a_jump_if_it_pushes() {
    let energy = "J = { value = 1, unit = \"J\" }";
    let floor = "f = { when = \"y\", restitution = 0 }\n";
    let both = format!("{floor}g = {{ when = \"-y\", restitution = 0 }}\n");
    // The step releases 1 J. An impulse along (1, 1/2) lifts the body; an impulse along (1, -1/2) is supported by the
    // floor.
    let impulse = (-2.0 + 6.5_f64.sqrt()) / 1.25;
    let lifted = [2.0 + impulse, 0.5 * impulse - 10.0 * 0.02];
    let pressed = [6.0_f64.sqrt(), 0.0];
    for (along, contacts, expected) in [
        ("+", floor, lifted),
        ("-", floor, pressed),
        ("-", &both, pressed),
        ("+", &both, pressed),
    ] {
        let potential = format!("-J*above(x {along} 0.5*y - a)");
        for solver in SOLVERS {
            let found = end(&body(energy, 2.0, &potential, contacts), 0.52, solver);
            for (a, b) in found[2..].iter().zip(expected) {
                assert!(
                    (a - b).abs() < 1e-9,
                    "{along} {contacts} {solver:?}: {found:?}, expected {expected:?}"
                );
            }
        }
    }
}

#[test]
fn impact_and_jump_at_one_instant_have_their_own_energies() {
    let text = r#"
[model]
name = "both"
[parameters]
m = { value = 1, unit = "kg" }
d = { value = 2, unit = "kg" }
t_1 = { value = 0.5, unit = "s" }
a = { value = 1, unit = "m" }
[coordinates]
x = { unit = "m", initial_rate = 2 }
[kinetic]
t = "1/2*(m + d*above(t - t_1))*dot(x)^2"
[impacts]
w = { when = "a - x", restitution = 0.5 }
"#;
    for solver in SOLVERS {
        let found = end(text, 1.0, solver);
        assert!((found[1] + 1.0 / 3.0).abs() < 1e-9, "{solver:?}: {found:?}");
    }
}

/// Returns a body of 1 kg in a corner of two walls that start to move with V, at a time at which the mass of the body
/// increases.
fn in_corner(force: f64) -> String {
    format!(
        r#"
[model]
name = "corner"
[parameters]
m = {{ value = 1, unit = "kg" }}
F = {{ value = {force:?}, unit = "N" }}
G = {{ value = 5, unit = "N" }}
V = {{ value = 1, unit = "m/s" }}
d = {{ value = 4, unit = "kg" }}
t_1 = {{ value = 0.2, unit = "s" }}
[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}
[definitions]
X = "x + V*max(t - t_1, 0)"
Y = "y + V*max(t - t_1, 0)"
[kinetic]
k = "1/2*m*(dot(X)^2 + dot(Y)^2) + 1/2*d*above(t - t_1)*(dot(X) - dot(Y))^2"
[potential]
p = "F*x + G*y"
[impacts]
wall = {{ when = "x", restitution = 0.5 }}
floor = {{ when = "y", restitution = 0.5 }}
"#
    )
}

#[test]
fn loaded_contacts_stay_closed_when_the_mass_increases() {
    for force in [1.0, 3.9, 5.0] {
        for solver in SOLVERS {
            let found = end(&in_corner(force), 0.3, solver);
            assert!(
                found.iter().all(|entry| entry.abs() < 1e-9),
                "{force} {solver:?}: {found:?}"
            );
        }
    }
}

#[test]
fn more_contacts_than_freedoms_act_in_a_jump() {
    let text = r#"
[model]
name = "block"
[parameters]
m = { value = 2, unit = "kg" }
J = { value = 0.5, unit = "kg m^2" }
g = { value = 9.81, unit = "m/s^2" }
F = { value = 3, unit = "N" }
l = { value = 1, unit = "m" }
V = { value = 1, unit = "m/s" }
t_1 = { value = 0.2, unit = "s" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
phi = { unit = "rad" }
[definitions]
X = "x + 0.08*max(t - t_1, 0)*V"
Y = "y + 0.32*max(t - t_1, 0)*V"
P = "phi - 0.94*max(t - t_1, 0)*V/l"
[kinetic]
k = "1/2*m*(dot(X)^2 + dot(Y)^2) + 1/2*J*dot(P)^2"
[potential]
p = "m*g*y + F*x"
[impacts]
c_0 = { when = "x + 0.5*l*phi", restitution = 0 }
c_1 = { when = "y - l*phi", restitution = 0 }
c_2 = { when = "y + l*phi", restitution = 0 }
c_3 = { when = "x - 0.5*l*phi", restitution = 0 }
"#;
    for solver in SOLVERS {
        let found = end(text, 0.3, solver);
        assert!(
            found.iter().all(|entry| entry.abs() < 1e-9),
            "{solver:?}: {found:?}"
        );
    }
}
