//! What the rates are functions of, as CasADi names it, and the Jacobians by each.

use crate::program::{Jacobian, Program, ValueId};
use crate::statements::{EmitError, Emitted};

/// An argument of the rates: its name, the sparsity of a column of it, the Jacobian of the rates
/// by it, how many numbers it has.
#[derive(Clone, Copy)]
pub(super) struct Given {
    pub(super) name: &'static str,
    pub(super) shape: &'static str,
    pub(super) jacobian: &'static str,
    pub(super) count: usize,
}

/// What the rates are functions of.
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

/// One of the Jacobians by its name.
pub(super) fn derived<'a>(program: &'a Program, name: &str) -> Emitted<&'a Jacobian<ValueId>> {
    let mut jacobians = program.outputs.jacobians.iter();
    let found = jacobians.find(|known| known.name == name);
    found.ok_or_else(|| EmitError::Value(format!("{name} was not derived")))
}
