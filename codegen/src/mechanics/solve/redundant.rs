//! Multipliers of dependent constraints: the solution of least norm of a symmetric positive semidefinite system
//! W lambda = r of known rank.
//!
//! With the scales S, the diagonal of A M^-1 A^T, S^-1/2 W S^-1/2 = V D^-1 V^T is factorised with pivoting (N. J.
//! Higham, *Accuracy and Stability of Numerical Algorithms*, 10.3): D are the pivots, and the columns V have one row
//! for each constraint. The solution that minimises lambda^T S lambda is V N^-1 D N^-1 V^T r with N = V^T V, in the
//! scaled unknowns. The solution does not depend on the choice of the pivots. Therefore the pivots are selected anew
//! at every state, because a fixed selection can be singular at a state at which the constraints have their full
//! rank.

use super::elimination::{Elimination, pivot_reciprocal};
use crate::symbolic::graph::{Graph, NodeId};

/// Multipliers that depend on each other.
#[derive(Clone, Debug, Default)]
pub(super) struct DependentRows {
    /// Indices of the dependent rows among all multipliers, ascending.
    pub(super) rows: Vec<usize>,
    /// Rank of the system of these multipliers.
    pub(super) rank: usize,
}

/// System of dependent multipliers.
pub(super) struct DependentSystem {
    /// W, symmetric.
    pub(super) matrix: Vec<Vec<NodeId>>,
    pub(super) right: Vec<NodeId>,
    /// S, positive.
    pub(super) scales: Vec<NodeId>,
    pub(super) rank: usize,
    /// True if S is the diagonal of W.
    pub(super) has_unit_diagonal: bool,
}

/// Column of the factor V with its pivot.
struct PivotColumn {
    column: Vec<NodeId>,
    pivot: NodeId,
}

impl DependentSystem {
    /// Returns the solution of least norm and the pivots, which must be positive.
    pub(super) fn solve(self, graph: &mut Graph) -> (Vec<NodeId>, Vec<NodeId>) {
        let scales = self.scales.iter();
        let weights: Vec<NodeId> = scales
            .map(|scale| pivot_reciprocal(graph, *scale))
            .collect();
        let columns = self.factorise(graph, &weights);
        let weighted: Vec<Vec<NodeId>> = columns
            .iter()
            .map(|own| multiply_elements(graph, &own.column, &weights))
            .collect();
        let mut normal = vec![vec![graph.zero(); self.rank]; self.rank];
        for (row, own) in weighted.iter().enumerate() {
            for (column, other) in columns.iter().enumerate().skip(row) {
                normal[row][column] = inner_product(graph, own, &other.column);
                normal[column][row] = normal[row][column];
            }
        }
        let right: Vec<NodeId> = weighted
            .iter()
            .map(|row| inner_product(graph, row, &self.right))
            .collect();
        let first = solve_definite(graph, &normal, right);
        let pivots: Vec<NodeId> = columns.iter().map(|own| own.pivot).collect();
        let scaled = multiply_elements(graph, &first, &pivots);
        let second = solve_definite(graph, &normal, scaled);
        let multipliers = (0..weights.len()).map(|row| {
            let entries: Vec<NodeId> = weighted.iter().map(|column| column[row]).collect();
            inner_product(graph, &entries, &second)
        });
        (multipliers.collect(), pivots)
    }

    /// Factorises the matrix with the largest pivots, relative to the scales 1/`weights`.
    fn factorise(&self, graph: &mut Graph, weights: &[NodeId]) -> Vec<PivotColumn> {
        let zero = graph.zero();
        let mut rest = self.matrix.clone();
        // In these rows the remaining matrix is zero.
        let mut first = 0;
        let mut found = Vec::with_capacity(self.rank);
        for step in 0..self.rank {
            let own = match step == 0 && self.has_unit_diagonal {
                true => PivotColumn {
                    column: rest[0].clone(),
                    pivot: rest[0][0],
                },
                false => select_column(graph, &rest[first..], &weights[first..]),
            };
            found.push(own);
            if step + 1 == self.rank {
                break;
            }
            let own = &found[step];
            let reciprocal = pivot_reciprocal(graph, own.pivot);
            let size = rest.len();
            let upper = (first..size).flat_map(|row| (row..size).map(move |column| (row, column)));
            for (row, column) in upper {
                let factor = graph.multiply(own.column[row], reciprocal);
                let product = graph.multiply(factor, own.column[column]);
                let entry = graph.combine_flat(&[(1.0, rest[row][column]), (-1.0, product)]);
                rest[row][column] = entry;
                rest[column][row] = entry;
            }
            if step == 0 && self.has_unit_diagonal {
                first = 1;
                rest[0].fill(zero);
                rest.iter_mut().for_each(|row| row[0] = zero);
            }
        }
        found
    }
}

/// Returns the column with the largest scaled diagonal entry of the remaining rows.
fn select_column(graph: &mut Graph, rows: &[Vec<NodeId>], weights: &[NodeId]) -> PivotColumn {
    let first = rows[0].len() - rows.len();
    let mut best = PivotColumn {
        column: rows[0].clone(),
        pivot: rows[0][first],
    };
    let mut largest = graph.multiply(best.pivot, weights[0]);
    for (index, row) in rows.iter().enumerate().skip(1) {
        let pivot = row[first + index];
        let size = graph.multiply(pivot, weights[index]);
        let mut choose =
            |here: NodeId, other: NodeId| graph.select_equivalent(size, largest, here, other);
        for (entry, here) in best.column.iter_mut().zip(row) {
            *entry = choose(*here, *entry);
        }
        best.pivot = choose(pivot, best.pivot);
        largest = choose(size, largest);
    }
    best
}

/// Solves a system with a positive definite matrix.
fn solve_definite(graph: &mut Graph, matrix: &[Vec<NodeId>], right: Vec<NodeId>) -> Vec<NodeId> {
    let order: Vec<usize> = (0..right.len()).collect();
    let mut unknowns = vec![graph.zero(); right.len()];
    let mut rest = Elimination::new(matrix.to_vec(), right);
    for _ in &order {
        rest.eliminate_next(graph, &order, false);
    }
    rest.substitute_back(graph, &order, &mut unknowns);
    unknowns
}

fn multiply_elements(graph: &mut Graph, a: &[NodeId], b: &[NodeId]) -> Vec<NodeId> {
    let entries = a.iter().zip(b);
    entries.map(|(a, b)| graph.multiply(*a, *b)).collect()
}

fn inner_product(graph: &mut Graph, a: &[NodeId], b: &[NodeId]) -> NodeId {
    let products = multiply_elements(graph, a, b);
    let terms: Vec<(f64, NodeId)> = products.into_iter().map(|term| (1.0, term)).collect();
    graph.combine(&terms)
}
