//! Surfaces g = 0 across which the Lagrangian L = T - V jumps. Constraints do not jump.
//!
//! The motion has a corner at such a surface; see [`corners`](crate::mechanics::corners). If the Lagrangian is
//! continuous, only the accelerations jump. A position with a kink, such as max(x, 0), is continuous, but its rate
//! jumps and can make a kinetic energy jump.

use std::collections::HashMap;

use eomgen_model_spec::ids::InputId;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;

use crate::mechanics::forces::{find_guards, find_surfaces};
use crate::mechanics::guard::Guard;
use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::sides::Sides;
use crate::mechanics::translate::{DeriveError, Derived, Translator};
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::expand::{MAX_EXPANSIONS, expand_once};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Shape};
use crate::symbolic::substitute::substitute;

/// Constants below this magnitude count as zero, such as the rounded value of cos(pi/2).
const CONSTANT_ROUNDING: f64 = 1e-12;

/// Surface at which an energy jumps.
pub(crate) struct Jump {
    pub guard: Guard,
    /// True if rates of the coordinates jump; false if only an energy jumps, at a given time.
    pub moves_rates: bool,
}

/// Energies of a model, and the expressions whose rates they contain.
pub(crate) struct Energies {
    /// Kinetic energy T in J.
    pub kinetic: NodeId,
    /// Potential energy V in J.
    pub potential: NodeId,
    /// Arguments of dot() in the energies, with their locations.
    pub positions: Vec<(Span, NodeId)>,
}

/// Returns the surfaces at which energies jump.
///
/// # Errors
/// A position that jumps although an energy contains its rate. A Lagrangian or momenta that jump where a rate changes
/// its sign, or along a field.
pub(crate) fn find_jumps(translator: &mut Translator, energies: &Energies) -> Derived<Vec<Jump>> {
    check_positions(translator, energies)?;
    let roots = [energies.kinetic, energies.potential];
    let steps = JumpFunctions::find(translator, &roots);
    let mut found = vec![None; steps.guards.len()];
    for (index, found) in found.iter_mut().enumerate() {
        let value = steps.guards[index].value;
        let graph = &mut translator.graph;
        let kinetic = steps.derive_jump(graph, energies.kinetic, index);
        let potential = steps.derive_jump(graph, energies.potential, index);
        let difference = graph.subtract(kinetic, potential);
        // A jump at a given time changes the rates only if the momenta jump.
        let is_felt = graph.dependence(value).has(Dependence::COORDINATE)
            || graph.dependence(difference).has(Dependence::RATE);
        let has_energy_jump = !vanishes_on(graph, difference, value);
        let moves_rates = has_energy_jump && is_felt;
        *found = has_energy_jump.then_some(moves_rates);
        let dependence = graph.dependence(value);
        if moves_rates && graph.shape(value) != Shape::Scalar {
            return Err(field_error(find_term(translator, value)));
        }
        if moves_rates && dependence.has(Dependence::RATE) {
            return Err(rate_error(find_term(translator, value)));
        }
    }
    check_momenta(translator, energies)?;
    Ok(steps.select_jumps(&found))
}

/// Rejects positions that jump although an energy contains their rates.
fn check_positions(translator: &mut Translator, energies: &Energies) -> Derived<()> {
    let nodes: Vec<NodeId> = energies.positions.iter().map(|(_, node)| *node).collect();
    if !contains_steps(&translator.graph, &nodes) {
        return Ok(());
    }
    for (span, node) in &energies.positions {
        let steps = JumpFunctions::find(translator, &[*node]);
        let graph = &mut translator.graph;
        for (index, guard) in steps.guards.iter().enumerate() {
            let jump = steps.derive_jump(graph, *node, index);
            if !vanishes_on(graph, jump, guard.value) && is_solvable(graph, guard.value) {
                return Err(position_error(*span));
            }
        }
    }
    Ok(())
}

/// Rejects momenta that jump where a rate changes its sign, such as the momentum of the energy abs(dot(x)).
fn check_momenta(translator: &mut Translator, energies: &Energies) -> Derived<()> {
    let graph = &translator.graph;
    let switches = graph.reachable(&[energies.kinetic]).into_iter().any(|id| {
        let is_switch = match graph.operation(id) {
            Operation::Select { is_switch, .. } => *is_switch && graph.guarded_power(id).is_none(),
            Operation::Call(function, _) => function.has_switches(),
            _ => false,
        };
        is_switch && graph.dependence(id).has(Dependence::RATE)
    });
    if !switches {
        return Ok(());
    }
    let rates: Vec<NodeId> = graph
        .reachable(&[energies.kinetic])
        .into_iter()
        .filter(|id| matches!(graph.operation(*id), Operation::Rate(_)))
        .collect();
    let momenta: Vec<NodeId> = rates
        .iter()
        .map(|rate| derive_by_scalar(&mut translator.graph, energies.kinetic, *rate))
        .collect();
    let steps = JumpFunctions::find(translator, &momenta);
    for (index, guard) in steps.guards.iter().enumerate() {
        let graph = &mut translator.graph;
        if !graph.dependence(guard.value).has(Dependence::RATE) || !is_solvable(graph, guard.value)
        {
            continue;
        }
        for momentum in &momenta {
            let jump = steps.derive_jump(graph, *momentum, index);
            if !vanishes_on(graph, jump, guard.value) {
                return Err(rate_error(find_term(translator, guard.value)));
            }
        }
    }
    Ok(())
}

