//! Derivatives on the flat side of a switch, on which the switch makes an expression constant.
//!
//! `sqrt(max(x, 0))` is constant for x < 0. Its derivative there is 0, but the chain rule gives 1/sqrt(0) times 0.
//! The activity of an expression is a node that is 0 on every open set on which a switch makes the expression
//! constant, and positive elsewhere. A term of a derivative with a factor that can be infinite is set to 0 if the
//! activity is 0. On the switching surface the activity is positive; therefore a derivative without a limit remains
//! infinite or NaN.

use std::collections::HashMap;

use eomgen_model_spec::model::Function;

use crate::symbolic::branches::choice;
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};
use crate::symbolic::switches::FlatGuard;

impl Graph {
    /// Returns the flat-side guard that a node represents, if there is one.
    pub(crate) fn flat_guard(&self, id: NodeId) -> Option<FlatGuard> {
        self.flat_guards.get(&id).copied()
    }

    /// Applies the condition of `guard` to `inner`, unless nothing in `inner` can be infinite.
    pub(super) fn guard_flat(&mut self, guard: FlatGuard, inner: NodeId) -> NodeId {
        if self.is_zero(inner) || !(guard.is_permanent || self.has_reciprocal_root(inner)) {
            return inner;
        }
        let zero = self.zero();
        let node = match *self.operation(guard.activity) {
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                ..
            } if self.is_zero(then) && self.as_constant(otherwise).is_some() => {
                self.select(a, b, zero, inner)
            }
            _ => self.select(guard.activity, zero, inner, zero),
        };
        let guard = FlatGuard { inner, ..guard };
        self.flat_guards.insert(node, guard);
        node
    }

    /// Returns a factor without its guards, and adds these to `guards`, outermost first.
    pub(super) fn remove_flat_guards(
        &mut self,
        mut id: NodeId,
        guards: &mut Vec<FlatGuard>,
    ) -> NodeId {
        loop {
            if let Some(guard) = self.flat_guard(id) {
                let activity = guard.activity;
                if guards.iter().all(|known| known.activity != activity) {
                    guards.push(guard);
                }
                id = guard.inner;
            } else if let Operation::Sum(terms) = self.operation(id)
                && let &[(factor, term)] = &**terms
                && self.flat_guard(term).is_some()
            {
                let inner = self.remove_flat_guards(term, guards);
                return self.scale(factor.value(), inner);
            } else {
                return id;
            }
        }
    }
}

/// Guards `partial`, the derivative of a function with respect to `argument`, if a switch can make `argument` constant.
pub(super) fn guard_partial(
    graph: &mut Graph,
    partial: NodeId,
    argument: NodeId,
    moves: &mut dyn FnMut(&Graph, NodeId) -> bool,
) -> NodeId {
    if !graph.holds_switch(argument) {
        return partial;
    }
    let activity = Activities::new(moves).activity(graph, argument);
    if graph.as_constant(activity).is_some() {
        return partial;
    }
    let guard = FlatGuard {
        activity,
        inner: partial,
        is_permanent: !graph.has_reciprocal_root(partial),
    };
    graph.guard_flat(guard, partial)
}

/// Activities and supports of nodes. The support of a node is another node that is 0 on every open set on which a
/// switch makes the first node 0.
struct Activities<'m> {
    moves: &'m mut dyn FnMut(&Graph, NodeId) -> bool,
    activities: HashMap<NodeId, NodeId>,
    supports: HashMap<NodeId, NodeId>,
}

impl<'m> Activities<'m> {
    fn new(moves: &'m mut dyn FnMut(&Graph, NodeId) -> bool) -> Self {
        Self {
            moves,
            activities: HashMap::new(),
            supports: HashMap::new(),
        }
    }

    fn activity(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if let Some(&known) = self.activities.get(&id) {
            return known;
        }
        let activity = self.find_activity(graph, id);
        self.activities.insert(id, activity);
        activity
    }

