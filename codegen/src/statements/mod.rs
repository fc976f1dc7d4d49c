//! From a program to the statements of its functions: which values get a name, which stand
//! inside the expressions that use them, which become loops over modes. Operations and operands
//! stay as the program has them, so that every backend that prints statements gives its bits.
//!
//! `stages` and `requested` are the functions, `preparation` what comes before them, `file` what
//! all of them are written from; `body` (with `operands`, and `blocks` for matrices, `rows`,
//! `sides`) makes the `statement`s of one out of `expression`s; `kernel` those of an elementary
//! function. What a language looks like is the backends' business.

mod blocks;
mod body;
mod emit_error;
mod expression;
mod file;
mod index;
mod kernel;
pub(crate) mod layout;
mod names;
mod needed;
mod operands;
mod preparation;
mod requested;
mod roots;
mod rows;
mod sides;
mod stage;
mod stages;
mod statement;
mod used;

pub use emit_error::EmitError;
pub(crate) use emit_error::Emitted;
pub(crate) use expression::{Array, Expression, Operator, Structure};
pub(crate) use file::{File, quantity_line};
pub(crate) use index::Index;
pub(crate) use kernel::{KernelStatements, describe_elementary};
pub(crate) use names::Words;
pub(crate) use needed::Needed;
pub(crate) use preparation::{Preparation, Prepared, preparation};
pub(crate) use requested::{nonzeros, rates_in_regime, requested};
pub(crate) use roots::stage_roots;
pub(crate) use stage::{Argument, Outcome, Size, Stage};
pub(crate) use stages::{ORDER, guards, mass_matrix, observables, rates, where_they_end};
pub(crate) use statement::{Place, Statement};
pub(crate) use used::Used;
