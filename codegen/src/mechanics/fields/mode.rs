//! One mode of a uniform beam, a rod or a string: its shape, its derivatives and what they are
//! at the ends.
//!
//! phi(s) = a sin z + c cos z + f exp(-z) + g exp(z - k), z = k s, with one exponential that
//! falls from the start and one that falls from the end: the hyperbolic functions themselves
//! lose all digits from the twelfth mode or so on. The elementary functions are the project's
//! own, so that the tables have the same bits on every machine.

use eomgen_elementary::Function;
use eomgen_model_spec::model::End;

/// A mode shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// k = beta_r l
    pub(super) wavenumber: f64,
    /// a
    pub(super) sine: f64,
    /// c, which is xi_r of Eq. (17) where the beam starts clamped.
    pub(super) cosine: f64,
    /// f
    pub(super) falling: f64,
    /// g
    pub(super) rising: f64,
    /// phi^(n)/k^n at the start for n = 0 .. 3, zero where the end says so.
    pub(super) at_start: [f64; 4],
    /// The same at the end.
    pub(super) at_end: [f64; 4],
    /// The integral of phi^2, as two factors.
    pub(super) mean_square: [f64; 2],
}

impl Mode {
    /// The integral of phi, or of s phi with `power` 1: phi'''' = k^4 phi, so that integrating by
    /// parts leaves values at the ends.
    pub(super) fn moment(&self, power: u32) -> f64 {
        let k = self.wavenumber;
        match power {
            0 => (self.at_end[3] - self.at_start[3]) / k,
            _ => self.at_end[3] / k + (self.at_start[2] - self.at_end[2]) / (k * k),
        }
    }

    /// phi^(n)(s), the derivative by s.
    pub(super) fn shape(&self, derivative: u8, s: f64) -> f64 {
        let z = self.wavenumber * s;
        let (sine, cosine) = (Function::Sin.apply(&[z]), Function::Cos.apply(&[z]));
        let wave = match derivative % 4 {
            0 => self.sine * sine + self.cosine * cosine,
            1 => self.sine * cosine - self.cosine * sine,
            2 => -self.sine * sine - self.cosine * cosine,
            _ => -self.sine * cosine + self.cosine * sine,
        };
        let rising = self.rising * exponential(-self.wavenumber * (1.0 - s));
        let falling = self.falling * exponential(-z);
        let falling = if derivative.is_multiple_of(2) {
            falling
        } else {
            -falling
        };
        power(self.wavenumber, derivative) * (wave + (rising + falling))
    }
}

/// phi^(n)/k^n for n = 0 .. 3 at a kind of end, from the wave (the sum of the first two terms of
/// phi) and the exponentials there, each with its first derivative over k. An end makes two of the
/// four vanish; where both kinds of term are needed for that, they are opposite in these two and
/// equal in the other two.
pub(super) fn values_at(end: End, [w, dw]: [f64; 2], [x, dx]: [f64; 2]) -> [f64; 4] {
    match end {
        End::Clamped => [0.0, 0.0, -2.0 * w, -2.0 * dw],
        End::Pinned => [0.0, dw + dx, 0.0, dx - dw],
        End::Free => [2.0 * w, 2.0 * dw, 0.0, 0.0],
        End::Guided => [w + x, 0.0, x - w, 0.0],
    }
}

/// exp(x)
pub(super) fn exponential(x: f64) -> f64 {
    Function::Exp.apply(&[x])
}

/// A power by repeated multiplication.
pub(super) fn power(base: f64, exponent: u8) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}
