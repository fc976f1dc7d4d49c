//! Functions of the expression language in double-double arithmetic: Taylor series after reduction of the argument, and
//! one Newton step from the value in double precision. Their errors are about 1e-30 of the largest of result and
//! argument.

use std::f64::consts;

use eomgen_codegen::program::evaluator::Number;
use eomgen_model_spec::function::Function;

use super::DoubleDouble;

/// pi/2 as a sum of three numbers.
const HALF_PI: [f64; 3] = [
    consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
];
/// ln 2 as a sum of three numbers.
const LN_2: [f64; 3] = [
    consts::LN_2,
    2.319_046_813_846_299_6e-17,
    5.707_708_438_416_212e-34,
];

const ZERO: DoubleDouble = DoubleDouble::new(0.0);
const ONE: DoubleDouble = DoubleDouble::new(1.0);

/// Number of terms of the series, enough for arguments up to 0.8.
const TERMS: usize = 34;

/// Largest integer exponent for which a power is computed by multiplications.
const LARGEST_WHOLE: f64 = 64.0;

impl DoubleDouble {
    fn is_greater(self, other: Self) -> bool {
        (self - other).high > 0.0
    }

    fn half(self) -> Self {
        self * DoubleDouble::new(0.5)
    }

    /// Subtracts `count` times the sum of the three numbers `parts`.
    fn reduce(self, count: f64, parts: [f64; 3]) -> Self {
        let [first, second, third] = parts.map(|part| Self::product(count, part));
        self - first - second - third
    }

    /// Sums a power series whose term n is the previous term times x/n. `sign` multiplies every second term of the even
    /// and of the odd powers. Returns the sums of even and odd powers.
    fn series(self, sign: f64) -> [Self; 2] {
        let (mut even, mut odd) = (ZERO, ZERO);
        let mut term = ONE;
        for n in 0..TERMS {
            match n % 2 {
                0 => even += term,
                _ => odd += term,
            }
            let flip = match n % 2 {
                0 => 1.0,
                _ => sign,
            };
            term = term * self * DoubleDouble::new(flip) / DoubleDouble::new((n + 1) as f64);
        }
        [even, odd]
    }

    /// Returns sine and cosine.
    fn sine_and_cosine(self) -> [Self; 2] {
        let quarters = (self.high * consts::FRAC_2_PI).round();
        let [cosine, sine] = self.reduce(quarters, HALF_PI).series(-1.0);
        match quarters.rem_euclid(4.0) {
            0.0 => [sine, cosine],
            1.0 => [cosine, -sine],
            2.0 => [-sine, -cosine],
            _ => [-cosine, sine],
        }
    }

    fn exponential(self) -> Self {
        let doublings = (self.high * consts::LOG2_E).round();
        let [even, odd] = self.reduce(doublings, LN_2).series(1.0);
        let half = (doublings / 2.0).trunc();
        let scale = |doublings: f64| DoubleDouble::new(2.0_f64.powi(doublings as i32));
        (even + odd) * scale(half) * scale(doublings - half)
    }

    fn logarithm(self) -> Self {
        let first = DoubleDouble::new(self.high.ln());
        first + (self * (-first).exponential() - ONE)
    }

    fn square_root(self) -> Self {
        match self.high == 0.0 {
            true => ZERO,
            false => {
                let first = DoubleDouble::new(self.high.sqrt());
                first + (self - first * first) / (first + first)
            }
        }
    }

    /// Returns the polar angle of the point (`abscissa`, `self`).
    fn angle(self, abscissa: Self) -> Self {
        let first = DoubleDouble::new(self.high.atan2(abscissa.high));
        let [sine, cosine] = first.sine_and_cosine();
        let rest = self * cosine - abscissa * sine;
        first + rest / (abscissa * cosine + self * sine)
    }

    /// Returns hyperbolic sine and cosine.
    fn hyperbolic(self) -> [Self; 2] {
        if self.high.abs() < 0.5 {
            let [cosine, sine] = self.series(1.0);
            return [sine, cosine];
        }
        let (up, down) = (self.exponential(), (-self).exponential());
        [(up - down).half(), (up + down).half()]
    }

    fn whole_power(self, exponent: usize) -> Self {
        (0..exponent).fold(ONE, |power, _| power * self)
    }

    fn indicator(is_true: bool) -> Self {
        match is_true {
            true => ONE,
            false => ZERO,
        }
    }
}

impl Number for DoubleDouble {
    fn constant(value: f64) -> Self {
        DoubleDouble::new(value)
    }

