//! Exact simulation of models that are linear between their switching surfaces.
//!
//! Within a regime the motion is a sum of exponentials, a polynomial and the response to
//! constant and sinusoidal forces; it is stepped from switch to switch with no error but
//! rounding. The pipeline, one file each: [`model`] (what can be propagated), `groups`
//! (parallel switching surfaces), `sliding` (motion held on them), `schur`, `blocks`,
//! `grouping`, `invariant`, `refine` and `decomposition` (a regime's matrix by parts that move
//! by themselves),
//! `modes`, `integrals`, `regime`, `functional` and `ladder` (prepared for stepping), `lanes`
//! and `kernels` (numbers side by side), `forced` (forced polynomials), `flow`, `watched` and
//! `cluster_flow` (the motion in a regime), `bounds` and `search` (the next switch, which
//! cannot be missed), `clock` (with `error_free`), `entered` and `beyond` (which regimes there are, and where limits lead),
//! `outline`, `coincidence`, `dependents` and `passage` (surfaces that feel the sides of others),
//! `switching`, `departure` (from a surface that held the motion), [`propagator`] (from switch to
//! switch),
//! `follow` (to a time, with samples), `simulate`; for neighbouring motions `saltation`,
//! `tangent`, `neighbours`, [`lyapunov`] and [`sensitivity`].
//!
//! What is not linear between switches belongs to [`crate::ode`].

mod beyond;
mod blocks;
mod bounds;
mod clock;
mod cluster_flow;
mod coincidence;
mod decomposition;
mod departure;
mod dependents;
pub mod derivative;
mod entered;
pub mod error;
mod error_free;
mod flow;
mod follow;
mod forced;
mod functional;
mod grouping;
mod groups;
mod integrals;
mod invariant;
mod kernels;
mod ladder;
mod lanes;
pub mod lyapunov;
pub mod model;
mod modes;
mod neighbours;
mod outline;
mod passage;
pub mod propagator;
mod refine;
mod regime;
mod saltation;
mod schur;
mod search;
pub mod sensitivity;
mod simulate;
mod sliding;
mod switching;
mod tangent;
mod watched;

pub use error::ExactError;
pub use lyapunov::{Carried, Growth, Lyapunov};
pub use model::PiecewiseLinear;
pub use propagator::{Motion, Propagator};
pub use sensitivity::{By, Sensitivities};
