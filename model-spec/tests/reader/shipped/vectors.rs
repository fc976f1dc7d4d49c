//! Vectors compared with closed forms, and with transforms and difference quotients of positions.

use std::fmt::Write as _;

use eomgen_model_spec::model::{Expr, Model};
use eomgen_model_spec::source::Source;

use super::bodies::{Matrix, State, energies, evaluate, links};

fn checked(text: &str) -> Model {
    let checked = eomgen_model_spec::check(Source::new("vectors.toml", text));
    let checked = checked.unwrap_or_else(|found| panic!("{}\n{text}", found.render(false)));
    assert!(checked.warnings.is_empty(), "{}", checked.warnings);
    checked.model
}

fn observed(model: &Model, name: &str, state: State<'_>) -> f64 {
    let observable = model.observables.iter().find(|o| o.name == name);
    let observable = observable.unwrap_or_else(|| panic!("{name}"));
    evaluate(model, state, &observable.value).0
}

fn vector(model: &Model, name: &str, state: State<'_>) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| observed(model, &format!("{name}_{axis}"), state))
}

fn close(one: &[f64], other: &[f64], tolerance: f64) {
    for (a, b) in one.iter().zip(other) {
        assert!((a - b).abs() <= tolerance, "{one:?} {other:?}");
    }
}

