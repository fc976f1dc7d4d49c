//! What the whole-path tests share: the shipped specifications with their derived
//! variants ([`models`]) and the built program ([`program`]). The tests themselves are in
//! `tests/`, one subject per file.

pub mod models;
pub mod program;