/// Functions that jump in some expressions, and their switching surfaces.
struct JumpFunctions {
    guards: Vec<Guard>,
    /// Indices of the surfaces of each function.
    calls: Vec<Vec<usize>>,
    /// Replacements of the functions by polynomials in the sides.
    known: HashMap<NodeId, NodeId>,
    sides: Vec<NodeId>,
}

impl JumpFunctions {
    fn find(translator: &mut Translator, roots: &[NodeId]) -> Self {
        let first = translator.model.inputs.len();
        let graph = &mut translator.graph;
        let mut values: Vec<Vec<NodeId>> = Vec::new();
        for id in graph.reachable(roots) {
            match graph.operation(id).clone() {
                _ if !is_step(graph, id) => {}
                Operation::Select { a, b, .. } => values.push(vec![graph.subtract(a, b)]),
                Operation::Call(function, arguments) => {
                    values.push(find_surfaces(graph, function, &arguments).all().collect());
                }
                _ => {}
            }
        }
        let mut steps = Self {
            guards: Vec::new(),
            calls: Vec::new(),
            known: HashMap::new(),
            sides: Vec::new(),
        };
        if values.is_empty() {
            return steps;
        }
        for guard in find_guards(graph, roots) {
            let opposite = graph.negate(guard.value);
            let mut all = values.iter().flatten();
            if all.any(|value| *value == guard.value || *value == opposite) {
                steps.guards.push(guard);
            }
        }
        for values in &values {
            let mut call = Vec::new();
            for value in values {
                let opposite = graph.negate(*value);
                let mut guards = steps.guards.iter();
                call.extend(guards.position(|g| g.value == *value || g.value == opposite));
            }
            steps.calls.push(call);
        }
        let side = |index: usize| Operation::Input(InputId::new(first + index));
        let given = (&mut *graph, &steps.guards[..]);
        steps.known = Sides::replace_jumps(given, roots, &|index| Some(side(index))).known;
        let places = 0..steps.guards.len();
        steps.sides = places.map(|index| graph.intern(side(index))).collect();
        steps
    }

    /// Returns the value of a node above a surface minus that below it.
    fn derive_jump(&self, graph: &mut Graph, node: NodeId, index: usize) -> NodeId {
        let mut known = self.known.clone();
        let sided = substitute(graph, node, &|_, _| None, &mut known);
        let own = self.sides[index];
        let at = |graph: &mut Graph, side: NodeId| {
            let replacement = |_: &mut Graph, id: NodeId| (id == own).then_some(side);
            substitute(graph, sided, &replacement, &mut HashMap::new())
        };
        let (one, zero) = (graph.one(), graph.zero());
        let (above, below) = (at(graph, one), at(graph, zero));
        graph.combine_flat(&[(1.0, above), (-1.0, below)])
    }

    /// Returns the surfaces with a jump, and the other surfaces of the same functions.
    fn select_jumps(self, found: &[Option<bool>]) -> Vec<Jump> {
        let mut taken = found.to_vec();
        for call in &self.calls {
            let moves_rates = call.iter().filter_map(|index| found[*index]).max();
            for index in call {
                taken[*index] = taken[*index].max(moves_rates);
            }
        }
        let guards = self.guards.into_iter().zip(taken);
        let scalar = guards.filter_map(|(guard, taken)| {
            Some(Jump {
                guard,
                moves_rates: taken?,
            })
        });
        scalar.collect()
    }
}

/// Returns true if a node is a function that jumps.
fn is_step(graph: &Graph, id: NodeId) -> bool {
    let jumps = match graph.operation(id) {
        Operation::Select { is_switch, .. } => *is_switch && graph.guarded_power(id).is_none(),
        Operation::Call(function, _) => function.is_step(),
        _ => false,
    };
    jumps && !graph.dependence(id).is_parameter_only()
}

fn contains_steps(graph: &Graph, nodes: &[NodeId]) -> bool {
    graph
        .reachable(nodes)
        .into_iter()
        .any(|id| is_step(graph, id))
}

