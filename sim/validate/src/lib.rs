//! Validation of derived equations of motion.
//!
//! [`oracle`] forms the equations a second time, from the checked model by automatic
//! differentiation; [`sampler`] draws states in every regime with [`random`] numbers; a
//! [`variant::Variant`] with [`outputs::Outputs`] is what is judged; [`checks`] compare, with a [`compiler`] for
//! emitted source; [`certify`](certify::certify) runs them and writes the
//! [`certificate`]. Nothing here knows how the equations under test were derived or
//! evaluated.
//!
//! The oracle by itself says what a right model's rows are at a state:
//!
//! ```
//! use eomgen_validate::oracle::Oracle;
//!
//! let model = eomgen_model_spec::check(eomgen_model_spec::models::PENDULUM.source())?.model;
//! let values = model.parameter_values()?;
//! let oracle = Oracle::new(&model, 0, &values)?;
//! let equations = oracle.equations(0.0, &[0.3, 0.0], &[])?;
//! let accelerations = equations.accelerations().ok_or("no inertia")?;
//! // Of M q'' + c - f nothing is left but rounding.
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
mod feasibility;
pub mod of_model;
pub mod oracle;
pub mod outputs;
pub mod random;
mod regimes;
mod sample;
pub mod sampler;
mod seek;
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
