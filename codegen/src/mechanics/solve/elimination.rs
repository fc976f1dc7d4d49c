//! Reciprocals of pivots and inner products over modes, for the elimination of modes and coordinates.

use crate::symbolic::graph::{Graph, NodeId, Operation, Space};
use eomgen_model_spec::ids::FieldId;

/// Returns the reciprocal of a pivot. A plain product of parameters can cancel against the row that it
/// divides; the preparation of the coefficients checks it. Any other pivot is checked when it is used.
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

/// Returns a . b over the modes of a field.
pub(super) fn inner_product(graph: &mut Graph, field: FieldId, a: NodeId, b: NodeId) -> NodeId {
    if graph.is_zero(a) || graph.is_zero(b) {
        return graph.zero();
    }
    let space = Space::Modes(field);
    match graph.operation(b).clone() {
        // The terms of a sum have separate prepared factors: keep them separate.
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
