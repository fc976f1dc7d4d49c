//! Matrix products with cancelled entries set to zero.

use nalgebra::DMatrix;

/// Largest rounding of a product of matrices, in units of the last place of its terms. Each entry of a
/// linearisation has a rounding of a few such units.
const MAX_ROUNDINGS: f64 = 16.0;

/// Multiplies two matrices. Entries whose terms cancel up to rounding are set to 0, so that null spaces can be
/// computed from the product.
pub(crate) fn product_without_rounding(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let terms = a.abs() * b.abs();
    (a * b).zip_map(&terms, |entry, terms| {
        match entry.abs() > MAX_ROUNDINGS * f64::EPSILON * terms {
            true => entry,
            false => 0.0,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancelling_terms_leave_zero_and_small_entries_stay() {
        let a = DMatrix::from_row_slice(2, 2, &[0.1, 0.2, 1e-20, 0.0]);
        let b = DMatrix::from_row_slice(2, 2, &[3.0, 0.1, -1.5 * (1.0 + f64::EPSILON), 0.2]);
        let product = product_without_rounding(&a, &b);
        assert_eq!(product[(0, 0)], 0.0);
        assert!((product[(1, 0)] / 3e-20 - 1.0).abs() < 1e-15);
        assert!((product[(0, 1)] - 0.05).abs() < 1e-17);
    }
}
