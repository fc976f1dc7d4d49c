//! Interval arithmetic: bounds of an expression over all values of its variables.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::function::{Function, call};

/// Closed interval. Its ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Relative widening of every result: a few rounding errors.
const ROUNDING: f64 = 1e-15;

/// Returns the amount by which an end is widened: a few rounding errors, and at least the smallest positive number
/// unless the end is exactly 0.
fn widening(end: f64) -> f64 {
    match end == 0.0 || end.is_infinite() {
        true => 0.0,
        false => (ROUNDING * end.abs()).max(SMALLEST),
    }
}

/// Smallest positive number.
const SMALLEST: f64 = f64::from_bits(1);

impl Interval {
    /// All real numbers.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// Returns the interval between two ends, widened by a few rounding errors. If an end is NaN,
    /// returns [`Interval::ALL`].
    pub fn from_ends(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        // A number that overflows is not infinite.
        Self {
            low: (low - widening(low)).min(f64::MAX),
            high: (high + widening(high)).max(f64::MIN),
        }
    }

    /// Returns the bounds of a sum.
    pub fn add_interval(self, other: Self) -> Self {
        Self::from_ends(self.low + other.low, self.high + other.high)
    }

    /// Returns the bounds of the negated value.
    pub fn negate(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }

    /// Returns the bounds of a product.
    pub fn multiply(self, other: Self) -> Self {
        // 0 times infinity is 0 here, and a product that underflows is not 0.
        let product = |a: f64, b: f64| match a * b {
            _ if a == 0.0 || b == 0.0 => 0.0,
            product if product == 0.0 => SMALLEST.copysign(product),
            product => product,
        };
        let ends = [
            product(self.low, other.low),
            product(self.low, other.high),
            product(self.high, other.low),
            product(self.high, other.high),
        ];
        let low = ends.into_iter().fold(f64::INFINITY, f64::min);
        let high = ends.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self::from_ends(low, high)
    }

    /// Returns the bounds of a difference.
    pub fn subtract(self, other: Self) -> Self {
        self.add_interval(other.negate())
    }

    /// Returns the bounds of the square of one number.
    pub fn square(self) -> Self {
        self.raise(2.0)
    }

    /// Returns true if the interval contains the number.
    pub fn contains(self, number: f64) -> bool {
        self.low <= number && number <= self.high
    }

