//! Statements of the emitted functions: named values, nested expressions and loops over modes. Operations and
//! operands are those of the program, so that every backend computes the same bits.
//!
//! `stages`, `requested` and `controllers` build the functions, `preparation` the coefficients, from the shared data in
//! `file`. `body` (with `operands`, `blocks`, `rows` and `sides`) builds the `statement`s of a function from
//! `expression`s; `kernel` builds those of an elementary function, `cholesky` those of a factorisation. `indices` and `data` list the constants for callers. The backends contain the syntax of each
//! language.

mod blocks;
mod body;
mod cholesky;
mod controllers;
mod data;
mod emit_error;
mod expression;
mod file;
mod index;
mod indices;
mod kernel;
pub(crate) mod layout;
mod names;
mod needed;
mod operands;
mod preparation;
mod reactions;
mod requested;
mod roots;
mod rows;
mod sides;
mod stage;
mod stages;
mod statement;
mod step;
mod used;

pub(crate) use cholesky::{Elements, MatrixOperand, Recorder};
pub(crate) use controllers::{ControllerStage, ControllerStages, TIMES, controller_stages};
pub use data::{DataArray, DataElements, data_arrays};
pub use emit_error::EmitError;
pub(crate) use emit_error::EmitResult;
pub(crate) use expression::{Array, Expression, Operator, Structure};
pub(crate) use file::{File, quantity_line};
pub(crate) use index::{Index, Span};
pub use indices::{Indices, indices};
pub(crate) use kernel::KernelStatements;
pub(crate) use names::Words;
pub(crate) use needed::{Helper, RequiredFunctions};
pub(crate) use preparation::{Preparation, PreparedValue, describe_coefficient, preparation};
pub(crate) use requested::{jacobian_stage, rates_in_regime, requested_stages};
pub use roots::coefficient_values;
pub(crate) use roots::stage_roots;
pub(crate) use stage::{Argument, Notes, Outcome, Size, Stage};
pub(crate) use stages::{
    RATES_ORDER_DOC, describe_rate_limits, guards, mass_matrix, observables, rates,
};
pub(crate) use statement::{Place, Statement};
pub(crate) use step::{
    APPLY_REACTIONS, CLOSE_CONTACTS, FIND_REACTIONS, SEPARATE_CONTACTS, describe_step,
    reaction_constants,
};
pub(crate) use used::UsedNames;
