//! Exact simulation of models that are linear between their switching surfaces.
//!
//! Within a regime the motion is a sum of exponentials, a polynomial and the response to
//! constant and sinusoidal forces; it is stepped from switch to switch with no error but
//! rounding. The pipeline, one file each: [`model`] (what can be propagated), `parallel_guards`
//! (families of switching surfaces), `sliding` (motion held on them), `schur`, `blocks`,
//! `clustering`, `invariant`, `refine` and `decomposition` (a regime's matrix by parts that move
//! by themselves),
//! `modes`, `integrals`, `regime`, `event_function` and `step_table` (prepared for stepping), `simd_vectors`
//! and `kernels` (numbers side by side), `forced` (forced polynomials), `flow`, `event_evaluation` and
//! `cluster_flow` (the motion in a regime), `bounds` and `search` (the next switch, which
//! cannot be missed), `clock` (with `error_free`), `visited` and `adjacent` (which regimes there are, and which border on each other),
//! `outline`, `coincidence`, `dependents` and `transition` (surfaces that feel the sides of others),
//! `standing_on` (several at once), `switching`, `departure` (from a surface that held the motion), [`propagator`] (from switch to
//! switch),
//! `follow` (to a time, with samples), `simulate`; for neighbouring motions `saltation`,
//! `tangent`, [`neighbours`] and [`lyapunov`].
//!
//! What is not linear between switches belongs to [`crate::ode`].

mod adjacent;
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
mod forced;
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
mod sliding;
mod standing_on;
mod step_table;
mod switching;
mod tangent;
mod transition;
mod visited;

pub use error::ExactError;
pub use lyapunov::{Carried, Growth, Lyapunov};
pub use model::PiecewiseLinear;
pub use neighbours::Sensitivities;
pub use propagator::{Motion, Propagator};
pub use simulate::StepObserver;
