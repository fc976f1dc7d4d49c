//! Regimes: the switching surfaces that determine the branch of each piecewise function in the accelerations. With a
//! given regime, the rates need no comparisons.

use crate::mechanics::equations::Equations;
use crate::mechanics::forces::{Surfaces, find_surfaces};
use crate::mechanics::outputs::types::{Decision, SURFACES_OF_A_REGIME, Switch};
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};

/// Finds the piecewise functions of the accelerations whose branches are determined by surfaces. Functions of vectors
/// over modes are excluded, and functions whose surfaces have no bit in the regime number.
pub(crate) fn find_switches(equations: &mut Equations) -> Vec<Switch<NodeId>> {
    let roots = equations.rate_nodes();
    let places = find_surface_indices(equations);
    let graph = &mut equations.graph;
    let place = |surface: NodeId| {
        let mut known = places.iter();
        known.find_map(|(value, place)| (*value == surface).then_some(*place))
    };
    let mut found = Vec::new();
    for id in graph.reachable(&roots) {
        if graph.dependence(id).is_parameter_only() || graph.shape(id) != Shape::Scalar {
            continue;
        }
        if let Some(decided) = find_decision(graph, id, &place) {
            found.push(Switch { value: id, decided });
        }
    }
    found
}

/// Returns the scalar surfaces with their indices.
fn find_surface_indices(equations: &Equations) -> Vec<(NodeId, usize)> {
    let graph = &equations.graph;
    let mut places = Vec::new();
    let mut next = 0;
    for guard in &equations.guards {
        match graph.shape(guard.value) {
            Shape::Vector(space) => next += graph.size(space),
            _ => {
                places.push((guard.value, next));
                next += 1;
            }
        }
    }
    places.retain(|(_, place)| *place < SURFACES_OF_A_REGIME);
    places
}

fn find_decision(
    graph: &mut Graph,
    id: NodeId,
    place: &dyn Fn(NodeId) -> Option<usize>,
) -> Option<Decision> {
    match graph.operation(id).clone() {
        Operation::Call(function, arguments) => match find_surfaces(graph, function, &arguments) {
            Surfaces::TwoSided { above, beyond } => Some(Decision::Between {
                above: place(above)?,
                beyond: place(beyond)?,
            }),
            Surfaces::OuterSides { above, below } => Some(Decision::Outside {
                above: place(above)?,
                below: place(below)?,
            }),
            Surfaces::Single(surface) => place(surface).map(Decision::Surface),
            Surfaces::Negated(surface) => place(surface).map(Decision::NegatedSurface),
            Surfaces::None => None,
        },
        Operation::Select { a, b, .. } => {
            let (difference, turned) = (graph.subtract(a, b), graph.subtract(b, a));
            let by = place(difference).map(Decision::Surface);
            by.or_else(|| place(turned).map(Decision::NegatedSurface))
        }
        _ => None,
    }
}
