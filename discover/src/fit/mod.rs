//! A specification fitted to records by multiple shooting: residuals of windows ([`shooting`]),
//! how they depend on initial states and unknowns ([`sensitivity`]), initial states eliminated
//! ([`variable_projection`]), steps ([`gauss_newton`] with [`bounded_least_squares`],
//! [`continuation`] from far away, `whole_motions` where unknowns share a direction),
//! [`initial_states`]; a [`preliminary`] fit and a [`full`] one, the `uncertainty` of what is
//! estimated, the [`residuals`] that are left, the [`mod@noise_floor`] that a right model would leave,
//! and the [`contradiction`]s among records, each fitted [`alone`].

pub(crate) mod acceleration_differences;
pub mod alone;
pub mod bounded_least_squares;
pub mod continuation;
pub mod contradiction;
pub mod fitted;
pub mod full;
pub mod gauss_newton;
pub mod information;
pub mod initial_states;
pub mod linearised;
pub mod noise_floor;
pub mod null_model;
pub mod preliminary;
pub mod prior;
pub mod residual_spectrum;
pub mod residuals;
pub mod sensitivity;
pub mod shooting;
pub mod travels;
pub(crate) mod uncertainty;
pub mod variable_projection;
pub(crate) mod whole_motions;
