//! Shared code of the integration tests: shipped specifications with their derived variants ([`models`]), generated
//! models with their motions ([`motions`]) or certificates ([`certified`]), random correct models ([`smooth_models`]),
//! the built program ([`program`]), commands in the documentation ([`pages`]), synthetic records ([`measured`], with
//! [`logistic_noise`], [`moving_base`] with [`moving_machines`], and [`constrained_records`] of
//! [`constrained_machines`]) and the arm integrated in extended precision ([`taylor`]).

pub mod certified;
pub mod constrained_machines;
pub mod constrained_records;
pub mod contact_machines;
pub mod logistic_noise;
pub mod measured;
pub mod models;
pub mod motions;
pub mod moving_base;
pub mod moving_machines;
pub mod pages;
pub mod piecewise;
pub mod program;
pub mod random_numbers;
pub mod runge_kutta;
pub mod smooth_models;
pub mod taylor;
