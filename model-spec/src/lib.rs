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
//! assert!(found.is_err()); // kg m^2 is not the unit of an energy; the message contains the location
//! # Ok::<(), eomgen_model_spec::diagnostic::Diagnostics>(())
//! ```
//!
//! Pipeline, one file per step: `specification_file` (text of a file), `source` (text and positions), `extension`
//! (files that the specification extends), [`lexer`], [`parser`] (tokens to [`ast`]), `document` (TOML tables to raw
//! entries), `names`, `expression` and `resolve` (names), `rate_order` (cycles among the rates of states), `motion`
//! (quantities allowed in each section), `units_check` and `infer` (units of every expression), `checks`,
//! `uncertainty` (spread of the parameters), [`model`] (the result). [`load()`] and [`check`] run all steps;
//! [`diagnostic`] contains their errors and warnings.
//!
//! Further modules: [`argument`] (names of arguments in messages), [`control`] (sampled controllers) and [`schedule`] (their times), [`mod@ids`] (indices into the lists of a model), [`rigid_tree`] (frames and
//! bodies), [`foreign`] (usual notations of other languages), [`shape_table`] (mode shapes from a file), [`edit`] (changes that keep the comments
//! of a file), [`variant`] (changed numbers), [`assignment`] (numbers from options),
//! [`interval`] (bounds of expressions), [`mod@keys`] and [`sections`] (table of the sections and keys), [`toml_file`], [`mod@table`], [`record`] and
//! [`quantity`] (TOML files with positions), [`models`] (shipped specifications). The derivation of equations is in the
//! crate `codegen`.

#[cfg(feature = "read")]
mod adjacent_file;
pub mod argument;
#[cfg(feature = "read")]
pub mod assignment;
#[cfg(feature = "read")]
pub mod ast;
#[cfg(feature = "read")]
mod bases;
#[cfg(feature = "read")]
mod checks;
#[cfg(feature = "read")]
mod constants;
#[cfg(feature = "read")]
pub mod control;
#[cfg(feature = "read")]
pub mod diagnostic;
#[cfg(feature = "read")]
pub mod dimension;
#[cfg(feature = "read")]
mod document;
#[cfg(feature = "read")]
pub mod edit;
#[cfg(feature = "read")]
mod entries;
#[cfg(feature = "read")]
pub mod evaluate;
#[cfg(feature = "read")]
mod expression;
#[cfg(feature = "read")]
mod extension;
#[cfg(feature = "read")]
pub mod foreign;
pub mod function;
#[cfg(feature = "read")]
mod functions;
mod greek;
#[cfg(feature = "read")]
pub mod hidden_characters;
#[cfg(feature = "read")]
mod id_set;
pub mod ids;
#[cfg(feature = "read")]
mod infer;
pub mod interval;
#[cfg(feature = "read")]
pub mod keys;
#[cfg(feature = "read")]
pub mod lexer;
#[cfg(feature = "read")]
mod load;
#[cfg(feature = "read")]
pub mod model;
#[cfg(feature = "read")]
pub mod models;
#[cfg(feature = "read")]
mod motion;
#[cfg(feature = "read")]
mod names;
#[cfg(feature = "read")]
mod observed_rate;
#[cfg(feature = "read")]
mod order;
#[cfg(feature = "read")]
pub mod parser;
#[cfg(feature = "read")]
mod positions;
#[cfg(feature = "read")]
pub mod quantity;
#[cfg(feature = "read")]
mod rate_order;
#[cfg(feature = "read")]
mod raw;
#[cfg(feature = "read")]
pub mod record;
#[cfg(feature = "read")]
mod resolve;
#[cfg(feature = "read")]
pub mod rigid_tree;
#[cfg(feature = "read")]
mod scale;
pub mod schedule;
#[cfg(feature = "read")]
pub mod schema;
#[rustfmt::skip]
#[cfg(feature = "read")]
pub mod sections;
#[cfg(feature = "read")]
pub mod shape_table;
#[cfg(feature = "read")]
pub mod source;
#[cfg(feature = "read")]
mod space;
#[cfg(feature = "read")]
pub mod span;
#[cfg(feature = "read")]
mod specification_file;
#[cfg(feature = "read")]
pub mod suggest;
#[cfg(feature = "read")]
pub mod table;
#[cfg(feature = "read")]
pub mod toml_file;
#[cfg(feature = "read")]
pub mod uncertainty;
#[cfg(feature = "read")]
pub mod unit;
#[cfg(feature = "read")]
mod units_check;
#[cfg(feature = "read")]
pub mod variant;

#[cfg(feature = "read")]
pub use checks::list_unused_inputs;
#[cfg(feature = "read")]
pub use functions::reservation_reason;
#[cfg(feature = "read")]
pub use load::{Checked, check, load, load_from};
#[cfg(feature = "read")]
pub use specification_file::MAX_SIZE;
