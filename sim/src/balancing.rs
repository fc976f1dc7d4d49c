//! Balancing of rate matrices by powers of two: states with different units give entries of very different
//! magnitude.

use nalgebra::DMatrix;
use nalgebra::linalg::balancing::balance_parlett_reinsch;

/// Largest entry of a matrix that can be balanced, 1/s. Squares of larger entries would overflow, and the
/// balancing would not terminate.
pub(crate) const MAX_ENTRY_PER_S: f64 = 1e150;

/// Entries below this fraction of the largest entry are ignored, so that negligible
/// couplings do not determine the scale of a state.
const NEGLIGIBLE_FRACTION: f64 = 1e-6;

/// Factor by which balancing of all entries must reduce the largest entry, to attribute this entry to the
/// choice of units.
const MIN_UNIT_EFFECT_FACTOR: f64 = 1e3;

/// Returns the diagonal of D, powers of two, for which the entries of D^-1 A D have similar size.
/// `guess` is the initial diagonal. The entries of A must be below [`MAX_ENTRY_PER_S`].
pub(crate) fn balance(matrix: &DMatrix<f64>, guess: Vec<f64>) -> Vec<f64> {
    let all = balance_above(matrix, guess.clone(), 0.0);
    // The first pass can make other entries large, so a second one follows.
    let twice = |scale| {
        let once = balance_above(matrix, scale, NEGLIGIBLE_FRACTION);
        balance_above(matrix, once, NEGLIGIBLE_FRACTION)
    };
    let large = twice(guess);
    if MIN_UNIT_EFFECT_FACTOR * scale_matrix(matrix, &all).amax()
        < scale_matrix(matrix, &large).amax()
    {
        return twice(all);
    }
    large
}

/// Returns D^-1 A D.
pub(crate) fn scale_matrix(matrix: &DMatrix<f64>, scale: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        matrix[(i, j)] * scale[j] / scale[i]
    })
}

/// Balances the entries that are at least the fraction `part` of the largest entry.
fn balance_above(matrix: &DMatrix<f64>, mut scale: Vec<f64>, part: f64) -> Vec<f64> {
    let scaled = scale_matrix(matrix, &scale);
    let least = part * scaled.amax();
    let mut kept = scaled.map(|entry| if entry.abs() < least { 0.0 } else { entry });
    let found = balance_parlett_reinsch(&mut kept);
    let factors = scale.iter_mut().zip(found.iter());
    factors.for_each(|(slot, factor)| *slot *= factor);
    scale
}

#[cfg(test)]
mod tests {
    use super::{balance, scale_matrix};
    use nalgebra::DMatrix;

    #[test]
    fn balance_does_not_depend_on_unit_of_pressure() {
        // Position, speed and pressure of a cylinder with the natural frequency 231 rad/s.
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
            let largest = scale_matrix(&matrix, &balance(&matrix, vec![1.0; 3])).amax();
            assert!(largest < 1e3, "{unit:e}: {largest:e}");
        }
    }
}
