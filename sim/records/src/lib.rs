//! Measured records: dataset files, columns of records, and checks of both.
//!
//! Pipeline:
//!
//! - a [`description`] is the parsed dataset file; `bound` looks up its names and units in a model;
//! - `files` and `columns` (text by `csv_file` with its `number`s, Parquet by `parquet_file`) read the numbers of a
//!   [`record`], whose time `clock` counts from the first sample without rounding (`decimal`);
//! - `wrapped_columns` (`unwrapping`, `wrap_detection`, `wrap_period`) unwraps columns of the `used_part` of a file,
//!   from their `initial_readings`, `decimation` reduces samples, [`samples`] checks them, and `record_parts` splits records at `gaps`;
//! - if the records give the motion (`given_motion`), `motion_rates` adds rates and `rest` removes
//!   samples at rest;
//! - a [`dataset`] contains all records; [`checks`] and `coverage` examine it, and [`windows`]
//!   split it.
//!
//! [`inputs`] are read separately for a simulation. [`feedback`] replaces controllers by their recorded outputs. [`mod@noise`] is estimated from a single
//! column. A [`proposal`] is a dataset file for a record that has none. A [`refusal`] is an error.
//! This crate does not simulate or fit anything.
//!
//! ```
//! use eomgen_records::read_dataset;
//!
//! # let folder = std::env::temp_dir().join(format!("eomgen-records-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! for (name, amplitude) in [("small.csv", 100.0), ("large.csv", 200.0)] {
//!     let times = (0..200).map(|k| f64::from(k) * 0.01);
//!     let rows = times.map(|t| format!("{t},{}\n", amplitude * (3.0 * t).cos()));
//!     std::fs::write(folder.join(name), format!("t,theta\n{}", rows.collect::<String>()))?;
//! }
//! let dataset = folder.join("dataset.toml");
//! std::fs::write(&dataset, r#"
//! title = "Pendulum, released from rest"
//! [records]
//! train = ["small.csv"]
//! test = ["large.csv"]
//! [time]
//! column = "t"
//! unit = "s"
//! [channels.theta]
//! column = "theta"
//! unit = "mrad"
//! noise = 0.1
//! "#)?;
//! let model = eomgen_model_spec::check(eomgen_model_spec::models::PENDULUM.source())?.model;
//! let read = read_dataset(&dataset, &model)?;
//! // All values are in SI.
//! assert_eq!(read.channels[0].noise, 1e-4);
//! assert_eq!(read.train[0].channels[0][0], 0.1);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod binding;
pub mod checks;
mod clock;
mod columns;
mod computed_observables;
mod coverage;
mod csv_file;
pub mod dataset;
mod dataset_reader;
mod decimal;
mod decimation;
pub mod description;
pub mod experiment;
pub mod feedback;
mod files;
mod gaps;
mod given_motion;
mod header;
mod initial_readings;
pub mod inputs;
mod motion_rates;
pub mod noise;
mod number;
mod outliers;
mod parquet_file;
pub mod proposal;
pub mod record;
mod record_parts;
pub mod refusal;
mod rest;
pub mod samples;
mod units;
mod unwrapping;
mod used_part;
pub mod windows;
mod wrap_detection;
mod wrap_period;
mod wrapped_columns;

pub use dataset_reader::read_dataset;
pub use inputs::{RecordInputs, read_inputs};
pub use proposal::propose_dataset;
pub use refusal::Refusal;
