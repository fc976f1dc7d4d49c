//! Second derivatives of the rates by forward-over-reverse differentiation: the gradient of their weighted sum is
//! differentiated along a direction. One function computes every column of the Hessian. Therefore the emitted code
//! has a size proportional to the gradient, independent of the number of variables.

use std::collections::HashMap;
use std::ops::Range;

use super::adjoint::{self, pair_weights};
use super::jacobian::{degrees_of_freedom, list_state_variables, mode_offset, seed_derived};
use super::types::{GradientDerivative, GradientRow, Jacobian};
use crate::mechanics::equations::Equations;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Argument, NodeId, Operation, Variable};
use eomgen_model_spec::ids::{InputId, ParameterId};

/// Variables with their index ranges, in the order time, state, inputs, independent parameters.
type IndexRanges = Vec<(Variable, Range<usize>)>;

/// Derives the derivative of the gradient along a direction. `weighted_by_parameters` is the gradient by the
/// parameters.
pub(crate) fn gradient_derivative(
    equations: &mut Equations,
    weighted_by_parameters: &Jacobian<NodeId>,
) -> GradientDerivative<NodeId> {
    let places = find_index_ranges(equations);
    let gradient = derive_gradient(equations, &places, weighted_by_parameters);
    let columns = find_columns(equations, &places);
    let mut direction = Direction::default();
    for (variable, _) in &places {
        let leaf = equations.graph.variable(*variable);
        let along = Operation::Argument(Argument::PointDirection, *variable);
        direction.seed(leaf, equations.graph.intern(along));
    }
    let (graph, derived) = (&mut equations.graph, &equations.derived_parameters);
    let mut seeded = vec![false; derived.len()];
    for index in ParameterId::first(derived.len()) {
        seed_derived(graph, derived, index, &mut direction, &mut seeded);
    }
    let mut rows = Vec::new();
    for (place, node) in gradient {
        let value = direction.derivative(graph, node);
        if graph.is_zero(value) {
            continue;
        }
        let reached = graph.reachable(&[node]).into_iter();
        let mut depends: Vec<Range<usize>> = reached
            .filter_map(|leaf| columns.get(&leaf))
            .flatten()
            .cloned()
            .collect();
        depends.sort_by_key(|range| range.start);
        depends.dedup();
        rows.push(GradientRow {
            first: place.start,
            count: place.len(),
            value,
            columns: depends,
        });
    }
    GradientDerivative { rows }
}

fn find_index_ranges(equations: &Equations) -> IndexRanges {
    let degrees = degrees_of_freedom(equations);
    let before_inputs = 1 + 2 * degrees + equations.state_rates.len();
    let before_parameters = before_inputs + equations.inputs;
    let one = |first: usize| first..first + 1;
    let mut places = vec![(Variable::Time, one(0))];
    for variable in list_state_variables(equations) {
        let modes = |field, before: usize| {
            let first = 1 + before + mode_offset(equations, field);
            first..first + equations.graph.orders()[field]
        };
        let place = match variable {
            Variable::Coordinate(index) => one(1 + index.index()),
            Variable::Rate(index) => one(1 + degrees + index.index()),
            Variable::ModeCoordinates(field) => modes(field, 0),
            Variable::ModeRates(field) => modes(field, degrees),
            Variable::State(index) => one(1 + 2 * degrees + index.index()),
            Variable::Input(_) | Variable::Parameter(_) | Variable::Time => continue,
        };
        places.push((variable, place));
    }
    for index in InputId::first(equations.inputs) {
        let place = one(before_inputs + index.index());
        places.push((Variable::Input(index), place));
    }
    for (place, index) in independent_parameters(equations).enumerate() {
        places.push((Variable::Parameter(index), one(before_parameters + place)));
    }
    places
}

fn independent_parameters(equations: &Equations) -> impl Iterator<Item = ParameterId> {
    let derived = &equations.derived_parameters;
    ParameterId::first(derived.len()).filter(|index| derived[*index].is_none())
}

/// Returns the gradient, without the constant contribution of the weights of the coordinates' rates.
fn derive_gradient(
    equations: &mut Equations,
    places: &IndexRanges,
    weighted_by_parameters: &Jacobian<NodeId>,
) -> Vec<(Range<usize>, NodeId)> {
    let weighted = pair_weights(equations);
    let graph = &mut equations.graph;
    let by_leaf = adjoint::gradient(graph, &weighted);
    let mut rows = Vec::new();
    for (variable, place) in places {
        let leaf = graph.variable(*variable);
        if let Some(node) = by_leaf.get(&leaf) {
            rows.push((place.clone(), *node));
        }
    }
    let before = places
        .iter()
        .find(|(variable, _)| matches!(variable, Variable::Parameter(_)))
        .map_or(0, |(_, place)| place.start);
    for entry in &weighted_by_parameters.entries {
        let first = before + entry.column;
        rows.push((first..first + 1, entry.value));
    }
    rows
}

/// Returns the Hessian columns of each leaf: its own columns, or for a derived parameter the columns of the
/// independent parameters in its expression.
fn find_columns(
    equations: &mut Equations,
    places: &IndexRanges,
) -> HashMap<NodeId, Vec<Range<usize>>> {
    let mut columns = HashMap::new();
    for (variable, place) in places {
        let leaf = equations.graph.variable(*variable);
        columns.insert(leaf, vec![place.clone()]);
    }
    for index in ParameterId::first(equations.derived_parameters.len()) {
        let graph = &mut equations.graph;
        let leaf = graph.intern(Operation::Parameter(index));
        // Expressions can contain other derived parameters, so their expressions are searched, too.
        let mut pending = vec![leaf];
        let mut reached = Vec::new();
        while let Some(of) = pending.pop() {
            let Operation::Parameter(read) = *graph.operation(of) else {
                continue;
            };
            match equations.derived_parameters[read] {
                Some(expression) => pending.extend(graph.reachable(&[expression])),
                None => reached.extend(columns.get(&of).into_iter().flatten().cloned()),
            }
        }
        if equations.derived_parameters[index].is_some() {
            columns.insert(leaf, reached);
        }
    }
    columns
}
