//! Eigenvectors to known eigenvalues by inverse iteration (G. H. Golub, C. F. Van Loan, *Matrix
//! Computations*, 7.6), with factors that skip zeros: those of a chain cost as many multiplications as it
//! has members.

use nalgebra::{Complex, DMatrix, DVector};

/// How far beside its eigenvalue the matrix of the inverse iteration is taken, relative to its size:
/// there it is not singular, and one step gains as many digits.
const BESIDE: f64 = 1e-11;

/// Steps of the iteration; the second mostly changes nothing.
const STEPS: usize = 4;

/// The vector that a matrix function maps to 0 at its eigenvalue, of norm 1, without the parts along
/// `earlier` vectors of the same eigenvalue.
pub(crate) fn null_vector_at(
    matrix: impl Fn(Complex<f64>) -> DMatrix<Complex<f64>>,
    eigenvalue: Complex<f64>,
    earlier: &[DVector<Complex<f64>>],
) -> DVector<Complex<f64>> {
    let factors = Factors::new(matrix(eigenvalue * (1.0 + BESIDE)));
    // Of no symmetry that a machine might have too.
    let mut vector = DVector::from_fn(factors.order.len(), |row, _| {
        Complex::new(1.0 + (1.7 * (row + earlier.len()) as f64).sin() / 2.0, 0.1)
    });
    for _ in 0..STEPS {
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

/// Triangular factors of a square matrix with its rows in another order.
struct Factors {
    /// Row by row: below the diagonal the multipliers, above it the upper factor.
    rows: Vec<Vec<Complex<f64>>>,
    /// Which row of the matrix each of them was.
    order: Vec<usize>,
}

impl Factors {
    fn new(matrix: DMatrix<Complex<f64>>) -> Self {
        let count = matrix.nrows();
        let mut rows: Vec<Vec<_>> = matrix
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        let mut order: Vec<usize> = (0..count).collect();
        let zero = Complex::from(0.0);
        for place in 0..count {
            let sizes = (place..count).map(|row| rows[row][place].norm());
            let largest = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let pivot = largest.map_or(place, |(row, _)| place + row);
            rows.swap(place, pivot);
            order.swap(place, pivot);
            let (above, below) = rows.split_at_mut(place + 1);
            let pivot = &above[place];
            if pivot[place] == zero {
                continue;
            }
            let later = place + 1..count;
            let columns: Vec<usize> = later.filter(|column| pivot[*column] != zero).collect();
            for row in below.iter_mut().filter(|row| row[place] != zero) {
                let factor = row[place] / pivot[place];
                row[place] = factor;
                for column in &columns {
                    row[*column] -= factor * pivot[*column];
                }
            }
        }
        Self { rows, order }
    }

    /// The x with matrix x = right; not finite where the matrix is singular.
    fn solve(&self, right: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
        let count = self.order.len();
        let mut solution = DVector::from_fn(count, |row, _| right[self.order[row]]);
        for row in 0..count {
            let known: Complex<f64> = (0..row)
                .map(|column| self.rows[row][column] * solution[column])
                .sum();
            solution[row] -= known;
        }
        for row in (0..count).rev() {
            let known: Complex<f64> = (row + 1..count)
                .map(|column| self.rows[row][column] * solution[column])
                .sum();
            solution[row] = (solution[row] - known) / self.rows[row][row];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_of_a_double_eigenvalue_are_two() {
        let matrix = DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 5.0]);
        let at = |value: Complex<f64>| {
            matrix.map(Complex::from) - DMatrix::from_diagonal_element(3, 3, value)
        };
        let first = null_vector_at(at, 2.0.into(), &[]);
        let second = null_vector_at(at, 2.0.into(), std::slice::from_ref(&first));
        for vector in [&first, &second] {
            assert!((at(2.0.into()) * vector).norm() < 1e-10, "{vector}");
        }
        assert!(first.dotc(&second).norm() < 1e-9);
    }
}
