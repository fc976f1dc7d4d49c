//! Modes of the clamped-free beam in the paper's normalisation, Eq. (17), on the unit interval.
//!
//! phi(s) = sin zs - sinh zs + xi (cos zs - cosh zs). It satisfies phi'''' = z^4 phi, phi(0) = phi'(0) = 0 and phi''(1)
//! = phi'''(1) = 0. Integration by parts gives int s phi = z^-4 [s phi''' - phi''] = phi''(0)/z^4 = -2 xi/z^2 and int
//! phi''^2 = z^4 int phi^2. With int phi^2 = phi(1)^2/4 (Rayleigh, "The theory of sound", art. 173) and cos z cosh z =
//! -1, phi(1) = 2 xi (-1)^r and int phi^2 = xi^2.

use super::scalar::Scalar;

/// Dimensionless constants of one mode.
#[derive(Clone, Copy, Debug)]
pub struct Mode<T> {
    /// beta l, the root of cos z cosh z = -1.
    pub z: T,
    /// xi = -(sin z + sinh z)/(cos z + cosh z).
    pub xi: T,
    /// Integral of s phi.
    pub moment: T,
    /// Integral of phi^2.
    pub square: T,
    /// Integral of (d^2 phi/ds^2)^2.
    pub bending: T,
    /// phi(1).
    pub tip: T,
}

impl<T: Scalar> Mode<T> {
    /// Returns mode `r`, counted from 1.
    pub fn clamped_free(r: usize) -> Self {
        let z: T = compute_root(r);
        let (sin, cos) = z.sin_cos();
        let decay = (-z).exp();
        let one = T::from_f64(1.0);
        // Numerator and denominator are multiplied by exp(-z) to avoid overflow.
        let sines = decay * sin + (one - decay * decay).scaled_by(0.5);
        let cosines = decay * cos + (one + decay * decay).scaled_by(0.5);
        let xi = -sines / cosines;
        let square = xi * xi;
        Self {
            z,
            xi,
            moment: xi.scaled_by(-2.0) / (z * z),
            square,
            bending: z * z * z * z * square,
            tip: xi.scaled_by(if r.is_multiple_of(2) { 2.0 } else { -2.0 }),
        }
    }
}

/// Returns the r-th positive root of cos z + 1/cosh z by Newton's method. The initial value (r - 1/2) pi has an error
/// of 0.3 at r = 1 and of 2 exp(-z) for larger r.
fn compute_root<T: Scalar>(r: usize) -> T {
    let one = T::from_f64(1.0);
    let mut z = T::PI.scaled_by(r as f64 - 0.5);
    for _ in 0..12 {
        let (sin, cos) = z.sin_cos();
        let decay = (-z).exp();
        let secant = decay.scaled_by(2.0) / (one + decay * decay);
        let tangent = (one - decay * decay) / (one + decay * decay);
        z = z + (cos + secant) / (sin + secant * tangent);
    }
    z
}
