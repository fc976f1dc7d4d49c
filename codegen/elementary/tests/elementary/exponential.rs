//! Accuracy of the exponential, the logarithm and the hyperbolic functions, with the bounds of the crate's
//! table.

use crate::oracle::{Exact, assert_within, magnitudes, uniform};
use eomgen_elementary::{cosh, exp, exp_minus_one, ln, sinh, tanh};

/// Largest argument with a finite exponential.
const LARGEST: f64 = 709.782_712_893_384;
/// Largest argument with a finite hyperbolic sine and cosine.
const LARGEST_HYPERBOLIC: f64 = 710.475_860_073_943_9;

fn exponents() -> Vec<f64> {
    let mut exponents = uniform(-708.0, LARGEST);
    exponents.extend(uniform(-1.0, 1.0));
    exponents.extend(uniform(-745.2, -707.0));
    exponents.extend(uniform(709.0, LARGEST));
    exponents.extend(magnitudes(-1074, -40));
    exponents.extend(magnitudes(-60, 8));
    exponents.push(LARGEST);
    exponents
}

#[test]
fn exponential_is_accurate() {
    assert_within(0.76, exponents(), exp, Exact::exp);
}

#[test]
fn exponential_minus_one_is_accurate() {
    assert_within(1.10, exponents(), exp_minus_one, Exact::exp_m1);
}

#[test]
fn logarithm_is_accurate() {
    let mut arguments: Vec<f64> = magnitudes(-1074, 1023).iter().map(|x| x.abs()).collect();
    arguments.retain(|&x| x > 0.0);
    arguments.extend(uniform(0.5, 2.0));
    arguments.extend(uniform(0.7, 1.42));
    arguments.extend(magnitudes(-53, -3).iter().map(|d| 1.0 + d));
    arguments.extend([f64::from_bits(1), f64::MIN_POSITIVE, f64::MAX, 1.0]);
    assert_within(0.81, arguments, ln, Exact::ln);
}

fn hyperbolic_arguments() -> Vec<f64> {
    let mut arguments = uniform(-LARGEST_HYPERBOLIC, LARGEST_HYPERBOLIC);
    arguments.extend(uniform(-3.0, 3.0));
    arguments.extend(uniform(709.0, LARGEST_HYPERBOLIC));
    arguments.extend(magnitudes(-1074, -20));
    arguments.extend(magnitudes(-30, 8));
    arguments.extend([LARGEST_HYPERBOLIC, -LARGEST_HYPERBOLIC]);
    arguments
}

#[test]
fn hyperbolic_sine_is_accurate() {
    assert_within(1.15, hyperbolic_arguments(), sinh, Exact::sinh);
}

#[test]
fn hyperbolic_cosine_is_accurate() {
    assert_within(0.88, hyperbolic_arguments(), cosh, Exact::cosh);
}

#[test]
fn hyperbolic_tangent_is_accurate() {
    assert_within(0.91, hyperbolic_arguments(), tanh, Exact::tanh);
}
