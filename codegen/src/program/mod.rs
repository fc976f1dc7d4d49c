//! The intermediate program of one variant: a list of values in static single assignment,
//! each computed from values before it, and which of them answer which question. Backends
//! read nothing else.
//!
//! Values that depend on parameters alone are prepared once; the rest is computed per
//! call. A value is a number, a vector or a matrix of fixed extent; a scalar operand
//! stands for every element. Every operation has one defined result in IEEE double
//! arithmetic, every sum has its order, and nothing is contracted, so that all backends give
//! the same bits.
//!
//! `value` and `types` (what a program is made of), `lowering` (from the equations of motion to it),
//! `evaluator` (runs it), `affine` (the matrices of a piecewise-linear model), `describe` (what a
//! prepared value is), `operation_count` (what a call costs).

pub mod affine;
pub mod describe;
pub mod evaluator;
pub mod lowering;
mod operation_count;
mod types;
mod value;

pub use crate::mechanics::impacts::Impact;
pub use crate::mechanics::outputs::SlidingSurface;
pub use crate::mechanics::outputs::{
    BlockPlace, Decided, GradientDerivative, GradientRow, Jacobian, JacobianBlock, Output, Outputs,
    Products, SURFACES_OF_A_REGIME, Switch,
};
pub use crate::symbolic::arguments::Arguments;
pub use crate::symbolic::graph::{Argument, Variable};
pub use types::{
    MassBlocks, Program, ProgramField, ProgramGuard, ProgramParameter, ProgramTable, Quantity,
    RowValues,
};
pub use value::{Extent, Op, PARTIAL_SUMS, ScaledValue, Value, ValueId};
