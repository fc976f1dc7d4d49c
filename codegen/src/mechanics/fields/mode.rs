//! Mode of a uniform beam, a rod or a string: shape, derivatives and end values.
//!
//! phi(s) = a sin z + c cos z + f exp(-z) + g exp(z - k), z = k s. One exponential decays from the start and one from
//! the end, because hyperbolic functions lose all digits from about the twelfth mode on. The project's own elementary
//! functions make the tables bit-identical on all machines.

use eomgen_elementary::Function;
use eomgen_model_spec::model::End;

#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// Wave number k = beta_r l.
    pub(super) wavenumber: f64,
    /// Amplitude a of the sine.
    pub(super) sine: f64,
    /// Amplitude c of the cosine; xi_r of Eq. (17) of the paper for a clamped start.
    pub(super) cosine: f64,
    /// Amplitude f of the exponential that decays from the start.
    pub(super) falling: f64,
    /// Amplitude g of the exponential that decays from the end.
    pub(super) rising: f64,
    /// phi^(n)/k^n at the start for n = 0 .. 3; exactly zero if the end condition requires it.
    pub(super) at_start: [f64; 4],
    /// phi^(n)/k^n at the end.
    pub(super) at_end: [f64; 4],
    /// Integral of phi^2, as two factors.
    pub(super) mean_square: [f64; 2],
}

impl Mode {
    /// Returns the integral of s^power phi for `power` 0 or 1. Because phi'''' = k^4 phi, integration by parts leaves
    /// only end values.
    pub(super) fn compute_moment(&self, power: u32) -> f64 {
        let k = self.wavenumber;
        match power {
            0 => (self.at_end[3] - self.at_start[3]) / k,
            _ => self.at_end[3] / k + (self.at_start[2] - self.at_end[2]) / (k * k),
        }
    }

    /// Returns phi^(n)(s), the n-th derivative with respect to s.
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

/// Returns phi^(n)/k^n for n = 0 .. 3 at an end. The arguments are the wave (the first two terms of phi) and the
/// exponentials at this end, each with its first derivative divided by k. The boundary condition makes two of the
/// four values zero. If wave and exponentials both contribute, they cancel in these two and are equal in the other
/// two.
pub(super) fn values_at(end: End, [w, dw]: [f64; 2], [x, dx]: [f64; 2]) -> [f64; 4] {
    match end {
        End::Clamped => [0.0, 0.0, -2.0 * w, -2.0 * dw],
        End::Pinned => [0.0, dw + dx, 0.0, dx - dw],
        End::Free => [2.0 * w, 2.0 * dw, 0.0, 0.0],
        End::Guided => [w + x, 0.0, x - w, 0.0],
    }
}

pub(super) fn exponential(x: f64) -> f64 {
    Function::Exp.apply(&[x])
}

pub(super) fn power(base: f64, exponent: u8) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}
