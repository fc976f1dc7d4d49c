//! Orders of nodes at zeros of a root's argument, used by [`limits`](super::limits).

use std::collections::HashMap;
use std::sync::Arc;

use crate::symbolic::operation::NodeId;

/// Powers of nodes.
pub(crate) type Monomial = Vec<(NodeId, f64)>;

/// Monomials with their orders in the argument s of a root: |monomial| <= C |s|^order near s = 0.
pub(crate) type Bounds = Arc<Vec<(Monomial, f64)>>;

#[derive(Default, Clone)]
pub(crate) struct Orders {
    /// Bounds by the argument of a root; `None` if its zeros are unknown.
    pub bounds: HashMap<NodeId, Option<Bounds>>,
    /// Orders by the argument of a root and a node.
    pub orders: HashMap<(NodeId, NodeId), f64>,
    /// Cofactors by the arguments of roots and a node.
    pub cofactors: HashMap<(Arc<Vec<NodeId>>, NodeId), Option<NodeId>>,
    /// True for nodes that are continuous functions.
    pub continuous: HashMap<NodeId, bool>,
    /// True for nodes that are Lipschitz continuous near their finite values.
    pub lipschitz: HashMap<NodeId, bool>,
    /// Arguments of the roots whose reciprocals a node contains.
    pub arguments: HashMap<NodeId, Arc<Vec<NodeId>>>,
}
