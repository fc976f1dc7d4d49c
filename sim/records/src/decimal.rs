//! Decimal numbers without rounding, for small differences of large numbers.

/// Number of significant digits that any decimal number keeps when it is converted to a double and back.
const DIGITS_OF_DOUBLE: u32 = 15;

/// Powers of ten up to this exponent are exact doubles.
const MAX_EXACT_POWER: u32 = 22;

/// The number `digits` times ten to the power of `exponent`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Decimal {
    digits: i128,
    exponent: i32,
}

impl Decimal {
    /// Reads a finite number; `None` for other text and for more digits than an integer of 128 bits holds.
    pub fn parse(text: &str) -> Option<Self> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse().ok()?),
            None => (text, 0_i32),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let fraction = fraction.trim_end_matches('0');
        let digits = format!("{whole}{fraction}").parse().ok()?;
        let places = i32::try_from(fraction.len()).ok()?;
        Some(Self {
            digits,
            exponent: exponent.checked_sub(places)?,
        })
    }

    /// Returns the shortest decimal number that rounds to a double; `None` if the double is not finite.
    pub fn from_double(value: f64) -> Option<Self> {
        Self::parse(&format!("{value:e}"))
    }

    pub fn from_integer(value: i64) -> Self {
        Self {
            digits: value.into(),
            exponent: 0,
        }
    }

    /// Returns the double nearest to the difference; `None` if its digits overflow.
    pub fn subtract(self, other: Self) -> Option<f64> {
        if other.digits == 0 {
            return Some(self.to_double());
        }
        let exponent = self.exponent.min(other.exponent);
        let align = |number: Self| {
            let places = u32::try_from(number.exponent.checked_sub(exponent)?).ok()?;
            number.digits.checked_mul(10_i128.checked_pow(places)?)
        };
        let digits = align(self)?.checked_sub(align(other)?)?;
        let difference = Self { digits, exponent };
        Some(difference.to_double())
    }

    fn to_double(self) -> f64 {
        let places = self.exponent.unsigned_abs();
        if self.exponent <= 0
            && places <= MAX_EXACT_POWER
            && self.digits.unsigned_abs() < 1 << f64::MANTISSA_DIGITS
        {
            return self.digits as f64 / 10_f64.powi(places as i32);
        }
        let text = format!("{}e{}", self.digits, self.exponent);
        text.parse().unwrap_or(f64::NAN)
    }

    /// Returns true if the number has so many digits that it may come from a rounded double.
    pub fn may_be_rounded(self) -> bool {
        let mut digits = self.digits.unsigned_abs();
        while digits > 0 && digits.is_multiple_of(10) {
            digits /= 10;
        }
        digits >= 10_u128.pow(DIGITS_OF_DOUBLE)
    }
}

#[cfg(test)]
mod tests {
    use super::Decimal;

    #[test]
    fn differences_are_those_of_the_written_digits() {
        for (a, b, difference) in [
            ("1700000000.005", "1700000000.0000", 0.005),
            ("1700000000.123456789", "1700000000", 0.123_456_789),
            ("1700000000000000100", "1700000000000000001", 99.0),
            ("1.700000000005e9", "+1.7E9", 0.005),
            ("-.5", "1.", -1.5),
            ("-0.25", "-1e-30", -0.25),
            ("1e300", "0", 1e300),
        ] {
            let [a, b] = [a, b].map(|text| Decimal::parse(text).expect("a number"));
            assert_eq!(a.subtract(b), Some(difference), "{a:?} {b:?}");
        }
        for text in ["", "x", "nan", "inf", "1e", "1.-5", "--1"] {
            assert_eq!(Decimal::parse(text), None, "{text}");
        }
    }

    #[test]
    fn doubles_become_their_shortest_decimal_number() {
        let [a, b] = [1_700_000_000.005, 1.7e9].map(|v| Decimal::from_double(v).expect("finite"));
        assert_eq!(a.subtract(b), Some(0.005));
        assert!(!a.may_be_rounded());
        assert!(
            Decimal::from_double(0.1 + 0.2)
                .expect("finite")
                .may_be_rounded()
        );
        assert_eq!(Decimal::from_double(f64::NAN), None);
    }
}
