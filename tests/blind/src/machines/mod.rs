//! Machines with all effects that can be hidden in them, and their measurements.

pub mod arm;
pub mod axes;
mod setup;
pub mod spring;
pub mod two_bodies;

use crate::friction::{AxisForces, FrictionLaw};
use crate::integrate::Motion;
use crate::random::RandomStream;
use arm::{Arm, Mesh};
use axes::{Pendulum, Stage};
pub use setup::{Channel, Setup, Specification};
use spring::Spring;
use two_bodies::{Form, TwoBodies};

/// Machine with its true parameters and hidden effects.
#[derive(Clone, Debug, PartialEq)]
pub enum Machine {
    /// Flexible arm on its reducer.
    Arm(Box<Arm>),
    /// Stage driven by a force.
    Stage(Stage),
    /// Free pendulum.
    Pendulum(Pendulum),
    /// Two bodies with random parameters.
    TwoBodies(Box<TwoBodies>),
}

/// Kind of machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Flexible arm on its reducer.
    Arm,
    /// Stage driven by a force.
    Stage,
    /// Free pendulum.
    Pendulum,
    /// Two bodies with random parameters.
    TwoBodies {
        /// Machine of the family.
        form: Form,
        /// Seed of its parameters.
        seed: u64,
    },
}

impl Kind {
    /// Returns the machine without hidden effects, with the parameters of the specification.
    pub fn nominal(self) -> Machine {
        match self {
            Kind::Arm => Machine::Arm(Box::new(Arm::nominal())),
            Kind::Stage => Machine::Stage(Stage::nominal()),
            Kind::Pendulum => Machine::Pendulum(Pendulum::nominal()),
            Kind::TwoBodies { form, seed } => {
                Machine::TwoBodies(Box::new(TwoBodies::random(form, seed)))
            }
        }
    }

    /// Returns the measurement setup.
    pub fn setup(self) -> Setup {
        let channel = |name, unit, scale, noise, step| Channel {
            name,
            unit,
            scale,
            noise,
            step,
        };
        match self {
            Kind::Arm => Setup {
                specification: Specification::Shipped("planetary_arm_rig.toml"),
                order: Some(2),
                channels: vec![
                    channel("theta_s", "rad", 1.0, 6e-5, 6e-5),
                    channel("theta_c", "rad", 1.0, 3e-5, 4e-5),
                    channel("tip", "m", 1.0, 1.5e-5, 5e-6),
                ],
                input: Some(("u", "N m")),
                sample: 5e-4,
                steps: 200,
                duration: 1.2,
                window: Some(0.1),
                uncertain: vec![("b_m", 0.02)],
                records: (1, 1),
            },
            Kind::Stage => Setup {
                specification: Specification::Shipped("emps.toml"),
                order: None,
                channels: vec![channel("q", "mm", 1e-3, 2e-6, 3e-6)],
                input: Some(("force", "N")),
                sample: 1e-3,
                steps: 100,
                duration: 1.6,
                window: Some(0.25),
                uncertain: vec![("M", 0.02), ("F_v", 0.05)],
                records: (1, 1),
            },
            Kind::Pendulum => Setup {
                specification: Specification::Shipped("pendulum.toml"),
                order: None,
                channels: vec![channel("theta", "rad", 1.0, 5e-4, 6e-4)],
                input: None,
                sample: 2e-3,
                steps: 100,
                duration: 1.4,
                window: None,
                uncertain: vec![("k", 0.3), ("I", 0.05)],
                records: (3, 2),
            },
            Kind::TwoBodies { form, seed } => TwoBodies::random(form, seed).setup(),
        }
    }
}

impl Machine {
    /// Returns the number of states.
    pub fn state_size(&self) -> usize {
        match self {
            Machine::Arm(_) => arm::STATE,
            Machine::Stage(_) | Machine::Pendulum(_) => 3,
            Machine::TwoBodies(_) => two_bodies::STATE,
        }
    }

    /// Returns the values of the channels, SI.
    pub fn outputs(&self, state: &[f64]) -> Vec<f64> {
        match self {
            Machine::Arm(arm) => arm.outputs(state).to_vec(),
            Machine::Stage(_) | Machine::Pendulum(_) => vec![state[0]],
            Machine::TwoBodies(_) => state[..2].to_vec(),
        }
    }

    /// Returns the indices of those states that the machine's model has.
    pub fn states_of_model(&self) -> Vec<usize> {
        match self {
            Machine::Arm(_) => Arm::states_of_model(2),
            Machine::Stage(_) | Machine::Pendulum(_) => vec![0, 1],
            Machine::TwoBodies(_) => vec![0, 1, 2, 3],
        }
    }

