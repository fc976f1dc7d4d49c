//! Results of a comparison or search: the whole computation ([`run`]) from the input ([`origin`]),
//! the [`result`] types filled in `discovery`, the [`location`] of the difference, the extended
//! specification ([`write_back`]) and its simulation ([`mod@resimulation`]), the remaining gap
//! (`remaining_gap`) and the `summary` in two sentences, documents (`json`) and the page (`page`) with its
//! `pictures` and the `overlay` of measurement and simulation, checks of the extended equations (`certification`), formatted numbers (`quantity`),
//! sizes that suggest a wrong unit (`units`), noise of a given motion (`motion_noise`), a common
//! delay (`common_delay`), lag (`common_lag`) or lead (`held_input`), a stated initial state that records contradict
//! (`initial_states`), the interactive model (`playback`), and the next `experiment`.

mod certification;
mod common_delay;
mod common_lag;
mod discovery;
mod experiment;
mod held_input;
mod high_floor;
mod initial_states;
mod json;
pub mod location;
mod motion_noise;
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
