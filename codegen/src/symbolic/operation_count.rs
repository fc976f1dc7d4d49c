//! Number of operations per call, for the comparison of expansions and elimination orders.

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Counts the additions, multiplications and calls that depend on the state, element by element.
pub fn count_operations(graph: &Graph, roots: &[NodeId]) -> usize {
    graph
        .reachable(roots)
        .into_iter()
        .filter(|id| !graph.dependence(*id).is_parameter_only())
        .map(|id| {
            let operation = graph.operation(id);
            let operands = graph.operands(operation);
            match operation {
                Operation::Total(a) => graph.length(graph.shape(*a)),
                Operation::Apply { matrix, .. } => 2 * graph.length(graph.shape(*matrix)),
                Operation::CholeskySolve(factor, _) => 2 * graph.length(graph.shape(*factor)),
                _ => operands.len() * graph.length(graph.shape(id)),
            }
        })
        .sum()
}
