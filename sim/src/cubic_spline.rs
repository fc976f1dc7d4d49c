//! Cubic splines with continuous first and second derivatives.
//!
//! The third derivative is continuous at the second and the last but one sample ("not-a-knot"; de Boor, *A
//! Practical Guide to Splines*, chapter IV), so a cubic is reproduced up to its ends. Before the first sample
//! the spline has the value of this sample, after the last sample the value of the last.

use eomgen_codegen::program::evaluator::Enclosure;
use eomgen_model_spec::interval::Interval;

/// Cubic spline through samples.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicSpline {
    times: Vec<f64>,
    values: Vec<f64>,
    curvatures: Vec<f64>,
}

impl CubicSpline {
    /// Fits a spline through values at ascending times, s. Returns `None` without samples, or if
    /// the times do not ascend or a number is not finite.
    pub fn fit(times: Vec<f64>, values: Vec<f64>) -> Option<Self> {
        let ascending = times.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = times.iter().chain(&values).all(|number| number.is_finite());
        if times.is_empty() || times.len() != values.len() || !ascending || !finite {
            return None;
        }
        let curvatures = fit_curvatures(&times, &values);
        curvatures.iter().all(|m| m.is_finite()).then_some(Self {
            times,
            values,
            curvatures,
        })
    }

    /// Returns the value and its first and second derivative at a time, s.
    pub fn evaluate(&self, t: f64) -> [f64; 3] {
        let [value, rate, second, _] = self.evaluate_piece(t, t);
        [value, rate, second]
    }

    /// Returns the value and its first three derivatives at a time, on the cubic that belongs to the time
    /// `piece`, both in s.
    pub fn evaluate_piece(&self, t: f64, piece: f64) -> [f64; 4] {
        let last = self.times.len() - 1;
        if piece < self.times[0] {
            return [self.values[0], 0.0, 0.0, 0.0];
        }
        if piece > self.times[last] || last == 0 {
            return [self.values[last], 0.0, 0.0, 0.0];
        }
        let after = self.times.partition_point(|time| *time <= piece);
        let after = after.clamp(1, last);
        let (a, b) = (after - 1, after);
        let h = self.times[b] - self.times[a];
        let (left, right) = ((self.times[b] - t) / h, (t - self.times[a]) / h);
        let [m_a, m_b] = [self.curvatures[a], self.curvatures[b]];
        let [y_a, y_b] = [self.values[a], self.values[b]];
        let bend = |s: f64| s * (s * s - 1.0) * h * h / 6.0;
        let slope = |s: f64| (3.0 * s * s - 1.0) * h / 6.0;
        [
            left * y_a + right * y_b + bend(left) * m_a + bend(right) * m_b,
            (y_b - y_a) / h - slope(left) * m_a + slope(right) * m_b,
            left * m_a + right * m_b,
            (m_b - m_a) / h,
        ]
    }
}

impl CubicSpline {
    /// Returns the bounds of the value and its first and second derivative from `begin` to `end`, s.
    pub fn bound(&self, begin: f64, end: f64) -> [Enclosure; 3] {
        let first = self.times.partition_point(|time| *time <= begin);
        let inside = self.times[first..].iter().take_while(|time| **time < end);
        let mut knots = vec![begin];
        knots.extend(inside);
        knots.push(end);
        let pieces = knots
            .windows(2)
            .map(|pair| self.bound_cubic(pair[0], pair[1]));
        pieces
            .reduce(|all, piece| {
                std::array::from_fn(|order| {
                    let (a, b) = (all[order], piece[order]);
                    Enclosure::from_bounds(a.value().hull(b.value()), a.rate().hull(b.rate()))
                })
            })
            .unwrap_or([Enclosure::UNKNOWN; 3])
    }

    /// Returns the bounds of [`CubicSpline::bound`] between two times without a sample between them.
    fn bound_cubic(&self, begin: f64, end: f64) -> [Enclosure; 3] {
        let duration = end - begin;
        // If one end is a sample, the derivatives of the adjacent piece may differ only because of rounding, except at
        // the first and the last sample.
        let middle = self.evaluate(begin + 0.5 * duration);
        let is_outside = end <= self.times[0] || begin >= self.times[self.times.len() - 1];
        if is_outside {
            return middle.map(Enclosure::constant);
        }
        let (a, b) = (self.evaluate(begin), self.evaluate(end));
        let third = (b[2] - a[2]) / duration;
        let curvature = hull([a[2], b[2]]);
        let slope = hull([a[1], a[1] + 0.5 * duration * a[2], b[1]]);
        let control = |(value, slope): (f64, f64)| value + slope * duration / 3.0;
        let (c, d) = (control((a[0], a[1])), control((b[0], -b[1])));
        let value = hull([a[0], c, d, b[0]]);
        [
            Enclosure::from_bounds(value, slope),
            Enclosure::from_bounds(slope, curvature),
            Enclosure::from_bounds(curvature, Interval::from_ends(third, third)),
        ]
    }
}

/// Returns the interval of the control points of a polynomial in Bernstein form.
fn hull<const N: usize>(points: [f64; N]) -> Interval {
    let low = points.into_iter().fold(f64::INFINITY, f64::min);
    let high = points.into_iter().fold(f64::NEG_INFINITY, f64::max);
    Interval::from_ends(low, high)
}

