//! Regimes: which switching surfaces decide each piecewise function of the accelerations, so
//! that a kernel for one side of all of them need not ask. How such a kernel is written is the
//! backend's; the polynomials in sides that make a model linear are in `affine`.

use crate::mechanics::equations::Equations;
use crate::mechanics::forces::{Surfaces, surfaces};
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};

/// How many surfaces the number of a regime has room for, a bit each.
pub const SURFACES_OF_A_REGIME: usize = u32::BITS as usize;

/// A piecewise function of the accelerations, as a node or value `N`, whose branch a regime
/// decides.
#[derive(Clone, Copy, Debug)]
pub struct Switch<N> {
    /// The function's value.
    pub value: N,
    /// What decides.
    pub decided: Decided,
}

/// What decides about a branch: surfaces by their places among the numbers of all guards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decided {
    /// A dead zone or a contact, by p - b and p + b.
    Between {
        /// The place of p - b.
        above: usize,
        /// The place of p + b.
        beyond: usize,
    },
    /// A sign or a contact that may rest on a whole region, by p - b and -p - b, where b is 0
    /// for a sign.
    Outside {
        /// The place of p - b.
        above: usize,
        /// The place of -p - b.
        below: usize,
    },
    /// Anything else, by the one surface at which it switches.
    By(usize),
    /// A choice where a > b, by b - a; or what is above where p > 0, by -p.
    Turned(usize),
}

/// The piecewise functions of the accelerations that surfaces decide. What switches mode by
/// mode, or by surfaces that the number of a regime has no room for, is not among them.
pub(crate) fn switches(equations: &mut Equations) -> Vec<Switch<NodeId>> {
    let roots = equations.rate_nodes();
    let places = places(equations);
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
        if let Some(decided) = decided(graph, id, &place) {
            found.push(Switch { value: id, decided });
        }
    }
    found
}

/// The surfaces that are single numbers, with their places.
fn places(equations: &Equations) -> Vec<(NodeId, usize)> {
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

fn decided(
    graph: &mut Graph,
    id: NodeId,
    place: &dyn Fn(NodeId) -> Option<usize>,
) -> Option<Decided> {
    match graph.operation(id).clone() {
        Operation::Call(function, arguments) => match surfaces(graph, function, &arguments) {
            Surfaces::Between { above, beyond } => Some(Decided::Between {
                above: place(above)?,
                beyond: place(beyond)?,
            }),
            Surfaces::Outside { above, below } => Some(Decided::Outside {
                above: place(above)?,
                below: place(below)?,
            }),
            Surfaces::One(surface) => place(surface).map(Decided::By),
            Surfaces::Turned(surface) => place(surface).map(Decided::Turned),
            Surfaces::None => None,
        },
        Operation::Select { a, b, .. } => {
            let (difference, turned) = (graph.subtract(a, b), graph.subtract(b, a));
            let by = place(difference).map(Decided::By);
            by.or_else(|| place(turned).map(Decided::Turned))
        }
        _ => None,
    }
}
