//! Derivatives of graph nodes by a scalar variable and along a direction (forward mode), and partial
//! derivatives of each operation. Shared nodes are differentiated once; no product is expanded.

use std::collections::BTreeMap;

use eomgen_model_spec::model::Function;

use crate::symbolic::arguments::Arguments;
use crate::symbolic::branches::{choice, is_switch};
use crate::symbolic::flat::guard_partial;
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};
use crate::symbolic::node_map::NodeMap;

/// Test for nodes that vary along a direction. It runs before derivatives are built, because most of an expression is
/// constant along most directions.
#[derive(Default)]
pub(super) struct VariationTest {
    pub(super) known: NodeMap<NodeId, bool>,
}

impl VariationTest {
    /// Returns true if `id` or an operand, direct or indirect, varies. `leaf` returns the answer for leaves and for
    /// some other nodes, else `None`.
    pub(super) fn has(
        &mut self,
        graph: &Graph,
        id: NodeId,
        leaf: &dyn Fn(&Graph, NodeId) -> Option<bool>,
    ) -> bool {
        if let Some(&known) = self.known.get(&id) {
            return known;
        }
        let moves = match leaf(graph, id) {
            // This test is as fast as a lookup.
            Some(false) => return false,
            Some(true) => true,
            None => {
                let operands = graph.operands(graph.operation(id));
                operands.into_iter().any(|a| self.has(graph, a, leaf))
            }
        };
        self.known.insert(id, moves);
        moves
    }
}

/// Function that returns the derivative of a leaf.
pub type Tangent<'a> = dyn Fn(&mut Graph, NodeId) -> NodeId + 'a;

/// Direction of differentiation, given by the derivatives of the leaves of the graph.
#[derive(Default)]
pub struct Direction<'a> {
    tangent: Option<&'a Tangent<'a>>,
    known: NodeMap<NodeId, NodeId>,
    /// Nodes whose derivatives were set by [`Direction::seed`].
    seeds: Vec<NodeId>,
    /// True if seeds with the derivative 0 have been removed.
    has_moving_seeds_alone: bool,
    moving: VariationTest,
}

#[derive(Default)]
pub(crate) struct KnownDerivatives {
    known: NodeMap<NodeId, NodeId>,
    moving: VariationTest,
}

impl<'a> Direction<'a> {
    /// Creates a direction from the derivatives of all leaves except parameters; constant leaves have derivative 0.
    pub fn new(tangent: &'a Tangent<'a>) -> Self {
        Self {
            tangent: Some(tangent),
            ..Self::default()
        }
    }

    /// Creates a direction with derivatives that are known from an earlier use.
    pub(crate) fn resume(tangent: &'a Tangent<'a>, known: KnownDerivatives) -> Self {
        let KnownDerivatives { known, moving } = known;
        Self {
            tangent: Some(tangent),
            known,
            moving,
            ..Self::default()
        }
    }

    pub(crate) fn into_known(self) -> KnownDerivatives {
        let Self { known, moving, .. } = self;
        KnownDerivatives { known, moving }
    }

    /// Treats the node `id` as a variable with the derivative `tangent`.
    pub fn seed(&mut self, id: NodeId, tangent: NodeId) {
        self.known.insert(id, tangent);
        self.seeds.push(id);
        self.has_moving_seeds_alone = false;
    }

    /// Returns the derivative of `id` along the direction.
    pub fn derivative(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if let Some(&known) = self.known.get(&id) {
            return known;
        }
        let result = self.compute(graph, id);
        self.known.insert(id, result);
        result
    }

    /// Returns true if `id` can have a derivative other than 0. The test evaluates no tangents, because this would
    /// change the order of nodes in the graph.
    fn is_moving(&mut self, graph: &Graph, id: NodeId) -> bool {
        let (known, tangents) = (&self.known, self.tangent.is_some());
        if !self.has_moving_seeds_alone {
            let moves = |seed: &NodeId| known.get(seed).is_some_and(|by| !graph.is_zero(*by));
            self.seeds.retain(moves);
            self.has_moving_seeds_alone = true;
        }
        let seeds = &self.seeds;
        let is_out_of_reach =
            |id| !tangents && !seeds.iter().any(|seed| graph.may_depend_on(id, *seed));
        // This bit test rejects most terms of a long sum without a lookup.
        if is_out_of_reach(id) {
            return false;
        }
        self.moving
            .has(graph, id, &|graph, id| match known.get(&id) {
                Some(derivative) => Some(!graph.is_zero(*derivative)),
                None if is_out_of_reach(id) => Some(false),
                None => graph
                    .operands(graph.operation(id))
                    .is_empty()
                    .then(|| tangents && !graph.dependence(id).is_parameter_only()),
            })
    }

