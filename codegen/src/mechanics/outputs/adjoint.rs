//! Gradients by reverse accumulation: derivatives of a weighted sum of nodes by every leaf, in one pass from the
//! nodes to the leaves. Vectors are not split into elements. If a vector contributes to a scalar, its contributions
//! are summed over the elements; the adjoint of a sum over elements applies to every element. The conditions of a
//! branch are applied to the sum of its contributions.

use eomgen_model_spec::ids::{CoordinateId, FieldId, ParameterId, StateId};
use std::collections::HashMap;

use super::matrix_derivatives::holds_matrix_of_parameters;
use crate::mechanics::equations::Equations;
use crate::symbolic::branches::choice;
use crate::symbolic::differentiate::derive_partials;
use crate::symbolic::graph::{
    Argument, Dependence, Graph, NodeId, Operation, Shape, Space, Variable,
};

/// Returns the leaf for the weight of the rate of a variable.
pub fn weight(graph: &mut Graph, variable: Variable) -> NodeId {
    graph.intern(Operation::Argument(Argument::Weights, variable))
}

/// Pairs each acceleration and each rate of a first-order state with the leaf of its weight.
pub fn pair_weights(equations: &mut Equations) -> Vec<(NodeId, NodeId)> {
    let rows = &equations.accelerations.rows;
    let graph = &mut equations.graph;
    let mut weighted = Vec::new();
    for (index, row) in CoordinateId::first(rows.scalars.len()).zip(&rows.scalars) {
        weighted.push((weight(graph, Variable::Rate(index)), *row));
    }
    for (field, row) in FieldId::first(rows.modal.len()).zip(&rows.modal) {
        weighted.push((weight(graph, Variable::ModeRates(field)), *row));
    }
    for (index, rate) in StateId::first(equations.state_rates.len()).zip(&equations.state_rates) {
        weighted.push((weight(graph, Variable::State(index)), *rate));
    }
    weighted
}

/// Returns the gradient of the sum of weight times node (summed over the elements of a vector) by every leaf except
/// parameters. State-dependent diagonals of Gram matrices are not differentiated; the caller must exclude them.
pub fn gradient(graph: &mut Graph, weighted: &[(NodeId, NodeId)]) -> HashMap<NodeId, NodeId> {
    accumulate(graph, weighted, |graph, id| {
        !graph.dependence(id).is_parameter_only()
    })
}

/// Returns the gradient by every independent parameter, in their order, including the dependence through derived
/// parameters. Returns `None` if a matrix depends on parameters.
pub fn derive_gradient_by_parameters(
    graph: &mut Graph,
    weighted: &[(NodeId, NodeId)],
    derived: &[Option<NodeId>],
) -> Option<Vec<NodeId>> {
    let mut roots: Vec<NodeId> = weighted.iter().map(|(_, node)| *node).collect();
    roots.extend(derived.iter().flatten());
    if holds_matrix_of_parameters(graph, &roots) {
        return None;
    }
    let mut parts: Vec<Vec<(f64, NodeId)>> = vec![Vec::new(); derived.len()];
    propagate_to_parameters(graph, weighted, &mut parts);
    for index in order_outermost_first(graph, derived) {
        let received = std::mem::take(&mut parts[index]);
        let adjoint = graph.combine(&received);
        if let (Some(expression), false) = (derived[index], graph.is_zero(adjoint)) {
            propagate_to_parameters(graph, &[(adjoint, expression)], &mut parts);
        }
    }
    let independent = parts.iter().zip(derived).filter(|(_, d)| d.is_none());
    Some(independent.map(|(parts, _)| graph.combine(parts)).collect())
}

/// Adds the contributions from derived parameters to the contributions of the parameters in their expressions.
fn propagate_to_parameters(
    graph: &mut Graph,
    weighted: &[(NodeId, NodeId)],
    parts: &mut [Vec<(f64, NodeId)>],
) {
    let received = accumulate(graph, weighted, depends_on_parameters);
    let mut received: Vec<(NodeId, NodeId)> = received.into_iter().collect();
    received.sort();
    for (leaf, adjoint) in received {
        if let Operation::Parameter(index) = *graph.operation(leaf) {
            parts[index].push((1.0, adjoint));
        }
    }
}

