//! Results of a comparison or search. Computation: [`run`] from the input ([`origin`]) to the
//! [`result`], filled in `discovery` and `effect_sizes`; extended specification ([`write_back`]), its simulation
//! ([`mod@resimulation`]) and validation (`certification`). Texts: [`location`] of the difference,
//! `remaining_gap`, `summary`, `names`, formatted numbers (`quantity`), `experiment`. Documents: `json`, and
//! the HTML page (`page`) with `pictures`, `overlay` of measured and simulated motion, and the
//! interactive model (`playback`). Checks that return notes: wrong units (`units`), noise of a
//! given motion (`motion_noise`), noise declared too small (`declared_noise`), high noise floor (`high_floor`), common delay, lag and lead of
//! all channels (`common_delay`, `common_lag`, `held_input`), contradicted initial state
//! (`initial_states`).

mod certification;
mod common_delay;
mod common_lag;
mod declared_noise;
mod discovery;
mod effect_sizes;
mod experiment;
mod held_input;
mod high_floor;
mod initial_states;
mod json;
pub mod location;
mod motion_noise;
mod names;
pub mod origin;
mod overlay;
mod page;
mod pictures;
mod playback;
mod quantity;
mod remaining_gap;
pub mod resimulation;
pub mod result;
pub mod run;
mod summary;
mod units;
pub mod write_back;
