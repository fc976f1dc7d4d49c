//! Tree of frames as links; each link is shifted or rotated relative to its parent.

use eomgen_model_spec::rigid_tree::{AxisTurn, RigidTree};

use super::mass_properties::MassProperties;
use super::vector::{Vector, rotate_back};
use crate::symbolic::graph::{Graph, NodeId};

/// Set of axes with the mass fixed to it.
pub(super) struct Link {
    /// Index of the parent link; `None` if the parent is the fixed axes.
    pub(super) parent: Option<usize>,
    /// Position relative to the parent.
    pub(super) joint: Joint,
    pub(super) mass: MassProperties,
}

/// Position of the axes of a link relative to its parent.
#[derive(Clone)]
pub(super) enum Joint {
    /// Shift of the origin, along the axes.
    Shift(Vector),
    /// Rotation about one of the axes.
    Rotation(AxisTurn<NodeId>),
}

impl Joint {
    /// Returns true if the joint depends only on parameters.
    pub(super) fn is_constant(&self, graph: &Graph) -> bool {
        let constant = |id: &NodeId| graph.dependence(*id).is_parameter_only();
        match self {
            Self::Shift(origin) => origin.iter().all(constant),
            Self::Rotation(turn) => constant(&turn.angle),
        }
    }
}

/// Position of a frame: a link, followed by constant rotations.
#[derive(Clone, Default)]
struct Placement {
    link: Option<usize>,
    fixed: Vec<AxisTurn<NodeId>>,
}

/// Returns the links of a tree, parents first. A constant rotation becomes a link only if a moving link follows.
/// Otherwise, its bodies are expressed along the axes before the rotation, along which velocities are already known.
pub(super) fn build_links(graph: &mut Graph, tree: &RigidTree<NodeId>) -> Vec<Link> {
    let mut links: Vec<Link> = Vec::new();
    let mut placements: Vec<Placement> = Vec::with_capacity(tree.frames.len());
    for frame in &tree.frames {
        let mut place = match frame.parent {
            Some(parent) => placements[parent].clone(),
            None => Placement::default(),
        };
        let back = place.fixed.iter().rev();
        let origin = back.fold(frame.origin, |origin, turn| {
            rotate_back(graph, turn, &origin)
        });
        if origin.iter().any(|component| !graph.is_zero(*component)) {
            place.link = push(graph, &mut links, place.link, Joint::Shift(origin));
        }
        for turn in &frame.turns {
            let joint = Joint::Rotation(turn.clone());
            if joint.is_constant(graph) {
                place.fixed.push(turn.clone());
                continue;
            }
            for fixed in std::mem::take(&mut place.fixed) {
                place.link = push(graph, &mut links, place.link, Joint::Rotation(fixed));
            }
            place.link = push(graph, &mut links, place.link, joint);
        }
        placements.push(place);
    }
    for body in &tree.bodies {
        let place = &placements[body.frame];
        let own = MassProperties::from_body(graph, body);
        let back = place.fixed.iter().rev();
        let along = back.fold(own, |mass, turn| mass.rotate_back(graph, turn));
        if let Some(link) = place.link {
            links[link].mass = links[link].mass.add(graph, &along);
        }
    }
    links
}

fn push(
    graph: &mut Graph,
    links: &mut Vec<Link>,
    parent: Option<usize>,
    joint: Joint,
) -> Option<usize> {
    links.push(Link {
        parent,
        joint,
        mass: MassProperties::zero(graph),
    });
    Some(links.len() - 1)
}
