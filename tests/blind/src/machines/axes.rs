//! Machines of one coordinate: a stage driven by a force, and a free pendulum. States:
//! displacement, rate, bristle deflection.

use crate::friction::{AxisForces, FrictionLaw};
use crate::integrate::Motion;

/// Linear stage: M q'' = F - F_v q' + hidden forces. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Moved mass, kg.
    pub mass: f64,
    /// Viscous friction, N s/m.
    pub viscous: f64,
    /// Hidden forces.
    pub hidden: AxisForces,
}

impl Stage {
    /// Returns the stage without hidden effects.
    pub fn nominal() -> Self {
        Self {
            mass: 95.0,
            viscous: 210.0,
            hidden: AxisForces::none(FrictionLaw::Steep { speed: 2e-4 }),
        }
    }
}

impl Motion for Stage {
    fn rates(&self, t: f64, state: &[f64], input: f64, rates: &mut [f64]) {
        let (force, bending) = self.hidden.force(t, state[0], state[1], state[2], input);
        rates[0] = state[1];
        rates[1] = (input - self.viscous * state[1] + force) / self.mass;
        rates[2] = bending;
    }
}

/// Pendulum with the angle th measured from the upright position: (m a^2 + I) th'' = m g a sin(th)
/// - k th' + hidden torques. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Pendulum {
    /// Mass, kg.
    pub mass: f64,
    /// Distance from the pivot to the centre of mass, m.
    pub distance: f64,
    /// Moment of inertia about the centre of mass, kg m^2.
    pub inertia: f64,
    /// Viscous friction, N m s.
    pub viscous: f64,
    /// Acceleration of gravity, m/s^2.
    pub gravity: f64,
    /// Hidden torques.
    pub hidden: AxisForces,
}

impl Pendulum {
    /// Returns the pendulum without hidden effects.
    pub fn nominal() -> Self {
        Self {
            mass: 0.14758,
            distance: 0.14775,
            inertia: 1.091e-4,
            viscous: 2.239e-4,
            gravity: 9.81,
            hidden: AxisForces::none(FrictionLaw::Steep { speed: 1e-2 }),
        }
    }

    fn inertia_about_pivot(&self) -> f64 {
        self.mass * self.distance * self.distance + self.inertia
    }

    /// Returns the kinetic and potential energy, J, without hidden effects.
    pub fn energy(&self, state: &[f64]) -> f64 {
        0.5 * self.inertia_about_pivot() * state[1] * state[1]
            + self.mass * self.gravity * self.distance * state[0].cos()
    }
}

impl Motion for Pendulum {
    fn rates(&self, t: f64, state: &[f64], input: f64, rates: &mut [f64]) {
        let (force, bending) = self.hidden.force(t, state[0], state[1], state[2], input);
        let weight = self.mass * self.gravity * self.distance * state[0].sin();
        rates[0] = state[1];
        rates[1] = (weight - self.viscous * state[1] + force) / self.inertia_about_pivot();
        rates[2] = bending;
    }
}
