//! Machines with constraints: a pendulum in Cartesian coordinates, a slider-crank, a four-bar linkage, two gears and
//! Chaplygin's sleigh.

use crate::constrained_records::{Channel, Machine};

const METRES: (&str, f64) = ("m", 1.0);
const RADIANS: (&str, f64) = ("rad", 1.0);
const MILLIMETRES: (&str, f64) = ("mm", 1e-3);
const DEGREES: (&str, f64) = ("deg", std::f64::consts::PI / 180.0);

/// Returns the units of lengths and angles: m and rad, or mm and deg.
fn units(is_si: bool) -> [(&'static str, f64); 2] {
    match is_si {
        true => [METRES, RADIANS],
        false => [MILLIMETRES, DEGREES],
    }
}

fn channel(name: &'static str, unit: (&'static str, f64), noise: f64) -> Channel {
    Channel { name, unit, noise }
}

const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 0.2, unit = "kg", min = 0 }
l = { value = 0.3, unit = "m", min = 0 }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 0.01, unit = "N s/m", min = 0 }
[inputs]
u = { unit = "N" }
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
gravity = "m*g*y"
[dissipation]
air = "1/2*c*(dot(x)^2 + dot(y)^2)"
[forces]
push = { on = "x", value = "u" }
"#;

/// Returns a pendulum of length `l` (m) with a spring of `stiffness` (N/m) along x. In the specification the length is
/// 0.3 m.
pub fn pendulum(l: f64, stiffness: f64, is_si: bool) -> Machine<2, 2> {
    let (m, g, c) = (0.2, 9.81, 0.01);
    let [length, _] = units(is_si);
    Machine {
        specification: format!(
            "{PENDULUM}[coordinates]\nx = {{ unit = \"m\" }}\ny = {{ unit = \"m\", initial = \"-l\" }}\n\
             [constraints]\nrod = {{ zero = \"x^2 + y^2 - l^2\" }}\n"
        ),
        independent: format!(
            "{PENDULUM}[coordinates]\nangle = {{ unit = \"rad\" }}\n\
             [definitions]\nx = \"l*sin(angle)\"\ny = \"-l*cos(angle)\"\n\
             [observables]\nx_seen = \"x\"\ny_seen = \"y\"\n"
        ),
        channels: [channel("x", length, 1e-4), channel("y", length, 1e-4)],
        sections: "[uncertain]\nc = { relative = 0.1 }",
        input: (0.0, 0.3, "N"),
        rates: Box::new(move |[angle, rate], u| {
            let along = u - stiffness * l * angle.sin();
            let moment = -m * g * l * angle.sin() + along * l * angle.cos() - c * l * l * rate;
            [rate, moment / (m * l * l)]
        }),
        friction: (0.0, Box::new(|_| [1.0, 1.0])),
        observe: Box::new(move |[angle, _]| [l * angle.sin(), -l * angle.cos()]),
        initial: [[0.5, 0.0], [-0.3, 0.2]],
    }
}

const CRANK: &str = r#"
[model]
name = "crank"
[parameters]
r = { value = 0.05, unit = "m", min = 0 }
l = { value = 0.15, unit = "m", min = 0 }
J = { value = 1e-3, unit = "kg m^2", min = 0 }
J_r = { value = 1e-4, unit = "kg m^2", min = 0 }
m_s = { value = 0.4, unit = "kg", min = 0 }
c = { value = 4e-3, unit = "N m s", min = 0 }
[inputs]
u = { unit = "N m" }
[kinetic]
crank = "1/2*J*dot(theta)^2"
rod = "1/2*J_r*dot(phi)^2"
slider = "1/2*m_s*dot(x)^2"
[dissipation]
bearing = "1/2*c*dot(theta)^2"
[forces]
motor = { on = "theta", value = "u" }
"#;

