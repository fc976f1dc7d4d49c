//! Small motions of a linearised machine that satisfy its constraints, and the reduced matrices.
//!
//! The linearised constraints are H x = 0. Let N be an orthonormal basis of their solutions. Motions
//! are x = N y with y' = N^T A N y + N^T B u, outputs are C N y + D u (E. Eich-Soellner, C. Fuehrer,
//! *Numerical Methods in Multibody Dynamics*, 2.6).

use nalgebra::DMatrix;

use crate::error::AnalysisError;
use crate::null_space::{equilibrate_rows, null_space};

/// The motions that satisfy linearised constraints.
pub struct AllowedMotions {
    basis: DMatrix<f64>,
}

impl AllowedMotions {
    /// Computes the motions with H x = 0. `held` is H row by row; the scale of a row is arbitrary. `sizes` are
    /// the typical sizes of the states: entries of H far below the others of their row, relative to these
    /// sizes, are rounding.
    ///
    /// # Errors
    /// A number of entries that is not a multiple of the number of states; entries that are not finite.
    pub fn new(held: &[f64], sizes: &[f64]) -> Result<Self, AnalysisError> {
        let states = sizes.len();
        if states == 0 || !held.len().is_multiple_of(states) {
            let (expected, given) = (states, held.len());
            return Err(AnalysisError::LengthMismatch { expected, given });
        }
        if let Some(sample) = held.iter().position(|entry| !entry.is_finite()) {
            return Err(AnalysisError::NotFinite { sample });
        }
        let mut rows = DMatrix::from_row_slice(held.len() / states, states, held);
        for (mut column, size) in rows.column_iter_mut().zip(sizes) {
            column *= *size;
        }
        let rows = equilibrate_rows(rows);
        let scaled = null_space(&(rows.transpose() * &rows));
        let mut basis = scaled.ok_or_else(|| AnalysisError::not_converged(&rows))?;
        if sizes.iter().all(|size| *size == 1.0) || basis.is_empty() {
            return Ok(Self { basis });
        }
        for (mut row, size) in basis.row_iter_mut().zip(sizes) {
            row *= *size;
        }
        Ok(Self {
            basis: basis.qr().q(),
        })
    }

    /// Returns the number of independent motions.
    pub fn count(&self) -> usize {
        self.basis.ncols()
    }

    /// Returns N, with one row per state.
    pub fn basis(&self) -> &DMatrix<f64> {
        &self.basis
    }

    /// Computes N^T A N, row by row, from a square A.
    pub fn reduce_state_matrix(&self, a: &[f64]) -> Vec<f64> {
        let states = self.basis.nrows();
        let a = DMatrix::from_row_slice(states, states, a);
        row_by_row(&(self.basis.transpose() * a * &self.basis))
    }

    /// Computes N^T B, row by row.
    pub fn reduce_input_matrix(&self, b: &[f64], inputs: usize) -> Vec<f64> {
        let b = DMatrix::from_row_slice(self.basis.nrows(), inputs, b);
        row_by_row(&(self.basis.transpose() * b))
    }

    /// Computes C N, row by row.
    pub fn reduce_output_matrix(&self, c: &[f64], outputs: usize) -> Vec<f64> {
        let c = DMatrix::from_row_slice(outputs, self.basis.nrows(), c);
        row_by_row(&(c * &self.basis))
    }
}

/// Returns the entries of a matrix row by row.
pub fn row_by_row(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().iter().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_coordinate_reduces_to_one_oscillator() {
        // x'' = -9 x + 2 u with y = y' = 0. Outputs are x, and a second one with slope 7 in y, which is 0.
        let a = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-9.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ];
        let held = [[0.0, 3e5, 0.0, 0.0], [0.0, 0.0, 0.0, 1e-3]];
        let allowed = AllowedMotions::new(held.as_flattened(), &[1.0; 4]).unwrap();
        assert_eq!(allowed.count(), 2);
        let reduced = DMatrix::from_row_slice(2, 2, &allowed.reduce_state_matrix(a.as_flattened()));
        assert!((reduced.determinant() - 9.0).abs() < 1e-12 && reduced.trace().abs() < 1e-12);
        let b =
            DMatrix::from_row_slice(2, 1, &allowed.reduce_input_matrix(&[0.0, 0.0, 2.0, 0.0], 1));
        let c = [1.0, 0.0, 0.0, 0.0, 0.0, 7.0, 0.0, 0.0];
        let c = DMatrix::from_row_slice(2, 2, &allowed.reduce_output_matrix(&c, 2));
        // Transfer function at s = 1: 2/(1 + 9) from u to x, 0 from u to y.
        let inverse = (DMatrix::identity(2, 2) - reduced).try_inverse().unwrap();
        let gain = c * inverse * b;
        assert!(
            (gain[0] - 0.2).abs() < 1e-12 && gain[1].abs() < 1e-12,
            "{gain}"
        );
    }

    #[test]
    fn units_of_states_and_rounding_add_no_motion() {
        // x = 0 and y = 0 in other units. The entries of z, which is free, are rounding.
        for unit in [2.0_f64.powi(-30), 1.0, 2.0_f64.powi(30)] {
            let held = [[1.0, 0.0, 1e-17], [1.0, -unit, 1e-16]];
            let allowed = AllowedMotions::new(held.as_flattened(), &[1.0, 1.0 / unit, 1.0]);
            let allowed = allowed.unwrap();
            assert_eq!(allowed.count(), 1, "{unit}");
            assert!(
                (allowed.basis()[(2, 0)].abs() - 1.0).abs() < 1e-12,
                "{unit}"
            );
        }
    }

    #[test]
    fn malformed_constraint_matrices_are_rejected() {
        assert!(AllowedMotions::new(&[1.0, 0.0, 0.0], &[1.0; 2]).is_err());
        assert!(AllowedMotions::new(&[1.0, f64::NAN], &[1.0; 2]).is_err());
        assert_eq!(
            AllowedMotions::new(&[0.0, 0.0], &[1.0; 2]).unwrap().count(),
            2
        );
    }
}
