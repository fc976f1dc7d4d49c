//! Accuracy of sine, cosine, tangent and their inverses, with the bounds of the crate's table.

use crate::hard_cases::near_multiples_of_half_pi;
use crate::oracle::{Exact, assert_pairs_within, assert_within, magnitudes, sample, ulps, uniform};
use eomgen_elementary::{LARGEST_ANGLE, acos, asin, atan, atan2, cos, sin, sin_cos, tan};
use std::f64::consts::FRAC_PI_4;

/// Returns angles from the smallest subnormal to 1e9, dense in the usual range.
fn angles() -> Vec<f64> {
    let mut angles = uniform(-FRAC_PI_4, FRAC_PI_4);
    angles.extend(uniform(-10.0, 10.0));
    angles.extend(uniform(-LARGEST_ANGLE, LARGEST_ANGLE));
    angles.extend(magnitudes(-1074, -20));
    angles.extend(magnitudes(-20, 28));
    angles.extend([LARGEST_ANGLE, -LARGEST_ANGLE]);
    angles
}

#[test]
fn sine_is_accurate() {
    assert_within(0.76, angles(), sin, Exact::sin);
}

#[test]
fn cosine_is_accurate() {
    assert_within(0.77, angles(), cos, Exact::cos);
}

#[test]
fn tangent_is_accurate() {
    assert_within(0.94, angles(), tan, Exact::tan);
}

#[test]
fn multiples_of_half_pi_are_reduced_accurately() {
    let arguments = near_multiples_of_half_pi();
    let closest = arguments
        .iter()
        .map(|&x| sin(x).abs().min(cos(x).abs()))
        .fold(1.0, f64::min);
    // The doubles near multiples of pi/2 are hard cases only if some are as near as is possible for doubles.
    assert!(closest < 2f64.powi(-58), "the closest is {closest:e} away");
    assert_within(0.76, arguments.clone(), sin, Exact::sin);
    assert_within(0.77, arguments.clone(), cos, Exact::cos);
    assert_within(0.94, arguments, tan, Exact::tan);
}

#[test]
fn joint_sine_and_cosine_are_bit_identical() {
    for x in angles() {
        let (sine, cosine) = sin_cos(x);
        assert_eq!(sine.to_bits(), sin(x).to_bits(), "sin {x:e}");
        assert_eq!(cosine.to_bits(), cos(x).to_bits(), "cos {x:e}");
    }
}

#[test]
fn symmetries_hold_in_every_bit() {
    for x in angles() {
        assert_eq!(sin(-x).to_bits(), (-sin(x)).to_bits(), "sin {x:e}");
        assert_eq!(cos(-x).to_bits(), cos(x).to_bits(), "cos {x:e}");
        assert_eq!(tan(-x).to_bits(), (-tan(x)).to_bits(), "tan {x:e}");
    }
}

#[test]
fn arc_tangent_is_accurate() {
    let mut arguments = uniform(-3.0, 3.0);
    arguments.extend(uniform(0.3, 0.75));
    arguments.extend(magnitudes(-1074, 1023));
    arguments.extend(magnitudes(-30, 60));
    assert_within(0.75, arguments, atan, Exact::atan);
}

#[test]
fn angle_of_a_point_is_accurate() {
    let mut points = sample(|random| (random.magnitude(-3, 3), random.magnitude(-3, 3)));
    points.extend(sample(|random| {
        (random.magnitude(-1000, 1023), random.magnitude(-1000, 1023))
    }));
    points.extend(sample(|random| {
        (
            random.magnitude(-1074, -1020),
            random.magnitude(-1074, -1020),
        )
    }));
    points.extend(sample(|random| {
        (random.magnitude(1020, 1023), random.magnitude(1020, 1023))
    }));
    assert_pairs_within(1.45, points, atan2, |y, x| y.atan2(x));
}

#[test]
fn arc_sine_is_accurate() {
    let mut arguments = uniform(-1.0, 1.0);
    arguments.extend(magnitudes(-1074, -1));
    arguments.extend(magnitudes(-53, -2).iter().map(|d| 1.0 - d.abs()));
    arguments.extend([0.5, -0.5, 1.0, -1.0]);
    assert_within(0.63, arguments, asin, Exact::asin);
}

#[test]
fn arc_cosine_is_accurate() {
    let mut arguments = uniform(-1.0, 1.0);
    arguments.extend(magnitudes(-1074, -1));
    arguments.extend(magnitudes(-53, -2).iter().map(|d| 1.0 - d.abs()));
    arguments.extend(magnitudes(-53, -2).iter().map(|d| d.abs() - 1.0));
    arguments.extend([0.5, -0.5, 1.0, -1.0]);
    assert_within(0.60, arguments, acos, Exact::acos);
}

#[test]
fn ulps_counts_last_places() {
    let one = crate::oracle::exact(1.0).expect("finite");
    assert_eq!(ulps(1.0, &one), 0.0);
    assert_eq!(ulps(1.0 + f64::EPSILON, &one), 1.0);
    assert_eq!(ulps(f64::NAN, &one), f64::INFINITY);
    let smallest = f64::from_bits(1);
    let subnormal = crate::oracle::exact(smallest).expect("finite");
    assert_eq!(ulps(3.0 * smallest, &subnormal), 2.0);
}
