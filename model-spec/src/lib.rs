//! Reads and checks a declarative specification of a mechanical system.
//!
//! The pipeline, one file each: `source` (text and places), `lexer`, `parser` (tokens to
//! [`ast`]), `document` (TOML tables to raw entries), `resolve` (names), `units_check`
//! (units of every expression), [`model`] (the result). What is wrong is said by
//! [`diagnostic`]; [`edit`] changes a specification and keeps its comments. Nothing here
//! knows how equations are derived.

pub mod ast;
pub mod model;
pub mod span;
