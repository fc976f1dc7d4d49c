//! Four machines on a moving base, most of them with a hidden force that is missing in the specification.

use crate::moving_base::Machine;

/// Returns a tower: two masses above each other with springs and dampers. The sensors measure absolute positions.
/// `hidden` is a force on the lower mass, a function of its distance from the base and the rate of this distance.
pub fn tower(hidden: fn(f64, f64) -> f64) -> Machine<2, 2> {
    Machine {
        specification: r#"
[model]
name = "tower"
[parameters]
m_1 = { value = 2, unit = "kg", min = 0 }
m_2 = { value = 1, unit = "kg", min = 0 }
k_1 = { value = 800, unit = "N/m", min = 0 }
k_2 = { value = 500, unit = "N/m", min = 0 }
c_1 = { value = 4, unit = "N s/m", min = 0 }
c_2 = { value = 2, unit = "N s/m", min = 0 }
[coordinates]
x_1 = { unit = "m" }
x_2 = { unit = "m" }
[inputs]
s = { unit = "m", rates = 2 }
[kinetic]
lower = "1/2*m_1*dot(x_1)^2"
upper = "1/2*m_2*dot(x_2)^2"
[potential]
column = "1/2*k_1*(x_1 - s)^2"
link = "1/2*k_2*(x_2 - x_1)^2"
[dissipation]
column = "1/2*c_1*(dot(x_1) - dot(s))^2"
link = "1/2*c_2*(dot(x_2) - dot(x_1))^2"
"#
        .to_owned(),
        channels: ["x_1", "x_2"],
        noise: (2e-5, "m"),
        sections: "[uncertain]\nk_1 = { relative = 0.02 }\nk_2 = { relative = 0.02 }\nc_1 = { relative = 0.1 }",
        base: (4e-3, [1.3, 2.9, 5.3]),
        inertia: [2.0, 1.0],
        friction: 0.0,
        force: Box::new(move |[s, rate, _], [x, y], [v, w]| {
            let link = 500.0 * (y - x) + 2.0 * (w - v);
            let column = -800.0 * (x - s) - 4.0 * (v - rate) + hidden(x - s, v - rate);
            [column + link, -link]
        }),
        observed: [[1.0, 0.0], [0.0, 1.0]],
        initial: [0.0, 0.0],
    }
}

/// Returns a pendulum with a moving pivot and dry friction `torque` (N m) in the pivot.
pub fn pendulum(torque: f64) -> Machine<1, 1> {
    let (m, l, g, c) = (0.2, 0.3, 9.81, 1e-3);
    Machine {
        specification: r#"
[model]
name = "pendulum"
[parameters]
m = { value = 0.2, unit = "kg", min = 0 }
l = { value = 0.3, unit = "m", min = 0 }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 1e-3, unit = "N m s", min = 0 }
[coordinates]
theta = { unit = "rad" }
[inputs]
s = { unit = "m", rates = 2 }
[definitions]
x = "s + l*sin(theta)"
y = "-l*cos(theta)"
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
gravity = "m*g*y"
[dissipation]
pivot = "1/2*c*dot(theta)^2"
"#
        .to_owned(),
        channels: ["theta"],
        noise: (1e-3, "rad"),
        sections: "[uncertain]\nc = { relative = 0.1 }",
        base: (0.02, [0.8, 1.1, 1.7]),
        inertia: [m * l * l],
        friction: torque,
        force: Box::new(move |[_, _, second], [theta], [rate]| {
            [-m * g * l * theta.sin() - m * l * second * theta.cos() - c * rate]
        }),
        observed: [[1.0]],
        initial: [0.8, -0.6],
    }
}

