//! Exact factor between a unit and its coherent SI unit: a rational number times a power of pi. Decimal factors such
//! as 0.001 are not exact in double precision, so 9 mm is computed as 9/1000, not as 9 * 0.001.

use num_rational::Ratio;
use num_traits::{CheckedDiv, CheckedMul, One};

/// Pi as a sum of two doubles, to 32 digits.
const PI_HIGH: f64 = std::f64::consts::PI;
const PI_LOW: f64 = 1.224_646_799_147_353_2e-16;

/// Positive factor `fraction * pi^pi_power`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    fraction: Ratio<i128>,
    pi_power: i32,
}

impl Scale {
    pub const ONE: Self = Self {
        fraction: Ratio::new_raw(1, 1),
        pi_power: 0,
    };

    /// Returns the factor `numerator / denominator`; `None` if either is not positive.
    pub fn fraction(numerator: i128, denominator: i128) -> Option<Self> {
        (numerator > 0 && denominator > 0).then(|| Self {
            fraction: Ratio::new(numerator, denominator),
            pi_power: 0,
        })
    }

    /// Factor pi/180 between degree and radian.
    pub const DEGREE: Self = Self {
        fraction: Ratio::new_raw(1, 180),
        pi_power: 1,
    };

    /// Returns `10^exponent`; `None` if the magnitude of the exponent exceeds 38.
    pub fn power_of_ten(exponent: i32) -> Option<Self> {
        let magnitude = 10_i128.checked_pow(exponent.unsigned_abs())?;
        if exponent < 0 {
            Self::fraction(1, magnitude)
        } else {
            Self::fraction(magnitude, 1)
        }
    }

    /// Returns the product; `None` if it is not exact.
    pub fn multiply(self, other: Self) -> Option<Self> {
        Some(Self {
            fraction: self.fraction.checked_mul(&other.fraction)?,
            pi_power: self.pi_power.checked_add(other.pi_power)?,
        })
    }

    /// Returns the integer power; `None` if it is not exact.
    pub fn raise(self, exponent: i32) -> Option<Self> {
        if exponent.unsigned_abs() > 64 {
            return (self == Self::ONE).then_some(self);
        }
        let mut result = Self::ONE;
        for _ in 0..exponent.unsigned_abs() {
            result = result.multiply(self)?;
        }
        if exponent < 0 {
            result.inverse()
        } else {
            Some(result)
        }
    }

    fn inverse(self) -> Option<Self> {
        Some(Self {
            fraction: Ratio::one().checked_div(&self.fraction)?,
            pi_power: self.pi_power.checked_neg()?,
        })
    }

    /// Returns `value` times this factor: correctly rounded for factors such as 1000, 1/1000 or
    /// 1/60, else within one unit in the last place.
    pub fn apply(self, value: f64) -> f64 {
        if self == Self::ONE {
            return value;
        }
        let numerator = *self.fraction.numer() as f64;
        let denominator = *self.fraction.denom() as f64;
        let mut result = DoubleDouble::product(value, numerator);
        for _ in 0..self.pi_power.unsigned_abs() {
            result = if self.pi_power > 0 {
                result.multiply(PI_HIGH, PI_LOW)
            } else {
                result.over(PI_HIGH, PI_LOW)
            };
        }
        result.over(denominator, 0.0).value()
    }

    /// Returns `value` divided by this factor, with the rounding of [`Scale::apply`].
    pub fn remove(self, value: f64) -> f64 {
        self.inverse()
            .map_or(f64::NAN, |inverse| inverse.apply(value))
    }
}

/// Number with about twice the precision, stored as an unevaluated sum of two numbers.
#[derive(Clone, Copy)]
struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    fn product(left: f64, right: f64) -> Self {
        let high = left * right;
        let low = left.mul_add(right, -high);
        Self { high, low }
    }

    fn multiply(self, high: f64, low: f64) -> Self {
        let leading = Self::product(self.high, high);
        let low = leading.low + self.high * low + self.low * high;
        Self {
            high: leading.high,
            low,
        }
    }

    fn over(self, high: f64, low: f64) -> Self {
        let quotient = self.high / high;
        let rest = (-quotient).mul_add(high, self.high) + self.low - quotient * low;
        Self {
            high: quotient,
            low: rest / high,
        }
    }

    /// Returns the nearest `f64`, or only the leading part if the other part overflowed.
    fn value(self) -> f64 {
        if self.low.is_finite() {
            self.high + self.low
        } else {
            self.high
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_factors_round_once() {
        let milli = Scale::power_of_ten(-3).unwrap();
        assert_eq!(milli.apply(3.0), 0.003);
        assert_eq!(milli.apply(-0.7), -0.7 / 1000.0);
        assert_eq!(Scale::power_of_ten(-6).unwrap().apply(25.0), 25e-6);
        assert_eq!(Scale::power_of_ten(9).unwrap().apply(200.0), 2e11);
    }

    #[test]
    fn degrees_are_correctly_rounded() {
        // Reference: the double nearest 24.6 times pi/180, to 40 digits:
        // 0.4293509959906051007258483593...
        assert_eq!(Scale::DEGREE.apply(24.6), 0.429_350_995_990_605_1);
        assert_eq!(Scale::DEGREE.apply(180.0), std::f64::consts::PI);
        assert_eq!(Scale::DEGREE.remove(std::f64::consts::PI), 180.0);
    }

    #[test]
    fn powers_beyond_the_exact_range_are_rejected() {
        let tera = Scale::power_of_ten(12).unwrap();
        assert_eq!(tera.raise(3), Scale::power_of_ten(36));
        assert_eq!(tera.raise(4), None);
        assert_eq!(Scale::power_of_ten(39), None);
    }

    #[test]
    fn zero_and_non_finite_values_are_preserved() {
        let kilo = Scale::power_of_ten(3).unwrap();
        assert_eq!(kilo.apply(0.0), 0.0);
        assert_eq!(kilo.apply(f64::MAX), f64::INFINITY);
        assert_eq!(kilo.apply(f64::INFINITY), f64::INFINITY);
        assert!(kilo.apply(f64::NAN).is_nan());
    }
}
