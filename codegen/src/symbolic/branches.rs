//! Nodes that select one of two others.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Returns, for a node that selects one of two others, a and b of the condition a > b, the node if it is
/// true, and the node otherwise. A guarded power counts as a power.
pub(crate) fn choice(graph: &Graph, id: NodeId) -> Option<[NodeId; 4]> {
    match graph.operation(id) {
        // Differentiated as the power that it guards, so that a missing limit remains visible.
        _ if graph.guarded_power(id).is_some() => None,
        &Operation::Select {
            a,
            b,
            then,
            otherwise,
            ..
        } => Some([a, b, then, otherwise]),
        Operation::Call(function, arguments) => match (function, &**arguments) {
            (Function::Max, &[a, b]) => Some([a, b, a, b]),
            (Function::Min, &[a, b]) => Some([b, a, a, b]),
            _ => None,
        },
        _ => None,
    }
}

/// Returns false for a selection between two results that agree near the surface.
pub(crate) fn is_switch(graph: &Graph, id: NodeId) -> bool {
    let is_equivalent = matches!(
        graph.operation(id),
        Operation::Select {
            is_switch: false,
            ..
        }
    );
    !is_equivalent
}
