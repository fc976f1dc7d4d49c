//! Outward recursion: motion of every link along its own axes.

use eomgen_model_spec::ids::CoordinateId;

use super::links::{Joint, Link};
use super::vector::{
    Matrix, Vector, build_signed_sum, cross, find_next_axes, multiply, rotate, zero,
};
use crate::mechanics::translate::along_motion;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Graph, NodeId, Operation};

pub(crate) type Acceleration<'a> = dyn Fn(&mut Graph, CoordinateId) -> NodeId + 'a;

/// Motion of a link along its own axes.
#[derive(Clone)]
pub(super) struct Motion {
    /// Angular velocity in 1/s.
    pub(super) omega: Vector,
    /// Angular acceleration in 1/s^2.
    pub(super) alpha: Vector,
    /// Acceleration of the origin minus gravity in m/s^2.
    pub(super) acceleration: Vector,
    /// Spatial gradient of the acceleration, [alpha]x + [omega]x [omega]x, in 1/s^2.
    pub(super) gradient: Matrix,
}

/// Returns the motion of every link. An acceleration of the fixed axes opposite to gravity replaces the weights of
/// all bodies.
pub(super) fn derive_motions(
    graph: &mut Graph,
    links: &[Link],
    gravity: &Vector,
    acceleration: &Acceleration<'_>,
) -> Vec<Motion> {
    let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
        Operation::Rate(index) => acceleration(graph, index),
        _ => along_motion(graph, leaf),
    };
    let mut along = Direction::new(&tangent);
    let still = zero(graph);
    let base = Motion {
        omega: still,
        alpha: still,
        acceleration: gravity.map(|component| graph.negate(component)),
        gradient: [still; 3],
    };
    let mut motions: Vec<Motion> = Vec::with_capacity(links.len());
    for link in links {
        let before = link.parent.map_or(&base, |parent| &motions[parent]).clone();
        motions.push(match &link.joint {
            Joint::Shift(origin) => shift_motion(graph, before, origin, &mut along),
            Joint::Rotation(turn) => {
                let rate = along_motion(graph, turn.angle);
                let second = along.derivative(graph, rate);
                let axes = [&before.omega, &before.alpha, &before.acceleration];
                let [omega, alpha, acceleration] = axes.map(|v| rotate(graph, turn, v));
                add_rotation(
                    graph,
                    (omega, alpha, acceleration),
                    turn.axis,
                    [rate, second],
                )
            }
        });
    }
    motions
}

/// Returns the motion of axes whose origin is shifted by a constant or moving offset.
fn shift_motion(
    graph: &mut Graph,
    mut motion: Motion,
    origin: &Vector,
    along: &mut Direction<'_>,
) -> Motion {
    let carried = multiply(graph, &motion.gradient, origin);
    let rate = origin.map(|component| along_motion(graph, component));
    let second = rate.map(|component| along.derivative(graph, component));
    let coriolis = cross(graph, &motion.omega, &rate);
    motion.acceleration = [0, 1, 2].map(|axis| {
        let mut terms = vec![(1.0, motion.acceleration[axis]), (1.0, second[axis])];
        terms.extend(&carried[axis]);
        terms.extend(
            coriolis[axis]
                .iter()
                .map(|(factor, term)| (2.0 * factor, *term)),
        );
        build_signed_sum(graph, &terms)
    });
    motion
}

/// Adds the rotation about an axis to a motion along axes that are already rotated.
fn add_rotation(
    graph: &mut Graph,
    (mut omega, mut alpha, acceleration): (Vector, Vector, Vector),
    axis: usize,
    [rate, second]: [NodeId; 2],
) -> Motion {
    let [i, j] = find_next_axes(axis);
    for (to, other, sign) in [(i, j, 1.0), (j, i, -1.0)] {
        let product = graph.multiply(omega[other], rate);
        alpha[to] = build_signed_sum(graph, &[(1.0, alpha[to]), (sign, product)]);
    }
    alpha[axis] = build_signed_sum(graph, &[(1.0, alpha[axis]), (1.0, second)]);
    omega[axis] = build_signed_sum(graph, &[(1.0, omega[axis]), (1.0, rate)]);
    Motion {
        gradient: gradient(graph, &omega, &alpha),
        omega,
        alpha,
        acceleration,
    }
}

/// Returns [alpha]x + [omega]x [omega]x.
fn gradient(graph: &mut Graph, omega: &Vector, alpha: &Vector) -> Matrix {
    let mut gradient = [*omega; 3];
    for axis in 0..3 {
        let [i, j] = find_next_axes(axis);
        let squares = [i, j].map(|other| (-1.0, graph.multiply(omega[other], omega[other])));
        gradient[axis][axis] = build_signed_sum(graph, &squares);
        let product = graph.multiply(omega[i], omega[j]);
        gradient[i][j] = build_signed_sum(graph, &[(1.0, product), (-1.0, alpha[axis])]);
        gradient[j][i] = build_signed_sum(graph, &[(1.0, product), (1.0, alpha[axis])]);
    }
    gradient
}
