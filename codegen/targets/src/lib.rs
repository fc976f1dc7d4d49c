//! Emitted files of a model in the languages and interfaces of [`Target`], for the command line and the Python package.
//!
//! ```
//! use eomgen_codegen::variant::Variant;
//! use eomgen_model_spec::models::PENDULUM;
//! use eomgen_model_spec::source::Source;
//! use eomgen_targets::{Target, emit, outputs};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = eomgen_model_spec::check(Source::new("pendulum.toml", PENDULUM.text))?.model;
//! let outputs = outputs(Target::C99, &[])?;
//! let variant = Variant::derive_with(&model, &[], &outputs)?;
//! let files = emit(&model, &variant, Target::C99, &|_| {})?;
//! let names: Vec<&str> = files.iter().map(|file| &*file.name).collect();
//! assert_eq!(names, ["pendulum.c", "pendulum.h"]);
//! # Ok(())
//! # }
//! ```

mod acados;
pub mod archive;
mod emission;
mod error;
mod file;
mod fmu;
mod target;

pub use emission::{emit, outputs, parse_output};
pub use error::EmissionError;
pub use file::EmittedFile;
pub use target::Target;
