//! Expansion of products, level by level and with limited length. It is applied only to terms that are likely to
//! cancel, and the result is kept only if it saves operations.

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Largest number of levels that are expanded.
pub const MAX_EXPANSIONS: usize = 4;

/// Largest number of terms of an expanded sum.
const MAX_TERMS: usize = 200;

/// Expands one sum in every product that has a sum as a factor; `None` if there is no such product, or if the result
/// is too long.
pub fn expand_once(graph: &mut Graph, id: NodeId) -> Option<NodeId> {
    let terms: Vec<(f64, NodeId)> = match graph.operation(id) {
        Operation::Sum(terms) => terms.iter().map(|(c, term)| (c.value(), *term)).collect(),
        Operation::Product(_) => vec![(1.0, id)],
        _ => return None,
    };
    let mut result = Vec::new();
    let mut changed = false;
    for (factor, term) in terms {
        match expand_product(graph, term) {
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

/// Returns true if [`expand_once`] would expand no term.
pub fn is_expanded(graph: &Graph, id: NodeId) -> bool {
    match graph.operation(id) {
        Operation::Sum(terms) => {
            let mut terms = terms.iter();
            terms.all(|(_, term)| find_expandable_factor(graph, *term).is_none())
        }
        _ => find_expandable_factor(graph, id).is_none(),
    }
}

/// Returns the index of the first sum among the factors of a product; its exponent must be 1 or 2.
fn find_expandable_factor(graph: &Graph, id: NodeId) -> Option<usize> {
    let Operation::Product(factors) = graph.operation(id) else {
        return None;
    };
    factors.iter().position(|(factor, exponent)| {
        matches!(exponent, 1 | 2) && matches!(graph.operation(*factor), Operation::Sum(_))
    })
}

/// Expands one sum in a product and returns the terms.
fn expand_product(graph: &mut Graph, id: NodeId) -> Option<Vec<(f64, NodeId)>> {
    let index = find_expandable_factor(graph, id)?;
    let Operation::Product(factors) = graph.operation(id) else {
        return None;
    };
    let mut rest = factors.to_vec();
    let (sum, exponent) = rest.remove(index);
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
