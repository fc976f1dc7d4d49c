//! Structured matrices over modes: sums of a diagonal, outer products of vectors and scaled tables. Modal mass
//! matrices have this form. A uniform beam gives a diagonal, a tip mass adds an outer product, and a basis that is
//! not orthogonal adds a table.

use crate::symbolic::graph::{Assembly, Graph, NodeId, Operation, ScaledMatrix, Shape, Space};

impl Assembly {
    /// Returns the terms of the product of this matrix and a vector.
    pub(crate) fn multiply_vector(&self, graph: &mut Graph, vector: NodeId) -> Vec<NodeId> {
        let mut parts = Vec::new();
        if let Some(diagonal) = self.diagonal {
            parts.push(graph.multiply(diagonal, vector));
        }
        for &(u, v) in &self.outer {
            let product = graph.multiply(v, vector);
            let total = graph.sum_over_space(self.columns, product);
            parts.push(graph.multiply(u, total));
        }
        for part in &self.matrices {
            let scaled = graph.multiply(part.column, vector);
            let product = graph.apply(part.matrix, part.transposed, scaled);
            parts.push(graph.multiply(part.row, product));
        }
        parts
    }
}

/// Structured matrix: diagonal + sum of u v^T + sum of diag(row) matrix diag(column).
#[derive(Clone, Debug)]
pub struct StructuredMatrix {
    /// Index space of the rows.
    pub rows: Space,
    /// Index space of the columns.
    pub columns: Space,
    /// Diagonal (a vector, or a scalar for equal entries); only for rows = columns.
    pub diagonal: Option<NodeId>,
    /// Outer products u v^T; u and v are vectors, or scalars for equal entries.
    pub outer: Vec<(NodeId, NodeId)>,
    /// Scaled tables.
    pub matrices: Vec<ScaledMatrix>,
}

impl StructuredMatrix {
    /// Returns the zero matrix.
    pub fn zero(rows: Space, columns: Space) -> Self {
        Self {
            rows,
            columns,
            diagonal: None,
            outer: Vec::new(),
            matrices: Vec::new(),
        }
    }

    /// Returns true if the matrix has no parts.
    pub fn is_zero(&self) -> bool {
        self.diagonal.is_none() && self.outer.is_empty() && self.matrices.is_empty()
    }

    /// Adds a multiple of the identity.
    pub fn add_diagonal(&mut self, graph: &mut Graph, value: f64) {
        let value = graph.constant(value);
        self.add_to_diagonal(graph, value);
    }

    fn add_to_diagonal(&mut self, graph: &mut Graph, value: NodeId) {
        let sum = match self.diagonal {
            Some(present) => graph.add(present, value),
            None => value,
        };
        self.diagonal = (!graph.is_zero(sum)).then_some(sum);
    }

    /// Adds u v^T; outer products with equal v are collected.
    pub fn add_outer(&mut self, graph: &mut Graph, u: NodeId, v: NodeId) {
        if graph.is_zero(u) || graph.is_zero(v) {
            return;
        }
        if let Some(present) = self.outer.iter().position(|(_, other)| *other == v) {
            let sum = graph.add(self.outer[present].0, u);
            if graph.is_zero(sum) {
                self.outer.remove(present);
            } else {
                self.outer[present].0 = sum;
            }
        } else {
            self.outer.push((u, v));
        }
    }

    /// Adds diag(scale) times `other`.
    pub fn add_scaled(&mut self, graph: &mut Graph, scale: NodeId, other: &Self) {
        if graph.is_zero(scale) {
            return;
        }
        if let Some(diagonal) = other.diagonal {
            let scaled = graph.build_derivative_term(scale, diagonal);
            self.add_to_diagonal(graph, scaled);
        }
        for &(u, v) in &other.outer {
            let scaled = graph.build_derivative_term(scale, u);
            self.add_outer(graph, scaled, v);
        }
        for matrix in &other.matrices {
            let row = graph.build_derivative_term(scale, matrix.row);
            self.matrices.push(ScaledMatrix { row, ..*matrix });
        }
    }

    /// Returns `matrix`, or its transpose, times this matrix.
    pub fn multiply_from_left(&self, graph: &mut Graph, matrix: NodeId, transposed: bool) -> Self {
        let rows = match (graph.shape(matrix), transposed) {
            (Shape::Matrix(rows, _), false) => rows,
            (Shape::Matrix(_, columns), true) => columns,
            _ => self.rows,
        };
        let mut result = Self::zero(rows, self.columns);
        let one = graph.one();
        if let Some(diagonal) = self.diagonal {
            result.matrices.push(ScaledMatrix {
                row: one,
                matrix,
                transposed,
                column: diagonal,
            });
        }
        for &(u, v) in &self.outer {
            let applied = graph.apply(matrix, transposed, u);
            result.add_outer(graph, applied, v);
        }
        for inner in &self.matrices {
            // The only such products are those of mode shapes at quadrature nodes, Phi^T diag(row) Phi.
            let product = graph.intern(Operation::Gram {
                left: matrix,
                weight: inner.row,
                right: inner.matrix,
            });
            result.matrices.push(ScaledMatrix {
                row: one,
                matrix: product,
                transposed: false,
                column: inner.column,
            });
        }
        result
    }

    /// Solves a system with a given Cholesky factor and this matrix as the right-hand side.
    pub fn solve_with_factor(&self, graph: &mut Graph, factor: NodeId) -> Self {
        let mut result = Self::zero(self.rows, self.columns);
        for &(u, v) in &self.outer {
            let solved = graph.cholesky_solve(factor, u);
            result.add_outer(graph, solved, v);
        }
        let rest = Self {
            outer: Vec::new(),
            ..self.clone()
        };
        if !rest.is_zero() {
            let right = rest.assemble(graph);
            let (one, matrix) = (graph.one(), graph.cholesky_solve(factor, right));
            result.matrices.push(ScaledMatrix {
                row: one,
                matrix,
                transposed: false,
                column: one,
            });
        }
        result
    }

    /// Returns the column sums as a vector. If this matrix is the Jacobian of a vector, they are the gradient of the
    /// sum of its elements.
    pub fn sum_columns(&self, graph: &mut Graph) -> NodeId {
        let mut terms = Vec::new();
        if let Some(diagonal) = self.diagonal {
            terms.push((1.0, diagonal));
        }
        for &(u, v) in &self.outer {
            let total = graph.sum_over_space(self.rows, u);
            terms.push((1.0, graph.multiply(total, v)));
        }
        for matrix in &self.matrices {
            let applied = graph.apply(matrix.matrix, !matrix.transposed, matrix.row);
            terms.push((1.0, graph.multiply(applied, matrix.column)));
        }
        graph.combine(&terms)
    }

    /// Returns the parts as the operand of [`Operation::Assemble`].
    pub fn assembly(&self) -> Assembly {
        Assembly {
            rows: self.rows,
            columns: self.columns,
            diagonal: self.diagonal,
            outer: self.outer.clone(),
            matrices: self.matrices.clone(),
        }
    }

    /// Returns the matrix as one node.
    pub fn assemble(&self, graph: &mut Graph) -> NodeId {
        graph.intern(Operation::Assemble(Box::new(self.assembly())))
    }
}
