//! What kind of motion a sampled trajectory is: spectra, sections, exponents, tests for chaos.
//!
//! ```
//! use eomgen_analysis::exponent::mean_exponent;
//!
//! // Neighbouring motions that part by e^0.2 in every half second.
//! let exponent = mean_exponent(&[0.2; 40], 0.5)?;
//! assert!((exponent.value - 0.4).abs() < 1e-12); // 1/s
//! # Ok::<(), eomgen_analysis::AnalysisError>(())
//! ```
//!
//! Pure functions of slices. Nothing here simulates, knows of a model, draws or writes files.
//! [`spectrum`] estimates power spectral densities, [`zero_one`] tests a series for chaos,
//! [`poincare`] describes a stroboscopic section, [`exponent`] averages logarithmic growth,
//! and [`classify`] weighs these against each other by a stated rule. [`modes`] says which
//! mode of a flexible body carries the motion, [`course`] has single numbers of a course over time, [`statistics`] numbers of many values, [`natural_modes`] which modes a
//! linearised machine has, [`constrained_modes`] which one with constraints has, whose [`allowed_motions`]
//! have matrices of their own. [`qr_iteration`] finds their eigenvalues after `balancing`, `block_eigenvalues` group by group within
//! `independent_parts`, `inverse_iteration`
//! their shapes in a `pencil`, and `null_space` the rigid ones.

pub mod allowed_motions;
mod balancing;
mod block_eigenvalues;
pub mod classify;
pub mod constrained_modes;
pub mod course;
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
pub mod zero_one;

#[cfg(test)]
mod maps;

pub use error::AnalysisError;
