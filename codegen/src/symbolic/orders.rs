//! Orders of nodes where the argument of a root vanishes, as [`limits`](super::limits) finds them.

use std::collections::HashMap;
use std::sync::Arc;

use crate::symbolic::operation::NodeId;

/// Powers of nodes, all exponents positive.
pub(crate) type Monomial = Vec<(NodeId, i32)>;

/// Monomials with their orders in s: |monomial| <= C s^order.
pub(crate) type Bounds = Arc<Vec<(Monomial, f64)>>;

/// Orders found so far.
#[derive(Default)]
pub(crate) struct Orders {
    /// By the argument of a root; none if it is not known where the argument vanishes.
    pub bounds: HashMap<NodeId, Option<Bounds>>,
    /// By the argument of a root and a node.
    pub orders: HashMap<(NodeId, NodeId), f64>,
    /// Arguments of the roots whose reciprocals a node holds.
    pub arguments: HashMap<NodeId, Arc<Vec<NodeId>>>,
}
