//! Reads and checks a declarative specification of a mechanical system.
//!
//! ```
//! use eomgen_model_spec::source::Source;
//!
//! let text = r#"
//! [model]
//! name = "oscillator"
//! [parameters]
//! m = { value = 200, unit = "g" }
//! [coordinates]
//! x = { unit = "m" }
//! [kinetic]
//! mass = "1/2*m*dot(x)^2"
//! "#;
//! let model = eomgen_model_spec::check(Source::new("oscillator.toml", text))?.model;
//! assert_eq!(model.name, "oscillator");
//! assert_eq!(model.state_names(&[]), ["x", "x_dot"]);
//!
//! let wrong = text.replace("dot(x)", "x");
//! let found = eomgen_model_spec::check(Source::new("oscillator.toml", wrong.as_str()));
//! assert!(found.is_err()); // kg m^2 is no energy; the message shows where
//! # Ok::<(), eomgen_model_spec::diagnostic::Diagnostics>(())
//! ```
//!
//! The pipeline, one file each: `source` (text and places), [`lexer`], [`parser`] (tokens
//! to [`ast`]), `document` (TOML tables to raw entries), `names`, `expression` and `resolve` (names),
//! `rate_order` (rates of states that lead to no circle), `motion` (what may stand where), `units_check` and `infer` (units of every expression), `checks`, `uncertainty` (how values are spread),
//! [`model`] (the result; [`mod@ids`] say which entry of its lists is meant, [`rigid_tree`] has its frames and bodies). [`load()`] and [`check`] go all the way. What is wrong is said by
//! [`diagnostic`]; [`shape_table`] reads mode shapes from a file beside it; [`edit`] changes a specification and keeps its comments; [`variant`] sets numbers, which [`assignment`] reads from options; [`interval`] bounds them.
//! [`toml_file`] and [`mod@table`] read other files of TOML with their places as well. [`models`] are
//! the specifications shipped. Nothing here knows how
//! equations are derived.

pub mod assignment;
pub mod ast;
mod checks;
mod constants;
pub mod diagnostic;
pub mod dimension;
mod document;
pub mod edit;
mod entries;
pub mod evaluate;
mod expression;
mod file_beside;
mod foreign;
mod functions;
mod id_set;
pub mod ids;
mod infer;
pub mod interval;
mod keys;
pub mod lexer;
mod load;
pub mod model;
pub mod models;
mod motion;
mod names;
mod observed_rate;
mod order;
pub mod parser;
mod rate_order;
mod raw;
mod resolve;
pub mod rigid_tree;
mod scale;
pub mod schema;
pub mod shape_table;
pub mod source;
mod space;
pub mod span;
pub mod suggest;
pub mod table;
pub mod toml_file;
pub mod uncertainty;
pub mod unit;
mod units_check;
pub mod variant;
pub mod visible;

pub use functions::reserved;
pub use load::{Checked, MAX_SIZE, check, load, load_from};
