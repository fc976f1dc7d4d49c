//! Integrals of polynomial times exponential functions, the response to a force exp(nu s): I_k(nu, tau) =
//! integral from 0 to tau of (tau - s)^k / k! exp(nu s) ds.
//!
//! With phi_k(z) = sum over j of z^j / (j + k)!, I_k = tau^(k+1) phi_(k+1)(nu tau) and phi_k(z) = z
//! phi_(k+1)(z) + 1/k!. The recursion towards smaller k is stable for small z, the recursion towards larger k
//! for large z. No difference of nearly equal numbers is formed. Therefore a frequency of zero, or one equal to
//! an eigenvalue, is no special case.

use nalgebra::Complex;

/// Number of derivatives. Orders -DERIVATIVES to -1 precede order 0.
pub(super) const DERIVATIVES: usize = 4;

/// Terms of the series at |z| < 1: the remainder is below 1/20! of the sum.
const TERMS: usize = 20;

/// Terms at |z| < 1/8: the remainder is below 8^-11 / 11! of the sum.
const FEW_TERMS: usize = 11;

/// 1 / n for every n that a series or a factorial needs.
const RECIPROCALS: [f64; 64] = {
    let mut all = [f64::INFINITY; 64];
    let mut n = 1;
    while n < 64 {
        all[n] = 1.0 / n as f64;
        n += 1;
    }
    all
};

/// Computes I_k(nu, tau) for k = -4 .. orders - 1 to `out`, where I_(k-1) is the derivative of I_k by tau for k
/// >= 0, I_(-1) = exp(nu tau) and I_(k-1) = nu I_k below.
///
/// `exponential` is exp(nu tau).
pub(super) fn integrals(
    nu: Complex<f64>,
    tau: f64,
    exponential: Complex<f64>,
    out: &mut [Complex<f64>],
) {
    out[3] = exponential;
    out[2] = nu * exponential;
    out[1] = nu * out[2];
    out[0] = nu * out[1];
    let values = &mut out[DERIVATIVES..];
    let orders = values.len();
    if orders == 0 {
        return;
    }
    let z = nu * tau;
    if z.norm_sqr() < 1.0 {
        let mut phi = sum_series(z, orders);
        for k in (0..orders).rev() {
            // At this point, phi is phi_(k+1).
            values[k] = phi;
            phi = z * phi + inverse_factorial(k);
        }
    } else {
        let mut phi = exponential;
        for (k, value) in values.iter_mut().enumerate() {
            phi = (phi - inverse_factorial(k)) / z;
            *value = phi;
        }
    }
    let mut power = tau;
    for value in values {
        *value *= power;
        power *= tau;
    }
}

/// Returns phi_k(z) for |z| < 1.
fn sum_series(z: Complex<f64>, k: usize) -> Complex<f64> {
    let terms = if z.norm_sqr() < 1.0 / 64.0 {
        FEW_TERMS
    } else {
        TERMS
    };
    let mut sum = Complex::new(1.0, 0.0);
    for j in (0..terms).rev() {
        // Horner's scheme for the sum of z^j k!/(j + k)!.
        sum = sum * z * reciprocal(j + k + 1) + 1.0;
    }
    sum * inverse_factorial(k)
}

/// Returns 1 / n.
pub(super) fn reciprocal(n: usize) -> f64 {
    RECIPROCALS.get(n).copied().unwrap_or(1.0 / n as f64)
}

/// Returns 1 / k!.
fn inverse_factorial(k: usize) -> f64 {
    (1..=k).fold(1.0, |product, i| product * reciprocal(i))
}

/// Returns k! as a floating-point number.
pub(super) fn factorial(k: usize) -> f64 {
    (1..=k).fold(1.0, |product, i| product * i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the integral by Simpson's rule, independent of the recursions.
    fn integrate_by_quadrature(nu: Complex<f64>, tau: f64, k: usize) -> Complex<f64> {
        let panels = 4000;
        let h = tau / panels as f64;
        let value = |s: f64| (nu * s).exp() * (tau - s).powi(k as i32) / factorial(k);
        (0..panels).fold(Complex::new(0.0, 0.0), |sum, panel| {
            let a = panel as f64 * h;
            sum + (value(a) + value(a + 0.5 * h) * 4.0 + value(a + h)) * (h / 6.0)
        })
    }

    #[test]
    fn integrals_match_quadrature_for_small_and_large_arguments() {
        for nu in [
            Complex::new(0.0, 0.0),
            Complex::new(0.0, 1e-9),
            Complex::new(0.0, 0.7),
            Complex::new(-0.4, 3.0),
            Complex::new(0.0, 40.0),
        ] {
            let tau = 0.8;
            let mut out = [Complex::new(0.0, 0.0); DERIVATIVES + 6];
            integrals(nu, tau, (nu * tau).exp(), &mut out);
            for k in 0..6 {
                let wanted = integrate_by_quadrature(nu, tau, k);
                // Simpson's rule with 4000 panels: (32 / 4000)^4 / 180 at most.
                let error = (out[DERIVATIVES + k] - wanted).norm();
                assert!(error < 3e-11 * wanted.norm(), "{nu} {k}: {error:e}");
            }
        }
    }
}
