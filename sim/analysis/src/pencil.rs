//! Quadratic eigenvalue problem of a balanced state matrix, in its coordinates.

use nalgebra::{Complex, DMatrix, DVector};

use crate::balancing::BalancedMatrix;
use crate::inverse_iteration::SparseRows;
use crate::null_space::{RANK_TOLERANCE, equilibrate_rows, null_space};
use crate::qr_iteration;

/// Quadratic pencil lambda^2 - lambda D - K in balanced coordinates. First-order states follow, with lambda
/// instead of lambda^2.
pub(crate) struct Pencil {
    /// Columns of possible nonzeros in each row: the diagonal, and those of K and D.
    columns: Vec<Vec<usize>>,
    /// Block matrix (K F; G H).
    stiffness: DMatrix<f64>,
    /// Block matrix (D 0; E 0).
    damping: DMatrix<f64>,
    /// Ratio of balanced q' to q, from the upper rows; 1 for first-order states.
    ratio: DVector<f64>,
    /// SI value of a balanced unit.
    sizes: DVector<f64>,
    degrees: usize,
}

/// Motions with the eigenvalue 0.
pub(crate) struct RigidMotions {
    pub shapes: Vec<DVector<Complex<f64>>>,
    /// Algebraic multiplicity of the eigenvalue 0.
    pub multiplicity: usize,
}

impl Pencil {
    /// Creates the pencil of a balanced state matrix with `degrees` coordinates.
    pub fn new(balanced: &BalancedMatrix, degrees: usize) -> Self {
        let (balanced, sizes) = (&balanced.matrix, &balanced.sizes);
        let count = balanced.nrows() - degrees;
        // Index in the state of a coordinate or first-order state.
        let held = |index: usize| {
            if index < degrees {
                index
            } else {
                index + degrees
            }
        };
        let stiffness = DMatrix::from_fn(count, count, |row, column| {
            balanced[(degrees + row, held(column))]
        });
        let damping = DMatrix::from_fn(count, count, |row, column| match column < degrees {
            true => balanced[(degrees + row, degrees + column)],
            false => 0.0,
        });
        let is_filled = |row: usize, column: usize| {
            row == column || stiffness[(row, column)] != 0.0 || damping[(row, column)] != 0.0
        };
        let columns = (0..count)
            .map(|row| {
                (0..count)
                    .filter(|column| is_filled(row, *column))
                    .collect()
            })
            .collect();
        Self {
            columns,
            stiffness,
            damping,
            ratio: DVector::from_fn(count, |index, _| match index < degrees {
                true => balanced[(index, degrees + index)],
                false => 1.0,
            }),
            sizes: DVector::from_fn(count, |index, _| sizes[held(index)]),
            degrees,
        }
    }

    /// Evaluates lambda (lambda/ratio) - (lambda/ratio) D - K; the rates are lambda/ratio times the
    /// coordinates.
    pub fn evaluate(&self, eigenvalue: Complex<f64>) -> SparseRows {
        let entry = |row: usize, column: usize| {
            let rate = eigenvalue / self.ratio[column];
            let inertia = match row == column {
                true if row < self.degrees => eigenvalue * rate,
                true => eigenvalue,
                false => 0.0.into(),
            };
            inertia - rate * self.damping[(row, column)] - self.stiffness[(row, column)]
        };
        let rows = self.columns.iter().enumerate();
        rows.map(|(row, columns)| columns.iter().map(|at| (*at, entry(row, *at))).collect())
            .collect()
    }

    /// Computes the motions with the eigenvalue 0. Returns `None` if the iteration does not
    /// converge.
    pub fn rigid_motions(&self) -> Option<RigidMotions> {
        let equilibrated = equilibrate_rows(self.stiffness.clone());
        let (right, left) = (
            null_space(&equilibrated)?,
            null_space(&equilibrated.transpose())?,
        );
        let rows = self.stiffness.row_iter().map(|row| row.amax());
        let weights: Vec<f64> = rows
            .map(|size| if size > 0.0 { size } else { 1.0 })
            .collect();
        if right.ncols() == 0 {
            return Some(RigidMotions {
                shapes: Vec::new(),
                multiplicity: 0,
            });
        }
        // Undoes the scaling of the rows.
        let left = DMatrix::from_fn(left.nrows(), left.ncols(), |row, column| {
            left[(row, column)] / weights[row]
        });
        let rates = DMatrix::from_fn(right.nrows(), right.ncols(), |row, column| {
            right[(row, column)] / self.ratio[row]
        });
        let damped = left.transpose() * &self.damping * &rates;
        let most = left.abs().transpose() * self.damping.abs() * rates.abs();
        let singular = qr_iteration::svd(&damped)?.singular_values;
        let most = most.amax();
        let again = singular
            .iter()
            .filter(|value| **value <= RANK_TOLERANCE * most)
            .count();
        let complex = |column: nalgebra::DVectorView<'_, f64>| column.map(Complex::from);
        Some(RigidMotions {
            shapes: right.column_iter().map(complex).collect(),
            multiplicity: right.ncols() + again,
        })
    }

    /// Converts a shape to SI, with the largest coordinate 1 and first-order states after the
    /// coordinates.
    pub fn to_si(&self, shape: &DVector<Complex<f64>>) -> Vec<Complex<f64>> {
        let amplitudes: Vec<Complex<f64>> = shape
            .iter()
            .zip(&self.sizes)
            .map(|(value, size)| value * *size)
            .collect();
        let largest = |of: &[Complex<f64>]| {
            let most = of
                .iter()
                .copied()
                .max_by(|a, b| a.norm().total_cmp(&b.norm()));
            most.filter(|value| value.norm() > 0.0)
        };
        // Coordinates that move only because of rounding do not set the scale.
        let moves = shape.rows(0, self.degrees).norm() > RANK_TOLERANCE * shape.norm();
        let largest = largest(&amplitudes[..self.degrees])
            .filter(|_| moves)
            .or_else(|| largest(&amplitudes))
            .unwrap_or(1.0.into());
        amplitudes.iter().map(|value| value / largest).collect()
    }
}
