//! Series with known properties, for tests.

use std::f64::consts::TAU;

/// Returns the logistic map x -> r x (1 - x) after a transient of 10000 steps. At r = 4 its
/// exponent is ln 2; at r = 3.5 it has period 4 (R. M. May, Nature 261 (1976) 459-467).
pub fn logistic(r: f64, count: usize) -> Vec<f64> {
    iterate(0.3, |x| r * x * (1.0 - x), count)
}

/// Returns the sine circle map on the unit circle; strength 0 is a rotation.
pub fn circle(rotation: f64, strength: f64, count: usize) -> Vec<f64> {
    let step = |x: f64| (x + rotation - strength / TAU * (TAU * x).sin()).rem_euclid(1.0);
    iterate(0.1, step, count)
}

/// Returns points (x, y) of Hénon's map at a = 1.4, b = 0.3: exponent 0.4192, correlation dimension
/// 1.21 (P. Grassberger, I. Procaccia, Physica D 9 (1983) 189-208).
pub fn henon(count: usize) -> Vec<[f64; 2]> {
    iterate([0.1, 0.1], |[x, y]| [1.0 - 1.4 * x * x + y, 0.3 * x], count)
}

/// Returns uncorrelated numbers, uniform on [-1, 1): a multiplicative congruential generator (D. E.
/// Knuth's MMIX constants).
pub fn noise(count: usize) -> Vec<f64> {
    let mut state = 1_u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn iterate<T: Copy>(start: T, step: impl Fn(T) -> T, count: usize) -> Vec<T> {
    let orbit = std::iter::successors(Some(start), |x| Some(step(*x)));
    orbit.skip(10_000).take(count).collect()
}