const STATES: [([f64; 6], [f64; 6]); 2] = [
    (
        [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
        [1.0, -0.7, 0.4, 2.0, -1.5, 0.3],
    ),
    (
        [-2.1, 1.2, -0.8, 2.4, -0.5, 1.6],
        [-0.3, 0.9, 1.4, -1.0, 0.5, 3.0],
    ),
];

/// Symmetric top with a fixed point, in Euler angles.
const TOP: &str = r#"
[model]
name = "top"
[parameters]
g = { value = 9.81, unit = "m/s^2" }
m = { value = 0.3, unit = "kg" }
l = { value = 0.04, unit = "m" }
A = { value = 2e-4, unit = "kg m^2" }
C = { value = 1.5e-4, unit = "kg m^2" }
M = { value = 0.7, unit = "N m" }
[coordinates]
phi = { unit = "rad" }
theta = { unit = "rad", initial = 0.6 }
psi = { unit = "rad" }
[frames]
top = { rotation = "rotation_z(phi)*rotation_x(theta)*rotation_z(psi)" }
[definitions]
turned = "rotation_z(phi)*rotation_x(theta)"
axis = "turned*[0, 0, 1]"
node = "turned*[1, 0, 0]"
omega = "dot(phi)*[0, 0, 1] + dot(theta)*node + dot(psi)*axis"
r = "l*axis"
[kinetic]
top = "1/2*m*dot(dot(r), dot(r)) + 1/2*A*dot(omega, omega) + 1/2*(C - A)*dot(omega, axis)^2"
[potential]
weight = "m*g*r.z"
[forces]
motor = { on = "top.rotation", value = "M*[1, 2, 3]" }
[observables]
node = "node"
axis = "axis"
omega = "omega"
own = "top.angular_velocity"
third = "top.z"
momentum = "m*cross(r, dot(r)) + A*omega + (C - A)*dot(omega, axis)*axis"
"#;

#[test]
fn top_matches_the_energies_in_euler_angles() {
    let model = checked(TOP);
    let (m, g, l, a, c) = (0.3, 9.81, 0.04, 2e-4, 1.5e-4);
    for (q, rates) in &STATES {
        let state = (q, rates);
        let total = |expr: &Expr| evaluate(&model, state, expr).0;
        let (sine, cosine) = q[1].sin_cos();
        let spin = rates[2] + rates[0] * cosine;
        let across = rates[1].powi(2) + (rates[0] * sine).powi(2);
        let kinetic = 0.5 * (a + m * l * l) * across + 0.5 * c * spin * spin;
        close(&[total(&model.kinetic[0].value)], &[kinetic], 1e-15);
        let potential = m * g * l * cosine;
        close(&[total(&model.potential[0].value)], &[potential], 1e-15);
        let (omega, own) = (vector(&model, "omega", state), vector(&model, "own", state));
        close(&omega, &own, 1e-14);
        let (axis, third) = (
            vector(&model, "axis", state),
            vector(&model, "third", state),
        );
        close(&axis, &third, 1e-15);
        // Angular momentum about the vertical: derivative of the kinetic energy with respect to the precession rate.
        let vertical = (a + m * l * l) * rates[0] * sine * sine + c * spin * cosine;
        close(&[observed(&model, "momentum_z", state)], &[vertical], 1e-15);
    }
}

#[test]
fn power_of_a_torque_uses_the_angular_velocity() {
    let model = checked(TOP);
    let (q, _) = STATES[0];
    let along = |name: &str, rates: &[f64; 6]| vector(&model, name, (&q, rates));
    let work = |a: [f64; 3]| 0.7 * (a[0] + 2.0 * a[1] + 3.0 * a[2]);
    let still = [0.0; 6];
    let directions = [
        [0.0, 0.0, 1.0],
        along("node", &still),
        along("axis", &still),
    ];
    for (coordinate, direction) in directions.into_iter().enumerate() {
        let mut unit = [0.0; 6];
        unit[coordinate] = 1.0;
        let forces = model.forces.iter().map(|force| {
            let (value, _) = evaluate(&model, (&q, &still), &force.value);
            value * evaluate(&model, (&q, &unit), &force.on).1
        });
        close(&[forces.sum()], &[work(direction)], 1e-14);
    }
}

#[test]
fn frames_match_their_transforms() {
    let text = include_str!("../../../models/puma_560.toml").to_owned()
        + "[observables]\n\
           origin = \"link_6.origin\"\n\
           tip = \"link_6.origin + link_6.rotation*[0, 0, r_6z]\"\n\
           velocity = \"link_6.velocity\"\n\
           speed = \"tip_rate\"\n\
           omega = \"link_6.angular_velocity\"\n\
           x = \"link_6.x\"\n\
           y = \"link_6.y\"\n\
           z = \"link_6.z\"\n\
           back = \"transpose(link_6.rotation)*link_6.y\"\n\
           [definitions]\n\
           tip_rate = \"dot(link_6.origin)\"\n";
    let model = checked(&text);
    for (q, rates) in &STATES {
        let state = (q, rates);
        let step = 1e-5;
        let at = |by: f64| -> Matrix {
            let mut moved = *q;
            for (own, rate) in moved.iter_mut().zip(rates) {
                *own += by * rate;
            }
            links(&moved)[5]
        };
        let (now, before, after) = (at(0.0), at(-step), at(step));
        let column = |matrix: &Matrix, j: usize| [0, 1, 2].map(|i| matrix[i][j]);
        let rate = |i: usize, j: usize| (after[i][j] - before[i][j]) / (2.0 * step);
        // In the model and in the transforms, the origin of the last links is the wrist.
        close(&vector(&model, "origin", state), &column(&now, 3), 1e-15);
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            close(&vector(&model, name, state), &column(&now, axis), 1e-15);
        }
        let velocity = [0, 1, 2].map(|i| rate(i, 3));
        close(&vector(&model, "velocity", state), &velocity, 1e-9);
        let exact = vector(&model, "velocity", state);
        close(&vector(&model, "speed", state), &exact, 1e-14);
        // dR/dt R' is the cross product with the angular velocity along the fixed axes.
        let turned = |a: usize, b: usize| (0..3).map(|k| rate(a, k) * now[b][k]).sum::<f64>();
        let omega = [turned(2, 1), turned(0, 2), turned(1, 0)];
        close(&vector(&model, "omega", state), &omega, 1e-8);
        close(&vector(&model, "back", state), &[0.0, 1.0, 0.0], 1e-15);
        let tip = [0, 1, 2].map(|i| now[i][3] + 0.032 * now[i][2]);
        close(&vector(&model, "tip", state), &tip, 1e-15);
    }
}

