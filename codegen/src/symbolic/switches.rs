//! Operations that switch, and guards that set a factor of a derivative to 0 on the flat side of a switch.

use eomgen_model_spec::model::Function;

use crate::symbolic::operation::{NodeId, Operation};

/// Factor of a derivative that is set to 0 on the flat side of a switch.
#[derive(Clone, Copy)]
pub(crate) struct FlatGuard {
    /// Node that is 0 on the flat side and positive elsewhere.
    pub(super) activity: NodeId,
    /// Value of the factor where the activity is positive.
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

/// Returns true if an operation switches between branches.
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
