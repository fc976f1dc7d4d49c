//! Small displacements of states in directions whose entries have no simple ratio.

use std::f64::consts::SQRT_2;

/// Displacement of the coordinates to each side, relative to their natural scales. It exceeds the error of an
/// equilibrium.
pub(crate) const DISPLACEMENT: f64 = 1e-5;

/// Returns a weight between -1.5 and -0.5 for an index; the ratios of weights are not simple.
pub(crate) fn generic_weight(index: usize) -> f64 {
    (SQRT_2 * (index + 1) as f64).fract() - 1.5
}
