//! Linear complementarity problems: impulses or forces that prevent penetration and do not pull.
//! The Delassus matrix is symmetric and positive semidefinite.

use eomgen_codegen::independence::vectors::{dot, find_max_magnitude};

/// A pivot below this fraction of its diagonal entry is rounding: its row depends on earlier rows.
pub(super) const MIN_INDEPENDENT_PIVOT: f64 = 1e-10;

/// Numbers below this fraction of the largest entry of the right-hand side count as zero.
const ZERO_FRACTION: f64 = 1e-12;

/// Solves x >= 0, W x + c >= 0, x (W x + c) = 0 by the active-set method of Lawson and Hanson
/// (*Solving Least Squares Problems*, chapter 23). W is given by rows.
pub(crate) fn solve_complementarity(w: &[Vec<f64>], c: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; c.len()];
    let mut pushing: Vec<usize> = Vec::new();
    let zero = ZERO_FRACTION * find_max_magnitude(c);
    let mut follows = vec![false; c.len()];
    // Each iteration lowers a convex function of x, so the loop ends; the limit guards against rounding.
    for _ in 0..10 * (c.len() + 1) {
        let rest = |row: usize| dot(&w[row], &x) + c[row];
        let outside = (0..c.len()).filter(|row| !pushing.contains(row) && !follows[*row]);
        let worst = outside.min_by(|a, b| rest(*a).total_cmp(&rest(*b)));
        let Some(next) = worst.filter(|row| rest(*row) < -zero) else {
            break;
        };
        pushing.push(next);
        loop {
            let wanted = solve_rows(w, c, &pushing);
            let place = pushing.iter().position(|row| *row == next);
            if place.is_some_and(|place| wanted[place] <= 0.0) {
                // The forces of the contacts that push already hold this one.
                follows[next] = true;
                pushing.retain(|row| *row != next);
                break;
            }
            let stops = pushing.iter().zip(&wanted).filter(|(_, to)| **to <= 0.0);
            let part = stops.map(|(row, to)| x[*row] / (x[*row] - to));
            let part = part.fold(1.0, f64::min);
            for (row, to) in pushing.iter().zip(&wanted) {
                x[*row] += part * (to - x[*row]);
            }
            if wanted.iter().all(|to| *to > 0.0) {
                break;
            }
            pushing.retain(|row| x[*row] > 0.0 || *row == next);
            for (row, entry) in x.iter_mut().enumerate() {
                if !pushing.contains(&row) {
                    *entry = 0.0;
                }
            }
        }
    }
    x
}

/// Solves W x = -c for the given rows; x is 0 for dependent rows.
pub(crate) fn solve_rows(w: &[Vec<f64>], c: &[f64], rows: &[usize]) -> Vec<f64> {
    let size = rows.len();
    let mut lower = vec![0.0; size * size];
    let mut y = vec![0.0; size];
    // Cholesky factorisation L L^T = W; dependent rows are left out.
    for row in 0..size {
        let mut sum = -c[rows[row]];
        for column in 0..=row {
            let products = (0..column).map(|k| lower[row * size + k] * lower[column * size + k]);
            let rest = w[rows[row]][rows[column]] - products.sum::<f64>();
            let pivot = lower[column * size + column];
            lower[row * size + column] = if column < row {
                if pivot == 0.0 { 0.0 } else { rest / pivot }
            } else if rest > MIN_INDEPENDENT_PIVOT * w[rows[row]][rows[row]] {
                rest.sqrt()
            } else {
                0.0
            };
            if column < row {
                sum -= lower[row * size + column] * y[column];
            }
        }
        let pivot = lower[row * size + row];
        y[row] = if pivot == 0.0 { 0.0 } else { sum / pivot };
    }
    for row in (0..size).rev() {
        let later = (row + 1..size).map(|k| lower[k * size + row] * y[k]);
        let rest = y[row] - later.sum::<f64>();
        let pivot = lower[row * size + row];
        y[row] = if pivot == 0.0 { 0.0 } else { rest / pivot };
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns B B^T for a random matrix B with `columns` columns, and a right-hand side.
    fn problem(seed: u64, size: usize, columns: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut number = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        };
        let b: Vec<Vec<f64>> = (0..size)
            .map(|_| (0..columns).map(|_| number()).collect())
            .collect();
        let w = b
            .iter()
            .map(|row| b.iter().map(|other| dot(row, other)).collect());
        // The right-hand side is in the range of B, as the rates of distances are.
        let motion: Vec<f64> = (0..columns).map(|_| number()).collect();
        (w.collect(), b.iter().map(|row| dot(row, &motion)).collect())
    }

    #[test]
    fn random_problems_satisfy_complementarity() {
        for seed in 1..2000 {
            let size = 1 + (seed % 7) as usize;
            let (w, c) = problem(seed, size, 1 + (seed / 7 % 6) as usize);
            let x = solve_complementarity(&w, &c);
            for row in 0..size {
                let rest = dot(&w[row], &x) + c[row];
                assert!(x[row] >= 0.0, "{seed}: {x:?}");
                assert!(rest > -1e-7, "{seed}: {rest}");
                assert!((x[row] * rest).abs() < 1e-6, "{seed}: {} {rest}", x[row]);
            }
        }
    }

    #[test]
    fn duplicate_walls_share_one_force() {
        let w = vec![vec![2.0, 2.0], vec![2.0, 2.0]];
        let x = solve_complementarity(&w, &[-1.0, -1.0]);
        assert!((x[0] + x[1] - 0.5).abs() < 1e-15, "{x:?}");
        assert_eq!(solve_complementarity(&w, &[1.0, 0.0]), [0.0, 0.0]);
        assert_eq!(solve_complementarity(&[], &[]), [0.0; 0]);
    }
}