/// Returns a specification of the PUMA 560 with vectors: rotations, positions and angular velocities of each link.
fn arm_of_vectors() -> String {
    let text = include_str!("../../../models/puma_560.toml").replace("gravity =", "# gravity =");
    let (head, rest) = text.split_once("[frames]").expect("frames");
    let (_, forces) = rest.split_once("[forces]").expect("forces");
    let turns = ["pi/2", "0", "-pi/2", "pi/2", "-pi/2", "0"];
    let origins = [
        "[0, 0, 0]",
        "[0, 0, 0]",
        "o_2 + R_2*[a_2, 0, 0]",
        "o_3 + R_3*[a_3, -d_3, 0]",
        "o_4 + R_4*[0, d_4, 0]",
        "o_5",
    ];
    let centres = [
        "",
        "a_2 + r_2x, r_2y, r_2z",
        "0, r_3y - d_3, r_3z",
        "0, d_4 + r_4y, 0",
        "0, 0, 0",
        "0, 0, r_6z",
    ];
    let moments = [
        [0.35, 0.35, 0.35],
        [0.13, 0.524, 0.539],
        [0.066, 0.086, 0.0125],
        [0.0018, 0.0013, 0.0018],
        [0.0003, 0.0004, 0.0003],
        [0.00015, 0.00015, 4e-5],
    ];
    let (mut definitions, mut kinetic, mut potential) =
        (String::new(), String::new(), String::new());
    for link in 0..6 {
        let (own, before) = (link + 1, link);
        let (turned, spun) = match link {
            0 => (String::new(), "dot(q_1)*[0, 0, 1]".to_owned()),
            _ => (
                format!("R_{before}*"),
                format!("w_{before} + dot(q_{own})*(R_{before}*[0, 0, 1])"),
            ),
        };
        let alpha = turns[link];
        let _ = write!(
            definitions,
            "R_{own} = \"{turned}rotation_z(q_{own})*rotation_x({alpha})\"\n\
             w_{own} = \"{spun}\"\nv_{own} = \"transpose(R_{own})*w_{own}\"\n\
             o_{own} = \"{}\"\n",
            origins[link]
        );
        let [x, y, z] = moments[link];
        let spin = format!("1/2*I*({x}*v_{own}.x^2 + {y}*v_{own}.y^2 + {z}*v_{own}.z^2)");
        let _ = writeln!(kinetic, "spin_{own} = \"{spin}\"");
        if link > 0 {
            let _ = writeln!(
                definitions,
                "c_{own} = \"o_{own} + R_{own}*[{}]\"",
                centres[link]
            );
            let square = format!("dot(dot(c_{own}), dot(c_{own}))");
            let _ = writeln!(kinetic, "move_{own} = \"1/2*m_{own}*{square}\"");
            let _ = writeln!(potential, "weight_{own} = \"m_{own}*g*c_{own}.z\"");
        }
    }
    // The origin of the first link is constant and would give an unused definition.
    let definitions = definitions.replace("o_1 = \"[0, 0, 0]\"\n", "");
    let energies = format!("[kinetic]\n{kinetic}[potential]\n{potential}");
    format!("{head}[definitions]\n{definitions}{energies}[forces]{forces}")
}

#[test]
fn six_joints_in_vectors_match_the_energies_of_positions() {
    let model = checked(&arm_of_vectors());
    for (q, rates) in &STATES {
        let total = |terms: &[eomgen_model_spec::model::Term]| -> f64 {
            let values = terms
                .iter()
                .map(|t| evaluate(&model, (q, rates), &t.value).0);
            values.sum()
        };
        let (kinetic, potential) = energies(q, rates);
        close(&[total(&model.kinetic)], &[kinetic], 1e-8 * kinetic);
        close(&[total(&model.potential)], &[potential], 1e-12 * 100.0);
    }
}