/// Computes the second derivatives at the samples. The spline is a line for two samples, a parabola for three,
/// and a not-a-knot spline for four or more.
fn fit_curvatures(times: &[f64], values: &[f64]) -> Vec<f64> {
    let count = times.len();
    if count < 3 {
        return vec![0.0; count];
    }
    let step: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let slope: Vec<f64> = values
        .windows(2)
        .zip(&step)
        .map(|(pair, h)| (pair[1] - pair[0]) / h)
        .collect();
    let jumps = slope.windows(2).map(|pair| 6.0 * (pair[1] - pair[0]));
    let mut right: Vec<f64> = jumps.collect();
    if count == 3 {
        return vec![right[0] / (3.0 * (step[0] + step[1])); 3];
    }
    // The system is tridiagonal in the inner samples; the outer second derivatives are extrapolated from two
    // neighbours each.
    let inner = count - 2;
    let mut diagonal: Vec<f64> = (0..inner).map(|k| 2.0 * (step[k] + step[k + 1])).collect();
    let mut lower: Vec<f64> = step[..inner].to_vec();
    let mut upper: Vec<f64> = step[1..].to_vec();
    let (first, second) = (step[0], step[1]);
    diagonal[0] += first * (1.0 + first / second);
    upper[0] -= first * first / second;
    let (last, before) = (step[count - 2], step[count - 3]);
    diagonal[inner - 1] += last * (1.0 + last / before);
    lower[inner - 1] -= last * last / before;
    // No pivoting: the matrix is diagonally dominant except in the outer rows, whose pivots remain positive.
    for k in 1..inner {
        let factor = lower[k] / diagonal[k - 1];
        diagonal[k] -= factor * upper[k - 1];
        right[k] -= factor * right[k - 1];
    }
    let mut curvatures = vec![0.0; count];
    for k in (0..inner).rev() {
        let next = if k + 1 < inner {
            upper[k] * curvatures[k + 2]
        } else {
            0.0
        };
        curvatures[k + 1] = (right[k] - next) / diagonal[k];
    }
    curvatures[0] = curvatures[1] + first / second * (curvatures[1] - curvatures[2]);
    curvatures[count - 1] =
        curvatures[count - 2] + last / before * (curvatures[count - 2] - curvatures[count - 3]);
    curvatures
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(times: &[f64], of: impl Fn(f64) -> f64) -> CubicSpline {
        let values = times.iter().map(|t| of(*t)).collect();
        CubicSpline::fit(times.to_vec(), values).expect("a spline")
    }

    #[test]
    fn spline_reproduces_cubic_up_to_its_ends() {
        let times = [0.0, 0.3, 0.5, 1.1, 1.2, 2.0];
        let of = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 0.7 * t * t * t;
        for count in 4..=6 {
            let spline = spline(&times[..count], of);
            for k in 0..=20 {
                let t = times[count - 1] * f64::from(k) / 20.0;
                let right = [of(t), -2.0 + t - 2.1 * t * t, 1.0 - 4.2 * t];
                for (found, right) in spline.evaluate(t).iter().zip(right) {
                    assert!(
                        (found - right).abs() < 1e-12,
                        "{count}, {t}: {found} {right}"
                    );
                }
            }
        }
    }

    #[test]
    fn third_derivative_is_that_of_the_given_piece() {
        let of = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 0.7 * t * t * t;
        let spline = spline(&[0.0, 0.3, 0.5, 1.1], of);
        for piece in [0.1, 0.4, 1.0] {
            let [value, _, _, third] = spline.evaluate_piece(0.3, piece);
            assert!((value - of(0.3)).abs() < 1e-12 && (third + 4.2).abs() < 1e-11);
        }
        assert_eq!(spline.evaluate_piece(0.0, -0.1), [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn spline_of_sine_converges_with_order_four() {
        let error = |count: u32| {
            let times: Vec<f64> = (0..=count)
                .map(|k| 6.0 * f64::from(k) / f64::from(count))
                .collect();
            let spline = spline(&times, f64::sin);
            let off = |t: f64| {
                let [value, rate, second] = spline.evaluate(t);
                [value - t.sin(), rate - t.cos(), second + t.sin()]
            };
            (0..=997)
                .map(|k| off(6.0 * f64::from(k) / 997.0))
                .fold([0.0f64; 3], |most, off| {
                    [0, 1, 2].map(|index| most[index].max(off[index].abs()))
                })
        };
        let (coarse, fine) = (error(40), error(80));
        for (index, order) in [4.0, 3.0, 2.0].into_iter().enumerate() {
            let found = (coarse[index] / fine[index]).log2();
            assert!((found - order).abs() < 0.4, "{index}: {found}");
        }
    }

    #[test]
    fn few_samples_give_polynomials_and_constant_ends() {
        assert_eq!(spline(&[1.0], |_| 3.0).evaluate(5.0), [3.0, 0.0, 0.0]);
        let line = spline(&[1.0, 3.0], |t| 2.0 * t);
        assert_eq!(line.evaluate(2.0), [4.0, 2.0, 0.0]);
        assert_eq!(
            (line.evaluate(0.0), line.evaluate(4.0)),
            ([2.0, 0.0, 0.0], [6.0, 0.0, 0.0])
        );
        let parabola = spline(&[0.0, 1.0, 3.0], |t| t * t);
        assert!(
            (parabola.evaluate(2.0)[0] - 4.0).abs() < 1e-14
                && (parabola.evaluate(2.0)[2] - 2.0).abs() < 1e-14
        );
        assert_eq!(CubicSpline::fit(vec![], vec![]), None);
        assert_eq!(CubicSpline::fit(vec![0.0, 0.0], vec![1.0, 2.0]), None);
        assert_eq!(CubicSpline::fit(vec![0.0, 1.0], vec![1.0, f64::NAN]), None);
    }
}
