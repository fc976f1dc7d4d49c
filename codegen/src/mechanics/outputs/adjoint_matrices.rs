//! Reverse accumulation through matrices that depend on the state. The contribution of a matrix M is the gradient of
//! the bilinear form y^T M x, in which x is the solution of a linear system.

use super::adjoint::{AdjointPart, Adjoints};
use crate::symbolic::graph::{Graph, NodeId, Operation, Space};

impl Adjoints {
    /// Adds the gradient of y^T M x with constant x to the adjoints of the operands of M; `y` is a vector under
    /// conditions.
    pub(super) fn propagate_to_matrix(
        &mut self,
        graph: &mut Graph,
        matrix: NodeId,
        y: AdjointPart,
        x: NodeId,
    ) {
        match graph.operation(matrix).clone() {
            Operation::Assemble(assembly) => {
                if let Some(diagonal) = assembly.diagonal {
                    self.propagate_product(graph, assembly.rows, diagonal, &y, x);
                }
                for &(u, v) in &assembly.outer {
                    let along_v = sum_products(graph, assembly.columns, v, x);
                    self.propagate_product(graph, assembly.rows, u, &y, along_v);
                    let along_u = sum_products(graph, assembly.rows, u, y.value);
                    let along_u = y.with_value(along_u);
                    self.propagate_product(graph, assembly.columns, v, &along_u, x);
                }
                for part in &assembly.matrices {
                    let (left, right) = (
                        y.with_value(graph.multiply(part.row, y.value)),
                        graph.multiply(part.column, x),
                    );
                    let applied = graph.apply(part.matrix, part.transposed, right);
                    self.propagate_product(graph, assembly.rows, part.row, &y, applied);
                    let applied = graph.apply(part.matrix, !part.transposed, left.value);
                    let applied = left.with_value(applied);
                    self.propagate_product(graph, assembly.columns, part.column, &applied, x);
                    if (self.follows)(graph, part.matrix) {
                        self.propagate_to_gram(graph, part.matrix, part.transposed, left, right);
                    }
                }
            }
            _ => self.propagate_to_gram(graph, matrix, false, y, x),
        }
    }

    fn propagate_to_gram(
        &mut self,
        graph: &mut Graph,
        matrix: NodeId,
        transposed: bool,
        y: AdjointPart,
        x: NodeId,
    ) {
        let Operation::Gram {
            left,
            weight,
            right,
        } = *graph.operation(matrix)
        else {
            return;
        };
        let (left, right) = if transposed {
            (right, left)
        } else {
            (left, right)
        };
        let Some(nodes) = rows(graph, left) else {
            return;
        };
        let y = y.with_value(graph.apply(left, false, y.value));
        let x = graph.apply(right, false, x);
        self.propagate_product(graph, nodes, weight, &y, x);
    }

    /// Adds y times x, element by element over `space`, to the adjoint of a vector, or their sum to that of a scalar.
    fn propagate_product(
        &mut self,
        graph: &mut Graph,
        space: Space,
        to: NodeId,
        y: &AdjointPart,
        x: NodeId,
    ) {
        if (self.follows)(graph, to) {
            let part = y.with_value(graph.multiply(y.value, x));
            self.add_over(graph, space, to, part);
        }
    }
}

fn sum_products(graph: &mut Graph, space: Space, a: NodeId, b: NodeId) -> NodeId {
    let product = graph.multiply(a, b);
    graph.sum_over_space(space, product)
}

fn rows(graph: &Graph, matrix: NodeId) -> Option<Space> {
    match graph.shape(matrix) {
        crate::symbolic::graph::Shape::Matrix(rows, _) => Some(rows),
        _ => None,
    }
}
