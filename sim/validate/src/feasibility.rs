//! Feasibility of linear inequalities and the nearest feasible point, by nonnegative least squares
//! (Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23).

use nalgebra::{DMatrix, DVector};

/// Residual of the least squares problem below which inequalities are infeasible, for rows of length 1.
const MAX_INFEASIBLE_RESIDUAL: f64 = 1e-12;
/// Maximum number of corrections per unknown.
const MAX_CORRECTIONS_PER_UNKNOWN: usize = 10;
/// Number of scaling rounds. Each round halves the remaining differences of the logarithms of the entries.
const SCALING_ROUNDS: usize = 20;
const SVD_ITERATIONS: usize = 10_000;

/// Returns true if no point z has a positive product with every row. By Gordan's theorem, this is true if a combination
/// of rows with nonnegative weights, not all 0, is 0. Rows of zeros are ignored.
pub(crate) fn cone_is_empty(rows: &[Vec<f64>]) -> bool {
    let rows: Vec<DVector<f64>> = equilibrate_rows(rows)
        .into_iter()
        .filter_map(|row| {
            let row = DVector::from_vec(row);
            let length = row.norm();
            (length > 0.0 && length.is_finite()).then(|| row / length)
        })
        .collect();
    let Some(residual) = residual(&rows) else {
        return false;
    };
    residual.norm() <= MAX_INFEASIBLE_RESIDUAL
}

/// Divides rows and columns by the geometric mean of their largest and smallest entries. Otherwise
/// a constant that is much smaller than another one would be treated as rounding error.
fn equilibrate_rows(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut rows = rows.to_vec();
    let columns = rows.first().map_or(0, Vec::len);
    for _ in 0..SCALING_ROUNDS {
        for column in 0..columns {
            let size = geometric_mean_of_extremes(rows.iter().map(|row| row[column]));
            rows.iter_mut().for_each(|row| row[column] /= size);
        }
        for row in &mut rows {
            let size = geometric_mean_of_extremes(row.iter().copied());
            row.iter_mut().for_each(|entry| *entry /= size);
        }
    }
    rows
}

fn geometric_mean_of_extremes(entries: impl Iterator<Item = f64>) -> f64 {
    let sizes = entries
        .map(f64::abs)
        .filter(|size| *size > 0.0 && size.is_finite());
    let (least, most) = sizes.fold((f64::INFINITY, 0.0_f64), |(least, most), size| {
        (least.min(size), most.max(size))
    });
    if most > 0.0 {
        least.sqrt() * most.sqrt()
    } else {
        1.0
    }
}

/// Returns the shortest x with `row * x >= bound` for every row and bound; `None` if infeasible.
pub(crate) fn nearest_point(rows: &[(Vec<f64>, f64)]) -> Option<Vec<f64>> {
    let mut columns = Vec::new();
    for (row, bound) in rows {
        let mut column = row.clone();
        column.push(*bound);
        let column = DVector::from_vec(column);
        let length = column.norm();
        if !length.is_finite() {
            return None;
        }
        if length > 0.0 {
            columns.push(column / length);
        }
    }
    let size = rows.first()?.0.len();
    let mut target = DVector::zeros(size + 1);
    target[size] = 1.0;
    let residual = if columns.is_empty() {
        -target
    } else {
        let matrix = DMatrix::from_columns(&columns);
        &matrix * nonnegative_least_squares(&matrix, &target) - target
    };
    let last = residual[size];
    if residual.norm() <= MAX_INFEASIBLE_RESIDUAL {
        return None;
    }
    Some(
        residual
            .iter()
            .take(size)
            .map(|entry| -entry / last)
            .collect(),
    )
}

/// Returns the residual of the nonnegative combination of rows that is nearest to (0, 1). Each row is extended by one
/// entry.
fn residual(rows: &[DVector<f64>]) -> Option<DVector<f64>> {
    let size = rows.first()?.len();
    let columns: Vec<DVector<f64>> = rows.iter().map(|row| row.clone().push(1.0)).collect();
    let matrix = DMatrix::from_columns(&columns);
    let mut target = DVector::zeros(size + 1);
    target[size] = 1.0;
    Some(&matrix * nonnegative_least_squares(&matrix, &target) - target)
}

