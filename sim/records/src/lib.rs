//! Measured records: what a dataset file says of them, their columns, and whether they can be
//! believed.
//!
//! The pipeline: a [`description`] is the dataset file by itself, `bound` its names and units
//! looked up in a model; `files` and `columns` (CSV, and Parquet by `parquet_file`) bring the
//! numbers of a [`record`], checked by [`samples`]; all records are a [`dataset`], examined by
//! [`checks`] and `coverage`, cut into [`windows`]. [`inputs`] are read alone for a simulation.
//! What is wrong is a [`refusal`]. Nothing here is simulated or fitted.

mod bound;
pub mod checks;
mod columns;
mod coverage;
pub mod dataset;
pub mod description;
mod files;
mod header;
pub mod inputs;
mod parquet_file;
mod read;
pub mod record;
pub mod refusal;
pub mod samples;
mod units;
pub mod windows;

pub use inputs::read_inputs;
pub use read::read_dataset;
pub use refusal::Refusal;
