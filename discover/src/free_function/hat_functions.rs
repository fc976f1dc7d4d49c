//! Hat functions of one variable with a penalty on their second differences (P-splines: Eilers and
//! Marx, Statistical Science 11, 1996).

use nalgebra::DMatrix;

use crate::thresholds;

/// Hat functions on ascending knots, constant beyond both ends.
#[derive(Clone, Debug)]
pub(super) struct HatFunctions {
    pub knots: Vec<f64>,
}

impl HatFunctions {
    /// Distributes the knots over the range of the values. If `bends_at_zero` and the range
    /// contains 0, knots are denser around 0. `None` if all values are equal.
    pub fn over_values(values: &mut [f64], bends_at_zero: bool) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |part: f64| values[(part * last as f64).round() as usize];
        let (low, high) = (at(thresholds::CURVE_TAIL), at(1.0 - thresholds::CURVE_TAIL));
        let width = high - low;
        if width.is_nan() || width <= 0.0 || !width.is_finite() {
            return None;
        }
        let count = thresholds::CURVE_KNOT_COUNT;
        let evenly = |k: usize| low + width * k as f64 / (count - 1) as f64;
        let largest = low.abs().max(high.abs());
        let is_around_zero = bends_at_zero && low < 0.0 && high > 0.0;
        let knot = |k: usize| match is_around_zero {
            // Signed squares of evenly spaced numbers.
            true => {
                let (a, b) = (-(low.abs() / largest).sqrt(), (high.abs() / largest).sqrt());
                let s = a + (b - a) * k as f64 / (count - 1) as f64;
                largest * s * s.abs()
            }
            false => evenly(k),
        };
        Some(Self {
            knots: (0..count).map(knot).collect(),
        })
    }

    /// Writes the weights of the functions at a value.
    pub fn write_weights(&self, value: f64, out: &mut [f64]) {
        out.fill(0.0);
        let next = self.knots.partition_point(|knot| *knot <= value);
        if next == 0 {
            out[0] = 1.0;
        } else if next == self.knots.len() {
            out[next - 1] = 1.0;
        } else {
            let (a, b) = (self.knots[next - 1], self.knots[next]);
            let part = (value - a) / (b - a);
            out[next - 1] = 1.0 - part;
            out[next] = part;
        }
    }

    /// Returns the penalty matrix of the coefficients: squared second differences plus a small
    /// multiple of the identity, which makes the matrix positive definite.
    pub fn penalty(&self) -> DMatrix<f64> {
        let count = self.knots.len();
        let mut differences = DMatrix::zeros(count - 2, count);
        for row in 0..count - 2 {
            differences[(row, row)] = 1.0;
            differences[(row, row + 1)] = -2.0;
            differences[(row, row + 2)] = 1.0;
        }
        differences.transpose() * differences
            + DMatrix::identity(count, count) * thresholds::CURVE_LEVEL_PENALTY
    }
}
