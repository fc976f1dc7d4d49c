//! Eigenvectors of known eigenvalues by inverse iteration (G. H. Golub, C. F. Van Loan, *Matrix Computations*,
//! 7.6), with triangular factors within the band of the matrix. For a chain, the cost is proportional to its
//! length.

use nalgebra::{Complex, DVector};

/// Relative distance of the shift from the eigenvalue. At this distance the matrix is nonsingular, and each
/// step gains 11 digits.
const RELATIVE_SHIFT: f64 = 1e-11;

/// Number of steps; the second step usually changes nothing.
const ITERATION_STEPS: usize = 4;

/// Nonzero entries of a square matrix row by row, with their columns.
pub(crate) type SparseRows = Vec<Vec<(usize, Complex<f64>)>>;

/// Computes the unit vector that `matrix(eigenvalue)` maps to 0, orthogonal to `earlier` vectors of
/// the same eigenvalue.
pub(crate) fn null_vector(
    matrix: impl Fn(Complex<f64>) -> SparseRows,
    eigenvalue: Complex<f64>,
    earlier: &[DVector<Complex<f64>>],
) -> DVector<Complex<f64>> {
    let factors = Factors::new(&matrix(eigenvalue * (1.0 + RELATIVE_SHIFT)));
    // The start vector has no symmetry, because a symmetric one could be orthogonal to a mode.
    let mut vector = DVector::from_fn(factors.steps.len(), |row, _| {
        Complex::new(1.0 + (1.7 * (row + earlier.len()) as f64).sin() / 2.0, 0.1)
    });
    for _ in 0..ITERATION_STEPS {
        for other in earlier {
            let part = other.dotc(&vector);
            vector.axpy(-part, other, Complex::from(1.0));
        }
        let next = factors.solve(&vector);
        let largest = next
            .iter()
            .fold(0.0, |most: f64, entry| most.max(entry.norm()));
        if !(largest > 0.0 && largest.is_finite()) {
            break;
        }
        let next = next.unscale(largest);
        vector = next.unscale(next.norm());
    }
    vector
}

/// Triangular factors of a square matrix within its band.
struct Factors {
    steps: Vec<Step>,
}

struct Step {
    /// Row exchanged with this row.
    pivot_row: usize,
    /// Multipliers of the rows below.
    below: Vec<(usize, Complex<f64>)>,
    pivot_value: Complex<f64>,
    /// Entries of the upper factor to the right of the pivot.
    right: Vec<(usize, Complex<f64>)>,
}

impl Factors {
    fn new(matrix: &SparseRows) -> Self {
        let count = matrix.len();
        let mut rows = vec![vec![Complex::from(0.0); count]; count];
        let (mut below, mut right) = (0, 0);
        for (index, row) in matrix.iter().enumerate() {
            for &(column, entry) in row {
                rows[index][column] = entry;
                below = below.max(index.saturating_sub(column));
                right = right.max(column.saturating_sub(index));
            }
        }
        // Row exchanges widen the upper band.
        let right = right + below;
        let steps = (0..count).map(|index| {
            let last_row = count.min(index + below + 1);
            let last_column = count.min(index + right + 1);
            eliminate(&mut rows[..last_row], index, last_column)
        });
        Self {
            steps: steps.collect(),
        }
    }

    /// Solves matrix x = right; not finite if the matrix is singular.
    fn solve(&self, right: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
        let mut solution = right.clone();
        for (index, step) in self.steps.iter().enumerate() {
            solution.swap_rows(index, step.pivot_row);
            let own = solution[index];
            for (row, factor) in &step.below {
                solution[*row] -= factor * own;
            }
        }
        for (index, step) in self.steps.iter().enumerate().rev() {
            let later = step.right.iter();
            let known: Complex<f64> = later.map(|(column, entry)| entry * solution[*column]).sum();
            solution[index] = (solution[index] - known) / step.pivot_value;
        }
        solution
    }
}

/// Eliminates a column from the rows below, whose entries end at `last_column`.
fn eliminate(rows: &mut [Vec<Complex<f64>>], index: usize, last_column: usize) -> Step {
    let zero = Complex::from(0.0);
    let sizes = rows[index..].iter().map(|row| row[index].norm());
    let largest = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    let pivot = largest.map_or(index, |(row, _)| index + row);
    rows.swap(index, pivot);
    let (above, rest) = rows.split_at_mut(index + 1);
    let pivot_row = &above[index];
    let own = pivot_row[index];
    let later = (index + 1..last_column).map(|column| (column, pivot_row[column]));
    let right: Vec<(usize, Complex<f64>)> = later.filter(|entry| entry.1 != zero).collect();
    let mut below = Vec::new();
    for (row, entries) in (index + 1..).zip(rest) {
        if own == zero || entries[index] == zero {
            continue;
        }
        let factor = entries[index] / own;
        below.push((row, factor));
        for (column, entry) in &right {
            entries[*column] -= factor * entry;
        }
    }
    Step {
        pivot_row: pivot,
        below,
        pivot_value: own,
        right,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn band_factors_solve_with_row_exchanges() {
        // Small pivots on the diagonal force row exchanges.
        let entry = |row: usize, column: usize| {
            let size = if row == column { 1e-3 } else { 1.0 };
            Complex::new(
                size + (row * 7 % 5) as f64 * 0.1,
                (column * 3 % 4) as f64 * 0.2,
            )
        };
        let near = |row: usize| row.saturating_sub(2)..(row + 2).min(12);
        let rows: SparseRows = (0..12)
            .map(|row| {
                near(row)
                    .map(|column| (column, entry(row, column)))
                    .collect()
            })
            .collect();
        let right = DVector::from_fn(12, |row, _| Complex::new(1.0, row as f64));
        let solution = Factors::new(&rows).solve(&right);
        for (row, entries) in rows.iter().enumerate() {
            let sum: Complex<f64> = entries
                .iter()
                .map(|(column, e)| e * solution[*column])
                .sum();
            assert!((sum - right[row]).norm() < 1e-11, "{row}: {sum}");
        }
    }

    #[test]
    fn double_eigenvalue_has_two_vectors() {
        let matrix = DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 5.0]);
        let at = |value: Complex<f64>| {
            matrix.map(Complex::from) - DMatrix::from_diagonal_element(3, 3, value)
        };
        let rows = |value: Complex<f64>| -> SparseRows {
            let matrix = at(value);
            let rows = matrix.row_iter();
            rows.map(|row| row.iter().copied().enumerate().collect())
                .collect()
        };
        let first = null_vector(rows, 2.0.into(), &[]);
        let second = null_vector(rows, 2.0.into(), std::slice::from_ref(&first));
        for vector in [&first, &second] {
            assert!((at(2.0.into()) * vector).norm() < 1e-10, "{vector}");
        }
        assert!(first.dotc(&second).norm() < 1e-9);
    }
}
