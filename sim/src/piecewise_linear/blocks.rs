//! Block diagonalisation of a triangular matrix: T X = X D with X unit upper triangular.

use std::ops::Range;

use nalgebra::{Complex, DMatrix};

/// Returns X of T X = X D, where D contains the diagonal blocks of T. The blocks are contiguous ranges that
/// cover T, and different blocks share no eigenvalue.
///
/// The Sylvester equations T_ii X_ij - X_ij T_jj = -(T_ij + sum over i < k < j of T_ik X_kj) are solved for one
/// block column after another, from the bottom up.
pub(super) fn decouple(
    triangle: &DMatrix<Complex<f64>>,
    blocks: &[Range<usize>],
) -> DMatrix<Complex<f64>> {
    let size = triangle.nrows();
    let mut coupling = DMatrix::identity(size, size);
    for (j, columns) in blocks.iter().enumerate() {
        for rows in blocks[..j].iter().rev() {
            for column in columns.clone() {
                for row in rows.clone().rev() {
                    let mut right = -triangle[(row, column)];
                    for between in row + 1..columns.start {
                        right -= triangle[(row, between)] * coupling[(between, column)];
                    }
                    for before in columns.start..column {
                        right += coupling[(row, before)] * triangle[(before, column)];
                    }
                    let gap = triangle[(row, row)] - triangle[(column, column)];
                    coupling[(row, column)] = right / gap;
                }
            }
        }
    }
    coupling
}

/// Returns the inverse of a unit upper triangular matrix.
pub(super) fn inverse(coupling: &DMatrix<Complex<f64>>) -> DMatrix<Complex<f64>> {
    let size = coupling.nrows();
    let mut inverse = DMatrix::identity(size, size);
    for column in 0..size {
        for row in (0..column).rev() {
            let mut sum = Complex::new(0.0, 0.0);
            for between in row + 1..=column {
                sum += coupling[(row, between)] * inverse[(between, column)];
            }
            inverse[(row, column)] = -sum;
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_decoupled() {
        let size = 6;
        let mut triangle = DMatrix::from_fn(size, size, |i, j| {
            if i <= j {
                Complex::new((i + 2 * j) as f64 * 0.3, (i * j) as f64 * 0.2 - 1.0)
            } else {
                Complex::new(0.0, 0.0)
            }
        });
        // A defective pair of eigenvalues inside one block.
        triangle[(2, 2)] = triangle[(1, 1)];
        let blocks = [0..1, 1..3, 3..4, 4..6];
        let coupling = decouple(&triangle, &blocks);
        let diagonal = inverse(&coupling) * &triangle * &coupling;
        for (i, rows) in blocks.iter().enumerate() {
            for (j, columns) in blocks.iter().enumerate() {
                for (row, column) in rows
                    .clone()
                    .flat_map(|r| columns.clone().map(move |c| (r, c)))
                {
                    let wanted = if i == j {
                        triangle[(row, column)]
                    } else {
                        Complex::new(0.0, 0.0)
                    };
                    // The error is rounding times the condition number of the small matrix.
                    assert!((diagonal[(row, column)] - wanted).norm() < 1e-11);
                }
            }
        }
    }
}
