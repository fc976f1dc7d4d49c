//! Gradients by reverse accumulation: of a weighted sum of nodes, by every leaf they depend
//! on, in one pass from the nodes down. Vectors stay vectors: what a scalar receives from a
//! vector is summed over its elements, what a sum hands down stands for every element.

use std::collections::HashMap;

use crate::differentiate::{choice, partial_derivatives};
use crate::graph::{Graph, Id, Operation, Shape, Space};

/// The gradient of the sum of weight times node, a vector's elements summed, by every leaf
/// that is no parameter. Matrices that move are not followed; the caller sees to it that
/// there are none.
pub fn gradient(graph: &mut Graph, weighted: &[(Id, Id)]) -> HashMap<Id, Id> {
    let roots: Vec<Id> = weighted.iter().map(|(_, node)| *node).collect();
    let mut adjoints = Adjoints::default();
    for &(weight, node) in weighted {
        adjoints.add(node, 1.0, weight);
    }
    let mut gradient = HashMap::new();
    for id in graph.reachable(&roots).into_iter().rev() {
        if graph.dependence(id).is_prepared() {
            continue;
        }
        let adjoint = adjoints.total(graph, id);
        if graph.is_zero(adjoint) {
            continue;
        }
        if graph.operands(graph.operation(id)).is_empty() {
            gradient.insert(id, adjoint);
        } else {
            adjoints.hand_down(graph, id, adjoint);
        }
    }
    gradient
}

/// What each node has received so far.
#[derive(Default)]
struct Adjoints {
    received: HashMap<Id, Vec<(f64, Id)>>,
}

impl Adjoints {
    fn add(&mut self, id: Id, factor: f64, part: Id) {
        self.received.entry(id).or_default().push((factor, part));
    }

    fn total(&mut self, graph: &mut Graph, id: Id) -> Id {
        let parts = self.received.remove(&id).unwrap_or_default();
        graph.combine(&parts)
    }

    /// Adds a part that is a vector over `space`, or stands for each of its elements.
    fn add_over(&mut self, graph: &mut Graph, space: Space, operand: Id, part: Id) {
        let part = match graph.shape(operand) {
            Shape::Scalar => graph.total_over(space, part),
            _ => part,
        };
        self.add(operand, 1.0, part);
    }

    /// What the operands of `id` receive from its adjoint.
    fn hand_down(&mut self, graph: &mut Graph, id: Id, adjoint: Id) {
        match graph.operation(id).clone() {
            Operation::Total(a) => self.add(a, 1.0, adjoint),
            Operation::Apply {
                matrix,
                transposed,
                vector,
            } => {
                let part = graph.apply(matrix, !transposed, adjoint);
                if let Shape::Matrix(rows, columns) = graph.shape(matrix) {
                    let space = if transposed { rows } else { columns };
                    self.add_over(graph, space, vector, part);
                }
            }
            Operation::CholeskySolve(factor, vector) => {
                let part = graph.cholesky_solve(factor, adjoint);
                if let Shape::Vector(space) = graph.shape(id) {
                    self.add_over(graph, space, vector, part);
                }
            }
            _ => self.hand_down_element_wise(graph, id, adjoint),
        }
    }

    fn hand_down_element_wise(&mut self, graph: &mut Graph, id: Id, adjoint: Id) {
        let parts: Vec<(Id, Id)> = if let Some([a, b, then, otherwise]) = choice(graph, id) {
            let zero = graph.zero();
            let taken = graph.select(a, b, adjoint, zero);
            let skipped = graph.select(a, b, zero, adjoint);
            vec![(then, taken), (otherwise, skipped)]
        } else {
            partial_derivatives(graph, id, |graph, operand| {
                !graph.dependence(operand).is_prepared()
            })
            .into_iter()
            .map(|(operand, partial)| (operand, graph.multiply(partial, adjoint)))
            .collect()
        };
        for (operand, part) in parts {
            if graph.dependence(operand).is_prepared() {
                continue;
            }
            match graph.shape(id) {
                Shape::Vector(space) => self.add_over(graph, space, operand, part),
                _ => self.add(operand, 1.0, part),
            }
        }
    }
}
