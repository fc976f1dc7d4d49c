//! Mode shapes of the clamped-free beam in the normalisation of the paper, Eq. (17), and their
//! integrals.
//!
//! All quantities are dimensionless: s = x/l runs from 0 to 1, z = beta l, and derivatives are by s. The growing
//! exponential is stored as exp(-z (1 - s)) to keep the accuracy of high modes.
//!
//! Source: Blevins, "Formulas for natural frequency and mode shape", clamped-free beam.

use std::f64::consts::PI;

/// Shape phi(s) = sin zs - sinh zs + xi (cos zs - cosh zs).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeShape {
    /// beta l.
    pub beta_l: f64,
    /// xi of Eq. (19).
    pub xi: f64,
    /// Factor (1 + xi) exp(beta l) of exp(-z (1 - s)).
    growing: f64,
}

/// Integrals over one shape on the unit span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalIntegrals {
    /// Integral of phi^2.
    pub phi_squared: f64,
    /// Integral of s phi.
    pub s_phi: f64,
    /// Integral of (d^2 phi/ds^2)^2.
    pub curvature_squared: f64,
}

impl ModeShape {
    /// Computes mode `r` (counted from 1) of the clamped-free beam: beta_r l is the r-th root of
    /// cos z cosh z = -1 and xi_r = -(sin z + sinh z)/(cos z + cosh z).
    pub fn clamped_free(r: usize) -> Self {
        let z = clamped_free_root(r);
        let decay = (-z).exp();
        // (cos z + cosh z) exp(-z) and (sin z + sinh z) exp(-z) remain of order 1.
        let cosines = decay * z.cos() + 0.5 * (1.0 + decay * decay);
        let sines = decay * z.sin() + 0.5 * (1.0 - decay * decay);
        Self {
            beta_l: z,
            xi: -sines / cosines,
            growing: (z.cos() - z.sin() + decay) / cosines,
        }
    }

    /// Creates the shape of Eq. (17) with any `beta_l` and `xi`. If the values do not satisfy the boundary conditions,
    /// the shape grows like exp(beta l).
    pub fn with_values(beta_l: f64, xi: f64) -> Self {
        Self {
            beta_l,
            xi,
            growing: (1.0 + xi) * beta_l.exp(),
        }
    }

    /// Computes the derivative of order `derivative` (0 to 3, higher ones repeat with z^4) of phi
    /// by s, for `s` in 0..=1.
    pub fn derivative(&self, derivative: u32, s: f64) -> f64 {
        let z = self.beta_l;
        let (sin, cos) = (z * s).sin_cos();
        // The derivatives of sin + xi cos repeat after four.
        let oscillating = match derivative % 4 {
            0 => sin + self.xi * cos,
            1 => cos - self.xi * sin,
            2 => -sin - self.xi * cos,
            _ => -cos + self.xi * sin,
        };
        let growing = -0.5 * self.growing * (-z * (1.0 - s)).exp();
        let decaying = 0.5 * (1.0 - self.xi) * (-z * s).exp();
        let alternating = if derivative.is_multiple_of(2) {
            decaying
        } else {
            -decaying
        };
        z.powi(derivative as i32) * (oscillating + growing + alternating)
    }

    /// Computes phi for `s` in 0..=1.
    pub fn value(&self, s: f64) -> f64 {
        self.derivative(0, s)
    }

    /// Returns the integrals of a shape with correct boundary conditions in closed form: xi^2, -2
    /// xi/z^2 and z^4 xi^2 (from phi'''' = z^4 phi and partial integration).
    pub fn integrals(&self) -> ModalIntegrals {
        let phi_squared = self.xi * self.xi;
        ModalIntegrals {
            phi_squared,
            s_phi: -2.0 * self.xi / (self.beta_l * self.beta_l),
            curvature_squared: self.beta_l.powi(4) * phi_squared,
        }
    }
}

