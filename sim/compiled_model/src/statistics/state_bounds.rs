//! Bounds of the states over a panel, from their values at Chebyshev points.
//!
//! A polynomial through the values bounds a state, up to the interpolation error. Samples of a fast oscillation may
//! look slow. The derivative of the polynomial of a coordinate then differs from the rate, which is a state too.

use std::sync::LazyLock;

use eomgen_codegen::program::evaluator::{DEGREE, Enclosure};
use eomgen_model_spec::interval::Interval;
use eomgen_sim::ode::BernsteinBasis;

use super::polynomial::{Polynomial, chebyshev_point};

/// Degree of the interpolation of states.
pub(super) const STATE_DEGREE: usize = DEGREE + 1;

static BASIS: LazyLock<BernsteinBasis> = LazyLock::new(BernsteinBasis::new);

/// Returns the bounds of the states over a panel of `length` s. `states` has the states at the Chebyshev points of
/// [`STATE_DEGREE`]. `degrees` is the number of coordinates, whose rates follow them in the state.
pub(super) fn bound_states(states: &[Vec<f64>], degrees: usize, length: f64) -> Vec<Enclosure> {
    let count = states.first().map_or(0, Vec::len);
    let column = |place: usize| -> Vec<f64> { states.iter().map(|state| state[place]).collect() };
    let polynomials = (0..count).map(|place| Polynomial::through(&column(place)));
    let mut polynomials: Vec<Polynomial> = polynomials.collect();
    let error = |(place, polynomial): (usize, &Polynomial)| {
        let last: f64 = polynomial.coefficients()[DEGREE..]
            .iter()
            .map(|entry| entry.abs())
            .sum();
        if place >= degrees {
            return last;
        }
        let rates = column(degrees + place).into_iter().enumerate();
        let differences = rates.map(|(index, rate)| {
            let part = chebyshev_point(index, STATE_DEGREE);
            (polynomial.derivative(part) - rate * length).abs()
        });
        // If a term of degree n causes this error of the derivative, the term is at least n times smaller.
        last.max(differences.fold(0.0, f64::max) / STATE_DEGREE as f64)
    };
    let errors: Vec<f64> = polynomials.iter().enumerate().map(error).collect();
    for polynomial in &mut polynomials {
        polynomial.truncate(DEGREE);
    }
    let at = |part: f64| -> Vec<f64> { polynomials.iter().map(|own| own.value(part)).collect() };
    let mut bounds = Vec::with_capacity(count);
    if let Some(piece) = BASIS.fit((&at(0.0), &at(1.0)), |part| Some(at(part))) {
        piece.bound(length, &mut bounds);
    }
    let with_rest = |(bound, error): (Enclosure, f64)| {
        // Markov's inequality bounds the rate of the interpolation error.
        let rate = 2.0 * (STATE_DEGREE * STATE_DEGREE) as f64 * error / length;
        bound.add_enclosure(Enclosure::from_bounds(symmetric(error), symmetric(rate)))
    };
    bounds.into_iter().zip(errors).map(with_rest).collect()
}

fn symmetric(size: f64) -> Interval {
    Interval {
        low: -size,
        high: size,
    }
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
