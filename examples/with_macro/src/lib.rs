//! Two models emitted at compile time: the planetary arm from its file, and a pendulum from text in the source.
#![no_std]

/// The planetary arm with four modes.
pub mod arm {
    eomgen::model! { spec = "../../model-spec/models/planetary_arm.toml", order = 4 }
}

/// A pendulum on a driven pivot.
pub mod pendulum {
    eomgen::model! {
        model { name: driven_pendulum, title: "Pendulum on a driven pivot" }
        parameters {
            m: { value: 0.15, unit: kg, doc: "bob", min: 0 },
            l: { value: 300, unit: mm, doc: "rod", min: 0 },
            c: { value: 2e-4, unit: N m s, doc: "friction in the pivot" },
            g: { value: 9.81, unit: m/s^2 },
        }
        coordinates { theta: { unit: rad, doc: "from hanging down", initial: pi/2 } }
        inputs { u: { unit: N m, doc: "torque at the pivot" } }
        definitions {
            // Position of the bob.
            x: l*sin(theta),
            y: -l*cos(theta),
        }
        kinetic { bob: 1/2*m*(dot(x)^2 + dot(y)^2) }
        potential { gravity: m*g*y }
        dissipation { pivot: 1/2*c*dot(theta)^2 }
        forces { motor: { on: theta, value: u } }
    }
}