fn depends_on_parameters(graph: &Graph, id: NodeId) -> bool {
    graph.dependence(id).has(Dependence::PARAMETER)
}

/// Returns the derived parameters, each before the derived parameters in its expression.
fn order_outermost_first(graph: &Graph, derived: &[Option<NodeId>]) -> Vec<ParameterId> {
    let mut order = Vec::new();
    let mut known = vec![false; derived.len()];
    for index in ParameterId::first(derived.len()) {
        order_after_operands(graph, derived, index, &mut known, &mut order);
    }
    order.reverse();
    order
}

fn order_after_operands(
    graph: &Graph,
    derived: &[Option<NodeId>],
    index: ParameterId,
    known: &mut [bool],
    order: &mut Vec<ParameterId>,
) {
    let (Some(expression), false) = (derived[index], known[index]) else {
        return;
    };
    known[index] = true;
    for node in graph.reachable(&[expression]) {
        if let Operation::Parameter(read) = *graph.operation(node) {
            order_after_operands(graph, derived, read, known, order);
        }
    }
    order.push(index);
}

/// Returns the gradient by every leaf; only nodes that `follows` accepts are differentiated.
fn accumulate(
    graph: &mut Graph,
    weighted: &[(NodeId, NodeId)],
    follows: fn(&Graph, NodeId) -> bool,
) -> HashMap<NodeId, NodeId> {
    let roots: Vec<NodeId> = weighted.iter().map(|(_, node)| *node).collect();
    let mut adjoints = Adjoints {
        received: HashMap::new(),
        follows,
    };
    for &(weight, node) in weighted {
        adjoints.add(node, AdjointPart::from_value(weight));
    }
    let mut gradient = HashMap::new();
    for id in graph.reachable(&roots).into_iter().rev() {
        if !follows(graph, id) {
            continue;
        }
        let adjoint = adjoints.total(graph, id);
        if graph.is_zero(adjoint.value) {
            continue;
        }
        if graph.operands(graph.operation(id)).is_empty() {
            gradient.insert(id, adjoint.select(graph));
        } else {
            adjoints.propagate(graph, id, &adjoint);
        }
    }
    gradient
}

/// Condition of a branch: a > b, or its negation.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Condition {
    a: NodeId,
    b: NodeId,
    holds: bool,
}

impl Condition {
    /// Returns `value` if the branch is taken, else 0.
    fn select(self, graph: &mut Graph, value: NodeId) -> NodeId {
        let zero = graph.zero();
        let (then, otherwise) = if self.holds {
            (value, zero)
        } else {
            (zero, value)
        };
        graph.select(self.a, self.b, then, otherwise)
    }

    fn is_scalar(self, graph: &Graph) -> bool {
        [self.a, self.b]
            .into_iter()
            .all(|id| graph.shape(id) == Shape::Scalar)
    }
}

/// Part of an adjoint under conditions, the outermost first. The selection is postponed until parts of different
/// branches are added. A partial derivative in a branch that is not taken can be infinite or NaN, and its product
/// with 0 would be NaN.
#[derive(Clone)]
pub(super) struct AdjointPart {
    conditions: Vec<Condition>,
    pub(super) value: NodeId,
}

impl AdjointPart {
    fn from_value(value: NodeId) -> Self {
        Self {
            conditions: Vec::new(),
            value,
        }
    }

    pub(super) fn with_value(&self, value: NodeId) -> Self {
        Self {
            conditions: self.conditions.clone(),
            value,
        }
    }

    fn add_condition(&self, condition: Condition) -> Self {
        let mut part = self.clone();
        part.conditions.push(condition);
        part
    }

    fn select(self, graph: &mut Graph) -> NodeId {
        self.select_to(graph, 0).value
    }

    /// Applies the innermost conditions until at most `open` conditions remain.
    fn select_to(mut self, graph: &mut Graph, open: usize) -> Self {
        while self.conditions.len() > open
            && let Some(condition) = self.conditions.pop()
        {
            self.value = condition.select(graph, self.value);
        }
        self
    }

