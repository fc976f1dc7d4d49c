//! Machines of the study, with dry frictions that their models lack.

use crate::coverage::machines::{Channel, MACHINES, Machine, PENDULUM};

/// Machine with an effect that its model lacks.
pub struct Case {
    pub machine: &'static Machine,
    /// Coordinate on which the input acts.
    pub driven: &'static str,
    /// Dry friction on this coordinate, in the unit of the input. The residual without it is about three noise floors.
    pub friction: f64,
}

pub const CASES: [Case; 8] = [
    case(&MACHINES[0], "phi", 0.0005),
    case(&MACHINES[1], "theta", 0.05),
    case(&MACHINES[2], "theta", 0.01),
    case(&MACHINES[3], "alpha", 0.05),
    case(&OTHERS[0], "x", 0.05),
    case(&OTHERS[1], "x", 0.05),
    case(&OTHERS[2], "y", 0.25),
    case(&OTHERS[3], "theta", 0.2),
];

const fn case(machine: &'static Machine, driven: &'static str, friction: f64) -> Case {
    Case {
        machine,
        driven,
        friction,
    }
}

/// Machines with nonlinear sensors, short windows or short records.
static OTHERS: [Machine; 4] = [
    Machine {
        name: "lever with a measured height",
        text: LEVER,
        uncertain: &[("J", 0.05), ("k", 0.05), ("c", 0.2)],
        input: ("u", "N m"),
        waves: &[(1.5, 0.9), (1.0, 2.3)],
        channels: &[Channel {
            name: "height",
            unit: "m",
            noise: 1e-4,
        }],
        sample: 5e-3,
        samples: 400,
        window: 0.25,
    },
    Machine {
        name: "lever with a measured angle",
        text: LEVER,
        uncertain: &[("k", 0.05), ("c", 0.2)],
        input: ("u", "N m"),
        waves: &[(1.5, 0.9), (1.0, 2.3)],
        channels: &[Channel {
            name: "x",
            unit: "rad",
            noise: 1e-3,
        }],
        sample: 5e-3,
        samples: 300,
        window: 0.25,
    },
    Machine {
        name: "two masses, one measured",
        text: MASSES,
        uncertain: &[("k_2", 0.05), ("m_2", 0.05)],
        input: ("F", "N"),
        waves: &[(4.0, 0.7), (3.0, 2.9)],
        channels: &[Channel {
            name: "y",
            unit: "m",
            noise: 1e-4,
        }],
        sample: 0.01,
        samples: 200,
        window: 0.5,
    },
    Machine {
        name: "pendulum with a measured position",
        text: PENDULUM,
        uncertain: &[("c", 0.2)],
        input: ("u", "N m"),
        waves: &[(2.0, 0.6), (1.5, 1.3)],
        channels: &[Channel {
            name: "s",
            unit: "m",
            noise: 5e-4,
        }],
        sample: 0.01,
        samples: 250,
        window: 0.25,
    },
];

const LEVER: &str = r#"
[model]
name = "lever"
[parameters]
J = { value = 0.02, unit = "kg m^2", min = 0 }
k = { value = 3, unit = "N m/rad" }
c = { value = 0.03, unit = "N m s/rad" }
l = { value = 0.3, unit = "m" }
[coordinates]
x = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
lever = "1/2*J*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
bearing = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
height = { value = "l*sin(x)", unit = "m" }
"#;

const MASSES: &str = r#"
[model]
name = "masses"
[parameters]
m_1 = { value = 1, unit = "kg" }
m_2 = { value = 0.6, unit = "kg", min = 0 }
k_1 = { value = 120, unit = "N/m" }
k_2 = { value = 90, unit = "N/m" }
d = { value = 0.8, unit = "N s/m" }
[coordinates]
y = { unit = "m" }
z = { unit = "m" }
[inputs]
F = { unit = "N" }
[kinetic]
masses = "1/2*m_1*dot(y)^2 + 1/2*m_2*dot(z)^2"
[potential]
springs = "1/2*k_1*y^2 + 1/2*k_2*(z - y)^2"
[dissipation]
dampers = "1/2*d*dot(y)^2 + 1/2*d*(dot(z) - dot(y))^2"
[forces]
drive = { on = "y", value = "F" }
"#;
