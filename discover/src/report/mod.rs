//! From records to a result: the whole way ([`run`]) from what is handed in ([`origin`]), the typed
//! [`result`] put together in `discovery`, where model and records disagree ([`location`]), the
//! specification with what was found ([`write_back`]) run again ([`mod@resimulation`]); how sure it is
//! (`left`) and the answer in two sentences (`summary`); documents (`json`) and the page (`page`) with its `pictures` and what was measured over what is simulated
//! (`overlay`), how numbers are written there (`quantity`), sizes that look like a wrong unit (`units`), noise of a motion that is given (`motion_noise`), channels that are all late (`late_channels`), and what was found, to be moved in the page (`playback`), and what to play next (`experiment`).

mod discovery;
mod experiment;
mod json;
mod late_channels;
mod left;
pub mod location;
mod motion_noise;
pub mod origin;
mod overlay;
mod page;
mod pictures;
mod playback;
mod quantity;
pub mod resimulation;
pub mod result;
pub mod run;
mod summary;
mod units;
pub mod write_back;
