//! Interval arithmetic: bounds of an expression over all values of its variables.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::evaluate::call;
use crate::model::Function;

/// Closed interval; the ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Relative widening of every result: a few rounding errors.
const ROUNDING: f64 = 1e-15;

impl Interval {
    /// All real numbers.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Returns the interval between two ends, widened by a few rounding errors. If an end is NaN,
    /// returns [`Interval::ALL`].
    pub fn between(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self {
            low: low - ROUNDING * low.abs(),
            high: high + ROUNDING * high.abs(),
        }
    }

    /// Returns the bounds of a sum.
    pub fn plus(self, other: Self) -> Self {
        Self::between(self.low + other.low, self.high + other.high)
    }

    /// Returns the bounds of the negated value.
    pub fn negated(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }

    /// Returns the bounds of a product.
    pub fn times(self, other: Self) -> Self {
        // 0 times an unbounded number is 0.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let ends = [
            product(self.low, other.low),
            product(self.low, other.high),
            product(self.high, other.low),
            product(self.high, other.high),
        ];
        let low = ends.into_iter().fold(f64::INFINITY, f64::min);
        let high = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self::between(low, high)
    }

    /// Returns the bounds of the reciprocal; all numbers if the interval contains 0.
    pub fn reciprocal(self) -> Self {
        if self.low > 0.0 || self.high < 0.0 {
            Self::between(1.0 / self.high, 1.0 / self.low)
        } else {
            Self::ALL
        }
    }

    /// Returns the smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Returns the bounds of the power with a constant exponent, over the values at which it is
    /// defined.
    pub fn power(self, exponent: f64) -> Self {
        let raised = |x: f64| x.powf(exponent);
        if exponent < 0.0 {
            return self.power(-exponent).reciprocal();
        }
        match (exponent.fract() == 0.0, exponent % 2.0 == 0.0) {
            (true, true) => self.magnitude().rising((0.0, f64::INFINITY), raised),
            (true, false) => self.rising((f64::NEG_INFINITY, f64::INFINITY), raised),
            // Undefined for negative numbers.
            (false, _) => self.rising((0.0, f64::INFINITY), raised),
        }
    }

    /// Returns the bounds of a function of one or two arguments, over the values at which it is
    /// defined.
    pub fn of_function(function: Function, arguments: &[Self]) -> Self {
        match arguments {
            [only] => only.of_one(function),
            [first, second] => Self::of_two(function, *first, *second),
            _ => Self::ALL,
        }
    }

    fn magnitude(self) -> Self {
        let high = self.low.abs().max(self.high.abs());
        let low = if self.low > 0.0 || self.high < 0.0 {
            self.low.abs().min(self.high.abs())
        } else {
            0.0
        };
        Self { low, high }
    }

    /// Returns the image under a non-decreasing function with the domain `from..=to`.
    fn rising(self, (from, to): (f64, f64), function: impl Fn(f64) -> f64) -> Self {
        let end = |x: f64| function(x.clamp(from, to));
        Self::between(end(self.low), end(self.high))
    }

    fn of_one(self, function: Function) -> Self {
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        let value = |x: f64| call(function, x, f64::NAN);
        match function {
            Function::Sin | Function::Cos => Self::between(-1.0, 1.0),
            Function::Asin => self.rising((-1.0, 1.0), value),
            Function::Acos => Self::between(0.0, PI),
            Function::Atan | Function::Sinh | Function::Tanh | Function::Exp => {
                self.rising(everywhere, value)
            }
            Function::Cosh => self.magnitude().rising((0.0, f64::INFINITY), value),
            Function::Ln | Function::Sqrt => self.rising((0.0, f64::INFINITY), value),
            Function::Abs => self.magnitude(),
            // The value at infinity equals that of a large number.
            Function::Sign | Function::Above => self.rising((f64::MIN, f64::MAX), value),
            _ => Self::ALL,
        }
    }

    fn of_two(function: Function, x: Self, y: Self) -> Self {
        match function {
            Function::Atan2 => Self::between(-PI - FRAC_PI_2 * ROUNDING, PI),
            Function::Min => Self::between(x.low.min(y.low), x.high.min(y.high)),
            Function::Max => Self::between(x.low.max(y.low), x.high.max(y.high)),
            Function::Deadzone => {
                // The half-width moves the argument towards 0, but not past it.
                let width = y.low.max(0.0);
                Self::between((x.low + width).min(0.0), (x.high - width).max(0.0))
            }
            Function::Contact => Self::between(0.0, 1.0),
            _ => Self::ALL,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_contain_values_at_the_ends_and_between() {
        let x = Interval::between(-2.0, 3.0);
        let images: [(Interval, &dyn Fn(f64) -> f64); 6] = [
            (x.power(2.0), &|x| x * x),
            (x.power(3.0), &|x| x.powi(3)),
            (x.times(x.negated()), &|x| -x * x),
            (x.plus(Interval::between(5.0, 5.0)).power(-1.0), &|x| {
                1.0 / (x + 5.0)
            }),
            (Interval::of_function(Function::Cosh, &[x]), &|x| x.cosh()),
            (Interval::of_function(Function::Sign, &[x]), &|x| {
                call(Function::Sign, x, 0.0)
            }),
        ];
        for (place, (bounds, function)) in images.iter().enumerate() {
            for step in 0..=50 {
                let value = function(-2.0 + 0.1 * f64::from(step));
                assert!(
                    bounds.low <= value && value <= bounds.high,
                    "{place}: {value} {bounds:?}"
                );
            }
        }
        assert_eq!(x.power(2.0).low, 0.0);
        assert_eq!(x.reciprocal(), Interval::ALL);
    }

    #[test]
    fn unbounded_arguments_keep_the_range_of_functions() {
        let square = Interval::ALL.power(2.0);
        assert_eq!((square.low, square.high), (0.0, f64::INFINITY));
        let sine = Interval::of_function(Function::Sin, &[Interval::ALL]);
        assert!(sine.low < -0.999 && sine.high > 0.999 && sine.high < 1.001);
        assert_eq!(Interval::ALL.plus(Interval::ALL), Interval::ALL);
    }
}