    fn compute(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        if !self.is_moving(graph, id) {
            return graph.zero();
        }
        let operation = graph.operation(id).clone();
        if graph.operands(&operation).is_empty() {
            return match self.tangent {
                Some(tangent) => tangent(graph, id),
                None => graph.zero(),
            };
        }
        match operation {
            Operation::Total(a) => {
                let inner = self.derivative(graph, a);
                match graph.shape(a) {
                    Shape::Vector(space) => graph.sum_over_space(space, inner),
                    _ => inner,
                }
            }
            Operation::Apply {
                matrix,
                transposed,
                vector,
            } => self.differentiate_product(graph, matrix, transposed, vector),
            Operation::CholeskySolve(factor, vector) => {
                self.differentiate_solution(graph, factor, vector, id)
            }
            Operation::GramDiagonal {
                left,
                weight,
                right,
            } => self.differentiate_gram_diagonal(graph, left, weight, right),
            _ if choice(graph, id).is_some() => {
                choose(graph, id, |graph, branch| self.derivative(graph, branch))
            }
            _ => {
                let partials =
                    derive_partials(graph, id, |graph, operand| self.is_moving(graph, operand));
                let mut terms = Vec::with_capacity(partials.len());
                for (operand, partial) in partials {
                    let inner = self.derivative(graph, operand);
                    if !graph.is_zero(inner) {
                        terms.push((1.0, graph.build_chain_rule_term(operand, partial, inner)));
                    }
                }
                graph.combine(&terms)
            }
        }
    }
}

/// Differentiates a node with respect to a scalar node: a leaf, or an expression that is treated as a variable.
pub fn derive_by_scalar(graph: &mut Graph, id: NodeId, variable: NodeId) -> NodeId {
    let mut direction = Direction::default();
    let one = graph.one();
    direction.seed(variable, one);
    direction.derivative(graph, id)
}

/// Selects between the derivatives of two branches. The derivatives are not multiplied by 1 and 0, because the
/// derivative of the branch not taken can be infinite or NaN.
pub(super) fn choose(
    graph: &mut Graph,
    id: NodeId,
    mut derivative: impl FnMut(&mut Graph, NodeId) -> NodeId,
) -> NodeId {
    let Some([a, b, then, otherwise]) = choice(graph, id) else {
        return graph.zero();
    };
    if let Some(guard) = graph.flat_guard(id) {
        let inner = derivative(graph, guard.inner);
        return graph.guard_flat(guard, inner);
    }
    let (taken, skipped) = (derivative(graph, then), derivative(graph, otherwise));
    graph.select_between([a, b], taken, skipped, is_switch(graph, id))
}

/// Returns the varying operands of an elementwise operation with their partial derivatives (for functions, all
/// operands). Matrix operations have no partial derivatives; `matrix_derivatives` differentiates them along a
/// direction.
pub(crate) fn derive_partials(
    graph: &mut Graph,
    id: NodeId,
    mut moves: impl FnMut(&Graph, NodeId) -> bool,
) -> Vec<(NodeId, NodeId)> {
    if let Some(guard) = graph.flat_guard(id) {
        let mut partials = derive_partials(
            graph,
            guard.inner,
            &mut moves as &mut dyn FnMut(&Graph, NodeId) -> bool,
        );
        for (_, partial) in &mut partials {
            *partial = graph.guard_flat(guard.permanent(), *partial);
        }
        return partials;
    }
    if let Some([a, b, then, otherwise]) = choice(graph, id) {
        let (zero, one) = (graph.zero(), graph.one());
        let is_switch = is_switch(graph, id);
        let taken = graph.select_between([a, b], one, zero, is_switch);
        let skipped = graph.select_between([a, b], zero, one, is_switch);
        return vec![(then, taken), (otherwise, skipped)];
    }
    if let Some((base, exponent)) = graph.guarded_power(id) {
        let plain = graph.integer_power(base, exponent);
        return derive_partials(graph, plain, moves);
    }
    match graph.operation(id).clone() {
        Operation::Sum(terms) => terms
            .iter()
            .filter_map(|&(factor, term)| {
                if !moves(graph, term) {
                    return None;
                }
                Some((term, graph.constant(factor.value())))
            })
            .collect(),
        Operation::Product(factors) => remove_guards(graph, &factors)
            .iter()
            .filter_map(|&(factor, exponent)| {
                if !moves(graph, factor) {
                    return None;
                }
                let lowered: Vec<(NodeId, i32)> = remove_guards(graph, &factors)
                    .iter()
                    .map(|&(other, power)| (other, if other == factor { power - 1 } else { power }))
                    .collect();
                let rest = graph.product(&lowered);
                Some((factor, graph.scale(f64::from(exponent), rest)))
            })
            .collect(),
        Operation::Power(base, exponent) => {
            let mut partials = differentiate_power(graph, id, base, exponent);
            if graph
                .as_constant(exponent)
                .is_none_or(|number| number < 1.0)
            {
                partials[0].1 = guard_partial(graph, partials[0].1, base, &mut moves);
            }
            partials.into()
        }
        Operation::Call(function, arguments) => {
            let mut partials = differentiate_function_call(graph, id, function, arguments);
            if let ([(argument, partial)], true) = (&mut partials[..], has_singular_slope(function))
            {
                *partial = guard_partial(graph, *partial, *argument, &mut moves);
            }
            partials
        }
        Operation::PivotReciprocal(pivot) => {
            let square = graph.integer_power(id, 2);
            vec![(pivot, graph.negate(square))]
        }
        _ => Vec::new(),
    }
}

