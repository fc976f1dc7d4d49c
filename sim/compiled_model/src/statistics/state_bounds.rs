//! Bounds of the states over a panel, from their values at Chebyshev points.
//!
//! A polynomial through the values bounds a state, up to the error of the interpolation. A fast oscillation may have values
//! that look slow; the derivative of the polynomial of a coordinate then differs from the rate, which is a state too.

use std::sync::LazyLock;

use eomgen_codegen::program::evaluator::{DEGREE, Enclosure};
use eomgen_model_spec::interval::Interval;

use super::polynomial::{Polynomial, chebyshev_point};

/// Degree of the interpolation of states.
pub(super) const STATE_DEGREE: usize = DEGREE + 1;

/// Bernstein control points of the Chebyshev polynomials up to [`DEGREE`], raised to that degree.
static CONTROLS: LazyLock<[[f64; DEGREE + 1]; DEGREE + 1]> =
    LazyLock::new(|| std::array::from_fn(|order| raise(&chebyshev_controls(order))));

/// Returns the bounds of the states over a panel of a length (s). `states` has the states at the Chebyshev points of
/// [`STATE_DEGREE`], and `degrees` is the number of coordinates, whose rates follow them in the state.
pub(super) fn bound_states(states: &[Vec<f64>], degrees: usize, length: f64) -> Vec<Enclosure> {
    let count = states.first().map_or(0, Vec::len);
    let column = |place: usize| -> Vec<f64> { states.iter().map(|state| state[place]).collect() };
    let bound = |place: usize| {
        let polynomial = Polynomial::through(&column(place));
        let coefficients = polynomial.coefficients();
        let mut error: f64 = coefficients[DEGREE..].iter().map(|entry| entry.abs()).sum();
        if place < degrees {
            let rates = column(degrees + place).into_iter().enumerate();
            let differences = rates.map(|(index, rate)| {
                let part = chebyshev_point(index, STATE_DEGREE);
                (polynomial.derivative(part) - rate * length).abs()
            });
            // A term of degree n with this error of the derivative is n times smaller, at least.
            error = error.max(differences.fold(0.0, f64::max) / STATE_DEGREE as f64);
        }
        let mut controls = [0.0; DEGREE + 1];
        for (coefficient, own) in coefficients.iter().zip(&*CONTROLS) {
            for (control, part) in controls.iter_mut().zip(own) {
                *control += coefficient * part;
            }
        }
        // Markov's inequality bounds the rate of the rest.
        let rate = 2.0 * (STATE_DEGREE * STATE_DEGREE) as f64 * error / length;
        let rest = Enclosure::from_bounds(symmetric(error), symmetric(rate));
        Enclosure::polynomial(controls, length).add_enclosure(rest)
    };
    (0..count).map(bound).collect()
}

fn symmetric(size: f64) -> Interval {
    Interval {
        low: -size,
        high: size,
    }
}

/// Returns the Bernstein control points of a Chebyshev polynomial over a panel, in its own degree.
fn chebyshev_controls(order: usize) -> Vec<f64> {
    let control = |place: usize| {
        let sign = if (order - place).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        sign * binomial(2 * order, 2 * place) / binomial(order, place)
    };
    (0..=order).map(control).collect()
}

/// Raises the degree of a Bernstein polynomial to [`DEGREE`].
fn raise(controls: &[f64]) -> [f64; DEGREE + 1] {
    let mut raised = controls.to_vec();
    while raised.len() <= DEGREE {
        let degree = raised.len();
        let point = |place: usize| {
            let part = place as f64 / degree as f64;
            let before = if place == 0 { 0.0 } else { raised[place - 1] };
            let own = raised.get(place).copied().unwrap_or(0.0);
            part * before + (1.0 - part) * own
        };
        raised = (0..=degree).map(point).collect();
    }
    std::array::from_fn(|place| raised[place])
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |choices, j| choices * (n - j) as f64 / (j + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds_of(function: impl Fn(f64) -> [f64; 2], length: f64) -> Vec<Enclosure> {
        let states: Vec<Vec<f64>> = (0..=STATE_DEGREE)
            .map(|index| function(length * chebyshev_point(index, STATE_DEGREE)).to_vec())
            .collect();
        bound_states(&states, 1, length)
    }

    #[test]
    fn bounds_contain_slow_and_fast_oscillations() {
        for step in 1..2000 {
            let frequency = 0.05 * f64::from(step);
            let motion = |t: f64| {
                let angle = frequency * t + 0.7 * f64::from(step);
                [angle.sin(), frequency * angle.cos()]
            };
            let length = 1.3;
            let bounds = bounds_of(motion, length);
            let value = bounds[0].value();
            let times = (0..=400).map(|place| length * f64::from(place) / 400.0);
            let most = times.fold(0.0_f64, |most, t| {
                let x = motion(t)[0];
                most.max(x - value.high).max(value.low - x)
            });
            assert!(most < 1e-9, "{frequency}: {most:e}, {value:?}");
        }
    }

    #[test]
    fn bounds_of_short_panels_are_close() {
        let bounds = bounds_of(|t| [t.sin(), t.cos()], 0.5);
        let (value, rate) = (bounds[0].value(), bounds[0].rate());
        assert!(value.low > -1e-6 && value.low <= 0.0, "{value:?}");
        assert!((value.high - 0.5_f64.sin()).abs() < 2e-2, "{value:?}");
        assert!(
            rate.high < 1.01 && rate.low > 0.5_f64.cos() - 0.1,
            "{rate:?}"
        );
    }
}
