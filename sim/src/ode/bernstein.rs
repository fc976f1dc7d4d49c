//! Dense output of a step in Bernstein form. The control points of a polynomial bound it. Subdivision makes the
//! bounds tighter (G. Farin, *Curves and Surfaces for CAGD*).

use eomgen_codegen::program::evaluator::{DEGREE, Enclosure};
use nalgebra::{SMatrix, SVector};

/// Fractions of a step at which the dense output is evaluated for the conversion: Chebyshev points.
const SAMPLE_FRACTIONS: [f64; 6] = [
    0.017_037_086_855_465_856,
    0.146_446_609_406_726_24,
    0.370_590_477_448_739_6,
    0.629_409_522_551_260_4,
    0.853_553_390_593_273_8,
    0.982_962_913_144_534_1,
];

/// Number of control points of a state. The degree is that of the dense output in `dormand_prince`.
const CONTROL_POINT_COUNT: usize = DEGREE + 1;

/// Number of inner control points.
const INNER_POINT_COUNT: usize = SAMPLE_FRACTIONS.len();

type Controls = [f64; CONTROL_POINT_COUNT];

/// Conversion of dense output to Bernstein form.
pub struct BernsteinBasis {
    /// Matrix from the values at [`SAMPLE_FRACTIONS`], relative to the chord, to the inner control points.
    inner: SMatrix<f64, INNER_POINT_COUNT, INNER_POINT_COUNT>,
    /// Control points of the factors in the nested form of `slopes`.
    nested: [Controls; DEGREE],
}

/// Dense output over a part of a step: control points of each state.
#[derive(Clone)]
pub struct Piece {
    /// Start of the piece, as a fraction of the step, 0 to 1.
    pub from: f64,
    /// End of the piece, as a fraction of the step.
    pub to: f64,
    controls: Vec<Controls>,
}

impl BernsteinBasis {
    /// Computes the matrices of the conversion.
    pub fn new() -> Self {
        let basis = SMatrix::<f64, INNER_POINT_COUNT, INNER_POINT_COUNT>::from_fn(|row, column| {
            evaluate_basis(column + 1, SAMPLE_FRACTIONS[row])
        });
        // Interpolation at distinct points is unique, so the matrix has an inverse.
        let inner = basis.try_inverse();
        Self {
            inner: inner.unwrap_or_else(SMatrix::zeros),
            nested: std::array::from_fn(expand_nested_factor),
        }
    }

    /// Returns the dense output of a step from `start` to `end` as one piece, from the coefficients of its
    /// nested form start + s (c_0 + (1 - s) (c_1 + s (c_2 + ...))).
    pub fn convert(&self, (start, end): (&[f64], &[f64]), nested: &[Vec<f64>; DEGREE]) -> Piece {
        let controls = start.iter().zip(end).enumerate().map(|(entry, (a, b))| {
            let mut points = [0.0; CONTROL_POINT_COUNT];
            for (factor, coefficients) in self.nested.iter().zip(nested) {
                let coefficient = coefficients[entry];
                let terms = points.iter_mut().zip(factor);
                terms.for_each(|(point, factor)| *point += coefficient * factor);
            }
            points.iter_mut().for_each(|point| *point += a);
            points[DEGREE] = *b;
            points
        });
        Piece {
            from: 0.0,
            to: 1.0,
            controls: controls.collect(),
        }
    }

    /// Returns the dense output of a step from `start` to `end` as one piece. `interpolate` returns the state
    /// at a fraction of the step.
    pub fn fit(
        &self,
        (start, end): (&[f64], &[f64]),
        mut interpolate: impl FnMut(f64) -> Option<Vec<f64>>,
    ) -> Option<Piece> {
        let mut values = vec![SVector::<f64, INNER_POINT_COUNT>::zeros(); start.len()];
        for (index, part) in SAMPLE_FRACTIONS.into_iter().enumerate() {
            let state = interpolate(part)?;
            let entries = values.iter_mut().zip(state).zip(start.iter().zip(end));
            for ((values, entry), (a, b)) in entries {
                values[index] = entry - (a + part * (b - a));
            }
        }
        let ends = start.iter().zip(end);
        let controls = values.iter().zip(ends).map(|(values, (a, b))| {
            let inner = self.inner * values;
            std::array::from_fn(|index| match index {
                0 => *a,
                DEGREE => *b,
                // The control points of the chord are equally spaced.
                _ => a + (b - a) * index as f64 / DEGREE as f64 + inner[index - 1],
            })
        });
        Some(Piece {
            from: 0.0,
            to: 1.0,
            controls: controls.collect(),
        })
    }
}

impl Default for BernsteinBasis {
    fn default() -> Self {
        Self::new()
    }
}

impl Piece {
    /// Returns the state at the end of the piece.
    pub fn end_state(&self) -> Vec<f64> {
        self.controls.iter().map(|points| points[DEGREE]).collect()
    }

