//! Scaling of the state matrix of a linearised machine, which makes results independent of units.
//!
//! States are scaled until rows and columns have entries of similar size (B. N. Parlett, C.
//! Reinsch, Numer. Math. 13 (1969) 293-304). Time is scaled until the largest entry is about 1. All
//! factors are powers of two, so nothing is rounded. Sizes are compared by exponents, so no square
//! overflows.

use nalgebra::{Complex, DMatrix, DVector};

use crate::null_space::RANK_TOLERANCE;

/// Maximum number of sweeps over the states; three or four are usual.
const MAX_SWEEPS: usize = 100;

/// A state matrix in scaled states and scaled time.
#[derive(Clone, Debug)]
pub struct BalancedMatrix {
    /// Scaled matrix T D^-1 A D.
    pub matrix: DMatrix<f64>,
    /// Diagonal of D: unit of each scaled state, relative to the largest.
    pub sizes: DVector<f64>,
    /// Exponent of 2 in T, the unit of scaled time in s.
    time: i32,
}

impl BalancedMatrix {
    /// Balances a square matrix of finite numbers.
    pub fn new(matrix: &DMatrix<f64>) -> Self {
        let exponents = Exponents::new(matrix);
        let sizes = balancing_exponents(&exponents);
        let shift = |row: usize, column: usize| sizes[column] - sizes[row];
        let rows = exponents.rows.iter().enumerate();
        let scaled = rows.flat_map(|(row, entries)| {
            let entries = entries.iter();
            entries.map(move |(column, exponent)| exponent + f64::from(shift(row, *column)))
        });
        let largest = scaled.fold(f64::NEG_INFINITY, f64::max);
        let time = if largest.is_finite() {
            -largest.floor() as i32
        } else {
            0
        };
        let most = sizes.iter().copied().max().unwrap_or(0);
        Self {
            matrix: matrix.map_with_location(|row, column, entry| {
                times_power_of_two(entry, shift(row, column) + time)
            }),
            sizes: DVector::from_iterator(
                sizes.len(),
                sizes
                    .iter()
                    .map(|size| times_power_of_two(1.0, size - most)),
            ),
            time,
        }
    }

    /// Returns the rate, 1/s, up to which an eigenvalue may count as 0. The null space of K then contains
    /// motions with lambda^2 up to [`RANK_TOLERANCE`] times the squared norm.
    pub fn resolution(&self) -> f64 {
        self.per_second(RANK_TOLERANCE.sqrt() * self.matrix.norm())
    }

    /// Converts a rate of scaled time to 1/s.
    fn per_second(&self, rate: f64) -> f64 {
        times_power_of_two(rate, -self.time)
    }

    /// Converts a time in s to scaled time.
    pub fn scaled_time(&self, seconds: f64) -> f64 {
        times_power_of_two(seconds, -self.time)
    }

    /// Converts an eigenvalue of the scaled matrix to 1/s.
    pub fn eigenvalue(&self, scaled: Complex<f64>) -> Complex<f64> {
        Complex::new(self.per_second(scaled.re), self.per_second(scaled.im))
    }
}

/// Binary logarithms of the nonzero entries of a matrix, with their columns or rows.
struct Exponents {
    rows: Vec<Vec<(usize, f64)>>,
    columns: Vec<Vec<(usize, f64)>>,
}

impl Exponents {
    fn new(matrix: &DMatrix<f64>) -> Self {
        let count = matrix.nrows();
        let (mut rows, mut columns) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        for row in 0..count {
            for column in 0..count {
                let entry = matrix[(row, column)].abs();
                if entry > 0.0 {
                    rows[row].push((column, entry.log2()));
                    columns[column].push((row, entry.log2()));
                }
            }
        }
        Self { rows, columns }
    }
}

/// Computes the exponents of 2 in the diagonal of D.
fn balancing_exponents(entries: &Exponents) -> Vec<i32> {
    let count = entries.rows.len();
    let mut sizes = vec![0_i32; count];
    for _ in 0..MAX_SWEEPS {
        let mut is_balanced = true;
        for state in 0..count {
            let size = sizes[state];
            let largest = |entries: &[(usize, f64)], sign: i32| {
                let others = entries.iter().filter(|(other, _)| *other != state);
                let scaled = others
                    .map(|(other, exponent)| exponent + f64::from(sign * (sizes[*other] - size)));
                scaled.fold(f64::NEG_INFINITY, f64::max)
            };
            let row = largest(&entries.rows[state], 1);
            let column = largest(&entries.columns[state], -1);
            let change = ((row - column) / 2.0).round();
            if change.is_finite() && change != 0.0 {
                sizes[state] += change as i32;
                is_balanced = false;
            }
        }
        if is_balanced {
            break;
        }
    }
    sizes
}

/// Multiplies by a power of 2 in two steps, because the power may overflow.
fn times_power_of_two(number: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    number * 2_f64.powi(half) * 2_f64.powi(exponent - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balancing_equalises_entries_of_any_size() {
        for stiffness in [1e-300, 1e-200, 1.0, 1e150, 1e300] {
            let matrix = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -stiffness, 0.0]);
            let balanced = BalancedMatrix::new(&matrix);
            let [up, down] = [balanced.matrix[(0, 1)], -balanced.matrix[(1, 0)]];
            assert!(up / down >= 0.25 && up / down <= 4.0 && up.max(down) >= 1.0);
            let frequency = balanced.per_second((up * down).sqrt());
            assert!(
                (frequency / stiffness.sqrt() - 1.0).abs() < 1e-15,
                "{stiffness:e}"
            );
        }
    }
}
