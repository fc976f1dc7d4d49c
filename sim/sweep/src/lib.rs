//! Maps over parameters: a grid of parameter values with measures at every point, computed in
//! parallel in chunks that survive an interruption and that several machines can share.
//!
//! Modules in the order of the computation:
//!
//! - [`points`]: a [`grid`] of varied [`parameters`], or random [`samples`];
//! - [`measure`]: interface of the measures [`poincare`], [`lyapunov`] and [`over_time`];
//!   `forcing`, [`span`] and [`window`] select their times;
//! - [`job`]: all of this as data, with an identifying hash;
//! - [`folder`] and `part`: the job and its finished chunks as files;
//! - [`shard`]: selection of chunks for one run; [`run`](mod@run): their computation;
//!   [`merge`](mod@merge): all chunks in one table.
//!
//! ```
//! use eomgen_compiled_model::{CompiledModel, Orders};
//! use eomgen_sweep::{Axis, Folder, Grid, Job, Lyapunov, Measure, Points, Shard, Span, Window, merge, run};
//! use eomgen_sweep::{job::Plan, parameters};
//!
//! let shipped = eomgen_model_spec::models::PLANETARY_ARM;
//! let model = CompiledModel::from_text("planetary_arm.toml", shipped.text, Orders::Uniform(0))?;
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
//! # Reproducibility
//!
//! A number in the result depends only on the job and the point. A worker keeps nothing from
//! previous points, chunks do not depend on the number of threads, and the table is in the order of
//! the points. Threads, shards, interruptions and resumed runs therefore give the same bytes.

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
pub use run::{RunSummary, run};
pub use samples::{SampledParameter, Samples};
pub use shard::Shard;
pub use span::Span;
pub use window::Window;
