//! From records to a result: the whole way ([`run`]), the typed [`result`] put together in
//! `discovery`, where model and records disagree ([`location`]), the specification with what was
//! found ([`write_back`]) run again ([`mod@resimulation`]); documents (`json`) and the page
//! (`page`) with its `pictures`.

mod discovery;
mod json;
pub mod location;
mod page;
mod pictures;
pub mod resimulation;
pub mod result;
pub mod run;
pub mod write_back;
