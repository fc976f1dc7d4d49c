//! Term of an integrand: powers of the position, a weight, and field atoms.

use crate::symbolic::graph::{Graph, NodeId, Operation};
use eomgen_model_spec::ids::FieldId;

/// Field, its rate or a mode shape, with the order of its derivative by the position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Atom {
    /// w
    Coordinates(u8),
    /// dot(w)
    Rates(u8),
    /// phi[i]
    Shapes(u8),
}

impl Atom {
    /// Returns the atom after `times` further differentiations by the position.
    pub fn derivative_of_order(self, times: u8) -> Self {
        match self {
            Self::Coordinates(d) => Self::Coordinates(d + times),
            Self::Rates(d) => Self::Rates(d + times),
            Self::Shapes(d) => Self::Shapes(d + times),
        }
    }

    pub(crate) fn derivative(self) -> u8 {
        match self {
            Self::Coordinates(d) | Self::Rates(d) | Self::Shapes(d) => d,
        }
    }

    /// Returns the modal coordinates or their rates, the factors of the shapes; `None` for a shape `phi[i]`.
    pub(crate) fn amplitudes(self, graph: &mut Graph, field: FieldId) -> Option<NodeId> {
        match self {
            Self::Coordinates(_) => Some(graph.intern(Operation::ModeCoordinates(field))),
            Self::Rates(_) => Some(graph.intern(Operation::ModeRates(field))),
            Self::Shapes(_) => None,
        }
    }
}

/// Term of an integrand: scalar * s^power * weight * atom_1 * atom_2. The atoms are differentiated with respect to s.
#[derive(Clone, Debug)]
pub(crate) struct IntegrandTerm {
    pub(crate) scalar: NodeId,
    pub(crate) power: u32,
    pub(crate) weight: Option<NodeId>,
    pub(crate) atoms: Vec<Atom>,
}
