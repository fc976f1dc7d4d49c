//! Comparison of derived equations, coefficients and certificates with independent computations.

mod certificates;
mod certified;
mod coefficients;
mod inverse_dynamics;
mod linearity;
mod rounding_bounds;
mod single_modes;
mod smooth_models;
mod two_link_arm;
