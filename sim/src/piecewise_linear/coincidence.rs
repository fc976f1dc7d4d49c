//! Coincident surfaces: their functions are proportional, and both reach their thresholds at the same time. The
//! order in which the crossings are found must not affect the result.

use super::event_function::Linear;
use super::outline::Outline;

/// Largest relative residual of proportional functions.
const ROUNDING: f64 = 1e-11;

/// Surface that a motion crosses.
pub(super) struct Crossing {
    pub family: usize,
    /// Function of the family in the regime before the crossing, without its constant.
    pub function: Linear,
    /// Threshold that the function has reached.
    pub threshold: f64,
    /// Index of the outline of the regime before the crossing.
    pub outline: usize,
}

/// Returns the rank of the threshold that a family's function has at the crossing of another surface, and the
/// factor between both functions; `None` if it is not on a threshold there.
pub(super) fn find_coincident_rank(
    outline: &Outline,
    family: usize,
    crossing: &Crossing,
) -> Option<(usize, f64)> {
    let factor = factor(&outline.functions[family], &crossing.function)?;
    let reached = factor * crossing.threshold;
    let near = |threshold: &f64| (threshold - reached).abs() <= ROUNDING * threshold.abs();
    let rank = outline.thresholds[family].iter().position(near)?;
    Some((rank, factor))
}

/// Returns c of f = c g; `None` if the functions are not proportional or c is 0.
pub(super) fn factor(f: &Linear, g: &Linear) -> Option<f64> {
    let (mut product, mut square, mut largest) = (0.0, 0.0, 0.0_f64);
    for (a, b) in f.coefficients().zip(g.coefficients()) {
        product += a * b;
        square += b * b;
        largest = largest.max(a.abs());
    }
    let factor = product / square;
    let mut rests = f.coefficients().zip(g.coefficients());
    let proportional = rests.all(|(a, b)| (a - factor * b).abs() <= ROUNDING * largest);
    (factor != 0.0 && factor.is_finite() && proportional).then_some(factor)
}
