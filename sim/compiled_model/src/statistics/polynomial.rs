//! Polynomials through values at Chebyshev points (L. N. Trefethen, *Approximation Theory and Approximation Practice*).

use std::f64::consts::PI;
use std::sync::LazyLock;

/// Highest degree of a polynomial.
pub(super) const MAX_DEGREE: usize = 16;

/// Degrees of the polynomials of a panel; the points of each degree include those of the lower degrees.
pub(super) const DEGREES: [usize; 3] = [4, 8, MAX_DEGREE];

/// Smallest assumed ratio of two consecutive pairs of coefficients.
const MIN_DECAY: f64 = 0.1;

/// Number of grid points for the maximum, per degree.
const GRID_POINTS_PER_DEGREE: usize = 4;

/// Iterations of the search for the maximum between grid points; each reduces the interval to 0.62 of its length.
const MAX_SEARCH_ITERATIONS: usize = 40;

const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Number of angles in [`COSINES`] per half turn, a multiple of the number of points of every grid.
const ANGLES: usize = MAX_DEGREE * GRID_POINTS_PER_DEGREE;

/// Cosines of the multiples of `PI / ANGLES` over a full turn.
static COSINES: LazyLock<[f64; 2 * ANGLES]> =
    LazyLock::new(|| std::array::from_fn(|place| (PI * place as f64 / ANGLES as f64).cos()));

/// Returns the cosine of `PI * index / count`; `count` divides [`ANGLES`].
fn cosine(index: usize, count: usize) -> f64 {
    COSINES[index * (ANGLES / count) % (2 * ANGLES)]
}

/// Returns the mean of the product of two Chebyshev polynomials.
fn mean_product(i: usize, j: usize) -> f64 {
    if (i + j) % 2 == 1 {
        return 0.0;
    }
    let (sum, difference) = ((i + j) as f64, i as f64 - j as f64);
    0.5 / (1.0 - sum * sum) + 0.5 / (1.0 - difference * difference)
}

/// Returns the Chebyshev point `index` for interpolation with a polynomial of this degree, as a fraction of the panel.
pub(super) fn chebyshev_point(index: usize, degree: usize) -> f64 {
    0.5 * (1.0 - cosine(index, degree))
}

/// Bounds of a polynomial over its panel.
pub(super) struct Bounds {
    pub low: f64,
    pub high: f64,
    /// Position of the largest value on a grid, as a fraction of the panel.
    pub largest_place: f64,
}

/// Polynomial over a panel.
pub(super) struct Polynomial {
    /// Coefficients of the Chebyshev polynomials.
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Interpolates values at the Chebyshev points of degree `values.len() - 1`.
    pub fn through(values: &[f64]) -> Self {
        let degree = values.len() - 1;
        let is_end = |index: usize| index == 0 || index == degree;
        let halved = |index: usize, value: f64| if is_end(index) { 0.5 * value } else { value };
        let coefficient = |order: usize| {
            let terms = values.iter().enumerate().map(|(index, value)| {
                // The interpolation points start at -1.
                halved(index, *value) * cosine(order * (degree - index), degree)
            });
            halved(order, 2.0 / degree as f64 * terms.sum::<f64>())
        };
        Self {
            coefficients: (0..=degree).map(coefficient).collect(),
        }
    }

    /// Returns the coefficients of the Chebyshev polynomials, by increasing degree.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Returns the derivative with respect to the fraction of the panel.
    pub fn derivative(&self, part: f64) -> f64 {
        let x = 2.0 * part - 1.0;
        // Uses that the derivative of T_n is n U_(n-1).
        let (mut before, mut own, mut sum) = (0.0, 1.0, 0.0);
        for (order, coefficient) in self.coefficients.iter().enumerate().skip(1) {
            sum += order as f64 * coefficient * own;
            (before, own) = (own, 2.0 * x * own - before);
        }
        2.0 * sum
    }

