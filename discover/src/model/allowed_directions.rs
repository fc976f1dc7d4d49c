//! Changes of a state that satisfy the constraints to first order, from the derivative of the
//! projection onto the constraints.
//!
//! The derivative D of a projection at a point on the constraints satisfies D D = D. Its singular
//! values are 0, or at least 1 in any scales of the states; therefore the limit 1/2 gives its rank.

use eomgen_analysis::qr_iteration;
use nalgebra::DMatrix;

use crate::thresholds;

/// Minimum singular value of an allowed direction.
const MIN_SINGULAR_VALUE: f64 = 0.5;

/// Projection of a state onto the constraints; `None` if no near state satisfies them.
pub(crate) type ProjectState<'p> = dyn FnMut(&[f64]) -> Option<Vec<f64>> + 'p;

/// Returns the derivatives of the projection at a state, scaled by the ranges of the states. `None`
/// if the state does not satisfy the constraints.
pub(crate) fn differentiate_projection(
    state: &[f64],
    ranges: &[f64],
    project: &mut ProjectState<'_>,
) -> Option<DMatrix<f64>> {
    let count = state.len();
    let mut derivative = DMatrix::zeros(count, count);
    let mut moved = state.to_vec();
    for column in 0..count {
        let step = thresholds::REFERENCE_QUOTIENT_IN_RANGES;
        let [after, before] = [step, -step].map(|step| {
            moved[column] = state[column] + step * ranges[column];
            project(&moved)
        });
        moved[column] = state[column];
        let (after, before) = (after?, before?);
        for row in 0..count {
            let quotient = (after[row] - before[row]) / (2.0 * step);
            derivative[(row, column)] = quotient / ranges[row];
        }
    }
    Some(derivative)
}

/// Returns a basis of the allowed directions, one per column, SI, from the derivatives of the
/// projection scaled by the ranges of the states. The scaled columns are orthonormal.
pub(crate) fn find_allowed_directions(
    derivative: &DMatrix<f64>,
    ranges: &[f64],
) -> Option<DMatrix<f64>> {
    let factors = qr_iteration::svd(derivative)?;
    let basis = factors.u?;
    let singular = factors.singular_values.iter().enumerate();
    let allowed = singular.filter(|(_, value)| **value > MIN_SINGULAR_VALUE);
    let mut basis = basis.select_columns(&allowed.map(|(index, _)| index).collect::<Vec<usize>>());
    for (mut row, range) in basis.row_iter_mut().zip(ranges) {
        row *= *range;
    }
    Some(basis)
}
