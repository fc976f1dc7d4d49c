//! A derived model that can be run.

pub mod driven;
