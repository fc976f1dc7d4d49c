//! Derivatives by a field's modes: a gradient vector for a scalar, a structured matrix (diagonal, outer
//! products and tables) for a vector.

use crate::symbolic::branches::choice;
use crate::symbolic::differentiate::{VariationTest, choose, derive_partials};
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape, Space};
use crate::symbolic::matrix::StructuredMatrix;
use crate::symbolic::node_map::NodeMap;

/// Derivatives with respect to the modes of one field.
pub struct ModalDerivative {
    variable: NodeId,
    space: Space,
    moving: VariationTest,
    gradients: NodeMap<NodeId, NodeId>,
    jacobians: NodeMap<NodeId, StructuredMatrix>,
}

impl ModalDerivative {
    /// Prepares derivatives with respect to the vector leaf `variable` (modal coordinates or rates); `None` for a
    /// scalar leaf.
    pub fn new(graph: &Graph, variable: NodeId) -> Option<Self> {
        match graph.shape(variable) {
            Shape::Vector(space) => Some(Self {
                variable,
                space,
                moving: VariationTest::default(),
                gradients: NodeMap::default(),
                jacobians: NodeMap::default(),
            }),
            _ => None,
        }
    }

    fn is_moving(&mut self, graph: &Graph, id: NodeId) -> bool {
        let variable = self.variable;
        if !graph.may_depend_on(id, variable) {
            return false;
        }
        self.moving.has(graph, id, &|graph, id| {
            if !graph.may_depend_on(id, variable) {
                return Some(false);
            }
            let leaf = graph.operands(graph.operation(id)).is_empty();
            leaf.then_some(id == variable)
        })
    }

    /// Returns the gradient of a scalar node: a vector over the modes, or 0.
    pub fn gradient(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if let Some(&known) = self.gradients.get(&id) {
            return known;
        }
        if !self.is_moving(graph, id) {
            return graph.zero();
        }
        let result = match graph.operation(id).clone() {
            Operation::Total(a) => {
                let jacobian = self.jacobian(graph, a);
                jacobian.sum_columns(graph)
            }
            _ if choice(graph, id).is_some() => {
                choose(graph, id, |graph, branch| self.gradient(graph, branch))
            }
            _ => {
                let partials =
                    derive_partials(graph, id, |graph, operand| self.is_moving(graph, operand));
                let mut terms = Vec::with_capacity(partials.len());
                for (operand, partial) in partials {
                    let inner = self.gradient(graph, operand);
                    if !graph.is_zero(inner) {
                        terms.push((1.0, graph.build_chain_rule_term(operand, partial, inner)));
                    }
                }
                graph.combine(&terms)
            }
        };
        self.gradients.insert(id, result);
        result
    }

    /// Returns the Jacobian of a vector node: rows for its elements, columns for the modes.
    pub fn jacobian(&mut self, graph: &mut Graph, id: NodeId) -> StructuredMatrix {
        if let Some(known) = self.jacobians.get(&id) {
            return known.clone();
        }
        let result = self.compute_jacobian(graph, id);
        self.jacobians.insert(id, result.clone());
        result
    }

    /// Returns the Jacobian of a vector, or of a scalar that is repeated for each element.
    pub fn derive_element_jacobian(
        &mut self,
        graph: &mut Graph,
        id: NodeId,
        rows: Space,
    ) -> StructuredMatrix {
        if graph.shape(id) != Shape::Scalar {
            return self.jacobian(graph, id);
        }
        let mut matrix = StructuredMatrix::zero(rows, self.space);
        let (one, gradient) = (graph.one(), self.gradient(graph, id));
        matrix.add_outer(graph, one, gradient);
        matrix
    }

    /// Returns the Jacobian of M x for constant x, where x solves M x = right and M depends on the modes.
    fn derive_product_jacobian(
        &mut self,
        graph: &mut Graph,
        factor: NodeId,
        solution: NodeId,
        rows: Space,
    ) -> StructuredMatrix {
        let zero = StructuredMatrix::zero(rows, self.space);
        let Operation::Cholesky(matrix) = *graph.operation(factor) else {
            return zero;
        };
        if !self.is_moving(graph, matrix) {
            return zero;
        }
        let Operation::Assemble(assembly) = graph.operation(matrix).clone() else {
            return zero;
        };
        let parts = assembly.multiply_vector(graph, solution);
        let terms: Vec<(f64, NodeId)> = parts.into_iter().map(|part| (1.0, part)).collect();
        let product = graph.combine(&terms);
        let mut held = Self {
            variable: self.variable,
            space: self.space,
            moving: VariationTest::default(),
            gradients: NodeMap::default(),
            jacobians: NodeMap::default(),
        };
        held.moving.known.insert(solution, false);
        held.derive_element_jacobian(graph, product, rows)
    }

    fn compute_jacobian(&mut self, graph: &mut Graph, id: NodeId) -> StructuredMatrix {
        let rows = match graph.shape(id) {
            Shape::Vector(space) => space,
            _ => self.space,
        };
        let mut result = StructuredMatrix::zero(rows, self.space);
        if !self.is_moving(graph, id) {
            return result;
        }
        if id == self.variable {
            result.add_diagonal(graph, 1.0);
            return result;
        }
        if let Operation::Apply {
            matrix,
            transposed,
            vector,
        } = *graph.operation(id)
        {
            return self
                .jacobian(graph, vector)
                .multiply_from_left(graph, matrix, transposed);
        }
        if let Operation::CholeskySolve(factor, right) = *graph.operation(id) {
            let mut rest = self.derive_element_jacobian(graph, right, rows);
            let moved = self.derive_product_jacobian(graph, factor, id, rows);
            let minus_one = graph.constant(-1.0);
            rest.add_scaled(graph, minus_one, &moved);
            return rest.solve_with_factor(graph, factor);
        }
        let partials = derive_partials(graph, id, |graph, operand| self.is_moving(graph, operand));
        for (operand, partial) in partials {
            match graph.shape(operand) {
                Shape::Scalar => {
                    let gradient = self.gradient(graph, operand);
                    result.add_outer(graph, partial, gradient);
                }
                _ => {
                    let inner = self.jacobian(graph, operand);
                    result.add_scaled(graph, partial, &inner);
                }
            }
        }
        result
    }
}
