//! Vectors and matrices of nodes along the axes of one frame.

use eomgen_model_spec::rigid_tree::AxisTurn;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Components along x, y, z.
pub(super) type Vector = [NodeId; 3];

pub(super) type Matrix = [Vector; 3];

/// Terms of a sum for each component.
pub(super) type VectorTerms = [Vec<(f64, NodeId)>; 3];

pub(super) fn zero(graph: &mut Graph) -> Vector {
    [graph.zero(); 3]
}

/// Returns the next two axes (i, j) in cyclic order, with axis = i x j.
pub(super) fn find_next_axes(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

/// Returns a sum. A sum of only negative terms becomes the negative of a sum, because later operations can absorb the
/// sign.
pub(super) fn build_signed_sum(graph: &mut Graph, terms: &[(f64, NodeId)]) -> NodeId {
    let sum = graph.combine(terms);
    let positive: Vec<(f64, NodeId)> = match graph.operation(sum) {
        Operation::Sum(parts) if parts.iter().all(|(factor, _)| factor.value() < 0.0) => {
            let negated = parts.iter().map(|(factor, id)| (-factor.value(), *id));
            negated.collect()
        }
        _ => return sum,
    };
    let positive = graph.combine(&positive);
    graph.negate(positive)
}

pub(super) fn build_signed_sums(graph: &mut Graph, terms: &VectorTerms) -> Vector {
    terms.each_ref().map(|terms| build_signed_sum(graph, terms))
}

/// Returns the terms of the vector product, by component.
pub(super) fn cross(graph: &mut Graph, a: &Vector, b: &Vector) -> VectorTerms {
    [0, 1, 2].map(|axis| {
        let [i, j] = find_next_axes(axis);
        vec![
            (1.0, graph.multiply(a[i], b[j])),
            (-1.0, graph.multiply(a[j], b[i])),
        ]
    })
}

/// Returns the terms of a matrix times a vector.
pub(super) fn multiply(graph: &mut Graph, matrix: &Matrix, vector: &Vector) -> VectorTerms {
    matrix.map(|row| {
        let products = row.iter().zip(vector);
        products
            .map(|(element, component)| (1.0, graph.multiply(*element, *component)))
            .collect()
    })
}

/// Transforms a vector to the rotated axes.
pub(super) fn rotate(graph: &mut Graph, turn: &AxisTurn<NodeId>, vector: &Vector) -> Vector {
    rotate_by_angle(graph, turn, vector, 1.0)
}

/// Transforms a vector from the rotated axes to the axes before the rotation.
pub(super) fn rotate_back(graph: &mut Graph, turn: &AxisTurn<NodeId>, vector: &Vector) -> Vector {
    rotate_by_angle(graph, turn, vector, -1.0)
}

fn rotate_by_angle(
    graph: &mut Graph,
    turn: &AxisTurn<NodeId>,
    vector: &Vector,
    way: f64,
) -> Vector {
    let [i, j] = find_next_axes(turn.axis);
    let mut result = *vector;
    for (to, other, sign) in [(i, j, way), (j, i, -way)] {
        let along = graph.multiply(turn.cosine, vector[to]);
        let across = graph.multiply(turn.sine, vector[other]);
        result[to] = build_signed_sum(graph, &[(1.0, along), (sign, across)]);
    }
    result
}
