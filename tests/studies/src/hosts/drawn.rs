//! Random machines of all kinds: the chains of the study `solvers`, and additional kinds.

use std::fmt::Write;

use eomgen_validate::random::Random;

use super::kind::Kind;
use crate::solvers::machine;

/// Input amplitude*sin(frequency*t) in SI, with the frequency in rad/s.
#[derive(Clone, Copy, Debug)]
pub struct Sine {
    pub amplitude: f64,
    pub frequency: f64,
}

/// Random machine as a specification text.
pub struct Drawn {
    pub text: String,
    /// Kind of the machine, if it cannot be determined from the text.
    pub kind: Option<Kind>,
    /// Name of an input and its sine.
    pub input: Option<(&'static str, Sine)>,
    /// Duration, s.
    pub until: f64,
}

/// Returns machine number `place`. Half of the machines are chains; the others are of the additional kinds in cyclic
/// order.
pub fn draw(place: usize, random: &mut Random) -> Drawn {
    if place.is_multiple_of(2) {
        let machine = machine::draw(random);
        return Drawn {
            text: machine.text,
            kind: None,
            input: None,
            until: machine.until,
        };
    }
    match (place / 2) % 6 {
        0 => puck(random),
        1 => box_on_floor(random),
        2 => corner(random),
        3 => driven_pendulum(random),
        4 => servo(random),
        _ => linkage(random),
    }
}

/// Returns a specification with this name, these parameters and the rest of the text.
fn write(name: &str, parameters: &[(&str, &str, f64)], rest: &str) -> String {
    let mut text = format!("[model]\nname = \"{name}\"\n[parameters]\n");
    for (name, unit, value) in parameters {
        let _ = writeln!(text, "{name} = {{ value = {value:e}, unit = \"{unit}\" }}");
    }
    text + rest
}

fn draw_between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

fn puck(random: &mut Random) -> Drawn {
    let parameters = [
        ("m", "kg", draw_between(random, 0.5, 2.0)),
        ("mu", "1", draw_between(random, 0.1, 0.5)),
        ("g", "m/s^2", 9.81),
        ("k", "N/m", draw_between(random, 1.0, 30.0)),
    ];
    let (x, y) = (
        draw_between(random, 0.2, 1.0),
        draw_between(random, -1.0, 1.0),
    );
    let (v_x, v_y) = (
        draw_between(random, 0.5, 2.0),
        draw_between(random, -2.0, 2.0),
    );
    let rest = format!(
        "[coordinates]\n\
         x = {{ unit = \"m\", initial = {x}, initial_rate = {v_x} }}\n\
         y = {{ unit = \"m\", initial = {y}, initial_rate = {v_y} }}\n\
         [definitions]\nv = \"[dot(x), dot(y)]\"\np = \"[x, y]\"\n\
         [kinetic]\nbody = \"1/2*m*dot(v, v)\"\n\
         [potential]\nspring = \"1/2*k*(x^2 + y^2)\"\n\
         [forces]\nfriction = {{ on = \"p\", value = \"-mu*m*g*v/norm(v)\" }}\n"
    );
    Drawn {
        text: write("puck", &parameters, &rest),
        kind: None,
        input: None,
        until: 3.0,
    }
}

fn box_on_floor(random: &mut Random) -> Drawn {
    let parameters = [
        ("m", "kg", draw_between(random, 0.5, 3.0)),
        ("J", "kg m^2", draw_between(random, 0.02, 0.1)),
        ("b", "m", draw_between(random, 0.1, 0.3)),
        ("h", "m", draw_between(random, 0.1, 0.3)),
        ("g", "m/s^2", 9.81),
        ("e", "1", draw_between(random, 0.1, 0.6)),
        ("mu", "1", draw_between(random, 0.2, 0.7)),
    ];
    let (tilt, speed) = (
        draw_between(random, -0.5, 0.5),
        draw_between(random, -1.0, 1.0),
    );
    let rest = format!(
        "[coordinates]\n\
         x = {{ unit = \"m\", initial_rate = {speed} }}\n\
         y = {{ unit = \"m\", initial = 0.6 }}\n\
         phi = {{ unit = \"rad\", initial = {tilt} }}\n\
         [kinetic]\ncentre = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\nspin = \"1/2*J*dot(phi)^2\"\n\
         [potential]\nweight = \"m*g*y\"\n\
         [definitions]\nleft_x = \"x + h*sin(phi) - b*cos(phi)\"\n\
         right_x = \"x + h*sin(phi) + b*cos(phi)\"\n\
         [impacts]\n\
         left = {{ when = \"y - h*cos(phi) - b*sin(phi)\", restitution = \"e\", friction = \"mu\", slip = \"dot(left_x)\" }}\n\
         right = {{ when = \"y - h*cos(phi) + b*sin(phi)\", restitution = \"e\", friction = \"mu\", slip = \"dot(right_x)\" }}\n"
    );
    Drawn {
        text: write("falling_box", &parameters, &rest),
        kind: None,
        input: None,
        until: 1.5,
    }
}

/// Returns a bead on a wire with a corner, which passes a step of the potential energy.
fn corner(random: &mut Random) -> Drawn {
    let parameters = [
        ("m", "kg", draw_between(random, 0.5, 2.0)),
        ("a", "1", draw_between(random, 0.3, 1.5)),
        ("U", "J", draw_between(random, 0.1, 1.0)),
        ("s", "m", draw_between(random, 0.2, 0.8)),
        ("k", "N/m", draw_between(random, 0.5, 3.0)),
    ];
    let (x, v) = (
        draw_between(random, -1.5, -0.5),
        draw_between(random, 0.3, 2.0),
    );
    let rest = format!(
        "[coordinates]\nx = {{ unit = \"m\", initial = {x}, initial_rate = {v} }}\n\
         [definitions]\ny = \"a*max(x, 0)\"\n\
         [kinetic]\nbody = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n\
         [potential]\nstep = \"U*above(x - s)\"\nspring = \"1/2*k*x^2\"\n"
    );
    Drawn {
        text: write("corner", &parameters, &rest),
        kind: None,
        input: None,
        until: 6.0,
    }
}

const PENDULUM: &str = "[coordinates]\ntheta = { unit = \"rad\", initial = 0.3 }\n\
    [inputs]\nu = { unit = \"N m\" }\n\
    [kinetic]\nbob = \"1/2*m*l^2*dot(theta)^2\"\n\
    [potential]\nbob = \"-m*g*l*cos(theta)\"\n\
    [dissipation]\njoint = \"1/2*c*dot(theta)^2\"\n\
    [forces]\ndrive = { on = \"theta\", value = \"u\" }\n";

fn pendulum_parameters(random: &mut Random) -> [(&'static str, &'static str, f64); 4] {
    [
        ("m", "kg", draw_between(random, 0.5, 2.0)),
        ("l", "m", draw_between(random, 0.3, 1.0)),
        ("g", "m/s^2", 9.81),
        ("c", "N m s", draw_between(random, 0.05, 0.5)),
    ]
}

fn driven_pendulum(random: &mut Random) -> Drawn {
    let parameters = pendulum_parameters(random);
    let amplitude = draw_between(random, 0.5, 3.0);
    let frequency = draw_between(random, 1.0, 8.0);
    Drawn {
        text: write("driven_pendulum", &parameters, PENDULUM),
        kind: Some(Kind::InputFunction),
        input: Some((
            "u",
            Sine {
                amplitude,
                frequency,
            },
        )),
        until: 4.0,
    }
}

/// Returns a pendulum with a sampled, quantised and delayed controller.
fn servo(random: &mut Random) -> Drawn {
    let mut parameters = pendulum_parameters(random).to_vec();
    parameters.extend([
        ("k_p", "N m", draw_between(random, 5.0, 20.0)),
        ("k_d", "N m s", draw_between(random, 0.2, 1.0)),
        ("r", "rad", draw_between(random, -1.0, 1.0)),
        ("u_max", "N m", draw_between(random, 5.0, 15.0)),
    ]);
    let period = draw_between(random, 5e-3, 2e-2);
    let rest = format!(
        "{PENDULUM}[controllers.servo]\nperiod = {period:e}\ndelay = {:e}\n\
         outputs = {{ u = \"clamp(k_p*(r - quantise(theta, 1e-4)) - k_d*dot(theta), -u_max, u_max)\" }}\n",
        0.3 * period
    );
    Drawn {
        text: write("servo", &parameters, &rest),
        kind: None,
        input: None,
        until: 2.0,
    }
}

/// Returns a four-bar linkage. The initial state violates the constraints slightly.
fn linkage(random: &mut Random) -> Drawn {
    let [a, b, c] =
        [(0.2, 0.3), (0.7, 0.9), (0.5, 0.7)].map(|(low, high)| draw_between(random, low, high));
    let parameters = [
        ("a", "m", a),
        ("b", "m", b),
        ("c", "m", c),
        ("d", "m", 0.8),
        ("m", "kg", draw_between(random, 0.5, 2.0)),
        ("g", "m/s^2", 9.81),
    ];
    let angle = draw_between(random, 0.5, 1.5);
    let rest = format!(
        "[coordinates]\n\
         alpha = {{ unit = \"rad\", initial = {angle} }}\n\
         beta = {{ unit = \"rad\", initial = 0.3 }}\n\
         gamma = {{ unit = \"rad\", initial = 1.6 }}\n\
         [kinetic]\nbars = \"1/6*m*(a^2*dot(alpha)^2 + b^2*dot(beta)^2 + c^2*dot(gamma)^2)\"\n\
         [potential]\nweight = \"1/2*m*g*(a*sin(alpha) + b*sin(beta) + c*sin(gamma))\"\n\
         [constraints]\n\
         along = {{ zero = \"a*cos(alpha) + b*cos(beta) - c*cos(gamma) - d\" }}\n\
         across = {{ zero = \"a*sin(alpha) + b*sin(beta) - c*sin(gamma)\" }}\n"
    );
    Drawn {
        text: write("linkage", &parameters, &rest),
        kind: None,
        input: None,
        until: 1.0,
    }
}