/// Returns true if symbolic substitution shows that a node is zero wherever `value` is zero.
fn vanishes_on(graph: &mut Graph, node: NodeId, value: NodeId) -> bool {
    if is_zero(graph, node) {
        return true;
    }
    let zero = graph.zero();
    let mut solutions = vec![(value, zero)];
    solutions.extend(solve_for_leaves(graph, value));
    solutions.into_iter().any(|(part, solution)| {
        let replacement = |_: &mut Graph, id: NodeId| (id == part).then_some(solution);
        let mut rest = substitute(graph, node, &replacement, &mut HashMap::new());
        for _ in 0..MAX_EXPANSIONS {
            match expand_once(graph, rest) {
                Some(expanded) if !is_zero(graph, rest) => rest = expanded,
                _ => break,
            }
        }
        is_zero(graph, rest)
    })
}

fn is_zero(graph: &Graph, node: NodeId) -> bool {
    let is_rounding = |value: f64| value.abs() <= CONSTANT_ROUNDING;
    graph.is_zero(node) || graph.as_constant(node).is_some_and(is_rounding)
}

/// Returns true if `value` = 0 can be solved for a coordinate, a rate, a state or the time. Then [`vanishes_on`]
/// covers all points of the surface.
fn is_solvable(graph: &mut Graph, value: NodeId) -> bool {
    !solve_for_leaves(graph, value).is_empty()
}

/// Solves `value` = 0 for each leaf in which it is linear, and returns pairs of leaf and solution.
fn solve_for_leaves(graph: &mut Graph, value: NodeId) -> Vec<(NodeId, NodeId)> {
    let leaves = graph.reachable(&[value]).into_iter().filter(|leaf| {
        let operation = graph.operation(*leaf);
        matches!(
            operation,
            Operation::Coordinate(_) | Operation::Rate(_) | Operation::State(_) | Operation::Time
        )
    });
    let mut found = Vec::new();
    for leaf in leaves.collect::<Vec<_>>() {
        let slope = derive_by_scalar(graph, value, leaf);
        if graph.is_zero(slope) || graph.reachable(&[slope]).contains(&leaf) {
            continue;
        }
        let quotient = graph.divide(value, slope);
        let difference = graph.combine_flat(&[(1.0, leaf), (-1.0, quotient)]);
        let solution = match expand_once(graph, difference) {
            Some(expanded) => expanded,
            None => difference,
        };
        found.push((leaf, solution));
    }
    found
}

/// Returns the location of the term that contains a function with this surface.
fn find_term(translator: &mut Translator, surface: NodeId) -> Span {
    let model = translator.model;
    let terms = model.kinetic.iter().chain(&model.potential);
    let expressions: Vec<_> = terms.map(|term| &term.value).collect();
    for expression in &expressions {
        let Ok(node) = translator.node(expression) else {
            continue;
        };
        let mut known = find_guards(&mut translator.graph, &[node]).into_iter();
        if known.any(|guard| guard.value == surface) {
            return expression.span;
        }
    }
    expressions
        .first()
        .map_or(Span::default(), |first| first.span)
}

/// Rejects corners of a model whose mass matrix depends on the rates.
pub(crate) fn check_mass(model: &Model, graph: &Graph, mass: &MassMatrix) -> Derived<()> {
    let depends = |entry: &NodeId| graph.dependence(*entry).has(Dependence::RATE);
    match (
        mass.scalars.iter().flatten().any(depends),
        model.kinetic.first(),
    ) {
        (true, Some(first)) => Err(mass_error(first.value.span)),
        _ => Ok(()),
    }
}

fn mass_error(span: Span) -> DeriveError {
    DeriveError {
        span,
        message: "the energies jump at a surface, and the kinetic energy is not a polynomial of second degree in \
                  the rates: the rates after the jump are not determined"
            .into(),
        help: Some("use a kinetic energy of second degree, or energies without a jump".into()),
    }
}

fn position_error(span: Span) -> DeriveError {
    DeriveError {
        span,
        message: "this position jumps, but the energies contain its rate, which would be infinite"
            .into(),
        help: Some(
            "let it change continuously within a short time, for example by max(t - t_0, 0), or use a coordinate for the \
             position of the mass and the step in the potential only"
                .into(),
        ),
    }
}

fn rate_error(span: Span) -> DeriveError {
    DeriveError {
        span,
        message: "an energy or its momenta jump where a rate changes its sign: the momenta do \
                  not follow from the rates"
            .into(),
        help: Some(
            "let the energy depend smoothly on the rates; write friction under [forces] or [dissipation]"
                .into(),
        ),
    }
}

fn field_error(span: Span) -> DeriveError {
    DeriveError {
        span,
        message:
            "an energy jumps along a field: the rates of its modes would jump at every position"
                .into(),
        help: Some("use a continuous function, such as max(p, 0) instead of p*above(p)".into()),
    }
}
