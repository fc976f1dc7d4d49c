//! Textbook equations of the other machines, one file per machine. Each file contains the mass matrix and forces with
//! the coordinates and parameter names of the specification of the same name.
//!
//! A missing optional parameter (damping or inertia) counts as 0.

mod cart_two_arms;
mod chaplygin_sleigh;
mod crane;
mod double_pendulum;
mod emps;
mod furuta_pendulum;
mod hub_beam_tip_mass;
mod linear_system;
mod loudspeaker;
mod pendulum;
mod puma_560;
mod quadrotor_slung_load;
mod shaft_and_disc;
mod two_link_arm;

use eomgen_model_spec::models::{self, ShippedModel};
use thiserror::Error;

use crate::references::evaluation::Evaluation;

/// State, parameters and inputs for the evaluation of a closed form.
pub struct StateAndParameters<'a> {
    /// Parameters by name, SI.
    pub parameter: &'a dyn Fn(&str) -> Option<f64>,
    /// Inputs by name, SI; an input without a value is 0.
    pub input: &'a dyn Fn(&str) -> Option<f64>,
    /// Truncation order of the flexible field, 0 without a field.
    pub order: usize,
    /// Coordinates in the order of the specification, modes, rates of coordinates and modes, then first-order states.
    pub state: &'a [f64],
}

/// Accelerations of a machine in the order of its coordinates, then rates of first-order states,
/// with row scales.
pub type ClosedForm = fn(&StateAndParameters<'_>) -> Result<Evaluation, NotApplicable>;

/// Reason why a closed form does not apply.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NotApplicable {
    /// A required parameter is missing.
    #[error("the closed form needs the parameter {0}")]
    Parameter(&'static str),
    /// The number of entries of the state differs from this number.
    #[error("the closed form needs a state of {0} entries")]
    State(usize),
    /// The mass matrix is singular.
    #[error("the closed form's mass matrix is singular")]
    Mass,
}

/// Shipped models and their closed forms.
pub const CLOSED_FORMS: [(ShippedModel, ClosedForm); 13] = [
    (models::CART_TWO_ARMS, cart_two_arms::accelerations),
    (models::CHAPLYGIN_SLEIGH, chaplygin_sleigh::accelerations),
    (models::CRANE, crane::accelerations),
    (models::DOUBLE_PENDULUM, double_pendulum::accelerations),
    (models::EMPS, emps::accelerations),
    (models::FURUTA_PENDULUM, furuta_pendulum::accelerations),
    (models::HUB_BEAM_TIP_MASS, hub_beam_tip_mass::accelerations),
    (models::LOUDSPEAKER, loudspeaker::accelerations),
    (models::PENDULUM, pendulum::accelerations),
    (models::PUMA_560, puma_560::accelerations),
    (
        models::QUADROTOR_SLUNG_LOAD,
        quadrotor_slung_load::accelerations,
    ),
    (models::SHAFT_AND_DISC, shaft_and_disc::accelerations),
    (models::TWO_LINK_ARM, two_link_arm::accelerations),
];

impl StateAndParameters<'_> {
    fn required(&self, name: &'static str) -> Result<f64, NotApplicable> {
        (self.parameter)(name).ok_or(NotApplicable::Parameter(name))
    }

    /// Returns a parameter, or 0 if it is missing.
    fn optional(&self, name: &str) -> f64 {
        (self.parameter)(name).unwrap_or(0.0)
    }

    /// Returns an input, or 0 without a value.
    fn input(&self, name: &str) -> f64 {
        (self.input)(name).unwrap_or(0.0)
    }

    /// Returns coordinates and rates of a machine with `N` coordinates and no field.
    fn motion<const N: usize>(&self) -> Result<([f64; N], [f64; N]), NotApplicable> {
        let (position, rate) = self.state.split_at(self.state.len() / 2);
        match (position.try_into(), rate.try_into()) {
            (Ok(position), Ok(rate)) => Ok((position, rate)),
            _ => Err(NotApplicable::State(2 * N)),
        }
    }
}
