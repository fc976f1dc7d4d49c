//! Operations that switch between sides, and the guard of a derivative on flat sides.

use eomgen_model_spec::model::Function;

use crate::symbolic::operation::{NodeId, Operation};

/// Factor of a derivative with a guard on flat sides.
#[derive(Clone, Copy)]
pub(crate) struct FlatGuard {
    /// Node that is 0 on flat sides.
    pub(super) activity: NodeId,
    /// Factor elsewhere.
    pub(super) inner: NodeId,
    /// True if terms keep the guard even without a reciprocal of a root.
    pub(super) is_permanent: bool,
}

impl FlatGuard {
    /// Returns the guard with `is_permanent` set.
    pub(super) fn permanent(self) -> Self {
        Self {
            is_permanent: true,
            ..self
        }
    }
}

/// Returns true if an operation switches between sides.
pub(super) fn is_switch(operation: &Operation) -> bool {
    match operation {
        Operation::Select { is_switch, .. } => *is_switch,
        Operation::Call(function, _) => matches!(
            function,
            Function::Max
                | Function::Min
                | Function::Deadzone
                | Function::Contact
                | Function::Above
        ),
        _ => false,
    }
}
