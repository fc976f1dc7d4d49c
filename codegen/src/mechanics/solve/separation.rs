//! Separation of coupling vectors over the modes into state-dependent scalars and vectors that depend only on
//! parameters.

use std::collections::BTreeMap;

use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};

/// Scalar times a vector without scalar factors; the vector is 1 if all entries are equal.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeparatedTerm {
    pub(super) scalar: NodeId,
    pub(super) vector: NodeId,
}

/// Splits a vector into a sum of terms with distinct vectors, in the order of the graph. Sums are expanded from the
/// outermost to the innermost; therefore a shared sum is expanded only once.
pub(super) fn separate(graph: &mut Graph, vector: NodeId) -> Vec<SeparatedTerm> {
    let one = graph.one();
    let mut waiting: BTreeMap<NodeId, Vec<(f64, NodeId)>> =
        BTreeMap::from([(vector, vec![(1.0, one)])]);
    let mut found: BTreeMap<NodeId, Vec<(f64, NodeId)>> = BTreeMap::new();
    while let Some((node, weights)) = waiting.pop_last() {
        let weight = graph.combine(&weights);
        if graph.shape(node) == Shape::Scalar {
            let scalar = graph.multiply(weight, node);
            found.entry(one).or_default().push((1.0, scalar));
            continue;
        }
        match graph.operation(node).clone() {
            Operation::Sum(terms) => {
                for (factor, term) in &terms {
                    let weight = (factor.value(), weight);
                    waiting.entry(*term).or_default().push(weight);
                }
            }
            Operation::Product(factors) => {
                let (scalars, mut vectors) = graph.split_scalar_factors(&factors);
                let scalar = graph.product(&scalars);
                let weight = graph.multiply(weight, scalar);
                let opened = remove_sum(graph, &mut vectors);
                let others = graph.product(&vectors);
                if opened.is_empty() && scalars.is_empty() {
                    found.entry(node).or_default().push((1.0, weight));
                } else if opened.is_empty() {
                    waiting.entry(others).or_default().push((1.0, weight));
                }
                for (factor, term) in opened {
                    let product = graph.multiply(others, term);
                    waiting.entry(product).or_default().push((factor, weight));
                }
            }
            _ => found.entry(node).or_default().push((1.0, weight)),
        }
    }
    let collected = found.into_iter().map(|(vector, weights)| SeparatedTerm {
        scalar: graph.combine(&weights),
        vector,
    });
    let parts: Vec<SeparatedTerm> = collected.collect();
    parts
        .into_iter()
        .filter(|part| !graph.is_zero(part.scalar))
        .collect()
}

/// Removes a sum from the factors and returns its terms; returns no terms if no factor is a sum.
fn remove_sum(graph: &Graph, factors: &mut Vec<(NodeId, i32)>) -> Vec<(f64, NodeId)> {
    let index = factors.iter().position(|(factor, exponent)| {
        *exponent == 1 && matches!(graph.operation(*factor), Operation::Sum(_))
    });
    let Some(index) = index else {
        return Vec::new();
    };
    match graph.operation(factors.remove(index).0) {
        Operation::Sum(terms) => terms.iter().map(|(c, term)| (c.value(), *term)).collect(),
        _ => Vec::new(),
    }
}
