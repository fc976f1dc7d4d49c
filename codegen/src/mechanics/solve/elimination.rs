//! What the elimination of modes and that of coordinates share: reciprocals of pivots, and inner
//! products over the modes of a field.

use crate::symbolic::graph::{Graph, NodeId, Operation, Space};
use eomgen_model_spec::ids::FieldId;

/// The reciprocal of a pivot. One of parameters alone that is a plain product cancels
/// against the row it divides (it is checked where the coefficients are prepared); any
/// other is checked on the spot.
pub(super) fn pivot_reciprocal(graph: &mut Graph, pivot: NodeId) -> NodeId {
    let plain = match graph.operation(pivot) {
        Operation::Parameter(_) | Operation::Product(_) => true,
        Operation::Sum(terms) => terms.len() == 1,
        _ => false,
    };
    if plain && graph.dependence(pivot).is_parameter_only() {
        graph.integer_power(pivot, -1)
    } else {
        graph.intern(Operation::PivotReciprocal(pivot))
    }
}

/// a . b over the modes of a field.
pub(super) fn inner_product(graph: &mut Graph, field: FieldId, a: NodeId, b: NodeId) -> NodeId {
    if graph.is_zero(a) || graph.is_zero(b) {
        return graph.zero();
    }
    let space = Space::Modes(field);
    match graph.operation(b).clone() {
        // A sum's terms have prepared factors of their own: keep them apart.
        Operation::Sum(terms) if terms.len() > 1 => {
            let terms: Vec<(f64, NodeId)> = terms
                .iter()
                .map(|&(c, term)| {
                    let product = graph.multiply(a, term);
                    (c.value(), graph.total_over(space, product))
                })
                .collect();
            graph.combine(&terms)
        }
        _ => {
            let product = graph.multiply(a, b);
            graph.total_over(space, product)
        }
    }
}
