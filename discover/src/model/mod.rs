//! What is estimated, and on what: a specification's model that can be run and its measured
//! outputs ([`estimation_model`], [`simulation`]), records cut into
//! [`windows`](eomgen_records::windows), the [`unknowns`] with their priors, inputs that act otherwise than recorded ([`input_faults`]), and the estimation
//! [`problem`] that all fits to one dataset share. [`channel_checks`] compares columns with what the
//! model expects of them; [`output_times`] are where quantities are computed; `given_motion` is what a motion takes that the records give; [`smoothing`] has no delay; [`stop`] ends all of it early.

pub(crate) mod affine_values;
pub mod channel_checks;
pub mod estimation_model;
pub mod first_state;
pub(crate) mod given_motion;
pub mod input_faults;
pub mod input_places;
pub mod linear_outputs;
pub(crate) mod longest_step;
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
