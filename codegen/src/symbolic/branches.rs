//! Nodes that select one of two other nodes.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Returns [a, b, then, otherwise] for a node that selects `then` if a > b, and `otherwise` if not. Returns `None`
/// for other nodes and for guarded powers, which count as powers.
pub(crate) fn choice(graph: &Graph, id: NodeId) -> Option<[NodeId; 4]> {
    match graph.operation(id) {
        // A guarded power is differentiated as the power itself; a derivative without a limit then remains infinite
        // or NaN.
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

/// Returns true if a node switches at a surface; returns false for a selection between results that agree near a = b.
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