/// Returns a slider-crank whose slider has the mass `mass` (kg), dry friction `friction` (N) and a damper `damping` (N
/// s/m). In the specification the mass is 0.4 kg.
pub fn slider_crank(mass: f64, friction: f64, damping: f64, is_si: bool) -> Machine<2, 2> {
    let (r, l, crank, rod, c) = (0.05_f64, 0.15_f64, 1e-3, 1e-4, 4e-3);
    // Angle of the rod, position of the slider, and their derivatives by the angle of the crank.
    let close = move |angle: f64| {
        let rod = (r / l * angle.sin()).asin();
        let turn = r * angle.cos() / (l * rod.cos());
        let lever = -r * angle.sin() - l * rod.sin() * turn;
        [turn, r * angle.cos() + l * rod.cos(), lever]
    };
    let inertia = move |angle: f64| {
        let [turn, _, lever] = close(angle);
        crank + rod * turn * turn + mass * lever * lever
    };
    let [length, turn] = units(is_si);
    Machine {
        specification: format!(
            "{CRANK}[coordinates]\ntheta = {{ unit = \"rad\", initial = 0.5 }}\n\
             phi = {{ unit = \"rad\", initial = 0.1 }}\nx = {{ unit = \"m\", initial = 0.19 }}\n\
             [constraints]\nalong = {{ zero = \"r*cos(theta) + l*cos(phi) - x\" }}\n\
             across = {{ zero = \"r*sin(theta) - l*sin(phi)\" }}\n"
        ),
        independent: format!(
            "{CRANK}[coordinates]\ntheta = {{ unit = \"rad\", initial = 0.5 }}\n\
             [definitions]\nphi = \"asin(r/l*sin(theta))\"\nx = \"r*cos(theta) + l*cos(phi)\"\n\
             [observables]\ntheta_seen = \"theta\"\nx_seen = \"x\"\n"
        ),
        channels: [channel("theta", turn, 1e-3), channel("x", length, 1e-5)],
        sections: "[uncertain]\nc = { relative = 0.1 }",
        input: (0.05, 0.02, "N m"),
        rates: Box::new(move |[angle, rate], u| {
            let lever = close(angle)[2];
            let small = 1e-5;
            let slope = (inertia(angle + small) - inertia(angle - small)) / (2.0 * small);
            let moment = u - c * rate - damping * lever * lever * rate - 0.5 * slope * rate * rate;
            [rate, moment / inertia(angle)]
        }),
        friction: (
            friction,
            Box::new(move |[angle, _]| [close(angle)[2], 1.0 / inertia(angle)]),
        ),
        observe: Box::new(move |[angle, _]| [angle, close(angle)[1]]),
        initial: [[0.6, 12.0], [1.0, 10.0]],
    }
}

/// Returns a four-bar linkage with a damper of `damping` (N m s) at the pivot of the rocker.
pub fn four_bar(damping: f64, is_si: bool) -> Machine<2, 2> {
    let (crank, coupler, rocker, ground) = (0.05_f64, 0.15_f64, 0.12_f64, 0.16_f64);
    let (inertias, mass, c) = ([1e-3, 3e-4, 2e-3], 0.3, 4e-3);
    // Angles of coupler and rocker.
    let close = move |angle: f64| {
        let (x, y) = (crank * angle.cos(), crank * angle.sin());
        let diagonal = (ground - x).hypot(y);
        let cosine = (coupler * coupler + diagonal * diagonal - rocker * rocker)
            / (2.0 * coupler * diagonal);
        let first = (-y).atan2(ground - x) + cosine.acos();
        let (x, y) = (x + coupler * first.cos(), y + coupler * first.sin());
        [first, y.atan2(x - ground)]
    };
    let turns = move |angle: f64| {
        let small = 1e-5;
        let [after, before] = [small, -small].map(|by| close(angle + by));
        [0, 1].map(|k| (after[k] - before[k]) / (2.0 * small))
    };
    let inertia = move |angle: f64| {
        let ([first, _], [turn, swing]) = (close(angle), turns(angle));
        let x = -crank * angle.sin() - 0.5 * coupler * first.sin() * turn;
        let y = crank * angle.cos() + 0.5 * coupler * first.cos() * turn;
        inertias[0]
            + inertias[1] * turn * turn
            + inertias[2] * swing * swing
            + mass * (x * x + y * y)
    };
    let turn = units(is_si)[1];
    Machine {
        specification: r#"
[model]
name = "four_bar"
[parameters]
a = { value = 0.05, unit = "m", min = 0 }
b = { value = 0.15, unit = "m", min = 0 }
e = { value = 0.12, unit = "m", min = 0 }
d = { value = 0.16, unit = "m", min = 0 }
J_a = { value = 1e-3, unit = "kg m^2", min = 0 }
J_b = { value = 3e-4, unit = "kg m^2", min = 0 }
J_c = { value = 2e-3, unit = "kg m^2", min = 0 }
m_b = { value = 0.3, unit = "kg", min = 0 }
c = { value = 4e-3, unit = "N m s", min = 0 }
[coordinates]
theta = { unit = "rad", initial = 0.5 }
phi = { unit = "rad", initial = 0.7 }
psi = { unit = "rad", initial = 1.6 }
[inputs]
u = { unit = "N m" }
[definitions]
x = "a*cos(theta) + b/2*cos(phi)"
y = "a*sin(theta) + b/2*sin(phi)"
[kinetic]
crank = "1/2*J_a*dot(theta)^2"
coupler = "1/2*J_b*dot(phi)^2 + 1/2*m_b*(dot(x)^2 + dot(y)^2)"
rocker = "1/2*J_c*dot(psi)^2"
[dissipation]
bearing = "1/2*c*dot(theta)^2"
[forces]
motor = { on = "theta", value = "u" }
[constraints]
loop_x = { zero = "a*cos(theta) + b*cos(phi) - d - e*cos(psi)" }
loop_y = { zero = "a*sin(theta) + b*sin(phi) - e*sin(psi)" }
"#
        .to_owned(),
        independent: String::new(),
        channels: [channel("theta", turn, 1e-3), channel("psi", turn, 3e-4)],
        sections: "[uncertain]\nc = { relative = 0.1 }",
        input: (0.05, 0.02, "N m"),
        rates: Box::new(move |[angle, rate], u| {
            let (swing, small) = (turns(angle)[1], 1e-4);
            let slope = (inertia(angle + small) - inertia(angle - small)) / (2.0 * small);
            let moment = u - c * rate - damping * swing * swing * rate - 0.5 * slope * rate * rate;
            [rate, moment / inertia(angle)]
        }),
        friction: (0.0, Box::new(|_| [1.0, 1.0])),
        observe: Box::new(move |[angle, _]| [angle, close(angle)[1]]),
        // The test record starts with a crank angle far from the initial state of the specification.
        initial: [[0.6, 12.0], [4.0, 10.0]],
    }
}

