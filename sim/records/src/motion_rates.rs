//! The rates of a motion that records give.

use eomgen_sim::cubic_spline::CubicSpline;

/// A coordinate's samples with their rates and second rates, on the cubic spline through those that are
/// known; none if nothing is.
pub(crate) fn with_rates(times: &[f64], column: &[f64]) -> Option<[Vec<f64>; 3]> {
    let samples = times.iter().zip(column);
    let known = samples.filter(|(_, value)| value.is_finite());
    let (at, values) = known.map(|(t, value)| (*t, *value)).unzip();
    let spline = CubicSpline::through(at, values)?;
    let mut found = [const { Vec::new() }; 3];
    for t in times {
        for (column, value) in found.iter_mut().zip(spline.at(*t)) {
            column.push(value);
        }
    }
    Some(found)
}