    /// Applies the conditions that differ between elements.
    fn select_by_element(self, graph: &mut Graph) -> Self {
        let whole = self
            .conditions
            .iter()
            .take_while(|condition| condition.is_scalar(graph))
            .count();
        self.select_to(graph, whole)
    }
}

/// Contributions to each node so far.
pub(super) struct Adjoints {
    received: HashMap<NodeId, Vec<AdjointPart>>,
    /// Predicate of the nodes to follow.
    pub(super) follows: fn(&Graph, NodeId) -> bool,
}

impl Adjoints {
    fn add(&mut self, id: NodeId, part: AdjointPart) {
        self.received.entry(id).or_default().push(part);
    }

    /// Sums the contributions to a node, under their common conditions.
    fn total(&mut self, graph: &mut Graph, id: NodeId) -> AdjointPart {
        let parts = self.received.remove(&id).unwrap_or_default();
        let mut common = parts.first().map_or(Vec::new(), |p| p.conditions.clone());
        for part in &parts {
            let pairs = common.iter().zip(&part.conditions);
            common.truncate(pairs.take_while(|(a, b)| a == b).count());
        }
        let mut terms = Vec::with_capacity(parts.len());
        for part in parts {
            terms.push((1.0, part.select_to(graph, common.len()).value));
        }
        AdjointPart {
            conditions: common,
            value: graph.combine(&terms),
        }
    }

    /// Adds a vector over `space`, or a scalar for each element of this space, to the adjoint of a node.
    pub(super) fn add_over(
        &mut self,
        graph: &mut Graph,
        space: Space,
        operand: NodeId,
        part: AdjointPart,
    ) {
        let part = match graph.shape(operand) {
            Shape::Scalar => {
                let part = part.select_by_element(graph);
                let total = graph.sum_over_space(space, part.value);
                part.with_value(total)
            }
            _ => part,
        };
        self.add(operand, part);
    }

    /// Passes the adjoint of `id` to its operands.
    fn propagate(&mut self, graph: &mut Graph, id: NodeId, adjoint: &AdjointPart) {
        match graph.operation(id).clone() {
            Operation::Total(a) => self.add(a, adjoint.clone()),
            Operation::Apply {
                matrix,
                transposed,
                vector,
            } => {
                let adjoint = adjoint.clone().select_by_element(graph);
                let part = adjoint.with_value(graph.apply(matrix, !transposed, adjoint.value));
                if let Shape::Matrix(rows, columns) = graph.shape(matrix) {
                    let space = if transposed { rows } else { columns };
                    self.add_over(graph, space, vector, part);
                }
            }
            Operation::CholeskySolve(factor, vector) => {
                let adjoint = adjoint.clone().select_by_element(graph);
                let part = adjoint.with_value(graph.cholesky_solve(factor, adjoint.value));
                if let Shape::Vector(space) = graph.shape(id) {
                    self.add_over(graph, space, vector, part.clone());
                }
                if let Operation::Cholesky(matrix) = *graph.operation(factor)
                    && (self.follows)(graph, matrix)
                {
                    let left = graph.negate(part.value);
                    self.propagate_to_matrix(graph, matrix, part.with_value(left), id);
                }
            }
            _ => self.propagate_element_wise(graph, id, adjoint),
        }
    }

    fn propagate_element_wise(&mut self, graph: &mut Graph, id: NodeId, adjoint: &AdjointPart) {
        let parts: Vec<(NodeId, AdjointPart)> =
            if let Some([a, b, then, otherwise]) = choice(graph, id) {
                let branch = |holds| adjoint.add_condition(Condition { a, b, holds });
                vec![(then, branch(true)), (otherwise, branch(false))]
            } else {
                derive_partials(graph, id, self.follows)
                    .into_iter()
                    .map(|(operand, partial)| {
                        let product = graph.build_derivative_term(partial, adjoint.value);
                        (operand, adjoint.with_value(product))
                    })
                    .collect()
            };
        for (operand, part) in parts {
            if !(self.follows)(graph, operand) {
                continue;
            }
            match graph.shape(id) {
                Shape::Vector(space) => self.add_over(graph, space, operand, part),
                _ => self.add(operand, part),
            }
        }
    }
}
