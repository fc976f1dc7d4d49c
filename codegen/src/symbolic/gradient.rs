//! Derivatives of a scalar by all its variables at once.
//!
//! Forward mode visits a sum of n variables n times. Reverse accumulation visits it once, and its derivatives are
//! products of adjoints and partial derivatives. Reverse accumulation stops at every operation whose derivative can
//! be infinite; its operands are differentiated in forward mode, which forms the limits at zeros of roots.

use std::collections::BTreeMap;

use eomgen_model_spec::model::Function;

use crate::symbolic::branches::choice;
use crate::symbolic::differentiate::{derive_by_scalar, derive_partials};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Shape};
use crate::symbolic::node_map::NodeMap;

/// Pairs of variable and derivative, in the order of the variables' nodes.
type Derivatives = Vec<(NodeId, NodeId)>;

/// Returns the nonzero derivatives of a scalar by all leaves of the kinds `by`, as pairs of leaf and derivative.
pub(crate) fn derive_by_all(graph: &mut Graph, scalar: NodeId, by: Dependence) -> Derivatives {
    let known = NodeMap::default();
    Gradients { by, known }.derive(graph, scalar)
}

struct Gradients {
    by: Dependence,
    /// Gradients of the nodes at which the accumulation stopped.
    known: NodeMap<NodeId, Derivatives>,
}

impl Gradients {
    fn derive(&mut self, graph: &mut Graph, scalar: NodeId) -> Derivatives {
        let mut adjoints = BTreeMap::from([(scalar, vec![(1.0, graph.one())])]);
        let mut parts = Parts::default();
        // Operands have smaller indices than their uses.
        while let Some((node, received)) = adjoints.pop_last() {
            let adjoint = graph.combine(&received);
            if self.is_variable(graph, node) {
                parts.add(node, adjoint);
            } else if self.has_bounded_slopes(graph, node) {
                for (operand, partial) in self.partials(graph, node) {
                    let part = graph.multiply(partial, adjoint);
                    adjoints.entry(operand).or_default().push((1.0, part));
                }
            } else {
                for (variable, derivative) in self.derive_stop(graph, node) {
                    parts.add(
                        variable,
                        graph.build_chain_rule_term(node, adjoint, derivative),
                    );
                }
            }
        }
        parts.sum(graph)
    }

    /// Returns the gradient of a node at which the reverse accumulation stops.
    fn derive_stop(&mut self, graph: &mut Graph, node: NodeId) -> Derivatives {
        if let Some(known) = self.known.get(&node) {
            return known.clone();
        }
        let mut parts = Parts::default();
        if is_scalar_function(graph, node) {
            for (operand, partial) in self.partials(graph, node) {
                for (variable, derivative) in self.derive(graph, operand) {
                    parts.add(
                        variable,
                        graph.build_chain_rule_term(operand, partial, derivative),
                    );
                }
            }
        } else {
            for variable in graph.reachable(&[node]) {
                if self.is_variable(graph, variable) {
                    parts.add(variable, derive_by_scalar(graph, node, variable));
                }
            }
        }
        let gradient = parts.sum(graph);
        self.known.insert(node, gradient.clone());
        gradient
    }

    /// Returns pairs of operand and partial derivative for all operands that depend on the variables.
    fn partials(&self, graph: &mut Graph, node: NodeId) -> Derivatives {
        let by = self.by;
        let moves = |graph: &Graph, operand: NodeId| graph.dependence(operand).has(by);
        let mut partials = derive_partials(graph, node, moves);
        partials.retain(|(operand, _)| moves(graph, *operand));
        partials
    }

    fn is_variable(&self, graph: &Graph, node: NodeId) -> bool {
        let is_scalar = matches!(
            graph.operation(node),
            Operation::Coordinate(_) | Operation::Rate(_)
        );
        is_scalar && graph.dependence(node).has(self.by)
    }

    /// Returns true for operations whose partial derivatives are finite: sums, and products and functions without a
    /// singularity.
    fn has_bounded_slopes(&self, graph: &Graph, node: NodeId) -> bool {
        let is_bounded = match graph.operation(node) {
            Operation::Sum(_) => true,
            Operation::Product(factors) => factors.iter().all(|(factor, exponent)| {
                *exponent > 0 || graph.dependence(*factor).is_parameter_only()
            }),
            Operation::Call(function, _) => matches!(
                function,
                Function::Sin | Function::Cos | Function::Tanh | Function::Atan
            ),
            _ => false,
        };
        is_bounded && is_scalar_function(graph, node)
    }
}