    /// Returns the start of the piece as a piece with constant state.
    pub fn start(&self) -> Self {
        let at_start = |points: &Controls| [points[0]; CONTROL_POINT_COUNT];
        Self {
            from: self.from,
            to: self.from,
            controls: self.controls.iter().map(at_start).collect(),
        }
    }

    /// Returns the first and the second half (de Casteljau's algorithm).
    pub fn halves(&self) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        let half = |from, to| Self {
            from,
            to,
            controls: Vec::with_capacity(self.controls.len()),
        };
        let (mut first, mut second) = (half(self.from, middle), half(middle, self.to));
        for controls in &self.controls {
            let mut points = *controls;
            let (mut left, mut right) = (points, points);
            for level in 0..CONTROL_POINT_COUNT {
                left[level] = points[0];
                right[DEGREE - level] = points[DEGREE - level];
                for index in 0..DEGREE - level {
                    points[index] = 0.5 * (points[index] + points[index + 1]);
                }
            }
            first.controls.push(left);
            second.controls.push(right);
        }
        [first, second]
    }

    /// Writes bounds of the state over the piece to `out`. The step has `length` s.
    pub fn bound(&self, length: f64, out: &mut Vec<Enclosure>) {
        let duration = (self.to - self.from) * length;
        out.clear();
        let bounds = |points: &Controls| Enclosure::polynomial(*points, duration);
        out.extend(self.controls.iter().map(bounds));
    }
}

/// Returns the control points of s^a (1 - s)^b, the factor of a coefficient in the nested form.
fn expand_nested_factor(coefficient: usize) -> Controls {
    let degree = coefficient + 1;
    let (a, more) = (coefficient / 2 + 1, DEGREE - degree);
    std::array::from_fn(|index| match index.checked_sub(a) {
        Some(rest) if rest <= more => binomial(more, rest) / binomial(DEGREE, index),
        _ => 0.0,
    })
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |choices, j| choices * (n - j) as f64 / (j + 1) as f64)
}

/// Returns the Bernstein basis polynomial number `index` of degree [`DEGREE`] at the fraction `part`.
fn evaluate_basis(index: usize, part: f64) -> f64 {
    binomial(DEGREE, index) * part.powi(index as i32) * (1.0 - part).powi((DEGREE - index) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(s: f64) -> f64 {
        1.0 + s * (0.3 + s * (-2.0 + s * (0.7 + s * (1.1 + s * (-0.4 + s * (0.9 - 1.3 * s))))))
    }

    fn piece() -> Piece {
        let ends = ([polynomial(0.0)], [polynomial(1.0)]);
        let fitted = BernsteinBasis::new().fit((&ends.0, &ends.1), |s| Some(vec![polynomial(s)]));
        fitted.expect("a polynomial")
    }

    #[test]
    fn nested_form_and_samples_give_the_same_control_points() {
        let coefficients: [f64; DEGREE] = [0.7, -1.3, 0.4, 2.1, -0.9, 0.2, 1.7];
        let start = 0.3;
        let value = |s: f64| {
            let nested = coefficients.iter().enumerate().rev();
            start
                + nested.fold(0.0, |value, (index, coefficient)| {
                    let factor = if index % 2 == 0 { s } else { 1.0 - s };
                    factor * (value + coefficient)
                })
        };
        let ends = ([start], [value(1.0)]);
        let basis = BernsteinBasis::new();
        let converted = basis.convert((&ends.0, &ends.1), &coefficients.map(|c| vec![c]));
        let fitted = basis.fit((&ends.0, &ends.1), |s| Some(vec![value(s)]));
        let pairs = converted.controls[0]
            .iter()
            .zip(fitted.expect("a polynomial").controls[0]);
        for (converted, fitted) in pairs {
            assert!((converted - fitted).abs() < 1e-13, "{converted} {fitted}");
        }
    }

    #[test]
    fn halves_have_values_of_polynomial_and_bound_it() {
        let mut pieces = vec![piece()];
        for _ in 0..5 {
            pieces = pieces.iter().flat_map(Piece::halves).collect();
        }
        let mut bounds = Vec::new();
        for piece in &pieces {
            assert!((piece.end_state()[0] - polynomial(piece.to)).abs() < 1e-13);
            piece.bound(2.0, &mut bounds);
            let (value, rate) = (bounds[0].value(), bounds[0].rate());
            assert!(value.high - value.low < 0.1);
            let step = 0.01 * (piece.to - piece.from);
            for k in 0..100 {
                let s = piece.from + f64::from(k) * step;
                let (here, there) = (polynomial(s), polynomial(s + step));
                assert!(value.low - 1e-13 < here && here < value.high + 1e-13);
                let slope = (there - here) / (2.0 * step);
                assert!(rate.low - 1e-9 < slope && slope < rate.high + 1e-9);
            }
        }
    }
}
