//! Regrouping of inertial parameters: parameters of a link are added to those of its parent if this does not change
//! the motion. The remaining base parameters (Gautier and Khalil, 1990: IEEE Trans. Robotics Automat. 6, 368-373) are
//! sums computed by `prepare`. Most other parameters become 0 and cost no operation.

use super::links::{Joint, Link};
use super::mass_properties::MassProperties;
use crate::symbolic::graph::Graph;

/// Regroups inertial parameters, outermost links first.
pub(super) fn regroup(graph: &mut Graph, links: &mut [Link]) {
    for index in (0..links.len()).rev() {
        let Link {
            parent,
            joint,
            mass,
        } = &links[index];
        let parent = *parent;
        let (passed, kept) = match joint {
            Joint::Rotation(turn) if joint.is_constant(graph) => {
                (mass.rotate_back(graph, turn), MassProperties::zero(graph))
            }
            Joint::Rotation(turn) => mass.split_by_rotation(graph, turn.axis),
            Joint::Shift(origin) if joint.is_constant(graph) => {
                (mass.shift_back(graph, origin), MassProperties::zero(graph))
            }
            Joint::Shift(_) => mass.split_by_shift(graph),
        };
        links[index].mass = kept;
        // Inertial parameters of the fixed axes have no effect on the motion.
        if let Some(parent) = parent {
            links[parent].mass = links[parent].mass.add(graph, &passed);
        }
    }
}
