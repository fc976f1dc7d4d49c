//! Replacement of nodes in an expression.

use std::collections::HashMap;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Replaces every node in the expression `id` for which `replacement` returns another node. Matrix factors are kept,
/// because they depend only on parameters.
pub fn substitute(
    graph: &mut Graph,
    id: NodeId,
    replacement: &dyn Fn(&mut Graph, NodeId) -> Option<NodeId>,
    known: &mut HashMap<NodeId, NodeId>,
) -> NodeId {
    if let Some(&done) = known.get(&id) {
        return done;
    }
    let result = match replacement(graph, id) {
        Some(other) => other,
        None => rebuild(graph, id, replacement, known),
    };
    known.insert(id, result);
    result
}

fn rebuild(
    graph: &mut Graph,
    id: NodeId,
    replacement: &dyn Fn(&mut Graph, NodeId) -> Option<NodeId>,
    known: &mut HashMap<NodeId, NodeId>,
) -> NodeId {
    let operation = graph.operation(id).clone();
    let mut inner = |graph: &mut Graph, id: NodeId| substitute(graph, id, replacement, known);
    match operation {
        Operation::Sum(terms) => {
            let terms: Vec<(f64, NodeId)> = terms
                .iter()
                .map(|&(factor, term)| (factor.value(), inner(graph, term)))
                .collect();
            graph.combine(&terms)
        }
        Operation::Product(factors) => {
            let factors: Vec<(NodeId, i32)> = factors
                .iter()
                .map(|&(factor, exponent)| (inner(graph, factor), exponent))
                .collect();
            graph.product(&factors)
        }
        Operation::Call(function, arguments) => {
            let arguments = arguments.map(|a| inner(graph, a));
            graph.call(function, arguments)
        }
        Operation::Power(base, exponent) => {
            let (base, exponent) = (inner(graph, base), inner(graph, exponent));
            graph.power(base, exponent)
        }
        Operation::Select {
            a,
            b,
            then,
            otherwise,
            is_switch,
        } => {
            let condition = [inner(graph, a), inner(graph, b)];
            let (then, otherwise) = (inner(graph, then), inner(graph, otherwise));
            graph.select_between(condition, then, otherwise, is_switch)
        }
        Operation::Total(a) => {
            let vector = inner(graph, a);
            match graph.shape(a) {
                crate::symbolic::graph::Shape::Vector(space) => graph.sum_over_space(space, vector),
                _ => vector,
            }
        }
        Operation::Apply {
            matrix,
            transposed,
            vector,
        } => {
            let vector = inner(graph, vector);
            graph.apply(matrix, transposed, vector)
        }
        Operation::CholeskySolve(factor, vector) => {
            let vector = inner(graph, vector);
            graph.cholesky_solve(factor, vector)
        }
        Operation::PivotReciprocal(pivot) => {
            let pivot = inner(graph, pivot);
            graph.intern(Operation::PivotReciprocal(pivot))
        }
        _ => id,
    }
}
