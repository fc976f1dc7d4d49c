//! Rates of functions along the motion, and their changes by reactions.

use crate::mechanics::equations::Equations;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::along_motion;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Change of the rates by a unit of a reaction.
pub(crate) type Column = (RowNodes, Vec<NodeId>);

/// Returns the rate of a function of the motion, with constant inputs.
pub(crate) fn guard_rate(equations: &mut Equations, value: NodeId) -> NodeId {
    let rows = &equations.accelerations.rows;
    let state_rates = &equations.state_rates;
    let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
        Operation::Rate(index) => rows.scalars[index],
        Operation::ModeRates(field) => rows.modal[field],
        Operation::State(index) => state_rates[index],
        _ => along_motion(graph, leaf),
    };
    Direction::new(&tangent).derivative(&mut equations.graph, value)
}

/// Returns the derivative of a function by a reaction with this column.
pub(crate) fn derive_along(graph: &mut Graph, function: NodeId, column: &Column) -> NodeId {
    let (rates, first_order) = column;
    let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
        Operation::Rate(index) => rates.scalars[index],
        Operation::ModeRates(field) => rates.modal[field],
        Operation::State(index) => first_order[index],
        _ => graph.zero(),
    };
    Direction::new(&tangent).derivative(graph, function)
}
