//! Cubic splines through the values of a table, for shapes without formulas.
//!
//! A spline is stored by its values and slopes at the knots. The second derivative is continuous at all inner knots.
//! The third derivative is also continuous at the first and the last inner knot (not-a-knot condition). The slopes
//! then solve a tridiagonal system after one elimination at each end (C. de Boor, "A Practical Guide to Splines",
//! chapter IV). With knot distances h, the values have errors O(h^4) for a smooth function, and the second
//! derivatives O(h^2).

/// Spline on [0, 1].
#[derive(Clone, Debug)]
pub(super) struct Spline {
    knots: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Spline {
    /// Interpolates `values` at `knots`, four or more, increasing from 0 to 1.
    pub(super) fn new(knots: &[f64], values: &[f64]) -> Self {
        Self {
            knots: knots.to_vec(),
            values: values.to_vec(),
            slopes: slopes(knots, values),
        }
    }

    /// Returns a derivative at s. At a knot, the third derivative is taken from the piece that ends there.
    pub(super) fn derivative(&self, derivative: u8, s: f64) -> f64 {
        let last = self.knots.len() - 2;
        let piece = self.knots[1..=last].partition_point(|knot| *knot < s);
        let (left, right) = (self.knots[piece], self.knots[piece + 1]);
        let h = right - left;
        let chord = (self.values[piece + 1] - self.values[piece]) / h;
        let (from, to) = (self.slopes[piece], self.slopes[piece + 1]);
        let quadratic = (3.0 * chord - 2.0 * from - to) / h;
        let cubic = (from + to - 2.0 * chord) / (h * h);
        let d = s - left;
        match derivative {
            0 => self.values[piece] + d * (from + d * (quadratic + d * cubic)),
            1 => from + d * (2.0 * quadratic + 3.0 * d * cubic),
            2 => 2.0 * quadratic + 6.0 * d * cubic,
            3 => 6.0 * cubic,
            _ => 0.0,
        }
    }
}

fn slopes(knots: &[f64], values: &[f64]) -> Vec<f64> {
    let n = knots.len();
    let h: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let chord: Vec<f64> = (0..n - 1)
        .map(|i| (values[i + 1] - values[i]) / h[i])
        .collect();
    // Each row has the lower diagonal, the diagonal, the upper diagonal and the right-hand side.
    let mut rows = vec![[0.0; 4]; n];
    let (a, b) = (h[0], h[1]);
    rows[0] = [
        0.0,
        b,
        a + b,
        ((a + 2.0 * (a + b)) * b * chord[0] + a * a * chord[1]) / (a + b),
    ];
    for i in 1..n - 1 {
        let right = 3.0 * (h[i] * chord[i - 1] + h[i - 1] * chord[i]);
        rows[i] = [h[i], 2.0 * (h[i - 1] + h[i]), h[i - 1], right];
    }
    let (a, b) = (h[n - 2], h[n - 3]);
    rows[n - 1] = [
        a + b,
        b,
        0.0,
        (a * a * chord[n - 3] + (2.0 * (a + b) + a) * b * chord[n - 2]) / (a + b),
    ];
    for i in 1..n {
        let factor = rows[i][0] / rows[i - 1][1];
        rows[i][1] -= factor * rows[i - 1][2];
        rows[i][3] -= factor * rows[i - 1][3];
    }
    let mut slopes = vec![0.0; n];
    for i in (0..n).rev() {
        let beyond = slopes.get(i + 1).copied().unwrap_or(0.0);
        slopes[i] = (rows[i][3] - rows[i][2] * beyond) / rows[i][1];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::Spline;

    #[test]
    fn spline_reproduces_a_cubic() {
        let cubic = |s: f64| {
            [
                1.0 - 2.0 * s + 3.0 * s * s - 4.0 * s * s * s,
                -2.0 + 6.0 * s - 12.0 * s * s,
                6.0 - 24.0 * s,
                -24.0,
            ]
        };
        let knots = [0.0, 0.1, 0.35, 0.4, 0.8, 1.0];
        for count in 4..=6 {
            let scale = knots[count - 1];
            let knots: Vec<f64> = knots[..count].iter().map(|s| s / scale).collect();
            let values: Vec<f64> = knots.iter().map(|s| cubic(*s)[0]).collect();
            let spline = Spline::new(&knots, &values);
            for s in [0.0, 0.05, 0.1, 0.33, 0.7, 0.99, 1.0] {
                for (derivative, right) in (0..).zip(cubic(s)) {
                    let found = spline.derivative(derivative, s);
                    assert!(
                        (found - right).abs() < 1e-11,
                        "{count}, {s}: {found} {right}"
                    );
                }
            }
        }
    }

    // Half the knot distance divides the error of the values by 16 and the error of the second derivatives by 4.
    #[test]
    fn spline_errors_have_orders_four_and_two() {
        let error = |count: usize, derivative: u8| {
            let knots: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
            let values: Vec<f64> = knots.iter().map(|s| (5.0 * s).sin()).collect();
            let spline = Spline::new(&knots, &values);
            let right = |s: f64| match derivative {
                0 => (5.0 * s).sin(),
                _ => -25.0 * (5.0 * s).sin(),
            };
            (0..1000)
                .map(|i| (f64::from(i) + 0.5) / 1000.0)
                .map(|s| (spline.derivative(derivative, s) - right(s)).abs())
                .fold(0.0, f64::max)
        };
        for (derivative, factor) in [(0, 16.0), (2, 4.0)] {
            let ratio = error(40, derivative) / error(80, derivative);
            assert!((ratio / factor - 1.0).abs() < 0.2, "{derivative}: {ratio}");
        }
    }
}
