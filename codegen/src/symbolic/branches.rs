//! Nodes that are one of two others.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// For a node that is one of two others: a and b of the condition a > b, the node where it
/// holds, the node elsewhere. A guarded power counts as the power.
pub(crate) fn choice(graph: &Graph, id: NodeId) -> Option<[NodeId; 4]> {
    match graph.operation(id) {
        // Differentiated as the power it guards: what has no limit there has to show it.
        _ if graph.guarded_power(id).is_some() => None,
        &Operation::Select {
            a,
            b,
            then,
            otherwise,
        } => Some([a, b, then, otherwise]),
        Operation::Call(function, arguments) => match (function, &**arguments) {
            (Function::Max, &[a, b]) => Some([a, b, a, b]),
            (Function::Min, &[a, b]) => Some([b, a, a, b]),
            _ => None,
        },
        _ => None,
    }
}
