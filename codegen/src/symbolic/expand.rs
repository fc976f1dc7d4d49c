//! Multiplying out, a level at a time and within bounds. The derivation does not do this
//! as a rule: it is tried where terms are known to cancel, and kept if it pays.

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// How many levels are tried.
pub const MOST_EXPANSIONS: usize = 4;

/// The most terms a sum may grow to.
const MOST_TERMS: usize = 200;

/// A sum in which every product with a sum among its factors is multiplied out by one of
/// them; `None` if there is nothing to multiply out, or too much.
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
        if result.len() > MOST_TERMS {
            return None;
        }
    }
    changed.then(|| graph.combine_flat(&result))
}

/// The terms of a product that has a sum as a factor, to the first power or squared.
fn expanded_product(graph: &mut Graph, id: NodeId) -> Option<Vec<(f64, NodeId)>> {
    let Operation::Product(factors) = graph.operation(id).clone() else {
        return None;
    };
    let place = factors.iter().position(|(factor, exponent)| {
        matches!(exponent, 1 | 2) && matches!(graph.operation(*factor), Operation::Sum(_))
    })?;
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
