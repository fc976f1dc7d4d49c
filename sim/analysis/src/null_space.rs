//! Null spaces of matrices, from singular values.

use nalgebra::DMatrix;

use crate::qr_iteration;

/// Largest singular value that counts as rounding, relative to the largest one.
pub(crate) const RANK_TOLERANCE: f64 = 1e-12;

/// Counts the multiplicity of the eigenvalue 0 with Jordan chains of any length: null spaces are removed until
/// none remains. Returns `None` if they cannot be computed.
pub(crate) fn zero_eigenvalues(mut matrix: DMatrix<f64>) -> Option<usize> {
    let mut count = 0;
    loop {
        let null = null_space(&equilibrate_rows(matrix.clone()))?;
        if null.ncols() == 0 {
            return Some(count);
        }
        count += null.ncols();
        if null.ncols() == matrix.ncols() {
            return Some(count);
        }
        // Orthonormal basis of the complement: the null space of the projector on the null space.
        let rest = null_space(&(&null * null.transpose()))?;
        matrix = rest.transpose() * matrix * rest;
    }
}

/// Computes an orthonormal basis of the null space, as columns. Returns `None` if the singular
/// values cannot be computed.
pub(crate) fn null_space(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let decomposed = qr_iteration::svd(matrix)?;
    let rows = decomposed.v_t?;
    let most = decomposed.singular_values.amax();
    let small: Vec<_> = decomposed
        .singular_values
        .iter()
        .zip(rows.row_iter())
        .filter(|(value, _)| **value <= RANK_TOLERANCE * most)
        .map(|(_, row)| row.transpose())
        .collect();
    Some(match small.is_empty() {
        true => DMatrix::zeros(matrix.ncols(), 0),
        false => DMatrix::from_columns(&small),
    })
}

/// Divides each row by its largest entry, which preserves the null space. A soft spring is then not
/// neglected because of a stiff one.
pub(crate) fn equilibrate_rows(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for mut row in matrix.row_iter_mut() {
        let size = row.amax();
        if size > 0.0 {
            row /= size;
        }
    }
    matrix
}
