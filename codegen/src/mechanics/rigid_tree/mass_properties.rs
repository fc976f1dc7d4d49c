//! Mass, first moments and inertia of the bodies that are fixed to a frame. The inertia forces are linear in these
//! parameters.

use eomgen_model_spec::rigid_tree::{AxisTurn, RigidBody};

use super::vector::{Matrix, Vector, find_next_axes, rotate_back};
use crate::symbolic::graph::{Graph, NodeId};

/// Inertial parameters of a body along the axes of a frame, about the frame's origin; all depend only on
/// parameters.
#[derive(Clone, Debug)]
pub(super) struct MassProperties {
    /// Mass m in kg.
    pub(super) mass: NodeId,
    /// m times the centre of mass in kg m.
    pub(super) first_moment: Vector,
    /// Inertia about the origin in kg m^2.
    pub(super) inertia: Matrix,
}

impl MassProperties {
    pub(super) fn zero(graph: &mut Graph) -> Self {
        let zero = graph.zero();
        Self {
            mass: zero,
            first_moment: [zero; 3],
            inertia: [[zero; 3]; 3],
        }
    }

    pub(super) fn from_body(graph: &mut Graph, body: &RigidBody<NodeId>) -> Self {
        let ([xx, yy, zz], [xy, yz, xz]) = (body.moments, body.products);
        let zero = graph.zero();
        let about_centre = Self {
            mass: body.mass,
            first_moment: [zero; 3],
            inertia: [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
        };
        about_centre.shift_back(graph, &body.centre)
    }

    pub(super) fn add(&self, graph: &mut Graph, other: &Self) -> Self {
        let mut sum = |a: NodeId, b: NodeId| graph.combine_flat(&[(1.0, a), (1.0, b)]);
        Self {
            mass: sum(self.mass, other.mass),
            first_moment: [0, 1, 2].map(|i| sum(self.first_moment[i], other.first_moment[i])),
            inertia: [0, 1, 2]
                .map(|i| [0, 1, 2].map(|j| sum(self.inertia[i][j], other.inertia[i][j]))),
        }
    }

    /// Transforms the parameters from rotated axes to the axes before the rotation.
    pub(super) fn rotate_back(&self, graph: &mut Graph, turn: &AxisTurn<NodeId>) -> Self {
        let rows = self.inertia.map(|row| rotate_back(graph, turn, &row));
        // The inertia matrix is symmetric, so its rows equal its columns.
        let columns = [0, 1, 2].map(|j| [0, 1, 2].map(|i| rows[i][j]));
        Self {
            mass: self.mass,
            first_moment: rotate_back(graph, turn, &self.first_moment),
            inertia: columns.map(|column| rotate_back(graph, turn, &column)),
        }
    }

    /// Transforms the parameters to a new origin; `origin` is the position of the present origin relative to the new
    /// one. Huygens-Steiner theorem with first moments h: J + (2 h.o + m o.o) 1 - h o' - o h' - m o o'.
    pub(super) fn shift_back(&self, graph: &mut Graph, origin: &Vector) -> Self {
        let moved = origin.map(|component| graph.multiply(self.mass, component));
        let first_moment =
            [0, 1, 2].map(|i| graph.combine_flat(&[(1.0, self.first_moment[i]), (1.0, moved[i])]));
        let squares: Vec<[(f64, NodeId); 2]> = (0..3)
            .map(|i| {
                let with_moment = graph.multiply(self.first_moment[i], origin[i]);
                [
                    (2.0, with_moment),
                    (1.0, graph.multiply(moved[i], origin[i])),
                ]
            })
            .collect();
        let inertia = [0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| {
                let mut terms = vec![
                    (1.0, self.inertia[i][j]),
                    (-1.0, graph.multiply(self.first_moment[i], origin[j])),
                    (-1.0, graph.multiply(origin[i], self.first_moment[j])),
                    (-1.0, graph.multiply(moved[i], origin[j])),
                ];
                if i == j {
                    terms.extend(squares.iter().flatten());
                }
                graph.combine_flat(&terms)
            })
        });
        Self {
            mass: self.mass,
            first_moment,
            inertia,
        }
    }

    /// Splits the parameters into a part that a rotation about an axis through the origin does not change, and the
    /// rest. The first part has the mass, the first moment along the axis, and the inertia of a thin rod along the
    /// axis.
    pub(super) fn split_by_rotation(&self, graph: &mut Graph, axis: usize) -> (Self, Self) {
        let [i, j] = find_next_axes(axis);
        let (mut symmetric, mut rest) = (Self::zero(graph), self.clone());
        symmetric.mass = self.mass;
        rest.mass = graph.zero();
        std::mem::swap(
            &mut symmetric.first_moment[axis],
            &mut rest.first_moment[axis],
        );
        let moment = self.inertia[j][j];
        symmetric.inertia[i][i] = moment;
        symmetric.inertia[j][j] = moment;
        rest.inertia[i][i] = graph.combine_flat(&[(1.0, self.inertia[i][i]), (-1.0, moment)]);
        rest.inertia[j][j] = graph.zero();
        (symmetric, rest)
    }

    /// Splits the parameters into the inertia and the rest. The inertia alone, without mass and first moment, is
    /// unchanged by a shift.
    pub(super) fn split_by_shift(&self, graph: &mut Graph) -> (Self, Self) {
        let (mut passed, mut rest) = (Self::zero(graph), self.clone());
        std::mem::swap(&mut passed.inertia, &mut rest.inertia);
        (passed, rest)
    }
}
