//! Elementary functions that the stages call, written from their kernels. All arguments are numbers, and no function
//! calls another one.

use wasm_encoder::Function;

use super::code::Code;
use super::indices::Indices;
use super::memory::Memory;
use crate::program::Program;
use crate::statements::{EmitResult, Expression, KernelStatements, RequiredFunctions, Statement};
use eomgen_elementary::{Double, Function as Elementary};

#[derive(Debug)]
pub(super) struct Helper {
    pub(super) name: &'static str,
    pub(super) arguments: &'static [&'static str],
    computed: Vec<Statement>,
    value: Expression,
}

impl Helper {
    pub(super) fn function(
        &self,
        program: &Program,
        memory: &mut Memory,
        functions: &Indices,
    ) -> EmitResult<Function> {
        let mut code = Code::new(program, memory, functions, self.arguments);
        code.statements(&self.computed)?;
        code.expression(&self.value)?;
        Ok(code.finish())
    }
}

pub(super) fn build_helpers(needed: &RequiredFunctions) -> Vec<Helper> {
    needed
        .kernels
        .iter()
        .copied()
        .filter_map(build_helper)
        .collect()
}

fn build_helper(function: Elementary) -> Option<Helper> {
    let kernel = KernelStatements::new::<Double>(function);
    Some(Helper {
        name: function.name(),
        arguments: function.arguments(),
        value: kernel.value()?.clone(),
        computed: kernel.computed,
    })
}
