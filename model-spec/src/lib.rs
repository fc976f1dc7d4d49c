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
//! Pipeline, one file per step: `specification_file` (text of a file), `source` (text and positions), `extension`
//! (files that the specification extends), [`lexer`], [`parser`] (tokens to
//! [`ast`]), `document` (TOML tables to raw entries), `names`, `expression` and `resolve`
//! (names), `rate_order` (cycles among the rates of states), `motion` (quantities allowed in
//! each section), `units_check` and `infer` (units of every expression), `checks`,
//! `uncertainty` (spread of the parameters), [`model`] (the result). [`load()`] and [`check`]
//! run all steps; [`diagnostic`] reports the findings.
//!
//! Further modules: [`control`] (sampled controllers), [`mod@ids`] (indices into the lists of a model), [`rigid_tree`] (frames and
//! bodies), [`shape_table`] (mode shapes from a file), [`edit`] (changes that keep the comments
//! of a file), [`variant`] (changed numbers), [`assignment`] (numbers from options),
//! [`interval`] (bounds of expressions), [`mod@keys`] and [`sections`] (table of the sections and keys), [`toml_file`], [`mod@table`], [`record`] and
//! [`quantity`] (TOML files with positions), [`models`] (shipped specifications). The derivation of equations is in the
//! crate `codegen`.

mod adjacent_file;
pub mod assignment;
pub mod ast;
mod bases;
mod checks;
mod constants;
pub mod control;
pub mod diagnostic;
pub mod dimension;
mod document;
pub mod edit;
mod entries;
pub mod evaluate;
mod expression;
mod extension;
mod foreign;
mod functions;
pub mod hidden_characters;
mod id_set;
pub mod ids;
mod infer;
pub mod interval;
pub mod keys;
pub mod lexer;
mod load;
pub mod model;
pub mod models;
mod motion;
mod names;
mod observed_rate;
mod order;
pub mod parser;
pub mod quantity;
mod rate_order;
mod raw;
pub mod record;
mod resolve;
pub mod rigid_tree;
mod scale;
pub mod schema;
#[rustfmt::skip]
pub mod sections;
pub mod shape_table;
pub mod source;
mod space;
pub mod span;
mod specification_file;
pub mod suggest;
pub mod table;
pub mod toml_file;
pub mod uncertainty;
pub mod unit;
mod units_check;
pub mod variant;

pub use functions::reservation_reason;
pub use load::{Checked, check, load, load_from};
pub use specification_file::MAX_SIZE;
