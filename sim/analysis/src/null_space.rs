//! Null spaces of matrices, by their singular values.

use nalgebra::DMatrix;

use crate::qr_iteration;

/// Below this, relative to the largest, a singular value is rounding.
pub(crate) const RANK: f64 = 1e-12;

/// How often 0 is an eigenvalue, chains of any length counted: null spaces are taken away until
/// there is none. Nothing if they cannot be computed.
pub(crate) fn zero_eigenvalues(mut matrix: DMatrix<f64>) -> Option<usize> {
    let mut count = 0;
    loop {
        let null = null_space(&with_rows_of_one_size(matrix.clone()))?;
        if null.ncols() == 0 {
            return Some(count);
        }
        count += null.ncols();
        if null.ncols() == matrix.ncols() {
            return Some(count);
        }
        // An orthonormal basis of what is left: the null space of the null space.
        let rest = null_space(&(&null * null.transpose()))?;
        matrix = rest.transpose() * matrix * rest;
    }
}

/// An orthonormal basis of what a matrix maps to 0, as columns; nothing if it cannot be computed.
pub(crate) fn null_space(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let decomposed = qr_iteration::svd(matrix)?;
    let rows = decomposed.v_t?;
    let most = decomposed.singular_values.amax();
    let small: Vec<_> = decomposed
        .singular_values
        .iter()
        .zip(rows.row_iter())
        .filter(|(value, _)| **value <= RANK * most)
        .map(|(_, row)| row.transpose())
        .collect();
    Some(match small.is_empty() {
        true => DMatrix::zeros(matrix.ncols(), 0),
        false => DMatrix::from_columns(&small),
    })
}

/// The matrix with each row divided by its largest entry, which leaves its null space: whether a soft
/// spring is there does not depend on a stiff one.
pub(crate) fn with_rows_of_one_size(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for mut row in matrix.row_iter_mut() {
        let size = row.amax();
        if size > 0.0 {
            row /= size;
        }
    }
    matrix
}
