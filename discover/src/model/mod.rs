//! Models and data of a fit. Models: the compiled model with its measured outputs
//! ([`estimation_model`], [`simulation`]), `admissible_states` and `allowed_directions` of
//! constraints, `measured_coordinates` for the initial positions of a linkage, `given_motion` for
//! inverse dynamics. Data: records divided into [`windows`](eomgen_records::windows), zero-phase
//! [`smoothing`], [`output_times`] of computed outputs and the interpolation error between them
//! (`input_jumps`). Unknowns: [`unknowns`] with their priors, errors of inputs ([`input_faults`]).
//! Checks: [`channel_checks`] compares columns with the model, `constraint_checks` with its
//! constraints. The [`problem`] is shared by all fits to one dataset; [`stop`] ends a search early,
//! and `work` ends a fit that costs too much.

pub(crate) mod admissible_states;
pub(crate) mod affine_values;
pub(crate) mod allowed_directions;
pub mod channel_checks;
#[cfg(test)]
mod constrained_tests;
pub(crate) mod constraint_checks;
pub mod estimation_model;
pub mod first_state;
pub(crate) mod given_motion;
pub mod input_faults;
pub(crate) mod input_jumps;
pub mod input_occurrences;
pub mod linear_outputs;
pub(crate) mod longest_step;
pub(crate) mod measured_coordinates;
pub(crate) mod measured_outputs;
pub(crate) mod nonlinear_remainder;
pub(crate) mod observed_rates;
pub mod output_times;
pub mod problem;
pub mod simulation;
pub mod smoothing;
pub mod specification_texts;
pub mod stop;
pub mod unknowns;
pub mod usual_rates;
pub(crate) mod work;
