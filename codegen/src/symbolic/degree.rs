//! Degree of a node in the rates, from its structure. It proves that a kinetic energy is a quadratic form.

use std::collections::HashMap;

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// Returns true if a node is homogeneous of degree 2 in the rates, according to its structure; then q' dT/dq' = 2 T.
pub fn is_quadratic_in_rates(graph: &Graph, id: NodeId) -> bool {
    graph.is_zero(id) || degree(graph, id, &mut HashMap::new()) == Some(2)
}

/// Returns true if a node depends on the rates.
fn moves(graph: &Graph, id: NodeId) -> bool {
    graph.dependence(id).has(Dependence::RATE)
}

/// Returns the degree of a homogeneous function of the rates; `None` if the structure is not recognised as
/// homogeneous.
fn degree(graph: &Graph, id: NodeId, known: &mut HashMap<NodeId, Option<i32>>) -> Option<i32> {
    if !moves(graph, id) {
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
        Operation::Call(Function::Sqrt, arguments) => degree(graph, arguments[0], known)
            .filter(|degree| degree % 2 == 0)
            .map(|degree| degree / 2),
        Operation::Select {
            a,
            b,
            then,
            otherwise,
            ..
        } if !moves(graph, *a) && !moves(graph, *b) => {
            let branches = [*then, *otherwise];
            let mut degrees = branches
                .into_iter()
                .filter(|branch| !graph.is_zero(*branch));
            let first = degree(graph, degrees.next()?, known);
            match degrees.next() {
                Some(other) if degree(graph, other, known) != first => None,
                _ => first,
            }
        }
        _ => None,
    };
    known.insert(id, result);
    result
}
