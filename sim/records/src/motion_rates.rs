//! Position, rate and second derivative of a given motion, from its positions or its speeds.

use std::ops::Range;

use eomgen_model_spec::unit::Unit;
use eomgen_sim::cubic_spline::CubicSpline;

use crate::description::columns::Column;

pub(crate) struct GivenColumn<'d> {
    pub name: &'d str,
    pub column: &'d Column,
    pub unit: Unit,
    pub kind: GivenKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum GivenKind {
    Position,
    /// Speed, with the position at the first sample in SI.
    Speed {
        initial: f64,
    },
}

/// Returns samples, rates and second derivatives from one cubic spline for each of the `parts` between gaps; NaN in the
/// gaps.
/// `None` without known samples.
pub(crate) fn differentiate_position(
    times: &[f64],
    column: &[f64],
    parts: &[Range<usize>],
) -> Option<[Vec<f64>; 3]> {
    let mut found: [Vec<f64>; 3] = std::array::from_fn(|_| vec![f64::NAN; times.len()]);
    for part in parts {
        let samples = times[part.clone()].iter().zip(&column[part.clone()]);
        let known = samples.filter(|(_, value)| value.is_finite());
        let (at, values) = known.map(|(t, value)| (*t, *value)).unzip();
        let spline = CubicSpline::fit(at, values)?;
        for sample in part.clone() {
            for (column, value) in found.iter_mut().zip(spline.evaluate(times[sample])) {
                column[sample] = value;
            }
        }
    }
    (!parts.is_empty()).then_some(found)
}

/// Returns positions, rates and second derivatives from samples of the speed; `None` without a known sample. The speed
/// is the cubic spline through the known samples of `part`, and constant before them. Its integral from `initial` at
/// the first sample is the position. The derivative of the speed is the second derivative of the position.
pub(crate) fn integrate_speed(
    times: &[f64],
    speeds: &[f64],
    part: Range<usize>,
    initial: f64,
) -> Option<[Vec<f64>; 3]> {
    let [rates, second, bends] =
        differentiate_position(times, speeds, std::slice::from_ref(&part))?;
    let first = part.start;
    let mut position = initial + rates[first] * (times[first] - times[0]);
    let mut positions = vec![f64::NAN; times.len()];
    positions[first] = position;
    for k in part.skip(1) {
        let h = times[k] - times[k - 1];
        // Exact integral of the cubic polynomial.
        position +=
            0.5 * h * (rates[k - 1] + rates[k]) - h.powi(3) / 24.0 * (bends[k - 1] + bends[k]);
        positions[k] = position;
    }
    Some([positions, rates, second])
}

#[cfg(test)]
mod tests {
    use super::integrate_speed;

    #[test]
    fn motion_from_speed_is_consistent() {
        let times: Vec<f64> = (0..=300).map(|k| 0.01 * f64::from(k)).collect();
        let speed = |t: f64| 2.0 + 3.0 * (4.0 * t).cos();
        let mut speeds: Vec<f64> = times.iter().map(|t| speed(*t)).collect();
        speeds[150] = f64::NAN;
        let [positions, rates, second] =
            integrate_speed(&times, &speeds, 0..times.len(), 0.5).expect("a motion");
        for (k, t) in times.iter().enumerate() {
            let wanted = [
                0.5 + 2.0 * t + 0.75 * (4.0 * t).sin(),
                speed(*t),
                -12.0 * (4.0 * t).sin(),
            ];
            let found = [positions[k], rates[k], second[k]];
            for ((found, wanted), within) in found.iter().zip(wanted).zip([1e-7, 1e-5, 2e-2]) {
                assert!((found - wanted).abs() < within, "{t}: {found} {wanted}");
            }
        }
    }
}
