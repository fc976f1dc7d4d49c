//! Powers of two that bring the rows and columns of a matrix of rates to like size: states have
//! different units, and the numbers of a matrix depend on them.

use nalgebra::DMatrix;
use nalgebra::linalg::balancing::balance_parlett_reinsch;

/// Squares of larger entries overflow, and balancing never ends, 1/s.
pub(crate) const LARGEST: f64 = 1e150;

/// Entries below this part of the largest one do not take part in the balance: what matters
/// that little must not decide on the scale of a state.
const NEGLIGIBLE: f64 = 1e-6;

/// The largest entry is due to units if a balance of all entries makes it smaller by this factor.
const BY_UNITS: f64 = 1e3;

/// Diagonal of D, powers of two, for which the entries of D^-1 A D have like size. `guess`: a first
/// guess of it. The entries of A are smaller than [`LARGEST`].
pub(crate) fn balance(matrix: &DMatrix<f64>, guess: Vec<f64>) -> Vec<f64> {
    let all = balance_above(matrix, guess.clone(), 0.0);
    // The second time around the large entries are balanced among themselves.
    let twice = |scale| {
        let once = balance_above(matrix, scale, NEGLIGIBLE);
        balance_above(matrix, once, NEGLIGIBLE)
    };
    let large = twice(guess);
    if BY_UNITS * scaled(matrix, &all).amax() < scaled(matrix, &large).amax() {
        return twice(all);
    }
    large
}

/// D^-1 A D.
pub(crate) fn scaled(matrix: &DMatrix<f64>, scale: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        matrix[(i, j)] * scale[j] / scale[i]
    })
}

/// A balance of the entries that are not below a part of the largest one.
fn balance_above(matrix: &DMatrix<f64>, mut scale: Vec<f64>, part: f64) -> Vec<f64> {
    let scaled = scaled(matrix, &scale);
    let least = part * scaled.amax();
    let mut kept = scaled.map(|entry| if entry.abs() < least { 0.0 } else { entry });
    let found = balance_parlett_reinsch(&mut kept);
    let factors = scale.iter_mut().zip(found.iter());
    factors.for_each(|(slot, factor)| *slot *= factor);
    scale
}

#[cfg(test)]
mod tests {
    use super::{balance, scaled};
    use nalgebra::DMatrix;

    #[test]
    fn a_pressure_in_pascals_is_balanced_like_one_in_megapascals() {
        // Position, speed and pressure of a cylinder, whose natural frequency is 231 rad/s.
        let rates = |unit: f64| {
            let entries = [
                [0.0, 1.0, 0.0],
                [-300.0, -8.0, 8e-4 / 60.0 * unit],
                [0.0, -4e9 / unit, -2.5],
            ];
            DMatrix::from_fn(3, 3, |row, column| entries[row][column])
        };
        for unit in [1e-6, 1.0, 1e3, 1e6, 1e9] {
            let matrix = rates(unit);
            let largest = scaled(&matrix, &balance(&matrix, vec![1.0; 3])).amax();
            assert!(largest < 1e3, "{unit:e}: {largest:e}");
        }
    }
}
