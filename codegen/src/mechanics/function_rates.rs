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
    let rates = (rows, &equations.state_rates[..]);
    derive_with(&mut equations.graph, value, rates, along_motion)
}

/// Returns the derivative of a function by a reaction with this column.
pub(crate) fn derive_along(graph: &mut Graph, function: NodeId, column: &Column) -> NodeId {
    let (rates, first_order) = column;
    derive_with(graph, function, (rates, first_order), |graph, _| {
        graph.zero()
    })
}

/// Returns the derivative of a function, given those of the rates, of the first-order states and of the other leaves.
fn derive_with(
    graph: &mut Graph,
    function: NodeId,
    (rates, first_order): (&RowNodes, &[NodeId]),
    other: impl Fn(&mut Graph, NodeId) -> NodeId,
) -> NodeId {
    let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
        Operation::Rate(index) => rates.scalars[index],
        Operation::ModeRates(field) => rates.modal[field],
        Operation::State(index) => first_order[index],
        _ => other(graph, leaf),
    };
    Direction::new(&tangent).derivative(graph, function)
}
