//! Small linear systems: elimination with full pivoting, and the solution of least norm if rows are linearly
//! dependent.

use nalgebra::{DMatrix, DVector};

use crate::sliding_modes::{solve_least_squares, solve_regularised};

/// Largest pivot that counts as rounding, as a fraction of the largest pivot.
const MIN_PIVOT_FRACTION: f64 = 1e-10;

/// Largest error of a row that counts as rounding, relative to the largest entry of b or x.
const MAX_ROW_ERROR: f64 = 1e-10;

/// Solves A x = b, with A row by row. If A is singular, x is the least-squares solution of least norm. Returns
/// `None` if an entry is not finite.
pub fn solve_balance(matrix: Vec<f64>, right: Vec<f64>) -> Option<Vec<f64>> {
    let size = right.len();
    if matrix.iter().chain(&right).any(|entry| !entry.is_finite()) {
        return None;
    }
    if let Some(solved) = eliminate(matrix.clone(), right.clone()) {
        return Some(solved);
    }
    let matrix = DMatrix::from_row_slice(size, size, &matrix);
    let solved = solve_least_squares(&matrix, DVector::from_vec(right));
    Some(solved.iter().copied().collect())
}

/// Solves A x = b like [`solve_balance`]. If the rows contradict each other, because directions that coincided
/// move apart, x is far beyond the limits of forces.
pub fn solve_holding_balance(matrix: Vec<f64>, right: Vec<f64>) -> Option<Vec<f64>> {
    let size = right.len();
    let solved = solve_balance(matrix.clone(), right.clone())?;
    let matrix = DMatrix::from_row_slice(size, size, &matrix);
    let (right, x) = (
        DVector::from_vec(right),
        DVector::from_column_slice(&solved),
    );
    if (&matrix * &x - &right).amax() <= MAX_ROW_ERROR * right.amax().max(x.amax()) {
        return Some(solved);
    }
    let beyond = solve_regularised(&matrix, &right);
    Some(beyond.map_or(solved, |beyond| beyond.iter().copied().collect()))
}

/// Returns the solution of a nonsingular system.
fn eliminate(mut matrix: Vec<f64>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let size = right.len();
    let mut columns: Vec<usize> = (0..size).collect();
    let mut largest = 0.0_f64;
    for step in 0..size {
        let entries = (step..size).flat_map(|row| (step..size).map(move |column| (row, column)));
        let (row, column) = entries.max_by(|a, b| {
            let [a, b] = [a, b].map(|(row, column)| matrix[row * size + column].abs());
            a.total_cmp(&b)
        })?;
        for entry in 0..size {
            matrix.swap(step * size + entry, row * size + entry);
        }
        right.swap(step, row);
        for entry in 0..size {
            matrix.swap(entry * size + step, entry * size + column);
        }
        columns.swap(step, column);
        let pivot = matrix[step * size + step];
        largest = largest.max(pivot.abs());
        if pivot.abs() <= MIN_PIVOT_FRACTION * largest {
            return None;
        }
        for below in step + 1..size {
            let factor = matrix[below * size + step] / pivot;
            if factor == 0.0 {
                continue;
            }
            for entry in step..size {
                matrix[below * size + entry] -= factor * matrix[step * size + entry];
            }
            right[below] -= factor * right[step];
        }
    }
    for step in (0..size).rev() {
        let known = (step + 1..size).map(|entry| matrix[step * size + entry] * right[entry]);
        right[step] = (right[step] - known.sum::<f64>()) / matrix[step * size + step];
    }
    let mut solved = vec![0.0; size];
    for (index, value) in columns.iter().zip(right) {
        solved[*index] = value;
    }
    Some(solved)
}
