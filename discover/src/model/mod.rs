//! What is estimated, and on what: a specification's model that can be run ([`plant`], [`runner`]),
//! records cut into [`windows`](eomgen_records::windows), the [`unknowns`] with their priors, and
//! the estimation [`problem`] that all fits to one dataset share. [`channel_checks`] compares
//! columns with what the model expects of them; [`smoothing`] has no delay.

pub(crate) mod beside;
pub mod channel_checks;
pub mod first_state;
pub mod plant;
pub mod problem;
pub mod runner;
pub mod smoothing;
pub mod texts;
pub mod unknowns;
pub mod usual_rates;
