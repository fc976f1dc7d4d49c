//! Fits of a specification to records by multiple shooting. Residuals of windows: [`shooting`];
//! their derivatives: [`sensitivity`], `jump_free_quotients` of accelerations; elimination of
//! initial states: [`variable_projection`]. Steps: [`gauss_newton`] with [`bounded_least_squares`],
//! [`continuation`] from distant initial values, `final_steps` for collinear unknowns,
//! `step_refinement` for the errors of fixed steps. Fits: [`initial_states`], [`preliminary_fit`],
//! [`full_fit`] with `uncertainty` and [`residuals`]. Evaluation: [`mod@noise_floor`] of a correct
//! model, [`contradiction`]s between records that are fitted separately ([`single_record`]).

pub(crate) mod acceleration_differences;
pub mod bounded_least_squares;
pub mod continuation;
pub mod contradiction;
pub mod expression_ranges;
pub(crate) mod final_steps;
pub mod fit_result;
pub mod full_fit;
pub mod gauss_newton;
pub mod information;
pub mod initial_states;
pub(crate) mod jump_free_quotients;
pub mod linearised_fit;
pub mod noise_floor;
pub mod null_model;
pub mod preliminary_fit;
pub mod prior;
pub mod residual_spectrum;
pub mod residuals;
pub mod sensitivity;
pub mod shooting;
pub mod single_record;
pub(crate) mod step_refinement;
pub(crate) mod uncertainty;
pub mod variable_projection;
