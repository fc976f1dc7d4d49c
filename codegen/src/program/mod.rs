//! Intermediate program of one variant: a list of values in static single assignment, and the values of each output.
//! It is the only input of the backends.
//!
//! Values that depend only on parameters are prepared once; the others are computed in each call. A value is a
//! number, a vector or a matrix of fixed size; a scalar operand is repeated for every element. Every operation has
//! one defined result in IEEE double arithmetic, every sum has a fixed order, and no operations are contracted.
//! Therefore the results of all backends are bit-identical.
//!
//! `value`, `types`, `domain` and `controllers` define programs. `lowering` builds programs from the equations of
//! motion, `evaluator` runs them, and `encoding` writes them as bytes. `cholesky` factorises matrices for all
//! backends, and `affine` computes the matrices of a piecewise-linear model. `describe` writes formulas of prepared
//! values, and `content` names values by their content. `trace` stores the terms that contribute to each value,
//! `units` infers units, and `operation_count` estimates the cost of a call.

#[cfg(feature = "derive")]
pub mod affine;
pub mod cholesky;
#[cfg(feature = "derive")]
pub mod content;
mod controllers;
#[cfg(feature = "derive")]
pub mod describe;
mod domain;
pub mod encoding;
pub mod evaluator;
#[cfg(feature = "derive")]
pub mod lowering;
#[cfg(feature = "derive")]
mod operation_count;
mod quantity;
mod trace;
mod types;
#[cfg(feature = "derive")]
pub mod units;
mod value;

pub use crate::mechanics::impact::{Friction, Impact};
pub use crate::mechanics::outputs::{
    BlockPlace, Decision, GradientDerivative, GradientRow, Jacobian, JacobianBlock, Output,
    Outputs, Products, SURFACES_OF_A_REGIME, Switch,
};
pub use crate::mechanics::outputs::{Corners, RateRow, ReactionCounts, Reactions, SlidingSurface};
pub use crate::symbolic::arguments::Arguments;
pub use crate::symbolic::variable::{Argument, Variable};
pub use controllers::{ControlOp, ControlValues, MeasuredSource, ProgramController};
pub use domain::Domain;
pub use quantity::Quantity;
pub use trace::{Trace, TraceTerm, ValueTrace};
pub use types::{
    MassBlocks, Program, ProgramField, ProgramGuard, ProgramParameter, ProgramReactions,
    ProgramTable, RowValues,
};
pub use value::{Extent, Op, PARTIAL_SUMS, ScaledValue, Value, ValueId};
