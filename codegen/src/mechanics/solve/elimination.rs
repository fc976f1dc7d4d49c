//! Elimination without pivoting, reciprocals of pivots, and inner products over modes.

use crate::symbolic::graph::{Graph, NodeId, Operation, Space};
use eomgen_model_spec::ids::FieldId;

/// System of scalars during its elimination.
pub(super) struct Elimination {
    pub(super) matrix: Vec<Vec<NodeId>>,
    pub(super) right: Vec<NodeId>,
    /// True if both halves of the matrix are the same nodes.
    is_symmetric: bool,
    /// Pivots so far; rows with negative pivots are stored with the opposite sign.
    pub(super) pivots: Vec<NodeId>,
    reciprocals: Vec<NodeId>,
}

impl Elimination {
    pub(super) fn new(matrix: Vec<Vec<NodeId>>, right: Vec<NodeId>) -> Self {
        let mut rows = matrix.iter().enumerate();
        let is_symmetric = rows.all(|(row, entries)| {
            let mut columns = 0..row;
            columns.all(|column| entries[column] == matrix[column][row])
        });
        Self {
            matrix,
            right,
            is_symmetric,
            pivots: Vec::new(),
            reciprocals: Vec::new(),
        }
    }

    /// Eliminates the next row of `order`.
    pub(super) fn eliminate_next(
        &mut self,
        graph: &mut Graph,
        order: &[usize],
        has_negative_pivot: bool,
    ) {
        let step = self.pivots.len();
        let (matrix, right) = (&mut self.matrix, &mut self.right);
        let pivot_row = order[step];
        let own = matrix[pivot_row][pivot_row];
        let (pivot, reciprocal) = if has_negative_pivot {
            let pivot = graph.negate(own);
            let reciprocal = pivot_reciprocal(graph, pivot);
            (pivot, graph.negate(reciprocal))
        } else {
            (own, pivot_reciprocal(graph, own))
        };
        self.pivots.push(pivot);
        self.reciprocals.push(reciprocal);
        for (place, &row) in order.iter().enumerate().skip(step + 1) {
            if graph.is_zero(matrix[row][pivot_row]) {
                continue;
            }
            let factor = graph.multiply(matrix[row][pivot_row], reciprocal);
            // The remaining matrix of a symmetric matrix is symmetric, so only its upper half is computed.
            let first = if self.is_symmetric { place } else { step + 1 };
            for &column in &order[first..] {
                let product = graph.multiply(factor, matrix[pivot_row][column]);
                matrix[row][column] =
                    graph.combine_flat(&[(1.0, matrix[row][column]), (-1.0, product)]);
                if self.is_symmetric {
                    matrix[column][row] = matrix[row][column];
                }
            }
            let product = graph.multiply(factor, right[pivot_row]);
            right[row] = graph.combine_flat(&[(1.0, right[row]), (-1.0, product)]);
        }
    }

    /// Computes the unknowns of the eliminated rows from those of the other rows of `order`.
    pub(super) fn substitute_back(
        &self,
        graph: &mut Graph,
        order: &[usize],
        unknowns: &mut [NodeId],
    ) {
        for (step, reciprocal) in self.reciprocals.iter().enumerate().rev() {
            let row = order[step];
            let mut terms = vec![(1.0, self.right[row])];
            for &column in &order[step + 1..] {
                let entry = self.matrix[row][column];
                if !graph.is_zero(entry) {
                    terms.push((-1.0, graph.multiply(entry, unknowns[column])));
                }
            }
            let rest = graph.combine(&terms);
            unknowns[row] = graph.multiply(rest, *reciprocal);
        }
    }
}

/// Returns the reciprocal of a pivot. A product of parameters can cancel against factors of its row; such a pivot is
/// checked by `prepare`. Any other pivot is checked when it is used.
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
        // The terms of a sum have separate prepared factors and stay separate.
        Operation::Sum(terms) if terms.len() > 1 => {
            let terms: Vec<(f64, NodeId)> = terms
                .iter()
                .map(|&(c, term)| {
                    let product = graph.multiply(a, term);
                    (c.value(), graph.sum_over_space(space, product))
                })
                .collect();
            graph.combine(&terms)
        }
        _ => {
            let product = graph.multiply(a, b);
            graph.sum_over_space(space, product)
        }
    }
}
