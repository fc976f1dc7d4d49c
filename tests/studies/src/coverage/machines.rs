//! Machines of the study: dry friction, nonlinear motion, a flexible beam, backlash.

/// Machine with its priors and records. All numbers are in SI units.
pub struct Machine {
    pub name: &'static str,
    /// Specification; its uncertain parameters are in SI units.
    pub text: &'static str,
    /// Uncertain parameters with their relative standard deviations.
    pub uncertain: &'static [(&'static str, f64)],
    pub input: (&'static str, &'static str),
    /// Amplitudes and frequencies (Hz) of the sines whose sum is the input. The phases differ between records.
    pub waves: &'static [(f64, f64)],
    pub channels: &'static [Channel],
    /// Time between samples, s.
    pub sample: f64,
    /// Number of samples of the fitted record; the held-out record has half as many.
    pub samples: usize,
    /// Window length, s.
    pub window: f64,
}

pub struct Channel {
    pub name: &'static str,
    pub unit: &'static str,
    /// Standard deviation of the noise.
    pub noise: f64,
}

pub static MACHINES: [Machine; 4] = [
    Machine {
        name: "ball-screw axis with dry friction",
        text: AXIS,
        uncertain: &[("J_m", 0.05), ("m", 0.05), ("b", 0.1)],
        input: ("M", "N m"),
        waves: &[(0.35, 1.1), (0.18, 3.7), (0.06, 9.0)],
        channels: &[
            Channel {
                name: "x",
                unit: "m",
                noise: 1e-6,
            },
            Channel {
                name: "phi",
                unit: "rad",
                noise: 8.7e-4,
            },
        ],
        sample: 2e-3,
        samples: 800,
        window: 0.2,
    },
    Machine {
        name: "pendulum",
        text: PENDULUM,
        uncertain: &[("l", 0.03), ("m", 0.05), ("c", 0.2)],
        input: ("u", "N m"),
        waves: &[(2.0, 0.6), (1.5, 1.3)],
        channels: &[Channel {
            name: "theta",
            unit: "rad",
            noise: 2e-3,
        }],
        sample: 0.01,
        samples: 500,
        window: 1.0,
    },
    Machine {
        name: "flexible beam on a hub",
        text: BEAM,
        uncertain: &[("J_h", 0.05), ("E", 0.05), ("c", 0.2)],
        input: ("u", "N m"),
        waves: &[(0.5, 0.7), (0.3, 3.1)],
        channels: &[
            Channel {
                name: "theta",
                unit: "rad",
                noise: 2e-4,
            },
            Channel {
                name: "tip",
                unit: "m",
                noise: 1e-4,
            },
        ],
        sample: 5e-3,
        samples: 500,
        window: 0.5,
    },
    Machine {
        name: "two inertias with play",
        text: PLAY,
        uncertain: &[("J_2", 0.05), ("k", 0.1), ("g", 0.1)],
        input: ("u", "N m"),
        waves: &[(0.8, 0.9), (0.5, 4.3)],
        channels: &[
            Channel {
                name: "alpha",
                unit: "rad",
                noise: 1e-3,
            },
            Channel {
                name: "beta",
                unit: "rad",
                noise: 1e-3,
            },
        ],
        sample: 2e-3,
        samples: 600,
        window: 0.2,
    },
];

const AXIS: &str = r#"
[model]
name = "axis"
[parameters]
J_m = { value = 2.1e-4, unit = "kg m^2", min = 0 }
m = { value = 18, unit = "kg", min = 0 }
k = { value = 24, unit = "N/um" }
c = { value = 9, unit = "N s/mm" }
p = { value = 10, unit = "mm" }
b = { value = 55, unit = "N s/m" }
F_c = { value = 41, unit = "N" }
[coordinates]
phi = { unit = "rad" }
x = { unit = "m" }
[inputs]
M = { unit = "N m" }
[definitions]
s = "p/(2*pi)*phi - x"
[kinetic]
motor = "1/2*J_m*dot(phi)^2"
table = "1/2*m*dot(x)^2"
[potential]
nut = "1/2*k*s^2"
[dissipation]
nut = "1/2*c*dot(s)^2"
guides = "1/2*b*dot(x)^2"
[forces]
motor = { on = "phi", value = "M" }
friction = { on = "x", value = "-F_c*sign(dot(x))" }
"#;

pub const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
m = { value = 1.2, unit = "kg", min = 0 }
l = { value = 0.4, unit = "m", min = 0 }
c = { value = 0.05, unit = "N m s" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
point = "1/2*m*l^2*dot(theta)^2"
[potential]
weight = "-m*g*l*cos(theta)"
[dissipation]
bearing = "1/2*c*dot(theta)^2"
[forces]
motor = { on = "theta", value = "u" }
[observables]
s = { value = "l*sin(theta)", unit = "m" }
"#;

const BEAM: &str = r#"
[model]
name = "beam"
[parameters]
J_h = { value = 0.05, unit = "kg m^2", min = 0 }
rho = { value = 2700, unit = "kg/m^3" }
A = { value = 90e-6, unit = "m^2" }
l = { value = 1.0, unit = "m", min = 0 }
E = { value = 70e9, unit = "Pa" }
I = { value = 67.5, unit = "mm^4" }
M_t = { value = 0.1, unit = "kg", min = 0 }
c = { value = 0.05, unit = "N m s" }
[coordinates]
theta = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 2
unit = "m"
[kinetic]
hub = "1/2*J_h*dot(theta)^2"
beam = "1/2*integral(rho*A*(x*dot(theta) + dot(w))^2, w)"
tip = "1/2*M_t*(l*dot(theta) + at(dot(w), l))^2"
[potential]
bending = "1/2*integral(E*I*diff(w, x, 2)^2, w)"
[dissipation]
bearing = "1/2*c*dot(theta)^2"
[forces]
motor = { on = "theta", value = "u" }
[observables]
tip = { value = "at(w, l)", unit = "m" }
"#;

const PLAY: &str = r#"
[model]
name = "play"
[parameters]
J_1 = { value = 0.01, unit = "kg m^2" }
J_2 = { value = 0.02, unit = "kg m^2" }
k = { value = 60, unit = "N m/rad" }
g = { value = 0.02, unit = "rad", min = 0 }
c = { value = 0.03, unit = "N m s/rad" }
[coordinates]
alpha = { unit = "rad" }
beta = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
inertias = "1/2*J_1*dot(alpha)^2 + 1/2*J_2*dot(beta)^2"
[potential]
coupling = "1/2*k*deadzone(alpha - beta, g)^2"
[dissipation]
bearings = "1/2*c*dot(alpha)^2 + 1/2*c*dot(beta)^2"
[forces]
motor = { on = "alpha", value = "u" }
"#;