    fn find_activity(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if !(self.moves)(graph, id) {
            return graph.zero();
        }
        let operation = graph.operation(id).clone();
        let operands = graph.operands(&operation);
        // The variable of differentiation can be an expression.
        let is_variable = !operands.iter().any(|operand| (self.moves)(graph, *operand));
        if is_variable || !graph.holds_switch(id) {
            return graph.one();
        }
        if let Some([a, b, then, otherwise]) = choice(graph, id) {
            let branches = [then, otherwise].map(|branch| self.activity(graph, branch));
            return build_strict_selection(graph, a, b, branches);
        }
        match operation {
            Operation::Sum(_) | Operation::Power(..) => self.derive_any_activity(graph, &operands),
            Operation::Product(_) => {
                let activity = self.derive_any_activity(graph, &operands);
                match self.support(graph, id) {
                    support if support == activity => activity,
                    support => graph.multiply(activity, support),
                }
            }
            Operation::Call(Function::Contact | Function::Above, _) => graph.zero(),
            Operation::Call(Function::Deadzone, arguments) => {
                build_outside_play(graph, arguments[0], arguments[1])
            }
            Operation::Call(..) => self.derive_any_activity(graph, &operands),
            Operation::Total(vector) => {
                let activity = self.activity(graph, vector);
                total(graph, vector, activity)
            }
            _ => graph.one(),
        }
    }

    /// Returns a node that is positive if any of the operands is active.
    fn derive_any_activity(&mut self, graph: &mut Graph, operands: &[NodeId]) -> NodeId {
        let found = operands
            .iter()
            .map(|operand| self.activity(graph, *operand));
        let found: Vec<NodeId> = found.collect();
        build_any_positive(graph, &found)
    }

    fn support(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if let Some(&known) = self.supports.get(&id) {
            return known;
        }
        let support = self.find_support(graph, id);
        self.supports.insert(id, support);
        support
    }

    fn find_support(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if graph.is_zero(id) {
            return id;
        }
        if !graph.holds_switch(id) {
            return graph.one();
        }
        if let Some([a, b, then, otherwise]) = choice(graph, id) {
            let branches = [then, otherwise].map(|branch| self.support(graph, branch));
            return build_strict_selection(graph, a, b, branches);
        }
        match graph.operation(id).clone() {
            Operation::Sum(terms) => {
                let found = terms.iter().map(|(_, term)| self.support(graph, *term));
                let found: Vec<NodeId> = found.collect();
                build_any_positive(graph, &found)
            }
            Operation::Product(factors) => {
                let mut product = graph.one();
                for &(factor, exponent) in &factors {
                    if exponent > 0 {
                        let support = self.support(graph, factor);
                        product = graph.multiply(product, support);
                    }
                }
                product
            }
            Operation::Call(Function::Deadzone | Function::Contact, arguments) => {
                build_outside_play(graph, arguments[0], arguments[1])
            }
            Operation::Call(Function::Above, arguments) => {
                let (zero, one) = (graph.zero(), graph.one());
                graph.select(zero, arguments[0], zero, one)
            }
            Operation::Call(function, arguments) if vanishes_at_zero(function) => {
                self.support(graph, arguments[0])
            }
            Operation::Total(vector) => {
                let support = self.support(graph, vector);
                total(graph, vector, support)
            }
            _ => graph.one(),
        }
    }
}

/// Selects the first branch if a > b and the second if b > a; if a = b, a branch that is not 0.
fn build_strict_selection(
    graph: &mut Graph,
    a: NodeId,
    b: NodeId,
    branches: [NodeId; 2],
) -> NodeId {
    let [then, otherwise] = branches;
    if graph.is_zero(otherwise) {
        return graph.select(b, a, otherwise, then);
    }
    graph.select(a, b, then, otherwise)
}

/// Returns a node that is 0 if |p| < b, else 1.
fn build_outside_play(graph: &mut Graph, p: NodeId, b: NodeId) -> NodeId {
    let magnitude = graph.call(Function::Abs, &[p]);
    let (zero, one) = (graph.zero(), graph.one());
    graph.select(b, magnitude, zero, one)
}

/// Returns a node that is positive if at least one of the nodes is positive; no node may be negative.
fn build_any_positive(graph: &mut Graph, nodes: &[NodeId]) -> NodeId {
    let is_positive = |id: &NodeId| graph.as_constant(*id).is_some_and(|value| value > 0.0);
    if nodes.iter().any(is_positive) {
        return graph.one();
    }
    let terms: Vec<(f64, NodeId)> = nodes.iter().map(|id| (1.0, *id)).collect();
    graph.combine(&terms)
}

/// Returns the sum of `summand` over the index space of `vector`.
fn total(graph: &mut Graph, vector: NodeId, summand: NodeId) -> NodeId {
    match graph.shape(vector) {
        Shape::Vector(space) => graph.sum_over_space(space, summand),
        _ => summand,
    }
}

fn vanishes_at_zero(function: Function) -> bool {
    function.is_odd() || matches!(function, Function::Abs | Function::Sqrt)
}