    /// Returns directions that span the initial states of the model, see
    /// [`Machine::states_of_model`]. Directions in which all bodies move together are first.
    pub fn directions(&self) -> Vec<Vec<f64>> {
        match self {
            Machine::Arm(_) => Arm::directions(2),
            Machine::Stage(_) | Machine::Pendulum(_) => {
                vec![vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]]
            }
            Machine::TwoBodies(bodies) => bodies.directions(),
        }
    }

    /// Converts a state to the corresponding state of the machine without hidden effects.
    pub fn plain_state(&self, state: &[f64]) -> Vec<f64> {
        match self {
            Machine::Arm(_) => Arm::without_joint(state),
            Machine::Stage(_) | Machine::Pendulum(_) | Machine::TwoBodies(_) => state.to_vec(),
        }
    }

    /// Returns the axis of this name.
    pub fn axis(&mut self, name: &str) -> Option<&mut AxisForces> {
        match (self, name) {
            (Machine::Arm(arm), "theta_s") => Some(&mut arm.on_sun),
            (Machine::Arm(arm), "theta_c") => Some(&mut arm.on_carrier),
            (Machine::Stage(stage), "q") => Some(&mut stage.hidden),
            (Machine::Pendulum(pendulum), "theta") => Some(&mut pendulum.hidden),
            (Machine::TwoBodies(bodies), _) => {
                let place = bodies.axes().iter().position(|axis| *axis == name)?;
                bodies.hidden.get_mut(place)
            }
            _ => None,
        }
    }

    /// Returns the mesh of this name.
    pub fn mesh(&mut self, name: &str) -> Option<&mut Mesh> {
        match (self, name) {
            (Machine::Arm(arm), "x_sp") => Some(&mut arm.meshes[0]),
            (Machine::Arm(arm), "x_pr") => Some(&mut arm.meshes[1]),
            _ => None,
        }
    }

    /// Returns the spring of this name.
    pub fn spring(&mut self, name: &str) -> Option<&mut Spring> {
        match self {
            Machine::TwoBodies(bodies) if bodies.spring_name() == Some(name) => {
                Some(&mut bodies.spring)
            }
            _ => None,
        }
    }

    /// Multiplies a parameter by a factor; returns false if it does not exist.
    pub fn scale(&mut self, parameter: &str, factor: f64) -> bool {
        let value = match (self, parameter) {
            (Machine::Arm(arm), "b_m") => &mut arm.b_m,
            (Machine::Arm(arm), "E" | "m_c") => {
                let value = match parameter {
                    "E" => &mut arm.modulus,
                    _ => &mut arm.carrier_mass,
                };
                *value *= factor;
                arm.prepare();
                return true;
            }
            (Machine::Stage(stage), "M") => &mut stage.mass,
            (Machine::Stage(stage), "F_v") => &mut stage.viscous,
            (Machine::Pendulum(pendulum), "k") => &mut pendulum.viscous,
            (Machine::Pendulum(pendulum), "I") => &mut pendulum.inertia,
            (Machine::Pendulum(pendulum), "a") => &mut pendulum.distance,
            (Machine::TwoBodies(bodies), _) => match bodies.parameter(parameter) {
                Some(value) => value,
                None => return false,
            },
            _ => return false,
        };
        *value *= factor;
        true
    }

    /// Selects the law of dry friction on every axis.
    pub fn choose_dry(&mut self, draw: &mut RandomStream) {
        let bristles = draw.between(0.0, 1.0) < 0.5;
        let choose = |forces: &mut AxisForces, reach: f64, inertia: f64| {
            if bristles {
                forces.dry = FrictionLaw::Bristles { reach, inertia };
            }
        };
        match self {
            Machine::Arm(arm) => {
                choose(&mut arm.on_sun, 2e-3, 6e-4);
                choose(&mut arm.on_carrier, 2e-4, 0.1);
            }
            Machine::Stage(stage) => choose(&mut stage.hidden, 5e-6, stage.mass),
            Machine::Pendulum(pendulum) => choose(&mut pendulum.hidden, 3e-4, 3.3e-3),
            Machine::TwoBodies(bodies) => {
                for ((reach, inertia), axis) in
                    bodies.bristles().into_iter().zip(&mut bodies.hidden)
                {
                    choose(axis, reach, inertia);
                }
            }
        }
    }
}

impl Motion for Machine {
    fn rates(&self, t: f64, state: &[f64], input: f64, rates: &mut [f64]) {
        match self {
            Machine::Arm(arm) => arm.rates(t, state, input, rates),
            Machine::Stage(stage) => stage.rates(t, state, input, rates),
            Machine::Pendulum(pendulum) => pendulum.rates(t, state, input, rates),
            Machine::TwoBodies(bodies) => bodies.rates(t, state, input, rates),
        }
    }
}
