//! Arguments of the rates with CasADi's names, and the Jacobian by each.

use crate::program::{Jacobian, Program, ValueId};
use crate::statements::{EmitError, Emitted};

/// Argument of the rates: name, sparsity of its column, Jacobian of the rates by it, and length.
#[derive(Clone, Copy)]
pub(super) struct Given {
    pub(super) name: &'static str,
    pub(super) shape: &'static str,
    pub(super) jacobian: &'static str,
    pub(super) count: usize,
}

pub(super) fn given(program: &Program) -> [Given; 4] {
    let one = |name, shape, jacobian, count| Given {
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

pub(super) fn derived<'a>(program: &'a Program, name: &str) -> Emitted<&'a Jacobian<ValueId>> {
    let mut jacobians = program.outputs.jacobians.iter();
    let found = jacobians.find(|known| known.name == name);
    found.ok_or_else(|| EmitError::Value(format!("the program lacks the Jacobian `{name}`")))
}
