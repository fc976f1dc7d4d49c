//! Coincident surfaces: their functions are proportional, and both are on their thresholds at once.
//! The order in which they are found to be crossed must not affect the result.

use super::event_function::Linear;
use super::outline::Outline;

/// Largest residual of proportional functions, relative.
const ROUNDING: f64 = 1e-11;

/// A surface that is crossed.
pub(super) struct Crossing {
    pub family: usize,
    /// The family's function in the regime before, without a constant.
    pub function: Linear,
    /// Threshold that the function equals.
    pub threshold: f64,
    /// The outline of the regime before.
    pub outline: usize,
}

/// The threshold that a family's function is on where another surface is crossed, and the factor
/// between both functions.
pub(super) fn coincident_rank(
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

/// c where f = c g, if there is one and it is not 0.
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
