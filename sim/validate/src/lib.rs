//! Validation of derived equations of motion.
//!
//! The [`oracle`] computes the equations of motion a second time, by automatic differentiation of the expressions of
//! the checked model. It shares no code with the derivation under test. The [`sampler`] draws [`random`] states in
//! every regime. The [`checks`] compare a [`variant::Variant`] and its [`outputs::Outputs`] with the oracle, and a
//! [`compiler`] builds the emitted source. Hand-written equations of known machines are [`mod@references`].
//! [`certify`](certify::certify) runs all checks and writes the [`certificate`]; [`model_certificate`] certifies a
//! model with its emitted source. [`meaning`] describes the checks in words. [`rounding`] bounds the rounding errors of
//! a variant. [`instructions`] bounds the instructions and the stack of the compiled C.
//!
//! Example: residuals of the oracle's own accelerations of a pendulum.
//!
//! ```
//! use eomgen_validate::oracle::Oracle;
//!
//! let model = eomgen_model_spec::check(eomgen_model_spec::models::PENDULUM.source())?.model;
//! let values = model.parameter_values()?;
//! let oracle = Oracle::new(&model, 0, &values)?;
//! let equations = oracle.equations(0.0, &[0.3, 0.0], &[])?;
//! let accelerations = equations.accelerations().ok_or("no inertia")?;
//! // The residual M q'' + c - f is zero to rounding.
//! for row in equations.residuals(accelerations.as_slice()) {
//!     assert!(row.value.abs() <= 1e-14 * row.scale);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod certificate;
pub mod certify;
pub mod checks;
pub mod compiler;
pub mod coverage;
pub mod derived;
pub mod derived_outputs;
mod differences;
pub mod double_double;
mod feasibility;
pub mod instructions;
pub mod meaning;
pub mod model_certificate;
pub mod oracle;
pub mod outputs;
mod overflow;
pub mod random;
pub mod references;
mod regime_search;
mod regimes;
pub mod rounding;
mod sample;
pub mod sampler;
mod sizes;
pub mod variant;

#[cfg(test)]
mod test_models;
#[cfg(test)]
mod test_outputs;
#[cfg(test)]
mod test_variants;
#[cfg(test)]
mod tests;
