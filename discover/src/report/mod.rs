//! What was found, for people and for programs: the result as documents ([`discovery`]), where
//! model and records disagree ([`location`]), the specification with what was found
//! ([`write_back`]) run again ([`mod@resimulation`]), and the [`page`].

pub mod discovery;
pub mod location;
pub mod page;
pub mod resimulation;
pub mod write_back;
