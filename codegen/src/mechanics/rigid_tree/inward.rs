//! Inward recursion: forces and moments of the links, and the generalised forces by virtual work.

use eomgen_model_spec::ids::CoordinateId;

use super::links::{Joint, Link};
use super::mass_properties::MassProperties;
use super::outward::Motion;
use super::vector::{VectorTerms, build_signed_sums, cross, find_next_axes, multiply, rotate_back};
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Terms of a force and of its moment about the origin of a link's axes.
#[derive(Clone, Default)]
struct Wrench {
    force: VectorTerms,
    moment: VectorTerms,
}

/// Returns the generalised force of each coordinate for this motion of the links.
pub(super) fn derive_generalised_forces(
    graph: &mut Graph,
    links: &[Link],
    motions: &[Motion],
    coordinates: usize,
) -> Vec<NodeId> {
    let mut work: Vec<Vec<(f64, NodeId)>> = vec![Vec::new(); coordinates];
    let mut carried: Vec<Wrench> = vec![Wrench::default(); links.len()];
    for (place, link) in links.iter().enumerate().rev() {
        let mut wrench = std::mem::take(&mut carried[place]);
        wrench.add_inertia(graph, &link.mass, &motions[place]);
        let force = build_signed_sums(graph, &wrench.force);
        let moment = build_signed_sums(graph, &wrench.moment);
        // Pairs of force and displacement (or moment and angle) whose product is the virtual work.
        let pairs = match &link.joint {
            Joint::Rotation(turn) => vec![(moment[turn.axis], turn.angle)],
            Joint::Shift(origin) => force.into_iter().zip(*origin).collect(),
        };
        for (row, index) in work.iter_mut().zip(CoordinateId::first(coordinates)) {
            let variable = graph.intern(Operation::Coordinate(index));
            for &(effort, way) in &pairs {
                let slope = derive_by_scalar(graph, way, variable);
                row.push((1.0, graph.multiply(effort, slope)));
            }
        }
        let Some(parent) = link.parent else {
            continue;
        };
        let (force, moment, lever) = match &link.joint {
            Joint::Rotation(turn) => {
                let [force, moment] = [force, moment].map(|v| rotate_back(graph, turn, &v));
                (force, moment, None)
            }
            Joint::Shift(origin) => (force, moment, Some(cross(graph, origin, &force))),
        };
        let before = &mut carried[parent];
        for axis in 0..3 {
            before.force[axis].push((1.0, force[axis]));
            before.moment[axis].push((1.0, moment[axis]));
            if let Some(lever) = &lever {
                before.moment[axis].extend(&lever[axis]);
            }
        }
    }
    work.iter().map(|terms| graph.combine(terms)).collect()
}

impl Wrench {
    /// Adds the inertia forces of a link: m a + U h, and h x a + the moment about the origin, with the
    /// acceleration a, its gradient U, the mass m and the first moments h.
    fn add_inertia(&mut self, graph: &mut Graph, mass: &MassProperties, motion: &Motion) {
        let carried = multiply(graph, &motion.gradient, &mass.first_moment);
        let lever = cross(graph, &mass.first_moment, &motion.acceleration);
        for axis in 0..3 {
            let product = graph.multiply(mass.mass, motion.acceleration[axis]);
            self.force[axis].push((1.0, product));
            self.force[axis].extend(&carried[axis]);
            self.moment[axis].extend(&lever[axis]);
            let rotation = derive_rotation_moment(graph, mass, motion, axis);
            self.moment[axis].extend(rotation);
        }
    }
}

/// Returns the terms of J alpha + omega x J omega along axis i. Products of inertia multiply entries of the
/// gradient U, which forces need as well: with j and k the axes after i, J_ij alpha_j - J_ij omega_i omega_k
/// = -J_ij U_ki.
fn derive_rotation_moment(
    graph: &mut Graph,
    mass: &MassProperties,
    motion: &Motion,
    axis: usize,
) -> Vec<(f64, NodeId)> {
    let (inertia, omega, gradient) = (&mass.inertia, &motion.omega, &motion.gradient);
    let [j, k] = find_next_axes(axis);
    let difference = graph.combine_flat(&[(1.0, inertia[k][k]), (-1.0, inertia[j][j])]);
    let squares = [k, j].map(|other| graph.multiply(omega[other], omega[other]));
    let squares = graph.subtract(squares[0], squares[1]);
    vec![
        (1.0, graph.multiply(inertia[axis][axis], motion.alpha[axis])),
        (
            1.0,
            graph.product(&[(difference, 1), (omega[j], 1), (omega[k], 1)]),
        ),
        (-1.0, graph.multiply(inertia[j][k], squares)),
        (-1.0, graph.multiply(inertia[axis][j], gradient[k][axis])),
        (1.0, graph.multiply(inertia[axis][k], gradient[j][axis])),
    ]
}
