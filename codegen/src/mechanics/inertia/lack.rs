//! Test of positive definiteness with a direction of failure: Cholesky factorisation of each connected block,
//! scaled to a unit diagonal, with the largest pivot first.

use std::collections::BTreeMap;

/// Rounding error of the factorisation per matrix row, relative to the unit diagonal.
pub(super) const ROUNDING_PER_ROW: f64 = 64.0 * f64::EPSILON;

/// Components of a direction below this fraction of the largest are rounding errors.
const MAX_ROUNDING_COMPONENT: f64 = 1e-6;

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Defect {
    /// Row index and value of a diagonal entry that is not positive, or of an entry of this row that is not finite.
    Entry(usize, f64),
    /// Direction of the rates with zero or negative kinetic energy.
    Direction { rates: Vec<f64>, negative: bool },
}

/// Symmetric matrix by rows; structural zeros are absent.
pub(super) type SparseRows = Vec<BTreeMap<usize, f64>>;

/// Converts a full matrix, given row by row, and removes its zeros.
pub(super) fn to_sparse(matrix: &[f64], size: usize) -> SparseRows {
    let rows = matrix.chunks(size.max(1));
    let entries = rows.map(|row| row.iter().copied().enumerate().filter(|(_, v)| *v != 0.0));
    entries.map(Iterator::collect).collect()
}

/// Returns the defect of the first connected block that is not positive definite.
pub(super) fn find_defect(rows: &SparseRows) -> Option<Defect> {
    for (index, row) in rows.iter().enumerate() {
        if let Some(bad) = row.values().find(|entry| !entry.is_finite()) {
            return Some(Defect::Entry(index, *bad));
        }
        let own = row.get(&index).copied().unwrap_or(0.0);
        if own <= 0.0 {
            return Some(Defect::Entry(index, own));
        }
    }
    find_blocks(rows)
        .iter()
        .find_map(|block| find_block_defect(rows, block))
}

/// Returns the connected blocks: sets of indices that nonzero entries connect.
fn find_blocks(rows: &SparseRows) -> Vec<Vec<usize>> {
    let mut is_seen = vec![false; rows.len()];
    let mut blocks = Vec::new();
    for start in 0..rows.len() {
        if std::mem::replace(&mut is_seen[start], true) {
            continue;
        }
        let mut block = vec![start];
        let mut next = 0;
        while let Some(&index) = block.get(next) {
            next += 1;
            for &other in rows[index].keys() {
                if !std::mem::replace(&mut is_seen[other], true) {
                    block.push(other);
                }
            }
        }
        block.sort_unstable();
        blocks.push(block);
    }
    blocks
}

fn find_block_defect(rows: &SparseRows, block: &[usize]) -> Option<Defect> {
    let entry = |a: usize, b: usize| rows[block[a]].get(&block[b]).copied().unwrap_or(0.0);
    let scales: Vec<f64> = (0..block.len())
        .map(|index| entry(index, index).sqrt())
        .collect();
    let mut factor = Factor::new(block.len());
    while let Some(index) = factor.find_largest_remaining_pivot() {
        if factor.rest[index] <= ROUNDING_PER_ROW * block.len() as f64 {
            let (index, negative) = factor.find_smallest_remaining_pivot();
            let direction = factor.compute_null_direction(index);
            let mut rates = vec![0.0; rows.len()];
            for ((own, part), scale) in block.iter().zip(direction).zip(&scales) {
                rates[*own] = part / scale;
            }
            let rates = normalise(rates);
            return Some(Defect::Direction { rates, negative });
        }
        factor.eliminate(index, |row| {
            entry(index, row) / (scales[index] * scales[row])
        });
    }
    None
}

/// Cholesky factor of a matrix with a unit diagonal, built with the largest remaining pivot first.
struct Factor {
    /// Rows of the factor for the columns eliminated so far.
    rows: Vec<Vec<f64>>,
    /// Diagonal of the matrix that remains to be factorised.
    rest: Vec<f64>,
    order: Vec<usize>,
    remaining: Vec<usize>,
}

impl Factor {
    fn new(size: usize) -> Self {
        Self {
            rows: vec![Vec::new(); size],
            rest: vec![1.0; size],
            order: Vec::new(),
            remaining: (0..size).collect(),
        }
    }

    fn find_largest_remaining_pivot(&self) -> Option<usize> {
        let remaining = self.remaining.iter().copied();
        remaining.max_by(|a, b| self.rest[*a].total_cmp(&self.rest[*b]))
    }