/// Returns two gears with dry friction `friction` (N m) on the second one, whose angle is measured.
pub fn gears(friction: f64, is_si: bool) -> Machine<2, 1> {
    let (ratio, motor, load, c) = (0.4, 1e-4, 2e-3, 2e-4);
    let inertia = motor + load * ratio * ratio;
    Machine {
        specification: r#"
[model]
name = "gears"
[parameters]
z_1 = { value = 20 }
z_2 = { value = 50 }
J_1 = { value = 1e-4, unit = "kg m^2", min = 0 }
J_2 = { value = 2e-3, unit = "kg m^2", min = 0 }
c = { value = 2e-4, unit = "N m s", min = 0 }
[coordinates]
q_1 = { unit = "rad" }
q_2 = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
motor = "1/2*J_1*dot(q_1)^2"
load = "1/2*J_2*dot(q_2)^2"
[dissipation]
bearing = "1/2*c*dot(q_1)^2"
[forces]
motor = { on = "q_1", value = "u" }
[constraints]
teeth = { zero = "z_1*q_1 - z_2*q_2" }
"#
        .to_owned(),
        independent: String::new(),
        channels: [channel("q_2", units(is_si)[1], 2e-4)],
        sections: "[uncertain]\nc = { relative = 0.1 }",
        input: (0.0, 0.015, "N m"),
        rates: Box::new(move |[_, rate], u| [rate, (u - c * rate) / inertia]),
        friction: (friction, Box::new(move |_| [ratio, 1.0 / inertia])),
        observe: Box::new(move |[angle, _]| [ratio * angle]),
        initial: [[0.0, 0.0], [0.3, 0.0]],
    }
}

/// Returns a sleigh on an edge that does not slip sideways (Chaplygin), with a rotational damper `damping` (N m s).
pub fn sleigh(damping: f64, is_si: bool) -> Machine<5, 3> {
    let (m, inertia, a, c, push) = (2.0, 0.05, 0.1, 1.0, 2.0);
    let [length, turn] = units(is_si);
    Machine {
        specification: r#"
[model]
name = "sleigh"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
J = { value = 0.05, unit = "kg m^2", min = 0 }
a = { value = 0.1, unit = "m" }
c = { value = 1, unit = "N s/m", min = 0 }
F = { value = 2, unit = "N" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
theta = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[definitions]
c_x = "x + a*cos(theta)"
c_y = "y + a*sin(theta)"
v = "cos(theta)*dot(x) + sin(theta)*dot(y)"
[kinetic]
body = "1/2*m*(dot(c_x)^2 + dot(c_y)^2) + 1/2*J*dot(theta)^2"
[dissipation]
ice = "1/2*c*v^2"
[forces]
steer = { on = "theta", value = "u" }
push_x = { on = "x", value = "F*cos(theta)" }
push_y = { on = "y", value = "F*sin(theta)" }
[constraints]
edge = { zero = "cos(theta)*dot(y) - sin(theta)*dot(x)" }
"#
        .to_owned(),
        independent: String::new(),
        channels: [
            channel("x", length, 5e-4),
            channel("y", length, 5e-4),
            channel("theta", turn, 1e-3),
        ],
        sections: "[uncertain]\nc = { relative = 0.1 }",
        input: (0.0, 0.25, "N m"),
        // State: speed along the edge, angular velocity, position and angle.
        rates: Box::new(move |[v, w, _, _, angle], u| {
            let along = (m * a * w * w - c * v + push) / m;
            let turning = (u - m * a * v * w - damping * w) / (inertia + m * a * a);
            [along, turning, v * angle.cos(), v * angle.sin(), w]
        }),
        friction: (0.0, Box::new(|_| [1.0, 1.0])),
        observe: Box::new(|[_, _, x, y, angle]| [x, y, angle]),
        initial: [[0.5, 0.0, 0.0, 0.0, 0.2], [0.3, 0.5, 0.1, 0.0, 1.0]],
    }
}
