//! Small displacements of states in a direction without a simple ratio of its parts.

use std::f64::consts::SQRT_2;

/// Displacement of the coordinates to each side, relative to their natural scales. An equilibrium
/// is known to a smaller error.
pub(crate) const DISPLACEMENT: f64 = 1e-5;

/// Returns a weight of -1.5 to -0.5 for an index; weights have no simple ratio.
pub(crate) fn generic_weight(index: usize) -> f64 {
    (SQRT_2 * (index + 1) as f64).fract() - 1.5
}
