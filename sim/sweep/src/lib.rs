//! Maps over parameters: a grid of parameter values with measures at every point, computed in
//! parallel in chunks that survive an interruption and that several machines can share.
//!
//! Modules in the order of the computation:
//!
//! - [`points`]: a [`grid`] of varied [`parameters`], or random [`samples`];
//! - [`conditions`]: initial states and inputs of the motions;
//! - [`measure`]: interface of the measures [`poincare`], [`lyapunov`] and [`over_time`];
//!   `forcing`, [`span`] and [`window`] select their times;
//! - [`sweep`](mod@sweep): points, conditions and measures from a request;
//! - [`job`]: the request as data, with an identifying hash;
//! - [`folder`] and `part`: the job and its finished chunks as files;
//! - [`shard`]: selection of chunks for one run; [`run`](mod@run): their computation;
//!   [`merge`](mod@merge): all chunks in one table; `missing_numbers`: points without numbers.
//!
//! ```
//! use eomgen_model_spec::source::Source;
//! use eomgen_sweep::{Folder, Shard, Span, Sweep, SweepRequest, merge, run};
//!
//! let shipped = eomgen_model_spec::models::PLANETARY_ARM;
//! let model = eomgen_model_spec::check(Source::new("planetary_arm.toml", shipped.text))?.model;
//! let request = SweepRequest {
//!     vary: vec!["b_sp=10e-6:50e-6:3".to_owned()],
//!     measures: vec!["lyapunov".to_owned()],
//!     order: Some(0),
//!     frequency: "omega".to_owned(),
//!     span: Span { transient: 2, periods: 20 },
//!     ..SweepRequest::default()
//! };
//! let sweep = Sweep::new(&model, request)?;
//! let measures = sweep.measures()?;
//! # let path = std::env::temp_dir().join(format!("eomgen-sweep-{}", std::process::id()));
//! let folder = Folder::open(&path, sweep.job(&measures)?)?;
//! run(&folder, &measures, Shard::WHOLE, 0, &mut |_, _| {})?;
//! let table = merge(&folder)?;
//! assert_eq!(table.column("b_sp").map(<[f64]>::len), Some(3));
//! # std::fs::remove_dir_all(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Reproducibility
//!
//! A number in the result depends only on the job and the point. A worker keeps nothing from
//! previous points, chunks do not depend on the number of threads, and the table is in the order of
//! the points. Threads, shards, interruptions and resumed runs therefore give the same bytes.

pub mod conditions;
pub mod error;
mod failure;
pub mod folder;
mod forcing;
pub mod grid;
pub mod job;
pub mod lyapunov;
pub mod measure;
pub mod merge;
mod missing_numbers;
pub mod over_time;
pub mod parameters;
mod part;
pub mod poincare;
pub mod points;
pub mod run;
pub mod samples;
pub mod shard;
pub mod span;
pub mod sweep;
pub mod window;

pub use conditions::Conditions;
pub use error::SweepError;
pub use folder::Folder;
pub use grid::{Axis, Grid};
pub use job::Job;
pub use lyapunov::Lyapunov;
pub use measure::{Column, Description, Failure, Measure, Worker};
pub use merge::{Table, merge};
pub use missing_numbers::MissingNumbers;
pub use over_time::OverTime;
pub use poincare::{Poincare, Section};
pub use points::Points;
pub use run::{RunSummary, run, run_with_check};
pub use samples::{SampledParameter, Samples};
pub use shard::Shard;
pub use span::Span;
pub use sweep::{Sweep, SweepRequest};
pub use window::Window;
