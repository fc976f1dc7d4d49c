//! Sine, cosine and exponential of double-double numbers, for arguments up to some hundreds.
//!
//! The argument is reduced by a multiple of pi/2 or ln 2, which are constants of 106 bits. For an argument x, the
//! reduced argument has an absolute error of about |x| 2^-107, like x itself.

use super::double_double::DoubleDouble;
use super::scalar::Scalar;

const PI: DoubleDouble = DoubleDouble {
    high: std::f64::consts::PI,
    low: 1.224_646_799_147_353_2e-16,
};

const LN_2: DoubleDouble = DoubleDouble {
    high: std::f64::consts::LN_2,
    low: 2.319_046_813_846_3e-17,
};

/// Number of terms of the series: the last is below 2^-110 for arguments up to pi/4.
const TERMS: u32 = 28;

/// Returns the sum of x^k/k! over k = `first`, `first` + `stride`, ..., with the sign of successive
/// terms multiplied by `sign`.
fn series(x: DoubleDouble, first: u32, stride: u32, sign: f64) -> DoubleDouble {
    let power = if stride == 2 { x * x } else { x };
    let mut term = if first == 0 {
        DoubleDouble::exactly(1.0)
    } else {
        x
    };
    let mut sum = term;
    let mut k = first;
    while k < TERMS {
        let below = ((k + 1)..=(k + stride)).map(f64::from).product::<f64>();
        term = (term * power).times(sign) / DoubleDouble::exactly(below);
        sum = sum + term;
        k += stride;
    }
    sum
}

impl Scalar for DoubleDouble {
    const EPSILON: f64 = f64::EPSILON * f64::EPSILON;
    const DEGREE: usize = 48;
    const PI: Self = PI;

    fn from_f64(value: f64) -> Self {
        Self::exactly(value)
    }

    fn to_f64(self) -> f64 {
        self.high
    }

    fn scaled_by(self, factor: f64) -> Self {
        self.times(factor)
    }

    fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.high / PI.times(0.5).high).round();
        let rest = self - PI.times(0.5 * quarters);
        let (sin, cos) = (series(rest, 1, 2, -1.0), series(rest, 0, 2, -1.0));
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    fn exp(self) -> Self {
        let doublings = (self.high / LN_2.high).round();
        let rest = self - LN_2.times(doublings);
        series(rest, 0, 1, 1.0).times(doublings.exp2())
    }
}
