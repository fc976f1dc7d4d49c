//! Solution of M a = f for the accelerations, based on the structure of the mass matrix.
//!
//! Modes are eliminated first. Their block is diagonal plus outer products through a few interface scalars
//! (for example the deflection at a tip mass): D a_q + Phi (G Phi^T a_q + C^T a - b) + H^T a = f_q, so that
//! the modes cost O(S). The interface forces p = G Phi^T a_q + C^T a - b are additional unknowns of a small
//! system with the coordinates, solved without pivoting in the cheapest order.
//!
//! - The unknowns are the forces p, not the accelerations Phi^T a_q. With many modes, the effective mass of a beam
//!   tip is small; p would be the small difference of nearly equal large accelerations.
//! - State-dependent coupling is expressed through interfaces (C), other coupling directly (H); therefore only
//!   scalars depend on the state (see `ModalBlock::couple_through_interfaces`).
//! - If G is not diagonal or C is not zero, the interfaces are orthogonalised first; otherwise a pivot could
//!   be negative although M is positive definite (see `ModalBlock::orthogonalise`).
//! - If the basis is not orthogonal, the modal block is dense and its Cholesky factor replaces D.
//! - Pivots must be positive; the reciprocal of any other pivot is NaN.
//! - For dependent constraints, the multipliers of least norm are computed (see `redundant`).

mod critical_path;
mod elimination;
mod modal;
mod redundant;
mod separation;
mod small;

use crate::mechanics::constraints::Constraints;
use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::RowNodes;
use crate::symbolic::graph::{Graph, NodeId};
use crate::symbolic::operation_count::count_operations;
use modal::{ModalBlock, ModalInverse};
use redundant::DependentRows;
use small::SmallSystem;

/// Accelerations with the pivots of their solution.
#[derive(Clone, Debug)]
pub struct Accelerations {
    /// Accelerations.
    pub rows: RowNodes,
    /// All pivots of the factorisation, which must be positive: those of the coordinates in the order of their
    /// elimination, those of the interfaces, vectors over the modes, and Cholesky factors (positive unless NaN).
    pub pivots: Vec<NodeId>,
    /// Report on the solution.
    pub report: SolveReport,
}

/// Report on the solution for the accelerations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SolveReport {
    /// Indices of the coordinates in the order of their elimination, after the modes.
    pub order: Vec<usize>,
    /// Number of interface scalars.
    pub interfaces: usize,
    /// Operations per call in the chosen order.
    pub operations: usize,
    /// Operations per call in the most expensive order tried.
    pub most_expensive_operations: usize,
    /// True if a field's modal block is dense.
    pub dense_modes: bool,
}

/// Solves M a = f, or M a - A^T lambda = f and A a = b, for the accelerations and lambda.
pub(crate) fn solve(
    graph: &mut Graph,
    mass: &MassMatrix,
    right: &RowNodes,
    constraints: &Constraints,
) -> (Accelerations, Vec<NodeId>) {
    let (mass, right) = &border_matrix(graph, mass, right, constraints);
    let modal = ModalBlock::new(graph, mass, right);
    let multipliers = constraints.rows.len();
    let dependent = DependentRows {
        rows: constraints.redundancy.constraints(),
        rank: constraints.redundancy.rank(),
    };
    let system = SmallSystem::new(graph, mass, right, &modal, (multipliers, dependent));
    let coordinates = right.scalars.len() - multipliers;
    let mut solved_in = |order: Vec<usize>| {
        let (mut unknowns, mut pivots) = system.eliminate(graph, &order);
        let lambda = unknowns.split_off(unknowns.len() - multipliers);
        pivots.rotate_left(system.interfaces);
        let rows = system.back_substitute(graph, &modal, &unknowns, &lambda);
        let operations = count_operations(graph, &rows.nodes());
        (operations, order, (rows, lambda), pivots)
    };
    let mut best = solved_in((0..coordinates).collect());
    let mut dearest = best.0;
    for order in list_other_orders(coordinates) {
        let other = solved_in(order);
        dearest = dearest.max(other.0);
        if other.0 < best.0 {
            best = other;
        }
    }
    let (operations, order, (rows, lambda), mut pivots) = best;
    let rows = critical_path::shorten_critical_path(graph, &rows);
    pivots.extend(modal.inverses.iter().flatten().map(ModalInverse::pivot));
    let accelerations = Accelerations {
        rows,
        pivots,
        report: SolveReport {
            order,
            interfaces: modal.interfaces.len(),
            operations,
            most_expensive_operations: dearest,
            dense_modes: modal.inverses.iter().flatten().any(ModalInverse::is_dense),
        },
    };
    (accelerations, lambda)
}

/// Returns the symmetric system with the multipliers as additional unknowns after the coordinates,
/// ```text
/// [ M  -A^T ] [ a      ]   [  f ]
/// [ -A   0  ] [ lambda ] = [ -b ]
/// ```
/// Multipliers are coupled to the modes like coordinates, through interfaces if the coupling depends on the state.
/// They are eliminated last; their pivots are the negative pivots of A M^-1 A^T.
fn border_matrix(
    graph: &mut Graph,
    mass: &MassMatrix,
    right: &RowNodes,
    constraints: &Constraints,
) -> (MassMatrix, RowNodes) {
    let coordinates = right.scalars.len();
    let size = coordinates + constraints.rows.len();
    let zero = graph.zero();
    let (mut mass, mut right) = (mass.clone(), right.clone());
    for row in &mut mass.scalars {
        row.resize(size, zero);
    }
    for (place, row) in (coordinates..).zip(&constraints.rows) {
        let mut last = vec![zero; size];
        for (coordinate, entry) in row.scalars.iter().enumerate() {
            let entry = graph.negate(*entry);
            last[coordinate] = entry;
            mass.scalars[coordinate][place] = entry;
        }
        mass.scalars.push(last);
        let coupling = row.modal.iter().map(|entry| graph.negate(*entry));
        mass.coupling.push(coupling.collect());
    }
    let sides = constraints.right.iter().map(|b| graph.negate(*b));
    right.scalars.extend(sides);
    (mass, right)
}

/// Returns the elimination orders to try in addition to the natural order: all other orders for up to four
/// coordinates, else the reverse order.
fn list_other_orders(count: usize) -> Vec<Vec<usize>> {
    if count > 4 {
        return vec![(0..count).rev().collect()];
    }
    let mut orders = vec![Vec::new()];
    for _ in 0..count {
        orders = orders
            .into_iter()
            .flat_map(|order: Vec<usize>| {
                (0..count)
                    .filter(|index| !order.contains(index))
                    .map(|index| [order.clone(), vec![index]].concat())
                    .collect::<Vec<_>>()
            })
            .collect();
    }
    // The first order is the natural one.
    orders.split_off(1)
}
