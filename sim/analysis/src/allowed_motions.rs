//! The small motions that constraints allow of a linearised machine, and its matrices for them.
//!
//! With the constraints linearised too, H x = 0, and N an orthonormal basis of what they allow, x = N y
//! moves by y' = N^T A N y + N^T B u and shows C N y + D u (E. Eich-Soellner, C. Fuehrer, *Numerical
//! Methods in Multibody Dynamics*, 2.6).

use nalgebra::DMatrix;

use crate::error::AnalysisError;
use crate::null_space::{null_space, with_rows_of_one_size};

/// The small motions that constraints allow.
pub struct AllowedMotions {
    basis: DMatrix<f64>,
}

impl AllowedMotions {
    /// Those of so many states for which H x = 0; `held` is H row by row, its rows in any scale.
    ///
    /// # Errors
    /// Another number of entries, and entries that are no finite numbers.
    pub fn new(held: &[f64], states: usize) -> Result<Self, AnalysisError> {
        if states == 0 || !held.len().is_multiple_of(states) {
            let (expected, given) = (states, held.len());
            return Err(AnalysisError::Lengths { expected, given });
        }
        if let Some(sample) = held.iter().position(|entry| !entry.is_finite()) {
            return Err(AnalysisError::NotFinite { sample });
        }
        let held = DMatrix::from_row_slice(held.len() / states, states, held);
        let rows = with_rows_of_one_size(held);
        let basis = null_space(&(rows.transpose() * &rows));
        let basis = basis.ok_or_else(|| AnalysisError::not_converged(&rows))?;
        Ok(Self { basis })
    }

    /// How many there are, independent of each other.
    pub fn count(&self) -> usize {
        self.basis.ncols()
    }

    /// N, as many rows as states.
    pub fn basis(&self) -> &DMatrix<f64> {
        &self.basis
    }

    /// N^T A N, row by row; A has as many rows as columns.
    pub fn of_states(&self, a: &[f64]) -> Vec<f64> {
        let states = self.basis.nrows();
        let a = DMatrix::from_row_slice(states, states, a);
        row_by_row(&(self.basis.transpose() * a * &self.basis))
    }

    /// N^T B, row by row.
    pub fn of_inputs(&self, b: &[f64], inputs: usize) -> Vec<f64> {
        let b = DMatrix::from_row_slice(self.basis.nrows(), inputs, b);
        row_by_row(&(self.basis.transpose() * b))
    }

    /// C N, row by row.
    pub fn of_outputs(&self, c: &[f64], outputs: usize) -> Vec<f64> {
        let c = DMatrix::from_row_slice(outputs, self.basis.nrows(), c);
        row_by_row(&(c * &self.basis))
    }
}

/// The entries of a matrix, row by row.
pub fn row_by_row(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_on_a_rod_at_rest_has_the_matrices_of_a_pendulum() {
        // x'' = -9 x + 2 u, y held: y = y' = 0. Shown are x, and y with what would be its slope.
        let a = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-9.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ];
        let held = [[0.0, 3e5, 0.0, 0.0], [0.0, 0.0, 0.0, 1e-3]];
        let allowed = AllowedMotions::new(held.as_flattened(), 4).unwrap();
        assert_eq!(allowed.count(), 2);
        let reduced = DMatrix::from_row_slice(2, 2, &allowed.of_states(a.as_flattened()));
        assert!((reduced.determinant() - 9.0).abs() < 1e-12 && reduced.trace().abs() < 1e-12);
        let b = DMatrix::from_row_slice(2, 1, &allowed.of_inputs(&[0.0, 0.0, 2.0, 0.0], 1));
        let c = [1.0, 0.0, 0.0, 0.0, 0.0, 7.0, 0.0, 0.0];
        let c = DMatrix::from_row_slice(2, 2, &allowed.of_outputs(&c, 2));
        // From u to x at s = 1: 2/(1 + 9), to y nothing.
        let inverse = (DMatrix::identity(2, 2) - reduced).try_inverse().unwrap();
        let gain = c * inverse * b;
        assert!(
            (gain[0] - 0.2).abs() < 1e-12 && gain[1].abs() < 1e-12,
            "{gain}"
        );
    }

    #[test]
    fn what_is_no_matrix_of_these_states_is_refused() {
        assert!(AllowedMotions::new(&[1.0, 0.0, 0.0], 2).is_err());
        assert!(AllowedMotions::new(&[1.0, f64::NAN], 2).is_err());
        assert_eq!(AllowedMotions::new(&[0.0, 0.0], 2).unwrap().count(), 2);
    }
}