    fn call(function: Function, a: Self, b: Self) -> Self {
        let smaller = |a: Self, b: Self| Self::select_greater(a, b, b, a);
        let larger = |a: Self, b: Self| Self::select_greater(a, b, a, b);
        match function {
            Function::Sin => a.sine_and_cosine()[0],
            Function::Cos => a.sine_and_cosine()[1],
            Function::Tan => {
                let [sine, cosine] = a.sine_and_cosine();
                sine / cosine
            }
            Function::Asin => a.angle(((ONE - a) * (ONE + a)).square_root()),
            Function::Acos => ((ONE - a) * (ONE + a)).square_root().angle(a),
            Function::Atan => a.angle(ONE),
            Function::Atan2 => a.angle(b),
            Function::Sinh => a.hyperbolic()[0],
            Function::Cosh => a.hyperbolic()[1],
            Function::Tanh => {
                let [sine, cosine] = a.hyperbolic();
                sine / cosine
            }
            Function::Exp => a.exponential(),
            Function::Ln => a.logarithm(),
            Function::Sqrt => a.square_root(),
            Function::Abs => larger(a, -a),
            Function::Sign => {
                Self::indicator(a.is_greater(ZERO)) - Self::indicator(ZERO.is_greater(a))
            }
            Function::Min => smaller(a, b),
            Function::Max => larger(a, b),
            Function::Deadzone => a - larger(smaller(a, b), -b),
            Function::Contact => Self::indicator(a.is_greater(b) || (-b).is_greater(a)),
            Function::Above => Self::indicator(a.is_greater(ZERO)),
        }
    }

    fn power(self, exponent: Self) -> Self {
        let size = exponent.high.abs();
        let is_whole = exponent.low == 0.0 && size.fract() == 0.0;
        match is_whole && size <= LARGEST_WHOLE {
            true if exponent.high < 0.0 => ONE / self.whole_power(size as usize),
            true => self.whole_power(size as usize),
            false if self.high == 0.0 => ZERO,
            false => (exponent * self.logarithm()).exponential(),
        }
    }

    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        match a.is_greater(b) {
            true => then,
            false => otherwise,
        }
    }

    fn positive(self) -> Self {
        match self.high > 0.0 {
            true => self,
            false => DoubleDouble::new(f64::NAN),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(function: Function, a: DoubleDouble) -> DoubleDouble {
        Number::call(function, a, a)
    }

    fn assert_small(rest: DoubleDouble, what: &str) {
        assert!(rest.high.abs() < 1e-29, "{what}: {rest:?}");
    }

    // The tolerance allows for the errors of both sides of an identity.
    #[test]
    fn identities_hold_to_29_digits() {
        for place in 1..40 {
            let x = DoubleDouble::new(0.173 * f64::from(place)) / DoubleDouble::new(3.0);
            let [sine, cosine] = [Function::Sin, Function::Cos].map(|f| call(f, x));
            assert_small(sine * sine + cosine * cosine - ONE, "circle");
            let triple = call(Function::Sin, x + x + x);
            let cube = DoubleDouble::new(3.0) * sine - DoubleDouble::new(4.0) * sine * sine * sine;
            assert_small(triple - cube, "three times the angle");
            let back = Number::call(Function::Atan2, sine, cosine);
            assert_small(call(Function::Sin, back) - sine, "angle");
            let inner = sine * DoubleDouble::new(0.9);
            assert_small(
                call(Function::Sin, call(Function::Asin, inner)) - inner,
                "asin",
            );
            assert_small(
                call(Function::Cos, call(Function::Acos, inner)) - inner,
                "acos",
            );
            assert_small(call(Function::Ln, call(Function::Exp, x)) - x, "ln");
            let power = x.power(ONE / DoubleDouble::new(3.0));
            assert_small(power * power * power - x, "cube root");
            let root = call(Function::Sqrt, x);
            assert_small(root * root - x, "root");
            let [up, down] = [Function::Sinh, Function::Cosh].map(|f| call(f, x));
            assert_small((up + down) / call(Function::Exp, x) - ONE, "hyperbolic");
        }
    }

    #[test]
    fn functions_agree_with_double_precision() {
        for function in [
            Function::Tan,
            Function::Atan,
            Function::Tanh,
            Function::Sign,
            Function::Above,
            Function::Abs,
        ] {
            for x in [-3.0, -0.7, 0.0, 0.2, 1.1, 40.0] {
                let expected: f64 = Number::call(function, x, x);
                let found = call(function, DoubleDouble::new(x));
                assert!(
                    (found.high - expected).abs() <= 1e-15 * expected.abs(),
                    "{function:?} at {x}: {found:?}, not {expected}"
                );
            }
        }
        for (p, b) in [(0.5, 1.0), (3.0, 1.0), (-3.0, 1.0), (1.0, 1.0)] {
            for function in [
                Function::Deadzone,
                Function::Contact,
                Function::Min,
                Function::Max,
            ] {
                let expected: f64 = Number::call(function, p, b);
                let found =
                    DoubleDouble::call(function, DoubleDouble::new(p), DoubleDouble::new(b));
                assert_eq!(
                    found,
                    DoubleDouble::new(expected),
                    "{function:?} of {p} and {b}"
                );
            }
        }
    }
}