    /// Returns the index of the smallest remaining pivot, and true if the pivot is more negative than rounding
    /// explains.
    fn find_smallest_remaining_pivot(&self) -> (usize, bool) {
        let remaining = self.remaining.iter().copied();
        let smallest = remaining
            .min_by(|a, b| self.rest[*a].total_cmp(&self.rest[*b]))
            .unwrap_or(0);
        let limit = ROUNDING_PER_ROW * self.rest.len() as f64;
        (smallest, self.rest[smallest] < -limit)
    }

    fn eliminate(&mut self, index: usize, entry: impl Fn(usize) -> f64) {
        let pivot = self.rest[index].sqrt();
        let own = self.rows[index].clone();
        self.order.push(index);
        self.rows[index].push(pivot);
        self.remaining.retain(|other| *other != index);
        for &row in &self.remaining {
            let known: f64 = own.iter().zip(&self.rows[row]).map(|(a, b)| a * b).sum();
            let element = (entry(row) - known) / pivot;
            self.rows[row].push(element);
            self.rest[row] -= element * element;
        }
    }

    /// Returns the direction with component 1 at `index` and the eliminated components that minimise the quadratic
    /// form.
    fn compute_null_direction(&self, index: usize) -> Vec<f64> {
        let mut direction = vec![0.0; self.rest.len()];
        direction[index] = 1.0;
        for (step, &row) in self.order.iter().enumerate().rev() {
            let later = &self.order[step + 1..];
            let known: f64 = later
                .iter()
                .map(|&other| self.rows[other][step] * direction[other])
                .sum();
            direction[row] = -(self.rows[index][step] + known) / self.rows[row][step];
        }
        direction
    }
}

/// Scales the largest component to 1 and sets rounding errors to 0.
fn normalise(rates: Vec<f64>) -> Vec<f64> {
    let largest = rates.iter().fold(
        0.0_f64,
        |most, rate| {
            if rate.abs() > most.abs() { *rate } else { most }
        },
    );
    let scaled = rates.into_iter().map(|rate| rate / largest);
    scaled
        .map(|rate| {
            if rate.abs() < MAX_ROUNDING_COMPONENT {
                0.0
            } else {
                rate
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(matrix: &[f64], size: usize) -> (Vec<f64>, bool) {
        match find_defect(&to_sparse(matrix, size)) {
            Some(Defect::Direction { rates, negative }) => (rates, negative),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn definite_matrices_of_any_units_pass() {
        assert_eq!(find_defect(&to_sparse(&[2.0, 1.0, 1.0, 2.0], 2)), None);
        assert_eq!(find_defect(&to_sparse(&[1e18, 1.0, 1.0, 1e-16], 2)), None);
        assert_eq!(
            find_defect(&to_sparse(&[1.0, 1.0, 1.0, 1.0 + 1e-10], 2)),
            None
        );
        assert_eq!(find_defect(&to_sparse(&[], 0)), None);
    }

    #[test]
    fn diagonal_entries_must_be_positive_numbers() {
        assert_eq!(
            find_defect(&to_sparse(&[1.0, 0.0, 0.0, 0.0], 2)),
            Some(Defect::Entry(1, 0.0))
        );
        assert_eq!(
            find_defect(&to_sparse(&[-3.0], 1)),
            Some(Defect::Entry(0, -3.0))
        );
        assert!(
            matches!(find_defect(&to_sparse(&[f64::NAN], 1)), Some(Defect::Entry(0, value)) if value.is_nan())
        );
    }

    #[test]
    fn direction_without_inertia_is_reported_by_its_rates() {
        let (rates, negative) = along(&[1.0, 1.0, 1.0, 1.0], 2);
        assert!(!negative && (rates[0] + rates[1]).abs() < 1e-12 && rates[0].abs() == 1.0);
        // The quadratic form is (a + 1000 b)^2 + c^2.
        let (rates, _) = along(&[1.0, 1000.0, 0.0, 1000.0, 1e6, 0.0, 0.0, 0.0, 1.0], 3);
        assert!(
            (rates[0] / rates[1] + 1000.0).abs() < 1e-9 && rates[2] == 0.0,
            "{rates:?}"
        );
        let (_, negative) = along(&[1.0, 2.0, 2.0, 1.0], 2);
        assert!(negative);
    }
}
