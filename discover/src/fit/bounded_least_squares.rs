//! Bounded linear least squares by a dense, deterministic active-set method.

use crate::interval::Interval;
use eomgen_analysis::qr_iteration;
use nalgebra::{DMatrix, DVector};

/// Maximum number of changes of the active set. Each change decreases the sum of squares, so the
/// maximum is reached only because of rounding.
const MAX_ACTIVE_SET_CHANGES: usize = 200;

/// Ratio to the largest slope below which a slope counts as 0.
const FLAT_SLOPE_RATIO: f64 = 1e-10;

/// Returns the x that minimises |A x - b| within `bounds`. The bounds must contain 0. Components
/// without influence remain 0.
pub fn solve_least_squares(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    bounds: &[Interval],
) -> DVector<f64> {
    let columns = a.ncols();
    let mut x = DVector::zeros(columns);
    let scale: Vec<f64> = a
        .column_iter()
        .map(|c| c.norm().max(f64::MIN_POSITIVE))
        .collect();
    let mut free = vec![true; columns];
    for (column, interval) in bounds.iter().enumerate() {
        free[column] = interval.low < interval.high;
    }
    for _ in 0..MAX_ACTIVE_SET_CHANGES {
        let target = solve_free(a, b, &x, &free, &scale);
        // Fraction of the step within the bounds.
        let mut reach = 1.0;
        let mut stop = None;
        for column in (0..columns).filter(|column| free[*column]) {
            let move_by = target[column] - x[column];
            let Interval { low, high } = bounds[column];
            let limit = if move_by > 0.0 { high } else { low };
            if move_by != 0.0 && (limit - x[column]) / move_by < reach {
                reach = ((limit - x[column]) / move_by).max(0.0);
                stop = Some((column, limit));
            }
        }
        for column in (0..columns).filter(|column| free[*column]) {
            x[column] += reach * (target[column] - x[column]);
        }
        if let Some((column, limit)) = stop {
            x[column] = limit;
            free[column] = false;
            continue;
        }
        let slope = a.transpose() * (b - a * &x);
        let largest = (0..columns)
            .map(|p| (slope[p] / scale[p]).abs())
            .fold(0.0, f64::max);
        let wants_in = |column: &usize| {
            let Interval { low, high } = bounds[*column];
            let along = slope[*column] / scale[*column];
            !free[*column]
                && low < high
                && along.abs() > FLAT_SLOPE_RATIO * b.norm().max(largest)
                && ((x[*column] <= low && along > 0.0) || (x[*column] >= high && along < 0.0))
        };
        let steepest = (0..columns).filter(wants_in).max_by(|p, q| {
            (slope[*p] / scale[*p])
                .abs()
                .total_cmp(&(slope[*q] / scale[*q]).abs())
        });
        match steepest {
            Some(column) => free[column] = true,
            None => break,
        }
    }
    x
}

/// Returns the solution for the free unknowns; the others are fixed.
fn solve_free(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    x: &DVector<f64>,
    free: &[bool],
    scale: &[f64],
) -> DVector<f64> {
    let in_use: Vec<usize> = (0..free.len()).filter(|column| free[*column]).collect();
    let mut target = x.clone();
    if in_use.is_empty() {
        return target;
    }
    let held = b
        - (0..free.len())
            .filter(|p| !free[*p])
            .fold(DVector::zeros(b.len()), |sum: DVector<f64>, p| {
                sum + a.column(p) * x[p]
            });
    let matrix = DMatrix::from_fn(a.nrows(), in_use.len(), |r, c| {
        a[(r, in_use[c])] / scale[in_use[c]]
    });
    // If the simulation diverged, no step is possible.
    if !held.iter().all(|value| value.is_finite()) {
        return target;
    }
    let solution = qr_iteration::svd(&matrix).and_then(|svd| svd.solve(&held, 1e-12).ok());
    if let Some(solution) = solution {
        for (value, column) in solution.iter().zip(&in_use) {
            target[*column] = value / scale[*column];
        }
    }
    target
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{Interval, solve_least_squares};

    #[test]
    fn solution_without_bounds_is_least_squares() {
        let a = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0]);
        let b = DVector::from_vec(vec![1.0, 3.0, 5.0]);
        let x = solve_least_squares(
            &a,
            &b,
            &[Interval::new(-9.0, 9.0), Interval::new(-9.0, 9.0)],
        );
        assert!((x - DVector::from_vec(vec![1.0, 2.0])).norm() < 1e-12);
    }

    #[test]
    fn non_finite_entries_give_zero() {
        let a = DMatrix::from_row_slice(2, 2, &[1.0, f64::NAN, 0.0, 1.0]);
        let b = DVector::from_vec(vec![1.0, f64::INFINITY]);
        let x = solve_least_squares(
            &a,
            &b,
            &[Interval::new(-9.0, 9.0), Interval::new(-9.0, 9.0)],
        );
        assert_eq!(x, DVector::zeros(2));
    }

    #[test]
    fn active_bound_changes_other_unknown() {
        // Problem: minimise (x + y - 1)^2 + (x - y - 3)^2. The free minimum is (2, -1); with y >= 0
        // it is (2, 0).
        let a = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, -1.0]);
        let b = DVector::from_vec(vec![1.0, 3.0]);
        let x = solve_least_squares(&a, &b, &[Interval::new(-9.0, 9.0), Interval::new(0.0, 9.0)]);
        assert!((x - DVector::from_vec(vec![2.0, 0.0])).norm() < 1e-12);
    }

    #[test]
    fn bound_reached_in_a_step_is_released() {
        // The steepest descent from 0 first meets x <= 0.5; the minimum is at (-1, 2).
        let a = DMatrix::from_row_slice(2, 2, &[3.0, 1.0, 0.0, 1.0]);
        let b = DVector::from_vec(vec![-1.0, 2.0]);
        let x = solve_least_squares(&a, &b, &[Interval::new(-5.0, 0.5), Interval::new(0.0, 5.0)]);
        assert!((x - DVector::from_vec(vec![-1.0, 2.0])).norm() < 1e-12);
    }
}
