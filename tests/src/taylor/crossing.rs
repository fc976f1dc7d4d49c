//! First time at which a polynomial becomes positive.
//!
//! On an interval a polynomial is within the hull of its Bernstein coefficients. The number of roots in the interval
//! equals the number of sign changes of these coefficients minus an even number (Descartes' rule; Lane and Riesenfeld,
//! "Bounds on a polynomial", BIT 21 (1981)). Without a sign change there is no root; with one sign change there is one
//! root. With more sign changes the interval is halved. Therefore no root is missed, even close to another one.

use super::scalar::Scalar;

/// Number of halvings after which a pair of unresolved roots is ignored.
const HALVINGS: u32 = 50;

/// Returns the first u in 0..=1 at which the polynomial changes from at most zero to positive; coefficients are in
/// ascending powers. If the polynomial starts above zero and increases, for example because the previous step ended on
/// the root, the result is 0.
pub fn first_rise<T: Scalar>(coefficients: &[T]) -> Option<T> {
    let zero = T::from_f64(0.0);
    if stays_negative(coefficients) {
        return None;
    }
    let (start, slope) = (*coefficients.first()?, *coefficients.get(1)?);
    if start > zero && slope > zero {
        return Some(zero);
    }
    rise_within(coefficients, bernstein(coefficients), 0.0, 1.0, HALVINGS)
}

/// Returns true if the first coefficient is negative and its magnitude exceeds the sum of the magnitudes of all others.
fn stays_negative<T: Scalar>(coefficients: &[T]) -> bool {
    let mut doubles = coefficients.iter().map(|coefficient| coefficient.to_f64());
    let start = doubles.next().unwrap_or(0.0);
    // The relative rounding error of a sum of fifty positive doubles is below 1e-14.
    start < 0.0 && doubles.map(f64::abs).sum::<f64>() < -0.999 * start
}

/// Returns the Bernstein coefficients on 0..=1 of a polynomial in powers: the binomial transform of a_k/C(n, k),
/// computed by additions.
fn bernstein<T: Scalar>(coefficients: &[T]) -> Vec<T> {
    let degree = coefficients.len() - 1;
    let mut binomial = 1.0;
    let mut values = Vec::with_capacity(coefficients.len());
    for (k, coefficient) in coefficients.iter().enumerate() {
        values.push(*coefficient / T::from_f64(binomial));
        // The binomial coefficients are exact up to degree 56.
        binomial = binomial * (degree - k) as f64 / (k + 1) as f64;
    }
    for first in 1..=degree {
        for k in (first..=degree).rev() {
            values[k] = values[k] + values[k - 1];
        }
    }
    values
}

/// Returns the first change to positive within `from..=from + width`; `values` are the Bernstein coefficients on this
/// interval.
fn rise_within<T: Scalar>(
    coefficients: &[T],
    values: Vec<T>,
    from: f64,
    width: f64,
    halvings: u32,
) -> Option<T> {
    let zero = T::from_f64(0.0);
    let changes = values
        .windows(2)
        .filter(|pair| (pair[0] > zero) != (pair[1] > zero))
        .count();
    let rises = values[values.len() - 1] > zero;
    if changes == 0 || (changes == 1 && !rises) {
        return None;
    }
    if changes == 1 || (halvings == 0 && rises) {
        return Some(refine_root(
            coefficients,
            T::from_f64(from),
            T::from_f64(from + width),
        ));
    }
    let halvings = halvings.checked_sub(1)?;
    let (left, right) = halve(values);
    let width = width / 2.0;
    rise_within(coefficients, left, from, width, halvings)
        .or_else(|| rise_within(coefficients, right, from + width, width, halvings))
}

/// Returns the Bernstein coefficients on both halves of the interval (de Casteljau).
fn halve<T: Scalar>(mut values: Vec<T>) -> (Vec<T>, Vec<T>) {
    let degree = values.len() - 1;
    let mut left = Vec::with_capacity(values.len());
    left.push(values[0]);
    for last in (0..degree).rev() {
        for k in 0..=last {
            values[k] = (values[k] + values[k + 1]).scaled_by(0.5);
        }
        left.push(values[0]);
    }
    // The remaining values are the coefficients on the right half.
    (left, values)
}

/// Returns the value and the derivative of a polynomial in powers, by Horner's rule.
fn value_and_slope<T: Scalar>(coefficients: &[T], at: T) -> (T, T) {
    let zero = T::from_f64(0.0);
    coefficients
        .iter()
        .rev()
        .fold((zero, zero), |(value, slope), coefficient| {
            (value * at + *coefficient, slope * at + value)
        })
}

/// Returns the single root in `low..=high` of a polynomial that increases at the root. Newton's method is used, with
/// bisection if an iterate leaves the bracket.
fn refine_root<T: Scalar>(coefficients: &[T], mut low: T, mut high: T) -> T {
    let mut at = (low + high).scaled_by(0.5);
    for _ in 0..200 {
        let (value, slope) = value_and_slope(coefficients, at);
        if value > T::from_f64(0.0) {
            high = at;
        } else {
            low = at;
        }
        let mut next = at - value / slope;
        if !(next >= low && next <= high) {
            next = (low + high).scaled_by(0.5);
        }
        let moved = (next - at).magnitude().to_f64();
        at = next;
        if moved <= 2.0 * T::EPSILON {
            break;
        }
    }
    at
}
