//! Rates of functions along the motion, and the changes of these rates by reactions (forces or impulses of frictions
//! and contacts).

use crate::mechanics::equations::Equations;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::along_motion;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Change of the rates of coordinates, modes and first-order states per unit of a reaction.
pub(crate) type Column = (RowNodes, Vec<NodeId>);

/// Returns the rate of a function of the motion, with constant inputs.
pub(crate) fn derive_guard_rate(equations: &mut Equations, value: NodeId) -> NodeId {
    let rows = &equations.accelerations.rows;
    let rates = (rows, &equations.state_rates[..]);
    derive_with(&mut equations.graph, value, rates, along_motion)
}

/// Returns the change of a function per unit of the reaction with this column.
pub(crate) fn derive_along(graph: &mut Graph, function: NodeId, column: &Column) -> NodeId {
    let (rates, first_order) = column;
    derive_with(graph, function, (rates, first_order), |graph, _| {
        graph.zero()
    })
}

/// Returns the derivative of a function from the derivatives of the rates, of the first-order states and of the other
/// leaves.
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