/// Returns true if a node and its operands are scalars and [`derive_partials`] covers its operation.
fn is_scalar_function(graph: &Graph, node: NodeId) -> bool {
    let has_partials = matches!(
        graph.operation(node),
        Operation::Sum(_) | Operation::Product(_) | Operation::Call(..) | Operation::Power(..)
    );
    has_partials && graph.shape(node) == Shape::Scalar && choice(graph, node).is_none()
}

/// Contributions to the derivatives, by variable.
#[derive(Default)]
struct Parts {
    terms: BTreeMap<NodeId, Vec<(f64, NodeId)>>,
}

impl Parts {
    fn add(&mut self, variable: NodeId, term: NodeId) {
        self.terms.entry(variable).or_default().push((1.0, term));
    }

    fn sum(self, graph: &mut Graph) -> Derivatives {
        let sums = self.terms.into_iter();
        let mut sums: Derivatives = sums
            .map(|(variable, terms)| (variable, graph.combine(&terms)))
            .collect();
        sums.retain(|(_, sum)| !graph.is_zero(*sum));
        sums
    }
}

#[cfg(test)]
mod tests {
    use eomgen_model_spec::ids::CoordinateId;

    use super::*;
    use crate::mechanics::inertia::point::Point;

    /// Returns the derivatives at a state computed together and, in the same order, computed one by one.
    fn derive_both(
        state: &[f64],
        scalar: impl Fn(&mut Graph, &[NodeId]) -> NodeId,
    ) -> [Vec<f64>; 2] {
        let graph = &mut Graph::new(&[], &[]);
        let variables: Vec<NodeId> = CoordinateId::first(state.len())
            .map(|index| graph.intern(Operation::Coordinate(index)))
            .collect();
        let scalar = scalar(graph, &variables);
        let all = derive_by_all(graph, scalar, Dependence::COORDINATE);
        let separate: Vec<NodeId> = all
            .iter()
            .map(|(leaf, _)| derive_by_scalar(graph, scalar, *leaf))
            .collect();
        let all: Vec<NodeId> = all.into_iter().map(|(_, derivative)| derivative).collect();
        let point = Point {
            parameters: &[],
            state,
            inputs: &[],
            coordinates: state.len(),
        };
        [all, separate].map(|nodes| {
            let values = point.values(graph, &graph.reachable(&nodes));
            let values = values.expect("scalars");
            nodes.iter().map(|node| values[node.0 as usize]).collect()
        })
    }

    fn norm(graph: &mut Graph, parts: &[NodeId]) -> NodeId {
        let squares: Vec<(f64, NodeId)> = parts
            .iter()
            .map(|part| (1.0, graph.integer_power(*part, 2)))
            .collect();
        let square = graph.combine(&squares);
        graph.call(Function::Sqrt, &[square])
    }

    #[test]
    fn derivatives_by_all_variables_match_single_derivatives() {
        let [all, separate] = derive_both(&[0.3, -0.7, 1.1], |graph, variables| {
            let &[x, y, z] = variables else {
                unreachable!("three variables")
            };
            let sum = graph.combine(&[(1.0, x), (2.0, y)]);
            let sine = graph.call(Function::Sin, &[sum]);
            let wave = graph.multiply(sine, z);
            let length = norm(graph, &[wave, y, z]);
            let least = graph.call(Function::Min, &[sum, length]);
            let angle = graph.call(Function::Atan2, &[y, z]);
            let exponent = graph.constant(0.7);
            let power = graph.power(z, exponent);
            let quotient = graph.divide(power, length);
            graph.combine(&[(1.0, wave), (2.0, least), (3.0, angle), (4.0, quotient)])
        });
        assert_eq!(all.len(), 3);
        for (a, b) in all.iter().zip(&separate) {
            assert!((a - b).abs() < 1e-13, "{all:?} {separate:?}");
        }
    }

    #[test]
    fn derivatives_have_their_limits_at_zeros_of_roots() {
        let [all, separate] = derive_both(&[0.0, 0.0, 2.0], |graph, variables| {
            let length = norm(graph, &variables[..2]);
            let root = graph.call(Function::Sqrt, &[length]);
            let drag = graph.multiply(length, variables[0]);
            let vanishing = graph.product(&[(root, 1), (variables[1], 1), (variables[2], 1)]);
            graph.combine(&[(1.0, drag), (1.0, vanishing), (1.0, variables[2])])
        });
        assert_eq!(all, [0.0, 0.0, 1.0]);
        assert_eq!(separate, all);
    }
}
