//! A model's program with its Jacobians: derived when they are first asked for, once.

use std::sync::Arc;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::MachineCode;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;

/// A model's program with its Jacobians, and its machine code.
pub(crate) struct Differentiated {
    pub(crate) program: Program,
    pub(crate) code: Option<Arc<dyn MachineCode>>,
}

impl Differentiated {
    pub(crate) fn of(model: &Model, orders: &[usize]) -> Result<Self, Diagnostics> {
        let outputs = [Output::Jacobians, Output::TimeDerivatives];
        let program = Variant::derive_to_read(model, orders, &outputs)?.program;
        let code = eomgen_jit::code(&program);
        Ok(Self { program, code })
    }
}
