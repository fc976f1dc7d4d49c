//! Arguments of the CasADi function `rates`, and the Jacobian of the rates with respect to each argument.

use crate::program::{Jacobian, Program, ValueId};
use crate::statements::{EmitError, EmitResult};

/// Argument of the rates: its name, the sparsity of its column, the Jacobian of the rates with respect to it, and its
/// length.
#[derive(Clone, Copy)]
pub(super) struct RateArgument {
    pub(super) name: &'static str,
    pub(super) shape: &'static str,
    pub(super) jacobian: &'static str,
    pub(super) count: usize,
}

pub(super) fn rate_arguments(program: &Program) -> [RateArgument; 4] {
    let one = |name, shape, jacobian, count| RateArgument {
        name,
        shape,
        jacobian,
        count,
    };
    [
        one("t", "scalar", "rates_by_time", 1),
        one("x", "states", "rates_by_state", program.states()),
        one("u", "inputs", "rates_by_inputs", program.inputs.len()),
        one(
            "p",
            "parameters",
            "rates_by_parameters",
            program.parameters.len(),
        ),
    ]
}

pub(super) fn find_jacobian<'a>(
    program: &'a Program,
    name: &str,
) -> EmitResult<&'a Jacobian<ValueId>> {
    let mut jacobians = program.outputs.jacobians.iter();
    let found = jacobians.find(|known| known.name == name);
    found.ok_or_else(|| EmitError::Value(format!("the program lacks the Jacobian `{name}`")))
}
