//! Evaluators of programs at given parameter values.

use std::sync::Arc;

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, MachineCode};
use eomgen_sim::ode::NOT_POSITIVE_DEFINITE_MESSAGE;

use crate::error::Error;

/// Returns an evaluator of a program at the given values of the independent parameters, SI. It runs `code` if given,
/// and interprets the program otherwise.
pub(crate) fn prepare_evaluator(
    program: &Program,
    code: Option<&Arc<dyn MachineCode>>,
    parameters: &[f64],
) -> Evaluator {
    let program = program.clone();
    let mut evaluator = match code {
        Some(code) => Evaluator::with_code(program, code.clone()),
        None => Evaluator::new(program),
    };
    evaluator.prepare(parameters);
    evaluator
}

/// Returns the evaluator, or an error if its mass matrix is not positive definite.
pub(crate) fn require_positive_pivots(evaluator: Evaluator) -> Result<Evaluator, Error> {
    match evaluator.pivots_are_positive() {
        true => Ok(evaluator),
        false => Err(Error::Request(NOT_POSITIVE_DEFINITE_MESSAGE.to_owned())),
    }
}