/// Returns a mass on a spring with friction on the moving base. The sensor measures the distance from the base.
/// `hidden` is a force on the mass, a function of this distance and its rate.
pub fn slider(hidden: fn(f64, f64) -> f64) -> Machine<1, 1> {
    Machine {
        specification: r#"
[model]
name = "slider"
[parameters]
m = { value = 1, unit = "kg", min = 0 }
k = { value = 400, unit = "N/m", min = 0 }
F = { value = 1.5, unit = "N", min = 0 }
[coordinates]
z = { unit = "m" }
[inputs]
s = { unit = "m", rates = 2 }
[kinetic]
mass = "1/2*m*(dot(z) + dot(s))^2"
[potential]
spring = "1/2*k*z^2"
[forces]
friction = { on = "z", value = "-F*sign(dot(z))" }
"#
        .to_owned(),
        channels: ["z"],
        noise: (2e-5, "m"),
        sections: "[uncertain]\nk = { relative = 0.02 }",
        base: (6e-3, [2.1, 2.9, 4.3]),
        inertia: [1.0],
        friction: 1.5,
        force: Box::new(move |[_, _, second], [z], [rate]| [-400.0 * z - second + hidden(z, rate)]),
        observed: [[1.0]],
        initial: [0.0, 0.0],
    }
}

/// Returns a beam with three modes, clamped to the moving base. The sensors measure the deflection at the end and in
/// the middle. `hidden` is a force at the end, a function of the end's deflection and rate.
pub fn mast(hidden: fn(f64, f64) -> f64) -> Machine<3, 2> {
    let (rho, stiffness, l, d) = (0.8, 2.0, 0.5, 0.02);
    let roots: [f64; 3] = [
        1.875_104_068_711_961,
        4.694_091_132_974_174,
        7.854_757_438_237_613,
    ];
    let ratio = |z: f64| (z.cosh() + z.cos()) / (z.sinh() + z.sin());
    // Mode shape with mean square 1, at the fraction `part` of the length.
    let shape = |z: f64, part: f64| {
        let at = z * part;
        at.cosh() - at.cos() - ratio(z) * (at.sinh() - at.sin())
    };
    let end = roots.map(|z| shape(z, 1.0));
    let middle = roots.map(|z| shape(z, 0.5));
    // Integral of the mode shape.
    let mass = roots.map(|z| 2.0 * rho * l * ratio(z) / z);
    let springs = roots.map(|z| stiffness * (z / l).powi(4) * l);
    Machine {
        specification: r#"
[model]
name = "mast"
[parameters]
rho = { value = 0.8, unit = "kg/m", min = 0 }
EI = { value = 2, unit = "N m^2", min = 0 }
l = { value = 0.5, unit = "m", min = 0 }
d = { value = 0.02, unit = "N s/m^2", min = 0 }
[fields.w]
unit = "m"
along = "x"
from = 0
to = "l"
basis = "clamped_free"
order = 3
coordinates = "q"
[inputs]
s = { unit = "m", rates = 2 }
[kinetic]
beam = "1/2*integral(rho*(dot(w) + dot(s))^2, w)"
[potential]
bending = "1/2*integral(EI*diff(w, x, 2)^2, w)"
[dissipation]
air = "1/2*integral(d*dot(w)^2, w)"
[observables]
tip = { value = "at(w, l)", unit = "m" }
middle = { value = "at(w, l/2)", unit = "m" }
"#
        .to_owned(),
        channels: ["tip", "middle"],
        noise: (2e-6, "m"),
        sections: "[uncertain]\nEI = { relative = 0.02 }\nd = { relative = 0.1 }",
        base: (1e-3, [4.1, 6.9, 31.0]),
        inertia: [rho * l; 3],
        friction: 0.0,
        force: Box::new(move |[_, _, second], q, v| {
            let [place, rate] = [q, v].map(|all| all.iter().zip(&end).map(|(a, b)| a * b).sum());
            let tip = hidden(place, rate);
            std::array::from_fn(|i| {
                -springs[i] * q[i] - d * l * v[i] - mass[i] * second + end[i] * tip
            })
        }),
        observed: [end, middle],
        initial: [0.0, 0.0],
    }
}
