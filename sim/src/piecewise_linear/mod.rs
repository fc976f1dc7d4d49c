//! Exact simulation of piecewise-linear models.
//!
//! Within a regime the motion is a sum of exponentials, a polynomial and the response to constant and
//! sinusoidal forces. It is propagated from event to event with rounding errors only. Files:
//!
//! | task | files |
//! | --- | --- |
//! | models and parallel switching surfaces | [`model`], `parallel_guards`, `sliding` |
//! | decomposition of a regime's matrix into invariant parts | `schur`, `blocks`, `clustering`,
//! `invariant`, `refine`, `decomposition` |
//! | preparation of a regime | `modes`, `integrals`, `regime`, `event_function`, `step_table` |
//! | SIMD | `simd_vectors`, `kernels` |
//! | motion in a regime | `forced_integrals`, `flow`, `event_evaluation`, `cluster_flow` |
//! | search for the next event, which cannot be missed | `bounds`, `search` |
//! | time with two parts | `clock`, `error_free` |
//! | regimes and their neighbours | `visited_regimes`, `adjacent_regimes` |
//! | surfaces that depend on other surfaces | `outline`, `coincidence`, `dependents`,
//! `transition`, `simultaneous_surfaces`, `switching`, `departure` |
//! | simulation | [`propagator`], `follow`, `simulate` |
//! | tangent vectors | `saltation`, `tangent`, [`neighbours`], [`lyapunov`] |
//!
//! The module [`crate::ode`] simulates all other models.

mod adjacent_regimes;
mod blocks;
mod bounds;
mod clock;
mod cluster_flow;
mod clustering;
mod coincidence;
mod decomposition;
mod departure;
mod dependents;
pub mod derivative;
pub mod error;
mod error_free;
mod event_evaluation;
mod event_function;
mod flow;
mod follow;
mod forced_integrals;
mod integrals;
mod invariant;
mod kernels;
pub mod lyapunov;
pub mod model;
mod modes;
pub mod neighbours;
mod outline;
mod parallel_guards;
pub mod propagator;
mod refine;
mod regime;
mod saltation;
mod schur;
mod search;
mod simd_vectors;
mod simulate;
mod simultaneous_surfaces;
mod sliding;
mod step_table;
mod switching;
mod tangent;
mod transition;
mod visited_regimes;

pub use error::ExactError;
pub use lyapunov::{LyapunovGrowth, LyapunovRequest, MotionWithTangents};
pub use model::PiecewiseLinear;
pub use neighbours::Sensitivities;
pub use propagator::{Motion, Propagator};
pub use simulate::StepObserver;
