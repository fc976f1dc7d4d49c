//! Models and data of an estimation: the compiled model with its measured outputs
//! ([`estimation_model`], [`simulation`]), records divided into
//! [`windows`](eomgen_records::windows), the [`unknowns`] with their priors, errors of inputs
//! ([`input_faults`]), and the [`problem`] that all fits to one dataset share. [`channel_checks`]
//! compares columns with the model, `constraint_checks` with its constraints; [`output_times`] are the times of computed outputs, `input_jumps`
//! the error between them; `admissible_states` and `allowed_directions` are those of the constraints,
//! `measured_coordinates` the first positions of a linkage;
//! `given_motion` contains the inverse dynamics; [`smoothing`] has no delay; [`stop`] ends a search
//! early, `work` a fit that costs too much.

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
