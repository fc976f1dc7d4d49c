//! A tree of frames as links, each a shift or a turn away from the one before it.

use eomgen_model_spec::rigid_tree::{AxisTurn, RigidTree};

use super::mass_properties::MassProperties;
use super::vector::{Vector, turned_back};
use crate::symbolic::graph::{Graph, NodeId};

/// A set of axes, and what is fixed to them.
pub(super) struct Link {
    /// The link before it; the fixed axes if there is none.
    pub(super) parent: Option<usize>,
    /// How it stands to that.
    pub(super) joint: Joint,
    /// What is fixed to it.
    pub(super) mass: MassProperties,
}

/// How the axes of a link stand to those before.
#[derive(Clone)]
pub(super) enum Joint {
    /// With the origin elsewhere, along the axes.
    Shift(Vector),
    /// Turned about one of them.
    Turn(AxisTurn<NodeId>),
}

impl Joint {
    /// Whether it is of parameters alone.
    pub(super) fn is_constant(&self, graph: &Graph) -> bool {
        let constant = |id: &NodeId| graph.dependence(*id).is_parameter_only();
        match self {
            Self::Shift(origin) => origin.iter().all(constant),
            Self::Turn(turn) => constant(&turn.angle),
        }
    }
}

/// Where a frame is: at a link, its axes turned by constant angles.
#[derive(Clone, Default)]
struct Placement {
    link: Option<usize>,
    fixed: Vec<AxisTurn<NodeId>>,
}

/// The links of a tree, each after the one before it. A constant turn becomes a link where a moving
/// one follows: all that stands before that is put along the axes before the constant turn, in
/// which velocities are known already.
pub(super) fn links(graph: &mut Graph, tree: &RigidTree<NodeId>) -> Vec<Link> {
    let mut links: Vec<Link> = Vec::new();
    let mut placements: Vec<Placement> = Vec::with_capacity(tree.frames.len());
    for frame in &tree.frames {
        let mut place = match frame.parent {
            Some(parent) => placements[parent].clone(),
            None => Placement::default(),
        };
        let back = place.fixed.iter().rev();
        let origin = back.fold(frame.origin, |origin, turn| {
            turned_back(graph, turn, &origin)
        });
        if origin.iter().any(|component| !graph.is_zero(*component)) {
            place.link = push(graph, &mut links, place.link, Joint::Shift(origin));
        }
        for turn in &frame.turns {
            let joint = Joint::Turn(turn.clone());
            if joint.is_constant(graph) {
                place.fixed.push(turn.clone());
                continue;
            }
            for fixed in std::mem::take(&mut place.fixed) {
                place.link = push(graph, &mut links, place.link, Joint::Turn(fixed));
            }
            place.link = push(graph, &mut links, place.link, joint);
        }
        placements.push(place);
    }
    for body in &tree.bodies {
        let place = &placements[body.frame];
        let own = MassProperties::of_body(graph, body);
        let back = place.fixed.iter().rev();
        let along = back.fold(own, |mass, turn| mass.turned_back(graph, turn));
        if let Some(link) = place.link {
            links[link].mass = links[link].mass.plus(graph, &along);
        }
    }
    links
}

/// Adds a link; its place.
fn push(
    graph: &mut Graph,
    links: &mut Vec<Link>,
    parent: Option<usize>,
    joint: Joint,
) -> Option<usize> {
    links.push(Link {
        parent,
        joint,
        mass: MassProperties::none(graph),
    });
    Some(links.len() - 1)
}
