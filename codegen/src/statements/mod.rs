//! Statements of the emitted functions: named values, nested expressions and loops over modes. Operations and
//! operands are those of the program. The results of all backends are therefore bit-identical.
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
pub(crate) use controllers::{
    ControllerStage, ControllerStages, TIME_FIELDS, build_controller_stages,
};
pub use data::{DataArray, DataElements, list_data_arrays};
pub use emit_error::EmitError;
pub(crate) use emit_error::EmitResult;
pub(crate) use expression::{ArgumentStruct, Array, Expression, Operator};
pub(crate) use file::{File, describe_quantity};
pub(crate) use index::{Index, Span};
pub use indices::{Indices, list_indices};
pub(crate) use kernel::KernelStatements;
pub(crate) use names::Words;
pub(crate) use needed::{Helper, RequiredFunctions};
pub(crate) use preparation::{Preparation, PreparedValue, build_preparation, describe_coefficient};
pub(crate) use requested::{build_jacobian_stage, build_rates_in_regime, build_requested_stages};
pub use roots::collect_coefficients;
pub(crate) use roots::collect_stage_roots;
pub(crate) use stage::{Argument, Notes, Outcome, Size, Stage};
pub(crate) use stages::{
    RATES_ORDER_DOC, build_guards, build_mass_matrix, build_observables, build_rates,
    describe_rate_limits,
};
pub(crate) use statement::{Place, Statement};
pub(crate) use step::{
    APPLY_REACTIONS, CLOSE_CONTACTS, FIND_REACTIONS, SEPARATE_CONTACTS, describe_step,
    reaction_constants,
};
pub(crate) use used::UsedNames;
