//! The continuous extension of order 7 that the Dormand-Prince method of order 8 has (Hairer,
//! Norsett and Wanner, "Solving Ordinary Differential Equations I", section II.6).
//!
//! The crate `differential-equations` 0.7 evaluates what the extension needs at the end of
//! every step, but swaps s and 1 - s in three of its seven levels, so that what its
//! interpolation gives is of order 4. The coefficients are right, and it does not show them.
//! They are recovered here: both polynomials are c_0 + s (c_1 + (1 - s) R(s)) with R of
//! degree 5, which six values determine.

use nalgebra::{Matrix6, Vector6};

/// Parts of a step at which its interior is interpolated: the Chebyshev points of the interval.
pub const PARTS: [f64; 6] = [
    0.017_037_086_855_465_856,
    0.146_446_609_406_726_24,
    0.370_590_477_448_739_6,
    0.629_409_522_551_260_4,
    0.853_553_390_593_273_8,
    0.982_962_913_144_534_1,
];

/// Makes of values of the crate's interpolation those of the extension.
pub struct ContinuousExtension {
    /// From R at [`PARTS`] to the coefficients c_2 .. c_7.
    coefficients: Matrix6<f64>,
}

impl ContinuousExtension {
    /// For steps of any system.
    pub fn new() -> Self {
        let rows = PARTS.map(|s| swapped(s).transpose());
        // Six different points determine the polynomial: there is an inverse.
        let coefficients = Matrix6::from_rows(&rows).try_inverse();
        Self {
            coefficients: coefficients.unwrap_or_else(Matrix6::zeros),
        }
    }

    /// The interior of a step from `start` to `end`; `swapped` gives the crate's interpolation at a
    /// part of it, or nothing.
    pub fn find_interior(
        &self,
        (start, end): (&[f64], &[f64]),
        mut swapped: impl FnMut(f64) -> Option<Vec<f64>>,
    ) -> Option<Interior> {
        let mut values = vec![Vector6::zeros(); start.len()];
        for (number, part) in PARTS.into_iter().enumerate() {
            let states = swapped(part)?;
            let components = values.iter_mut().zip(states).zip(start.iter().zip(end));
            for ((values, value), (a, b)) in components {
                values[number] = (value - line(part, *a, *b)) / (part * (1.0 - part));
            }
        }
        let coefficients = values.iter().map(|values| self.coefficients * values);
        Some(Interior {
            coefficients: coefficients.collect(),
        })
    }
}

/// What the extension gives inside one step.
pub struct Interior {
    /// For each state c_2 .. c_7.
    coefficients: Vec<Vector6<f64>>,
}

impl Interior {
    /// The state at a `part` of the step from `start` to `end`.
    pub fn interpolate(&self, part: f64, (start, end): (&[f64], &[f64])) -> Vec<f64> {
        let powers = straight(part) * (part * (1.0 - part));
        let ends = start.iter().zip(end);
        ends.zip(&self.coefficients)
            .map(|((a, b), coefficients)| line(part, *a, *b) + powers.dot(coefficients))
            .collect()
    }
}

/// The straight line from `a` to `b`.
fn line(part: f64, a: f64, b: f64) -> f64 {
    a + part * (b - a)
}

/// What multiplies c_2 .. c_7 in the extension's R at s.
fn straight(s: f64) -> Vector6<f64> {
    let r = 1.0 - s;
    Vector6::new(1.0, s, s * r, s * r * s, s * r * s * r, s * r * s * r * s)
}

/// The same as the crate has it.
fn swapped(s: f64) -> Vector6<f64> {
    let r = 1.0 - s;
    Vector6::new(1.0, s, s * r, s * r * r, s * r * r * s, s * r * r * s * r)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_recovered_from_six_values() {
        let c = Vector6::new(0.3, -0.7, 1.1, 0.4, -0.2, 0.9);
        let (start, end) = ([2.0], [2.5]);
        let of = |s: f64, levels: Vector6<f64>| 2.0 + s * (0.5 + (1.0 - s) * levels.dot(&c));
        let extension = ContinuousExtension::new();
        for part in [0.0, 0.2, 0.55, 1.0] {
            let step = (&start[..], &end[..]);
            let interior = extension.find_interior(step, |s| Some(vec![of(s, swapped(s))]));
            let state = interior.expect("an interior").interpolate(part, step);
            let error = state[0] - of(part, straight(part));
            assert!(error.abs() < 1e-13, "{error:e} at {part}");
        }
    }
}
