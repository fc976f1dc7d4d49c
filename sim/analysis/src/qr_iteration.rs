//! Schur forms, eigenvalues and singular values of small dense matrices, by QR iterations of
//! bounded length.
//!
//! The iteration of `nalgebra` has no exceptional shifts. It may cycle if the eigenvalues are symmetric, as for
//! undamped machines. A change of basis ends the cycle.

use nalgebra::{Complex, ComplexField, DMatrix, DVector, Dyn, SVD, Schur, SymmetricEigen};

/// Maximum number of iterations per eigenvalue; two or three are usual.
const MAX_ITERATIONS_PER_EIGENVALUE: usize = 400;

/// Maximum number of reflections that are tried.
const MAX_REFLECTIONS: usize = 3;

/// Computes the Schur form Q T Q^H of a square matrix: unitary Q, and upper triangular T (with blocks of two on
/// the diagonal for a real matrix). Returns `None` if the iteration converges in no tried basis.
pub fn schur_form<T: ComplexField<RealField = f64>>(
    matrix: &DMatrix<T>,
) -> Option<(DMatrix<T>, DMatrix<T>)> {
    let ConvergedSchur { reflection, schur } = converge_schur(matrix)?;
    let (unitary, triangle) = schur.unpack();
    Some(match reflection {
        Some(reflection) => (reflection * unitary, triangle),
        None => (unitary, triangle),
    })
}

/// Computes the eigenvalues of a square matrix, unsorted. Returns `None` if there is no [`schur_form`].
pub fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let schur = converge_schur(matrix)?.schur;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Computes the singular values of a matrix, largest first, with left and right vectors. Returns
/// `None` if the matrix is empty or not finite, or if the iteration does not converge.
pub fn svd(matrix: &DMatrix<f64>) -> Option<SVD<f64, Dyn, Dyn>> {
    if matrix.is_empty() || !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let most = MAX_ITERATIONS_PER_EIGENVALUE * matrix.nrows().max(matrix.ncols());
    SVD::try_new(matrix.clone(), true, true, 5.0 * f64::EPSILON, most)
}

/// Computes the eigenvalues and eigenvectors of a symmetric matrix. Returns `None` if the matrix is
/// empty or not finite, or if the iteration does not converge.
pub fn symmetric_eigen(matrix: &DMatrix<f64>) -> Option<SymmetricEigen<f64, Dyn>> {
    if matrix.is_empty() || !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let most = MAX_ITERATIONS_PER_EIGENVALUE * matrix.nrows();
    SymmetricEigen::try_new(matrix.clone(), f64::EPSILON, most)
}

/// Schur form of the matrix or of its reflection, after convergence.
struct ConvergedSchur<T: ComplexField<RealField = f64>> {
    reflection: Option<DMatrix<T>>,
    schur: Schur<T, Dyn>,
}

fn converge_schur<T: ComplexField<RealField = f64>>(
    matrix: &DMatrix<T>,
) -> Option<ConvergedSchur<T>> {
    let size = matrix.nrows();
    let most = MAX_ITERATIONS_PER_EIGENVALUE * size.max(1);
    let iterate = |matrix| Schur::try_new(matrix, f64::EPSILON, most);
    if let Some(schur) = iterate(matrix.clone()) {
        return Some(ConvergedSchur {
            reflection: None,
            schur,
        });
    }
    (1..=MAX_REFLECTIONS).find_map(|basis| {
        let normal = DVector::from_fn(size, |index, _| T::from_real(1.0 / (index + basis) as f64));
        let factor = T::from_real(2.0 / normal.norm_squared());
        let reflection = DMatrix::identity(size, size) - &normal * normal.transpose() * factor;
        let schur = iterate(&reflection * matrix * &reflection)?;
        Some(ConvergedSchur {
            reflection: Some(reflection),
            schur,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{eigenvalues, schur_form, svd, symmetric_eigen};
    use nalgebra::{Complex, DMatrix, Schur};

    /// Returns x' = v, v' = K x of two masses on a spring and a free mass.
    fn circling() -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(6, 6);
        for index in 0..3 {
            matrix[(index, index + 3)] = 1.0;
        }
        let k = 251.31233257696744;
        for (row, column, entry) in [(3, 0, -k), (3, 2, k), (5, 0, k), (5, 2, -k)] {
            matrix[(row, column)] = entry;
        }
        matrix
    }

    #[test]
    fn cyclic_iteration_converges_in_another_basis() {
        let matrix = circling();
        assert!(Schur::try_new(matrix.clone(), f64::EPSILON, 1000).is_none());
        let found = eigenvalues(&matrix).expect("another basis");
        let fastest = found.iter().map(|e| e.norm()).fold(0.0, f64::max);
        assert!((fastest / (2.0 * 251.31233257696744_f64).sqrt() - 1.0).abs() < 1e-14);
        // Two pairs of eigenvalues 0, with one eigenvector each: rounding displaces them by its square root.
        assert_eq!(found.iter().filter(|e| e.norm() < 1e-6).count(), 4);
    }

    #[test]
    fn schur_form_reproduces_the_matrix() {
        let matrix = circling();
        let (unitary, triangle) = schur_form(&matrix).expect("another basis");
        let back = &unitary * triangle * unitary.transpose();
        assert!((back - &matrix).norm() < 1e-14 * matrix.norm());
        let complex = matrix.map(|entry| Complex::new(entry, 0.0));
        let (unitary, triangle) = schur_form(&complex).expect("another basis");
        let back = &unitary * triangle * unitary.adjoint();
        assert!((back - &complex).norm() < 1e-14 * complex.norm());
    }

    #[test]
    fn matrices_that_are_not_finite_are_rejected() {
        for entry in [f64::NAN, f64::INFINITY] {
            let matrix = DMatrix::from_element(3, 3, entry);
            assert!(svd(&matrix).is_none() && symmetric_eigen(&matrix).is_none());
        }
        assert!(svd(&DMatrix::zeros(0, 3)).is_none());
    }
}
