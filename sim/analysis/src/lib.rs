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
//! - [`modes`] finds the dominant mode of a flexible body. [`time_history`] reduces a time history to a
//!   number, and [`statistics`] describes samples of values.
//! - [`natural_modes`] computes the modes of a linearised machine, and [`constrained_modes`] those
//!   of a machine with constraints, from its [`allowed_motions`]. [`qr_iteration`] finds
//!   eigenvalues after `balancing`, for each group in `block_eigenvalues` and each of the
//!   `independent_parts`. `inverse_iteration` finds their shapes in a `pencil`, and `null_space`
//!   the rigid motions.
//! - [`discretisation`] computes the discrete form of a linearised machine with held inputs.

pub mod allowed_motions;
mod balancing;
mod block_eigenvalues;
pub mod classify;
pub mod constrained_modes;
pub mod discretisation;
mod error;
pub mod exponent;
mod independent_parts;
mod inverse_iteration;
pub mod modes;
pub mod natural_modes;
mod null_space;
mod pencil;
pub mod poincare;
pub mod qr_iteration;
pub mod spectrum;
pub mod statistics;
pub mod time_history;
pub mod zero_one;

#[cfg(test)]
mod maps;

pub use error::AnalysisError;
