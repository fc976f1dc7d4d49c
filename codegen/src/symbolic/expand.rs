//! Expansion of products, level by level and within bounds. It is applied only to terms that are likely to
//! cancel, and kept if it saves operations.

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Largest number of expanded levels.
pub const MAX_EXPANSIONS: usize = 4;

/// Largest number of terms of an expanded sum.
const MAX_TERMS: usize = 200;

/// Expands every product with a sum among its factors by one of the sums; `None` if there is no such product,
/// or if the result is too long.
pub fn expand_once(graph: &mut Graph, id: NodeId) -> Option<NodeId> {
    let terms: Vec<(f64, NodeId)> = match graph.operation(id) {
        Operation::Sum(terms) => terms.iter().map(|(c, term)| (c.value(), *term)).collect(),
        Operation::Product(_) => vec![(1.0, id)],
        _ => return None,
    };
    let mut result = Vec::new();
    let mut changed = false;
    for (factor, term) in terms {
        match expanded_product(graph, term) {
            Some(parts) => {
                changed = true;
                result.extend(parts.into_iter().map(|(c, part)| (factor * c, part)));
            }
            None => result.push((factor, term)),
        }
        if result.len() > MAX_TERMS {
            return None;
        }
    }
    changed.then(|| graph.combine_flat(&result))
}

/// Returns true if no term is a product that [`expand_once`] expands.
pub fn is_expanded(graph: &Graph, id: NodeId) -> bool {
    match graph.operation(id) {
        Operation::Sum(terms) => {
            let mut terms = terms.iter();
            terms.all(|(_, term)| expandable_factor(graph, *term).is_none())
        }
        _ => expandable_factor(graph, id).is_none(),
    }
}

/// Returns the place of the first sum among the factors of a product, to the first or second power.
fn expandable_factor(graph: &Graph, id: NodeId) -> Option<usize> {
    let Operation::Product(factors) = graph.operation(id) else {
        return None;
    };
    factors.iter().position(|(factor, exponent)| {
        matches!(exponent, 1 | 2) && matches!(graph.operation(*factor), Operation::Sum(_))
    })
}

/// Returns the terms of a product, expanded by one of its sums.
fn expanded_product(graph: &mut Graph, id: NodeId) -> Option<Vec<(f64, NodeId)>> {
    let place = expandable_factor(graph, id)?;
    let Operation::Product(factors) = graph.operation(id) else {
        return None;
    };
    let mut rest = factors.to_vec();
    let (sum, exponent) = rest.remove(place);
    if exponent == 2 {
        rest.push((sum, 1));
    }
    let Operation::Sum(terms) = graph.operation(sum).clone() else {
        return None;
    };
    let rest = graph.product(&rest);
    Some(
        terms
            .iter()
            .map(|(c, term)| (c.value(), graph.multiply(rest, *term)))
            .collect(),
    )
}
