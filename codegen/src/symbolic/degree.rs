//! Degree of a node in the rates, read off its structure. Shows that a kinetic energy is a quadratic form.

use std::collections::HashMap;

use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// Returns true if the structure of a node is a homogeneous quadratic form of the rates.
pub fn is_quadratic_in_rates(graph: &Graph, id: NodeId) -> bool {
    graph.is_zero(id) || degree(graph, id, &mut HashMap::new()) == Some(2)
}

/// Returns the degree of a homogeneous polynomial of the rates; `None` for another or unrecognised structure.
fn degree(graph: &Graph, id: NodeId, known: &mut HashMap<NodeId, Option<i32>>) -> Option<i32> {
    if !graph.dependence(id).has(Dependence::RATE) {
        return Some(0);
    }
    if let Some(&result) = known.get(&id) {
        return result;
    }
    let result = match graph.operation(id) {
        Operation::Rate(_) | Operation::ModeRates(_) => Some(1),
        Operation::Sum(terms) => {
            let mut degrees = terms.iter().map(|(_, term)| degree(graph, *term, known));
            let first = degrees.next().flatten();
            if degrees.all(|other| other == first) {
                first
            } else {
                None
            }
        }
        Operation::Product(factors) => factors
            .iter()
            .map(|(factor, exponent)| degree(graph, *factor, known).map(|d| d * exponent))
            .sum(),
        Operation::Total(a) => degree(graph, *a, known),
        Operation::Apply { vector, .. } => degree(graph, *vector, known),
        _ => None,
    };
    known.insert(id, result);
    result
}
