//! Variational equations: the growth of a tangent vector along a motion of the general solver, for
//! any model.
//!
//! A [`TangentSystem`] is a [`System`](crate::ode::System) with a tangent vector v, v' = J v, which the
//! `saltation` matrix transforms at events. [`measure_growth`] integrates it over intervals and measures
//! the growth of its length (Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9-30).
//! [`piecewise_linear`](crate::piecewise_linear) has an exact version for piecewise-linear models.

mod growth;
mod saltation;
mod tangent_system;

pub use growth::{GrowthError, GrowthMeasurements, MeasurementTimes, measure_growth};
pub use tangent_system::TangentSystem;
