//! Classification of sampled motions, and natural modes of linearised machines.
//!
//! ```
//! use eomgen_analysis::exponent::mean_exponent;
//!
//! // Neighbouring motions separate by e^0.2 in every half second.
//! let exponent = mean_exponent(&[0.2; 40], 0.5)?;
//! assert!((exponent.value - 0.4).abs() < 1e-12); // 1/s
//! # Ok::<(), eomgen_analysis::AnalysisError>(())
//! ```
//!
//! All functions are pure functions of slices.
//!
//! - [`spectrum`] estimates power spectral densities, [`zero_one`] tests a series for chaos,
//!   [`poincare`] describes a stroboscopic section, and [`exponent`] averages logarithmic growth.
//!   [`classify`] combines them by one rule.
//! - [`modes`] finds the dominant mode of a flexible body, and [`statistics`] describes samples of values.
//! - [`natural_modes`] computes the modes of a linearised machine, and [`constrained_modes`] those
//!   of a machine with constraints, from its `independent_states`. [`allowed_motions`] are an
//!   orthonormal basis of its small motions. [`qr_iteration`] finds eigenvalues after `balancing`,
//!   for each group in `block_eigenvalues` and each of the `independent_parts`. `inverse_iteration`
//!   finds their shapes in a `pencil`, and `null_space` the rigid motions.
//! - [`discretisation`] computes the discrete form of a linearised machine with held inputs.

#[cfg(feature = "full")]
pub mod allowed_motions;
#[cfg(feature = "full")]
mod balancing;
#[cfg(feature = "full")]
mod block_eigenvalues;
#[cfg(feature = "full")]
pub mod classify;
#[cfg(feature = "full")]
pub mod constrained_modes;
#[cfg(feature = "full")]
pub mod discretisation;
#[cfg(feature = "full")]
mod error;
#[cfg(feature = "full")]
pub mod exponent;
#[cfg(feature = "full")]
mod independent_parts;
#[cfg(feature = "full")]
mod independent_states;
#[cfg(feature = "full")]
mod inverse_iteration;
#[cfg(feature = "full")]
pub mod modes;
#[cfg(feature = "full")]
pub mod natural_modes;
#[cfg(feature = "full")]
mod null_space;
#[cfg(feature = "full")]
mod pencil;
#[cfg(feature = "full")]
pub mod poincare;
pub mod qr_iteration;
#[cfg(feature = "full")]
mod rounding;
#[cfg(feature = "full")]
pub mod spectrum;
#[cfg(feature = "full")]
pub mod statistics;
#[cfg(feature = "full")]
#[cfg(feature = "full")]
pub mod zero_one;

#[cfg(test)]
#[cfg(feature = "full")]
mod maps;

#[cfg(feature = "full")]
pub use error::AnalysisError;
