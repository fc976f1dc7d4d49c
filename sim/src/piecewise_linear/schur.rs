//! Complex Schur form of a balanced real matrix, with eigenvalues in any required order.

use eomgen_analysis::qr_iteration::schur_form;
use nalgebra::{Complex, DMatrix};

use crate::balancing::{MAX_ENTRY_PER_S, balance};

/// A = D Q T Q^H D^-1 with T upper triangular, Q unitary and D diagonal.
pub(super) struct SchurForm {
    /// Upper triangular matrix T; its diagonal contains the eigenvalues, 1/s.
    pub triangle: DMatrix<Complex<f64>>,
    /// Unitary matrix Q.
    pub basis: DMatrix<Complex<f64>>,
    /// Diagonal of D: powers of two that scale rows and columns to similar size.
    pub scale: Vec<f64>,
}

impl SchurForm {
    /// Computes the Schur form of a square matrix. Returns `None` if the iteration does not converge. `scale`
    /// is the initial guess of D, powers of two.
    pub fn decompose(matrix: &DMatrix<f64>, scale: Vec<f64>) -> Option<Self> {
        let size = matrix.nrows();
        if size == 0 {
            return Some(Self {
                triangle: DMatrix::zeros(0, 0),
                basis: DMatrix::zeros(0, 0),
                scale: Vec::new(),
            });
        }
        if !matrix.iter().all(|entry| entry.abs() < MAX_ENTRY_PER_S) {
            return None;
        }
        let scale = balance(matrix, scale);
        let complex = DMatrix::from_fn(size, size, |i, j| {
            Complex::new(matrix[(i, j)] * scale[j] / scale[i], 0.0)
        });
        let (basis, triangle) = schur_form(&complex)?;
        Some(Self {
            triangle,
            basis,
            scale,
        })
    }

    /// Returns the eigenvalues in the current order, 1/s.
    pub fn eigenvalues(&self) -> Vec<Complex<f64>> {
        (0..self.triangle.nrows())
            .map(|index| self.triangle[(index, index)])
            .collect()
    }

    /// Sorts the eigenvalues by `key` (stable sort).
    pub fn sort_by_key(&mut self, mut key: Vec<usize>) {
        for end in (1..key.len()).rev() {
            for index in 0..end {
                if key[index] > key[index + 1] {
                    key.swap(index, index + 1);
                    self.swap(index);
                }
            }
        }
    }

    /// Exchanges the eigenvalues `index` and `index` + 1 by a rotation (Golub and Van Loan, Matrix
    /// Computations, 7.6.2).
    fn swap(&mut self, index: usize) {
        let (p, q) = (index, index + 1);
        let difference = self.triangle[(q, q)] - self.triangle[(p, p)];
        let coupling = self.triangle[(p, q)];
        let length = (coupling.norm_sqr() + difference.norm_sqr()).sqrt();
        if length == 0.0 {
            return;
        }
        let (c, s) = (coupling / length, difference / length);
        // The first new basis vector is the eigenvector of the second eigenvalue.
        let rotate_columns = |matrix: &mut DMatrix<Complex<f64>>, rows: usize| {
            for row in 0..rows {
                let (a, b) = (matrix[(row, p)], matrix[(row, q)]);
                matrix[(row, p)] = a * c + b * s;
                matrix[(row, q)] = b * c.conj() - a * s.conj();
            }
        };
        let size = self.triangle.nrows();
        rotate_columns(&mut self.triangle, q + 1);
        rotate_columns(&mut self.basis, size);
        for column in p..size {
            let (a, b) = (self.triangle[(p, column)], self.triangle[(q, column)]);
            self.triangle[(p, column)] = a * c.conj() + b * s.conj();
            self.triangle[(q, column)] = b * c - a * s;
        }
        self.triangle[(q, p)] = Complex::new(0.0, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residual(matrix: &DMatrix<f64>, form: &SchurForm) -> f64 {
        let size = matrix.nrows();
        let scaled = DMatrix::from_fn(size, size, |i, j| {
            Complex::new(matrix[(i, j)] * form.scale[j] / form.scale[i], 0.0)
        });
        let back = &form.basis * &form.triangle * form.basis.adjoint();
        (back - &scaled).norm() / scaled.norm()
    }

    #[test]
    fn iteration_leaves_a_cycle() {
        // Two oscillators, and a third rate near one of them.
        let mut matrix = DMatrix::zeros(5, 5);
        let entries = [
            (0, 3, 8.0),
            (1, 4, 4.0),
            (2, 0, -6.25),
            (3, 0, -6.25),
            (4, 1, -4.802871669958299),
        ];
        for (row, column, entry) in entries {
            matrix[(row, column)] = entry;
        }
        let form = SchurForm::decompose(&matrix, vec![1.0; 5]).expect("another basis");
        assert!(residual(&matrix, &form) < 1e-14);
        let mut turns: Vec<f64> = form.eigenvalues().iter().map(|e| e.im).collect();
        turns.sort_by(f64::total_cmp);
        let (fast, slow) = (f64::sqrt(50.0), f64::sqrt(4.0 * 4.802871669958299));
        for (turn, expected) in turns.iter().zip([-fast, -slow, 0.0, slow, fast]) {
            assert!((turn - expected).abs() < 1e-13, "{turns:?}");
        }
    }

    #[test]
    fn sorting_keeps_the_matrix() {
        let size = 9;
        let matrix = DMatrix::from_fn(size, size, |i, j| {
            ((7 * i + 3 * j * j + 1) % 11) as f64 - 5.0 + if i == j { 0.5 * i as f64 } else { 0.0 }
        });
        let mut form = SchurForm::decompose(&matrix, vec![1.0; size]).expect("converges");
        // A hundred roundings of a matrix of size 9.
        assert!(residual(&matrix, &form) < 1e-14);
        let before = form.eigenvalues();
        let key: Vec<usize> = (0..size).map(|i| (i * 5) % size).collect();
        form.sort_by_key(key.clone());
        assert!(residual(&matrix, &form) < 1e-14);
        for (index, value) in form.eigenvalues().iter().enumerate() {
            let from = key.iter().position(|k| *k == index).expect("a permutation");
            assert!((value - before[from]).norm() < 1e-11 * before[from].norm());
        }
    }
}
