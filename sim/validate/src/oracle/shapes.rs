//! Mode shapes of a uniform clamped-free beam, Eq. (17), with exact frequencies or with
//! Eq. (18) and (19) as printed. Own formulas and own roots: the derivation has its own,
//! and the two must meet only in the result.
//!
//! phi_r = (sin u - sinh u) + xi_r (cos u - cosh u), u = z_r s, s = x/l, is evaluated as
//!
//! ```text
//! sin u + xi cos u + (1 - xi)/2 exp(-u) - growing exp(-(z - u))
//! ```
//!
//! so that nothing cancels for large z. The phase is (r - 1/2) pi s + delta_r s with a
//! small delta_r, its first part reduced exactly before it is multiplied by pi.

use super::double_double::DoubleDouble;
use eomgen_model_spec::model::Basis;
use std::f64::consts::PI;

/// Mode r of a beam of unit length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// r - 1/2.
    half_waves: f64,
    /// z_r - (r - 1/2) pi.
    delta: f64,
    /// z_r = beta_r l.
    root: f64,
    /// xi_r of Eq. (17).
    xi: f64,
    /// (1 + xi)/2 exp(z), the factor of exp(-(z - u)).
    growing: f64,
}

impl Shape {
    /// Mode `r`, counted from 1, of `basis`.
    pub fn new(basis: Basis, r: usize) -> Self {
        match basis {
            Basis::ClampedFree => Self::exact(r),
            Basis::ClampedFreePrinted => Self::printed(r),
        }
    }

    /// cos z cosh z = -1 with z = (r - 1/2) pi + delta reads
    /// sin delta = (-1)^(r+1)/cosh z; then cos z = -1/cosh z and
    /// sin z = (-1)^(r+1) tanh z, which is what xi is built from.
    fn exact(r: usize) -> Self {
        let half_waves = r as f64 - 0.5;
        let sign = if r.is_multiple_of(2) { -1.0 } else { 1.0 };
        let mut delta: f64 = 0.0;
        for _ in 0..60 {
            let z = half_waves * PI + delta;
            let value = delta.sin() - sign / z.cosh();
            let slope = delta.cos() + sign * z.tanh() / z.cosh();
            delta -= value / slope;
        }
        let root = half_waves * PI + delta;
        let decay = (-root).exp();
        let (sine, cosine) = (sign * root.tanh(), -1.0 / root.cosh());
        let divisor = 2.0 * sine * decay - 1.0 + decay * decay;
        Self {
            half_waves,
            delta,
            root,
            xi: (2.0 * cosine * decay + 1.0 + decay * decay) / divisor,
            growing: (sine + cosine + decay) / divisor,
        }
    }

    /// Eq. (18): z = (r - 1/2) pi, so cos z = 0 and sin z = (-1)^(r+1); Eq. (19) with
    /// its printed sign, so that (1 + xi)/2 tends to 1 and exp(u) stays.
    fn printed(r: usize) -> Self {
        let half_waves = r as f64 - 0.5;
        let sign = if r.is_multiple_of(2) { -1.0 } else { 1.0 };
        let root = half_waves * PI;
        let decay = (-root).exp();
        let xi = (1.0 + decay * decay) / (2.0 * sign * decay + 1.0 - decay * decay);
        Self {
            half_waves,
            delta: 0.0,
            root,
            xi,
            growing: 0.5 * (1.0 + xi) * root.exp(),
        }
    }

    /// The derivative of order `derivative` of phi by s at `position` in [0, 1].
    pub fn derivative(&self, derivative: u8, position: DoubleDouble) -> f64 {
        let s = position.high;
        let (sine, cosine) = self.sine_cosine(position);
        let (sine_part, cosine_part) = match derivative % 4 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        };
        let remaining = (1.0 - s) - position.low;
        let parity = if derivative.is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let decaying = parity * 0.5 * (1.0 - self.xi) * (-self.root * s).exp();
        let growing = self.growing * (-self.root * remaining).exp();
        let value = (sine_part + self.xi * cosine_part) + (decaying - growing);
        value * self.root.powi(i32::from(derivative))
    }

    /// sin and cos of z s: the turns (r - 1/2) s / 2 are reduced exactly, the rest is a
    /// small angle, so the error does not grow with r.
    fn sine_cosine(&self, position: DoubleDouble) -> (f64, f64) {
        let half_turns = DoubleDouble::product(self.half_waves, position.high);
        let quarter_turns = (2.0 * half_turns.high).round();
        let reduced = (half_turns.high - 0.5 * quarter_turns)
            + (half_turns.low + self.half_waves * position.low);
        let (sine, cosine) = (PI * reduced + self.delta * position.high).sin_cos();
        match quarter_turns.rem_euclid(4.0) as u8 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::legendre::unit_rule;
    use super::*;

    const ONE: DoubleDouble = DoubleDouble {
        high: 1.0,
        low: 0.0,
    };

    #[test]
    fn the_first_roots_are_the_textbook_ones() {
        let roots = [
            1.875_104_068_711_961_2,
            4.694_091_132_974_175,
            7.854_757_438_237_613,
        ];
        for (index, root) in roots.iter().enumerate() {
            let shape = Shape::new(Basis::ClampedFree, index + 1);
            assert!((shape.root - root).abs() < 4e-15, "{}", shape.root);
        }
    }

    #[test]
    fn the_exact_shapes_satisfy_the_ends_and_the_printed_ones_do_not() {
        for r in [1, 2, 3, 12, 64, 128] {
            let shape = Shape::new(Basis::ClampedFree, r);
            let clamp = DoubleDouble::new(0.0);
            for (derivative, end) in [(0, clamp), (1, clamp), (2, ONE), (3, ONE)] {
                let scaled = shape.derivative(derivative, end) / shape.root.powi(derivative.into());
                assert!(
                    scaled.abs() < 1e-15,
                    "r = {r}, derivative {derivative}: {scaled}"
                );
            }
        }
        let printed = Shape::new(Basis::ClampedFreePrinted, 1);
        assert!((printed.derivative(2, ONE) / printed.root.powi(2)).abs() > 1.0);
    }

    #[test]
    fn the_rule_finds_the_shapes_orthogonal_up_to_the_highest_order() {
        let rule = unit_rule(4 * 64 + 40);
        for (r, k) in [(1, 2), (1, 64), (63, 64), (30, 41)] {
            let (left, right) = (
                Shape::new(Basis::ClampedFree, r),
                Shape::new(Basis::ClampedFree, k),
            );
            let product: f64 = rule
                .iter()
                .map(|node| {
                    node.weight
                        * left.derivative(0, node.position)
                        * right.derivative(0, node.position)
                })
                .sum();
            assert!(product.abs() < 1e-15, "modes {r} and {k}: {product}");
        }
    }

    #[test]
    fn the_first_moment_is_right_to_thirteen_digits_at_every_mode() {
        // int_0^1 s phi ds = 2/z^2 in magnitude: phi'''' = z^4 phi integrated by parts.
        let rule = unit_rule(4 * 128 + 40);
        for r in [1, 8, 64, 128] {
            let shape = Shape::new(Basis::ClampedFree, r);
            let moment: f64 = rule
                .iter()
                .map(|node| node.weight * node.position.high * shape.derivative(0, node.position))
                .sum();
            let exact = 2.0 * shape.xi / shape.root.powi(2);
            // The addends are of size 1/552 and the moment of size 2/z^2.
            let tolerance = 1e-14_f64.max(2e-17 * shape.root.powi(2));
            assert!(
                (moment / exact + 1.0).abs() < tolerance,
                "r = {r}: {moment} {exact}"
            );
        }
    }
}