/// Replaces guarded powers in a product by powers, because each term of the derivative gets its own guards.
fn remove_guards(graph: &Graph, factors: &[(NodeId, i32)]) -> Vec<(NodeId, i32)> {
    let mut collected = BTreeMap::new();
    for &(factor, exponent) in factors {
        let (base, power) = graph.guarded_power(factor).unwrap_or((factor, 1));
        *collected.entry(base).or_insert(0) += power * exponent;
    }
    collected.retain(|_, exponent| *exponent != 0);
    collected.into_iter().collect()
}

fn differentiate_power(
    graph: &mut Graph,
    id: NodeId,
    base: NodeId,
    exponent: NodeId,
) -> [(NodeId, NodeId); 2] {
    let minus_one = graph.constant(-1.0);
    let lowered = graph.add(exponent, minus_one);
    let power = graph.power(base, lowered);
    let by_base = graph.multiply(exponent, power);
    let by_exponent = derive_by_exponent(graph, id, base, exponent);
    [(base, by_base), (exponent, by_exponent)]
}

/// Returns b^e ln(b), which has the limit 0 at b = 0 for e > 0. Without a limit, the result at b = 0 is NaN.
fn derive_by_exponent(graph: &mut Graph, power: NodeId, base: NodeId, exponent: NodeId) -> NodeId {
    let logarithm = graph.call(Function::Ln, &[base]);
    let then = graph.multiply(power, logarithm);
    if !graph.dependence(exponent).is_parameter_only() {
        return then;
    }
    let root = graph.call(Function::Sqrt, &[base]);
    let (otherwise, zero) = (graph.multiply(power, root), graph.zero());
    graph.select(base, zero, then, otherwise)
}

fn differentiate_function_call(
    graph: &mut Graph,
    id: NodeId,
    function: Function,
    arguments: Arguments<NodeId>,
) -> Vec<(NodeId, NodeId)> {
    match (function, &*arguments) {
        (Function::Atan2, &[y, x]) => {
            let squares = [graph.integer_power(y, 2), graph.integer_power(x, 2)];
            let radius = graph.add(squares[0], squares[1]);
            let by_y = graph.divide(x, radius);
            let by_x = graph.divide(y, radius);
            vec![(y, by_y), (x, graph.negate(by_x))]
        }
        (Function::Deadzone, &[p, b]) => {
            let contact = graph.call(Function::Contact, arguments);
            let side = graph.call(Function::Sign, &[p]);
            let by_b = graph.multiply(contact, side);
            vec![(p, contact), (b, graph.negate(by_b))]
        }
        (_, &[a]) => match differentiate_function(graph, id, function, a) {
            Some(derivative) => vec![(a, derivative)],
            None => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// Returns true if a function has an infinite derivative at the boundary of its domain, at which `max` or `min` may
/// clip its argument.
fn has_singular_slope(function: Function) -> bool {
    matches!(
        function,
        Function::Sqrt | Function::Asin | Function::Acos | Function::Ln
    )
}

/// Returns the derivative of a function of one argument; `None` if the derivative is 0 almost everywhere.
fn differentiate_function(
    graph: &mut Graph,
    id: NodeId,
    function: Function,
    a: NodeId,
) -> Option<NodeId> {
    let one = graph.one();
    let square = |graph: &mut Graph, x: NodeId| graph.integer_power(x, 2);
    Some(match function {
        Function::Sin => graph.call(Function::Cos, &[a]),
        Function::Cos => {
            let sine = graph.call(Function::Sin, &[a]);
            graph.negate(sine)
        }
        Function::Tan => {
            let tangent = square(graph, id);
            graph.add(one, tangent)
        }
        Function::Asin | Function::Acos => {
            let argument = square(graph, a);
            let rest = graph.subtract(one, argument);
            let root = graph.call(Function::Sqrt, &[rest]);
            let slope = graph.integer_power(root, -1);
            if function == Function::Acos {
                graph.negate(slope)
            } else {
                slope
            }
        }
        Function::Atan => {
            let argument = square(graph, a);
            let sum = graph.add(one, argument);
            graph.integer_power(sum, -1)
        }
        Function::Sinh => graph.call(Function::Cosh, &[a]),
        Function::Cosh => graph.call(Function::Sinh, &[a]),
        Function::Tanh => {
            let value = square(graph, id);
            graph.subtract(one, value)
        }
        Function::Exp => id,
        Function::Ln => graph.integer_power(a, -1),
        Function::Sqrt => {
            let reciprocal = graph.integer_power(id, -1);
            graph.scale(0.5, reciprocal)
        }
        Function::Abs => graph.call(Function::Sign, &[a]),
        _ => return None,
    })
}
