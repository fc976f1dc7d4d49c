//! Directional derivatives of products, Gram matrices and Cholesky solutions whose matrices vary along the direction,
//! because modal matrices depend on parameters. A Cholesky factor itself is not differentiated; instead d(M^-1 b) =
//! M^-1 (db - dM M^-1 b).

use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Assembly, Dependence, Graph, NodeId, Operation};

impl Direction<'_> {
    /// Returns d(matrix vector) along the direction.
    pub(crate) fn differentiate_product(
        &mut self,
        graph: &mut Graph,
        matrix: NodeId,
        transposed: bool,
        vector: NodeId,
    ) -> NodeId {
        let inner = self.derivative(graph, vector);
        let by_vector = graph.apply(matrix, transposed, inner);
        let by_matrix = self.apply_matrix_derivative(graph, matrix, transposed, vector);
        graph.add(by_vector, by_matrix)
    }

    /// Returns d(L^-T L^-1 right) along the direction; `solution` is the node itself.
    pub(crate) fn differentiate_solution(
        &mut self,
        graph: &mut Graph,
        factor: NodeId,
        right: NodeId,
        solution: NodeId,
    ) -> NodeId {
        let inner = self.derivative(graph, right);
        let moved = match *graph.operation(factor) {
            Operation::Cholesky(matrix) => {
                self.apply_matrix_derivative(graph, matrix, false, solution)
            }
            _ => graph.zero(),
        };
        let rest = graph.subtract(inner, moved);
        graph.cholesky_solve(factor, rest)
    }

    /// Returns d(matrix) vector, with a constant vector.
    fn apply_matrix_derivative(
        &mut self,
        graph: &mut Graph,
        matrix: NodeId,
        transposed: bool,
        vector: NodeId,
    ) -> NodeId {
        match graph.operation(matrix).clone() {
            Operation::Gram {
                left,
                weight,
                right,
            } => {
                let moved = self.derivative(graph, weight);
                if graph.is_zero(moved) {
                    return moved;
                }
                let (outer, inner) = if transposed {
                    (right, left)
                } else {
                    (left, right)
                };
                let at_nodes = graph.apply(inner, false, vector);
                let weighted = graph.multiply(moved, at_nodes);
                graph.apply(outer, true, weighted)
            }
            Operation::Assemble(assembly) => self.differentiate_assembly(graph, &assembly, vector),
            _ => graph.zero(),
        }
    }

    /// Returns d(matrix) vector for an assembled matrix, part by part. Assembled matrices are symmetric and need no
    /// transposition.
    fn differentiate_assembly(
        &mut self,
        graph: &mut Graph,
        assembly: &Assembly,
        vector: NodeId,
    ) -> NodeId {
        let mut terms = Vec::new();
        if let Some(diagonal) = assembly.diagonal {
            let moved = self.derivative(graph, diagonal);
            terms.push((1.0, graph.multiply(moved, vector)));
        }
        for &(u, v) in &assembly.outer {
            let (moved_u, moved_v) = (self.derivative(graph, u), self.derivative(graph, v));
            for (u, v) in [(moved_u, v), (u, moved_v)] {
                let product = graph.multiply(v, vector);
                let total = graph.sum_over_space(assembly.columns, product);
                terms.push((1.0, graph.multiply(u, total)));
            }
        }
        for part in &assembly.matrices {
            let scaled = graph.multiply(part.column, vector);
            let product = graph.apply(part.matrix, part.transposed, scaled);
            let moved_row = self.derivative(graph, part.row);
            terms.push((1.0, graph.multiply(moved_row, product)));
            let moved_column = self.derivative(graph, part.column);
            let scaled_by_moved = graph.multiply(moved_column, vector);
            let by_column = graph.apply(part.matrix, part.transposed, scaled_by_moved);
            let by_matrix =
                self.apply_matrix_derivative(graph, part.matrix, part.transposed, scaled);
            let inner = graph.add(by_column, by_matrix);
            terms.push((1.0, graph.multiply(part.row, inner)));
        }
        graph.combine(&terms)
    }

    /// Returns d(diagonal of left^T diag(weight) right) along the direction.
    pub(crate) fn differentiate_gram_diagonal(
        &mut self,
        graph: &mut Graph,
        left: NodeId,
        weight: NodeId,
        right: NodeId,
    ) -> NodeId {
        let moved = self.derivative(graph, weight);
        if graph.is_zero(moved) {
            return moved;
        }
        graph.intern(Operation::GramDiagonal {
            left,
            weight: moved,
            right,
        })
    }
}

/// Returns true if `roots` depend on the diagonal of a state-dependent Gram matrix. Such diagonals can be
/// differentiated only with respect to parameters.
pub(crate) fn holds_moving_diagonal(graph: &Graph, roots: &[NodeId]) -> bool {
    graph.reachable(roots).into_iter().any(|id| {
        matches!(graph.operation(id), Operation::GramDiagonal { .. })
            && !graph.dependence(id).is_parameter_only()
    })
}

/// Returns true if `roots` depend on a matrix operation on parameters.
pub(crate) fn holds_matrix_of_parameters(graph: &Graph, roots: &[NodeId]) -> bool {
    graph.reachable(roots).into_iter().any(|id| {
        matches!(
            graph.operation(id),
            Operation::Gram { .. }
                | Operation::GramDiagonal { .. }
                | Operation::Assemble(_)
                | Operation::Cholesky(_)
        ) && graph.dependence(id).has(Dependence::PARAMETER)
    })
}