/// Computes the r-th positive root of cos z cosh z = -1. Newton's method iterates on the distance
/// from pi (r - 1/2), which keeps the digits of the small distance.
fn clamped_free_root(r: usize) -> f64 {
    let centre = (r as f64 - 0.5) * PI;
    let sign = if r.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut distance: f64 = 0.0;
    for _ in 0..50 {
        let z = centre + distance;
        let residual = distance.sin() + sign / z.cosh();
        let slope = distance.cos() - sign * z.tanh() / z.cosh();
        let correction = residual / slope;
        distance -= correction;
        if correction.abs() <= f64::EPSILON * distance.abs() {
            break;
        }
    }
    centre + distance
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published roots (Blevins, table 8-1; fifteen digits from the same equation).
    const ROOTS: [f64; 4] = [
        1.875_104_068_711_961,
        4.694_091_132_974_175,
        7.854_757_438_237_613,
        10.995_540_734_875_467,
    ];

    /// Positive nodes and weights of the eight-point Gauss-Legendre rule on -1..1
    /// (Abramowitz and Stegun, table 25.4).
    const GAUSS_8: [(f64, f64); 4] = [
        (0.183_434_642_495_649_8, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887_3),
        (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
        (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    ];

    /// Computes the integrals by Gauss-Legendre quadrature with eight points per half wave (error
    /// below 1e-12 of the integral of the squares).
    fn integrals_by_quadrature(shape: &ModeShape) -> ModalIntegrals {
        let panels = 2 * (shape.beta_l / PI).ceil() as usize + 2;
        let width = 1.0 / panels as f64;
        let mean = |f: &dyn Fn(f64) -> f64| -> f64 {
            let panel_sum = |panel: usize| -> f64 {
                let middle = (panel as f64 + 0.5) * width;
                let pair = |(node, weight): (f64, f64)| {
                    let offset = 0.5 * width * node;
                    0.5 * width * weight * (f(middle + offset) + f(middle - offset))
                };
                GAUSS_8.into_iter().map(pair).sum()
            };
            (0..panels).map(panel_sum).sum()
        };
        ModalIntegrals {
            phi_squared: mean(&|s| shape.value(s).powi(2)),
            s_phi: mean(&|s| s * shape.value(s)),
            curvature_squared: mean(&|s| shape.derivative(2, s).powi(2)),
        }
    }

    #[test]
    fn roots_match_published_values() {
        for (r, root) in (1..).zip(ROOTS) {
            let own = ModeShape::clamped_free(r).beta_l;
            // The tolerance is one unit in the last published digit.
            assert!(
                (own - root).abs() <= 1e-15 * root,
                "mode {r}: {own} and {root}"
            );
        }
    }

    #[test]
    fn shapes_satisfy_the_boundary_conditions() {
        for r in [1, 2, 5, 12, 40, 128] {
            let shape = ModeShape::clamped_free(r);
            // The phase z s has a rounding error of z eps; each derivative multiplies by z.
            let rounding = 4.0 * f64::EPSILON * shape.beta_l;
            for (derivative, s) in [(0, 0.0), (1, 0.0), (2, 1.0), (3, 1.0)] {
                let value = shape.derivative(derivative, s) / shape.beta_l.powi(derivative as i32);
                assert!(
                    value.abs() <= rounding,
                    "mode {r}, derivative {derivative}: {value}"
                );
            }
        }
    }

    #[test]
    fn closed_forms_match_quadrature() {
        for r in [1, 2, 3, 7, 20, 64, 128] {
            let shape = ModeShape::clamped_free(r);
            let (exact, sum) = (shape.integrals(), integrals_by_quadrature(&shape));
            // The tolerance allows for the rounding of the phase, z eps, and of about a thousand summands.
            let tolerance = 1e-13 + 4.0 * f64::EPSILON * shape.beta_l;
            assert!((exact.phi_squared - sum.phi_squared).abs() <= tolerance * exact.phi_squared);
            // s phi oscillates, so its sum is compared with the size of its summands.
            assert!((exact.s_phi - sum.s_phi).abs() <= tolerance);
            let curvature = exact.curvature_squared;
            assert!((curvature - sum.curvature_squared).abs() <= tolerance * curvature);
        }
    }

    #[test]
    fn derivatives_match_differences() {
        let shape = ModeShape::clamped_free(3);
        let step = 1e-4;
        for derivative in 0..3 {
            for s in [0.1, 0.45, 0.8] {
                let difference = (shape.derivative(derivative, s + step)
                    - shape.derivative(derivative, s - step))
                    / (2.0 * step);
                let exact = shape.derivative(derivative + 1, s);
                // Truncation error of the central difference: (z step)^2/6 of the derivative.
                let scale = shape.beta_l.powi(derivative as i32 + 1);
                assert!((difference - exact).abs() <= 1e-6 * scale);
            }
        }
    }
}
