//! Maps over parameters: a grid of parameter values, something measured at every point, in
//! parallel, in parts that survive a kill and can be computed on several machines.
//!
//! The pipeline: [`points`] of a [`grid`] (what is varied, [`parameters`] of the model) or of random [`samples`], [`measure`] (what is
//! measured; `forcing` is its period, [`span`] and [`window`] say how long is looked; [`poincare`],
//! [`lyapunov`] and [`over_time`] are measures), [`job`] (all of that as data, with a
//! hash that names it), [`folder`] and `part` (the job and its finished chunks as files),
//! [`shard`] (who computes which chunk), [`run`](mod@run) (computing them), [`merge`](mod@merge) (all chunks to one
//! table). Messages and final files are the caller's.
//!
//! ```
//! use eomgen_compiled_model::{CompiledModel, Orders};
//! use eomgen_sweep::{Axis, Folder, Grid, Job, Lyapunov, Measure, Points, Shard, Span, Window, merge, run};
//! use eomgen_sweep::{job::Plan, parameters};
//!
//! let shipped = eomgen_model_spec::models::PLANETARY_ARM;
//! let model = CompiledModel::of_text("planetary_arm.toml", shipped.text, Orders::All(0))?;
//! let grid = Points::Grid(Grid::new(vec![Axis::parse("b_sp=10e-6:50e-6:3")?])?);
//! let span = Span { transient: 2, periods: 20 };
//! let window = Window::Periods { forcing: "omega".to_owned(), span };
//! let measures: [Box<dyn Measure + '_>; 1] = [Box::new(Lyapunov::new(&model, &window)?)];
//! let plan = Plan::new(
//!     model.model().hash(),
//!     &model.model().name,
//!     model.orders(),
//!     &[],
//!     parameters::columns(model.model(), &grid)?,
//!     &grid,
//!     measures.iter().map(|measure| measure.describe()).collect(),
//! );
//! # let path = std::env::temp_dir().join(format!("eomgen-sweep-{}", std::process::id()));
//! let folder = Folder::open(&path, Job::new(plan)?)?;
//! run(&folder, &measures, Shard::WHOLE, 0, &mut |_, _| {})?;
//! let table = merge(&folder)?;
//! assert_eq!(table.column("b_sp").map(<[f64]>::len), Some(3));
//! # std::fs::remove_dir_all(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The same bytes
//!
//! A number in the result depends on the job and the point alone: a worker keeps nothing
//! from the point before, chunks are cut by the job and not by the number of threads, and
//! the table is in the order of the grid. Threads, shards, kills and resumptions therefore
//! leave no trace in it.

pub mod error;
mod failure;
pub mod folder;
mod forcing;
pub mod grid;
pub mod job;
pub mod lyapunov;
pub mod measure;
pub mod merge;
pub mod over_time;
pub mod parameters;
mod part;
pub mod poincare;
pub mod points;
pub mod run;
pub mod samples;
pub mod shard;
pub mod span;
pub mod window;

pub use error::SweepError;
pub use folder::Folder;
pub use grid::{Axis, Grid};
pub use job::Job;
pub use lyapunov::Lyapunov;
pub use measure::{Column, Description, Failure, Measure, Worker};
pub use merge::{Table, merge};
pub use over_time::OverTime;
pub use poincare::{Poincare, Section};
pub use points::Points;
pub use run::{Done, run};
pub use samples::{Sampled, Samples};
pub use shard::Shard;
pub use span::Span;
pub use window::Window;