    fn degree(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// Returns the value at a fraction of the panel, 0 to 1 (Clenshaw's algorithm).
    pub fn value(&self, part: f64) -> f64 {
        let x = 2.0 * part - 1.0;
        let (mut later, mut last) = (0.0, 0.0);
        for coefficient in self.coefficients[1..].iter().rev() {
            (later, last) = (last, coefficient + 2.0 * x * last - later);
        }
        self.coefficients[0] + x * last - later
    }

    /// Estimates the interpolation error from the decay of the last coefficients.
    pub fn error(&self) -> f64 {
        let (last, before) = (self.terms_before(0), self.terms_before(2));
        if last == 0.0 {
            return 0.0;
        }
        let decay = (last / before).clamp(MIN_DECAY, 1.0);
        last * decay / (1.0 - decay).max(0.5)
    }

    /// Returns the larger magnitude of the last two terms.
    pub fn last_terms(&self) -> f64 {
        self.terms_before(0)
    }

    /// Returns the larger magnitude of the two terms before the last `count` terms.
    fn terms_before(&self, count: usize) -> f64 {
        let earlier = self.coefficients.iter().rev().skip(count);
        earlier
            .take(2)
            .fold(0.0, |most, entry| entry.abs().max(most))
    }

    /// Returns the mean of the square over the panel.
    pub fn mean_square(&self) -> f64 {
        let mut sum = 0.0;
        for (i, a) in self.coefficients.iter().enumerate() {
            for (j, b) in self.coefficients.iter().enumerate().skip(i % 2).step_by(2) {
                sum += a * b * mean_product(i, j);
            }
        }
        sum.max(0.0)
    }

    /// Estimates the error of [`Polynomial::mean_square`] from the interpolation error.
    pub fn mean_square_error(&self, error: f64) -> f64 {
        let degree = self.degree();
        // At the interpolation points, the first omitted terms equal the terms as far below the degree (aliasing).
        let omitted = |by: usize, order: usize| {
            mean_product(order, degree + by) - mean_product(order, degree - by)
        };
        let products = self.coefficients.iter().enumerate().map(|(order, own)| {
            let mean = omitted(1, order).abs().max(omitted(2, order).abs());
            own.abs() * mean
        });
        error * (2.0 * products.sum::<f64>() + error)
    }

    /// Drops the terms above a degree.
    pub fn truncate(&mut self, degree: usize) {
        self.coefficients.truncate(degree + 1);
    }

    /// Returns bounds of the values over the panel.
    pub fn bounds(&self) -> Bounds {
        let points = GRID_POINTS_PER_DEGREE * self.degree();
        let mut greatest = (f64::NEG_INFINITY, 0.0);
        let mut least = f64::INFINITY;
        for index in 0..=points {
            let part = chebyshev_point(index, points);
            let value = self.value(part);
            least = least.min(value);
            if value > greatest.0 {
                greatest = (value, part);
            }
        }
        // The excess over such a grid is bounded (H. Ehlich and K. Zeller, Math. Z. 86, 1964).
        let excess = 1.0 / (0.5 * PI / GRID_POINTS_PER_DEGREE as f64).cos() - 1.0;
        let margin = excess * 0.5 * (greatest.0 - least);
        Bounds {
            low: least - margin,
            high: greatest.0 + margin,
            largest_place: greatest.1,
        }
    }

    /// Returns the position of the maximum next to a grid point.
    pub fn find_maximum_near(&self, part: f64) -> f64 {
        let points = (GRID_POINTS_PER_DEGREE * self.degree()) as f64;
        let angle = (1.0 - 2.0 * part).clamp(-1.0, 1.0).acos();
        let place = |angle: f64| 0.5 * (1.0 - angle.cos());
        let mut low = (angle - PI / points).max(0.0);
        let mut high = (angle + PI / points).min(PI);
        for _ in 0..MAX_SEARCH_ITERATIONS {
            let width = GOLDEN * (high - low);
            let (left, right) = (high - width, low + width);
            match self.value(place(left)) < self.value(place(right)) {
                true => low = left,
                false => high = right,
            }
        }
        place(0.5 * (low + high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interpolate(degree: usize, function: impl Fn(f64) -> f64) -> Polynomial {
        let values: Vec<f64> = (0..=degree)
            .map(|index| function(chebyshev_point(index, degree)))
            .collect();
        Polynomial::through(&values)
    }

    #[test]
    fn polynomial_has_its_values_and_mean_square() {
        let function = |s: f64| 1.0 + s * (2.0 - s * (3.0 - s * s));
        let polynomial = interpolate(8, function);
        for part in [0.0, 0.1, 0.37, 0.5, 0.99, 1.0] {
            assert!((polynomial.value(part) - function(part)).abs() < 1e-14);
        }
        // Expected value: integral of (1 + 2 s - 3 s^2 + s^4)^2.
        let expected = 1.0 + 2.0 - 2.0 / 3.0 - 3.0 + 2.2 + 2.0 / 3.0 - 6.0 / 7.0 + 1.0 / 9.0;
        let found = polynomial.mean_square();
        assert!(
            (found - expected).abs() < 1e-14,
            "{found}, expected {expected}"
        );
        assert!(polynomial.error() < 1e-14);
    }

    #[test]
    fn error_of_oscillations_is_not_underestimated() {
        for turns in 1..60 {
            for phase in 0..20 {
                let function = |s: f64| (0.1 * f64::from(turns) * s + 0.3 * f64::from(phase)).sin();
                for degree in DEGREES {
                    let polynomial = interpolate(degree, function);
                    let errors = (0..=200).map(|k| 0.005 * f64::from(k));
                    let errors = errors.map(|s| (polynomial.value(s) - function(s)).abs());
                    let worst = errors.fold(0.0, f64::max);
                    let told = polynomial.error();
                    assert!(
                        worst < 3.0 * told + 1e-14,
                        "{turns} {phase} {degree}: {worst:e} {told:e}"
                    );
                    let (w, p) = (0.2 * f64::from(turns), 0.6 * f64::from(phase));
                    let expected = 0.5 - ((w + p).sin() - p.sin()) / (2.0 * w);
                    let worst = (polynomial.mean_square() - expected).abs();
                    let told = polynomial.mean_square_error(told);
                    assert!(
                        worst < 3.0 * told + 1e-14,
                        "{turns} {phase} {degree}: mean square {worst:e} {told:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn maximum_is_found_and_bounded() {
        for phase in 0..40 {
            let function = |s: f64| (5.0 * s + 0.2 * f64::from(phase)).sin();
            let polynomial = interpolate(16, function);
            let Bounds {
                high: bound,
                largest_place,
                ..
            } = polynomial.bounds();
            let found = polynomial.value(polynomial.find_maximum_near(largest_place));
            let grid = (0..=100_000).map(|k| polynomial.value(1e-5 * f64::from(k)));
            let expected = grid.fold(f64::NEG_INFINITY, f64::max);
            assert!(
                (found - expected).abs() < 1e-9,
                "{phase}: {found}, expected {expected}"
            );
            assert!(bound >= expected && bound < expected + 0.1);
        }
    }
}