/// Returns the y >= 0 that minimises |A y - b|.
fn nonnegative_least_squares(matrix: &DMatrix<f64>, target: &DVector<f64>) -> DVector<f64> {
    let count = matrix.ncols();
    let mut solution = DVector::zeros(count);
    let mut active: Vec<usize> = Vec::new();
    for _ in 0..MAX_CORRECTIONS_PER_UNKNOWN * count {
        let gradient = matrix.tr_mul(&(target - matrix * &solution));
        let candidates = (0..count).filter(|place| !active.contains(place));
        let steepest = candidates.max_by(|a, b| gradient[*a].total_cmp(&gradient[*b]));
        let Some(entering) = steepest.filter(|place| gradient[*place] > 1e-14) else {
            break;
        };
        active.push(entering);
        while !active.is_empty() {
            let Some(trial) = least_squares(matrix, target, &active) else {
                active.pop();
                return solution;
            };
            let step = longest_step(&solution, &trial, &active);
            for (place, value) in active.iter().zip(trial.iter()) {
                solution[*place] += step * (value - solution[*place]);
            }
            if step >= 1.0 {
                break;
            }
            let left: Vec<usize> = active
                .iter()
                .zip(trial.iter())
                .filter(|(place, value)| **value > 0.0 || solution[**place] > 1e-15)
                .map(|(place, _)| *place)
                .collect();
            for place in active.iter().filter(|place| !left.contains(place)) {
                solution[*place] = 0.0;
            }
            if left.len() == active.len() {
                return solution;
            }
            active = left;
        }
    }
    solution
}

/// Returns the largest step towards `trial`, at most 1, that keeps all entries nonnegative.
fn longest_step(solution: &DVector<f64>, trial: &DVector<f64>, active: &[usize]) -> f64 {
    let shares = active.iter().zip(trial.iter()).map(|(place, value)| {
        if *value > 0.0 {
            1.0
        } else {
            solution[*place] / (solution[*place] - value)
        }
    });
    shares.fold(1.0, f64::min)
}

fn least_squares(
    matrix: &DMatrix<f64>,
    target: &DVector<f64>,
    active: &[usize],
) -> Option<DVector<f64>> {
    let part = matrix.select_columns(active);
    let svd = part.try_svd(true, true, 5.0 * f64::EPSILON, SVD_ITERATIONS)?;
    svd.solve(target, 1e-14).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cone_of_opposite_half_spaces_is_empty() {
        // x > b and -x > b.
        for b in [0.0, 1e-6, 1.0, 1e5] {
            let cone = [vec![1.0, -b], vec![-1.0, -b], vec![0.0, 1.0]];
            assert!(cone_is_empty(&cone), "{b}");
        }
        // x > b and -x > -2 b.
        for b in [1e-6, 1.0, 1e5] {
            assert!(!cone_is_empty(&[
                vec![1.0, -b],
                vec![-1.0, 2.0 * b],
                vec![0.0, 1.0]
            ]));
        }
    }

    #[test]
    fn cone_with_small_gap_and_large_constant_is_not_empty() {
        // -0.2 < u < 0.2 and 1e5 < p < 3e12.
        let mut cone = vec![
            vec![1.0, 0.0, 0.2],
            vec![-1.0, 0.0, 0.2],
            vec![0.0, 1.0, -1e5],
            vec![0.0, -1.0, 3e12],
            vec![0.0, 0.0, 1.0],
        ];
        assert!(!cone_is_empty(&cone));
        // u > 0.2 and u < -0.2.
        cone[0][2] = -0.2;
        cone[1][2] = -0.2;
        assert!(cone_is_empty(&cone));
    }

    #[test]
    fn cone_outside_all_triangle_sides_is_empty() {
        let triangle = |sign: f64| {
            vec![
                vec![-sign, 0.0, -1.0],
                vec![0.0, -sign, -1.0],
                vec![sign, sign, -1.0],
                vec![0.0, 0.0, 1.0],
            ]
        };
        assert!(cone_is_empty(&triangle(1.0)));
        let mut open = triangle(1.0);
        open.remove(2);
        assert!(!cone_is_empty(&open));
    }

    #[test]
    fn nearest_point_is_foot_of_normal() {
        let x = nearest_point(&[(vec![3.0, 4.0], 10.0)]).unwrap();
        assert!((x[0] - 1.2).abs() < 1e-12 && (x[1] - 1.6).abs() < 1e-12);
        assert_eq!(nearest_point(&[(vec![1.0], 1.0), (vec![-1.0], 1.0)]), None);
        let inside = nearest_point(&[(vec![1.0], -1.0), (vec![-1.0], -1.0)]).unwrap();
        assert!(inside[0].abs() < 1e-14);
    }
}
