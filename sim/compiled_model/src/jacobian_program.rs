//! Program of a model with its Jacobians, lowered at first use.

use std::sync::{Arc, OnceLock};

use eomgen_codegen::mechanics::equations::Equations;
use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::MachineCode;
use eomgen_codegen::variant::lower_with_derivatives;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;

/// Outputs with every entry of every Jacobian.
pub(crate) const ENTRY_BY_ENTRY: [Output; 2] = [Output::Jacobians, Output::TimeDerivatives];

/// Outputs with one derivative along a direction, which all variables share.
pub(crate) const ALONG_DIRECTION: [Output; 2] = [Output::Tangents, Output::TimeDerivatives];

/// Program of a model with its Jacobians; its machine code is compiled at first use.
pub(crate) struct JacobianProgram {
    pub(crate) program: Program,
    code: OnceLock<Option<Arc<dyn MachineCode>>>,
}

impl JacobianProgram {
    pub(crate) fn lower(
        model: &Model,
        equations: &Equations,
        outputs: &[Output],
    ) -> Result<Self, Diagnostics> {
        lower_with_derivatives(model, equations, outputs).map(Self::new)
    }

    pub(crate) fn new(program: Program) -> Self {
        Self {
            program,
            code: OnceLock::new(),
        }
    }

    pub(crate) fn machine_code(&self) -> Option<&Arc<dyn MachineCode>> {
        let code = self.code.get_or_init(|| eomgen_jit::code(&self.program));
        code.as_ref()
    }
}