    /// Returns the bounds of the reciprocal; all numbers if the interval contains 0.
    pub fn reciprocal(self) -> Self {
        if self.low > 0.0 || self.high < 0.0 {
            Self::from_ends(1.0 / self.high, 1.0 / self.low)
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
    pub fn raise(self, exponent: f64) -> Self {
        let raised = |x: f64| x.powf(exponent);
        if exponent < 0.0 {
            return self.raise(-exponent).reciprocal();
        }
        match (exponent.fract() == 0.0, exponent % 2.0 == 0.0) {
            (true, true) => self
                .magnitude()
                .apply_non_decreasing((0.0, f64::INFINITY), raised),
            (true, false) => self.apply_non_decreasing((f64::NEG_INFINITY, f64::INFINITY), raised),
            // A power with such an exponent is undefined for negative numbers.
            (false, _) => self.apply_non_decreasing((0.0, f64::INFINITY), raised),
        }
    }

    /// Returns the bounds of a function of one or two arguments, over the values at which it is
    /// defined.
    pub fn apply_function(function: Function, arguments: &[Self]) -> Self {
        match arguments {
            [only] => only.apply_unary(function),
            [first, second] => Self::apply_binary(function, *first, *second),
            _ => Self::ALL,
        }
    }

    /// Returns the bounds of the derivative of a smooth function of one argument; `None` for other functions. `value`
    /// contains the bounds of the function.
    pub fn differentiate(self, function: Function, value: Self) -> Option<Self> {
        let number = |value: f64| Self {
            low: value,
            high: value,
        };
        let one = number(1.0);
        let apply = |function| Self::apply_function(function, &[self]);
        Some(match function {
            Function::Sin => apply(Function::Cos),
            Function::Cos => apply(Function::Sin).negate(),
            Function::Tan => one.add_interval(value.square()),
            Function::Asin => one.subtract(self.square()).raise(-0.5),
            Function::Acos => one.subtract(self.square()).raise(-0.5).negate(),
            Function::Atan => one.add_interval(self.square()).reciprocal(),
            Function::Sinh => apply(Function::Cosh),
            Function::Cosh => apply(Function::Sinh),
            Function::Tanh => one.subtract(value.square()),
            Function::Exp => value,
            Function::Ln => self.reciprocal(),
            Function::Sqrt => value.reciprocal().multiply(number(0.5)),
            _ => return None,
        })
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
    fn apply_non_decreasing(self, (from, to): (f64, f64), function: impl Fn(f64) -> f64) -> Self {
        let end = |x: f64| function(x.clamp(from, to));
        Self::from_ends(end(self.low), end(self.high))
    }

    fn apply_unary(self, function: Function) -> Self {
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        let value = |x: f64| call(function, x, f64::NAN);
        match function {
            Function::Sin => self.apply_sine(),
            Function::Cos => self
                .add_interval(Self::from_ends(FRAC_PI_2, FRAC_PI_2))
                .apply_sine(),
            Function::Asin => self.apply_non_decreasing((-1.0, 1.0), value),
            Function::Acos => Self::from_ends(0.0, PI),
            Function::Atan | Function::Sinh | Function::Tanh => {
                self.apply_non_decreasing(everywhere, value)
            }
            // An exponential that underflows is not 0.
            Function::Exp => {
                let bounds = self.apply_non_decreasing(everywhere, value);
                Self {
                    high: bounds.high.max(SMALLEST),
                    ..bounds
                }
            }
            Function::Tan => self.apply_tangent(value),
            Function::Cosh => self
                .magnitude()
                .apply_non_decreasing((0.0, f64::INFINITY), value),
            Function::Ln | Function::Sqrt => self.apply_non_decreasing((0.0, f64::INFINITY), value),
            Function::Abs => self.magnitude(),
            // The value at infinity equals the value at any large number.
            Function::Sign | Function::Above => {
                self.apply_non_decreasing((f64::MIN, f64::MAX), value)
            }
            _ => Self::ALL,
        }
    }

    fn apply_sine(self) -> Self {
        let width = self.high - self.low;
        if width.is_nan() || width >= TAU {
            return Self::from_ends(-1.0, 1.0);
        }
        // The slack covers the rounding of the argument and of the multiple of 2 pi.
        let slack = 8.0 * f64::EPSILON * (1.0 + self.low.abs().max(self.high.abs()));
        let contains_angle = |angle: f64| {
            let turns = ((self.low - slack - angle) / TAU).ceil();
            angle + TAU * turns <= self.high + slack
        };
        let (a, b) = (self.low.sin(), self.high.sin());
        let low = match contains_angle(-FRAC_PI_2) {
            true => -1.0,
            false => a.min(b),
        };
        let high = match contains_angle(FRAC_PI_2) {
            true => 1.0,
            false => a.max(b),
        };
        Self::from_ends((low - slack).max(-1.0), (high + slack).min(1.0))
    }

    /// Returns the bounds of the tangent; all numbers if a pole may be inside.
    fn apply_tangent(self, tangent: impl Fn(f64) -> f64) -> Self {
        let cosine = self.apply_unary(Function::Cos);
        let is_branch = self.high - self.low < PI && !cosine.contains(0.0);
        match is_branch {
            true => Self::from_ends(tangent(self.low), tangent(self.high)),
            false => Self::ALL,
        }
    }

    fn apply_binary(function: Function, x: Self, y: Self) -> Self {
        match function {
            Function::Atan2 => Self::from_ends(-PI - FRAC_PI_2 * ROUNDING, PI),
            Function::Min => Self::from_ends(x.low.min(y.low), x.high.min(y.high)),
            Function::Max => Self::from_ends(x.low.max(y.low), x.high.max(y.high)),
            Function::Deadzone => {
                // The half-width moves the argument towards 0, but not past it.
                let width = y.low.max(0.0);
                Self::from_ends((x.low + width).min(0.0), (x.high - width).max(0.0))
            }
            Function::Contact => Self::from_ends(0.0, 1.0),
            _ => Self::ALL,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_contain_values_at_the_ends_and_between() {
        let x = Interval::from_ends(-2.0, 3.0);
        let images: [(Interval, &dyn Fn(f64) -> f64); 6] = [
            (x.raise(2.0), &|x| x * x),
            (x.raise(3.0), &|x| x.powi(3)),
            (x.multiply(x.negate()), &|x| -x * x),
            (
                x.add_interval(Interval::from_ends(5.0, 5.0)).raise(-1.0),
                &|x| 1.0 / (x + 5.0),
            ),
            (Interval::apply_function(Function::Cosh, &[x]), &|x| {
                x.cosh()
            }),
            (Interval::apply_function(Function::Sign, &[x]), &|x| {
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
        assert_eq!(x.raise(2.0).low, 0.0);
        assert_eq!(x.reciprocal(), Interval::ALL);
    }

    #[test]
    fn bounds_of_sine_and_cosine_are_attained() {
        for start in [-1000.0, -7.0, -0.3, 0.0, 1.2, 40.0, 1e6] {
            for width in [0.0, 0.01, 0.7, 3.0, 5.0, 6.2, 9.0] {
                let x = Interval::from_ends(start, start + width);
                for function in [Function::Sin, Function::Cos] {
                    let value = |x: f64| call(function, x, 0.0);
                    let bounds = Interval::apply_function(function, &[x]);
                    let values = (0..=20_000).map(|k| value(start + width * f64::from(k) / 2e4));
                    let (low, high) = values.fold((1.0_f64, -1.0_f64), |(low, high), value| {
                        (low.min(value), high.max(value))
                    });
                    assert!(bounds.contains(low) && bounds.contains(high), "{x:?}");
                    assert!(
                        bounds.low > low - 1e-6 && bounds.high < high + 1e-6,
                        "{x:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn tangent_is_bounded_between_its_poles() {
        let tangent = |low, high| {
            let x = Interval::from_ends(low, high);
            Interval::apply_function(Function::Tan, &[x])
        };
        let bounds = tangent(2.0, 4.0);
        assert!(bounds.contains(2.0_f64.tan()) && bounds.contains(4.0_f64.tan()));
        assert!(bounds.low > -2.2 && bounds.high < 1.2, "{bounds:?}");
        assert_eq!(tangent(1.0, 2.0), Interval::ALL);
        assert_eq!(tangent(-1.0, 3.0), Interval::ALL);
    }

    #[test]
    fn results_that_underflow_or_overflow_are_inside() {
        let tiny = Interval::from_ends(1e-200, 2e-200);
        assert!(tiny.multiply(tiny).high > 0.0);
        let exponential = Interval::apply_function(Function::Exp, &[exactly(-800.0)]);
        assert!(exponential.high > 0.0 && exponential.low == 0.0);
        let subnormal = exactly(1e-310);
        assert!(subnormal.low < 1e-310 && subnormal.high > 1e-310);
        assert!(exactly(1e300).square().low < f64::INFINITY);
        assert_eq!(exactly(0.0), exactly(0.0).negate());
    }

    fn exactly(value: f64) -> Interval {
        Interval::from_ends(value, value)
    }

    #[test]
    fn unbounded_arguments_keep_the_range_of_functions() {
        let square = Interval::ALL.raise(2.0);
        assert_eq!((square.low, square.high), (0.0, f64::INFINITY));
        let sine = Interval::apply_function(Function::Sin, &[Interval::ALL]);
        assert!(sine.low < -0.999 && sine.high > 0.999 && sine.high < 1.001);
        assert_eq!(Interval::ALL.add_interval(Interval::ALL), Interval::ALL);
    }
}