#[test]
fn rotation_about_any_axis_matches_quaternions() {
    let model = checked(
        "[model]\nname = \"turns\"\n[parameters]\nJ = { value = 1, unit = \"kg m^2\" }\n\
         [coordinates]\nq = { unit = \"rad\" }\np = { unit = \"rad\" }\n\
         [kinetic]\nown = \"1/2*J*(dot(q)^2 + dot(p)^2)\"\n\
         [observables]\nturned = \"rotation([3, 4, 12], q)*[1, 2, -0.5]\"\n\
         moving = \"rotation([cos(p), sin(p), 2], q)*[1, 2, -0.5]\"\n\
         quarter = \"rotation([0, 0, 2], pi/2)*[1, 2, 3]\"\n\
         planar = \"rotation(q)*[1, 2]\"\narea = \"cross([1, 2], rotation(q)*[1, 2])\"\n\
         length = \"norm([3, 4, 12]) + norm([3, -4])\"\n",
    );
    let (q, rates) = &STATES[1];
    let state = (q, rates);
    // v + 2 w (u x v) + 2 u x (u x v) of the quaternion (w, u).
    let turned = |axis: [f64; 3]| {
        let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let (s, w) = (q[0] / 2.0).sin_cos();
        let u = axis.map(|a| a / length * s);
        let v = [1.0, 2.0, -0.5];
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let once = cross(u, v);
        let twice = cross(u, once);
        [0, 1, 2].map(|i| v[i] + 2.0 * w * once[i] + 2.0 * twice[i])
    };
    close(
        &vector(&model, "turned", state),
        &turned([3.0, 4.0, 12.0]),
        1e-15,
    );
    let moving = [q[1].cos(), q[1].sin(), 2.0];
    close(&vector(&model, "moving", state), &turned(moving), 1e-15);
    assert_eq!(vector(&model, "quarter", state), [-2.0, 1.0, 3.0]);
    let (s, c) = q[0].sin_cos();
    let planar = ["planar_x", "planar_y"].map(|name| observed(&model, name, state));
    close(&planar, &[c - 2.0 * s, s + 2.0 * c], 1e-15);
    close(&[observed(&model, "area", state)], &[5.0 * s], 1e-15);
    close(&[observed(&model, "length", state)], &[18.0], 1e-15);
}

#[test]
fn nested_products_grow_linearly() {
    let head = "[model]\nname = \"nested\"\n[parameters]\nJ = { value = 1, unit = \"kg m^2\" }\n\
                [coordinates]\nq = { unit = \"rad\" }\n[kinetic]\nown = \"1/2*J*dot(q)^2\"\n";
    let nested = "cross([0, 0, 1], ".repeat(60) + "[cos(q), sin(q), q]" + &")".repeat(60);
    let general = "cross([q, 1, 2*q], ".repeat(60) + "[cos(q), sin(q), q]" + &")".repeat(60);
    let turned = "rotation_z(q)*rotation([1, q, 2], q)*".repeat(30) + "[cos(q), sin(q), q]";
    for (text, most) in [(nested, 10), (general, 600), (turned, 1500)] {
        let model = checked(&format!("{head}[observables]\nend = \"{text}\"\n"));
        let definitions = model.definitions.len();
        assert!(definitions <= most, "{definitions}");
    }
}

/// Returns a specification with rotations that are each the square of the one before, and a
/// vector rotated by the last.
fn squared_rotations(first: &str, vector: &str, count: usize) -> String {
    let mut text =
        "[model]\nname = \"squared\"\n[parameters]\nJ = { value = 1, unit = \"kg m^2\" }\n\
                    [coordinates]\nq = { unit = \"rad\" }\n[kinetic]\nown = \"1/2*J*dot(q)^2\"\n\
                    [definitions]\n"
            .to_owned();
    let _ = writeln!(text, "R_0 = \"{first}\"");
    for next in 1..=count {
        let _ = writeln!(text, "R_{next} = \"R_{0}*R_{0}\"", next - 1);
    }
    let _ = writeln!(text, "[observables]\nend = \"R_{count}*{vector}\"");
    text
}

#[test]
fn squared_rotations_share_their_parts() {
    for (first, vector) in [
        ("rotation_z(q)", "[1, 0, 0]"),
        ("rotation(q)", "[1, 0]"),
        ("rotation_x(q)*rotation_z(2*q)", "[1, q, 0]"),
        ("transpose(rotation([1, 2, q], q))", "[1, q, 0]"),
    ] {
        let sizes = [30, 60].map(|count| {
            let model = checked(&squared_rotations(first, vector, count));
            model.definitions.len()
        });
        assert!(
            sizes[1] <= 2 * sizes[0] + 20 && sizes[1] <= 60 * 60,
            "{sizes:?}"
        );
    }
}

#[test]
fn repeated_squaring_multiplies_the_angle_by_powers_of_two() {
    let model = checked(&squared_rotations("rotation_z(q)", "[1, 0, 0]", 4));
    for (values, rates) in &STATES {
        let end = vector(&model, "end", (values, rates));
        let angle = 16.0 * values[0];
        close(&end, &[angle.cos(), angle.sin(), 0.0], 1e-12);
    }
}
