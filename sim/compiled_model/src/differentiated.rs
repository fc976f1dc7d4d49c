//! A model's program with its Jacobians: derived when they are first asked for, once.

use std::sync::{Arc, OnceLock};

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::MachineCode;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;

/// A model's program with its Jacobians, and its machine code once that is asked for.
pub(crate) struct Differentiated {
    pub(crate) program: Program,
    code: OnceLock<Option<Arc<dyn MachineCode>>>,
}

impl Differentiated {
    pub(crate) fn of(model: &Model, orders: &[usize]) -> Result<Self, Diagnostics> {
        let outputs = [Output::Jacobians, Output::TimeDerivatives];
        let program = Variant::derive_to_read(model, orders, &outputs)?.program;
        Ok(Self {
            program,
            code: OnceLock::new(),
        })
    }

    /// Compiles the program, once.
    pub(crate) fn code(&self) -> Option<&Arc<dyn MachineCode>> {
        let code = self.code.get_or_init(|| eomgen_jit::code(&self.program));
        code.as_ref()
    }
}
