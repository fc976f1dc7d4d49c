//! Bounds of a quantity and of its rate over a time interval.

use eomgen_model_spec::function::Function;
use eomgen_model_spec::interval::Interval;

/// Degree of the polynomial part of an [`Enclosure`].
pub const DEGREE: usize = 7;

/// Bound of the rounding error of a sum, relative to its terms.
const ROUNDING: f64 = 1e-15;

/// Bounds of a quantity and of its time derivative over a time interval. The bounds of the rate hold for the
/// difference quotient between any two times of the interval. Therefore they exist at a kink, but a jump makes them
/// infinite.
///
/// The quantity is the sum of a polynomial in Bernstein form and a remainder, for which only bounds are known. Sums
/// and multiples keep the polynomial; therefore a difference of large quantities has tight bounds. Other operations
/// keep only bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    controls: [f64; DEGREE + 1],
    /// Degree of the polynomial divided by the duration of the interval, in 1/s; 0 if there is no polynomial.
    per_time: f64,
    rest_value: Interval,
    rest_rate: Interval,
}

const ZERO: Interval = Interval {
    low: 0.0,
    high: 0.0,
};

const ONE: Interval = Interval {
    low: 1.0,
    high: 1.0,
};

impl Enclosure {
    /// Infinite bounds of quantity and rate.
    pub const UNKNOWN: Self = Self::from_bounds(Interval::ALL, Interval::ALL);

    /// Returns the enclosure with these bounds of the quantity and of its rate per second.
    pub const fn from_bounds(value: Interval, rate: Interval) -> Self {
        Self {
            controls: [0.0; DEGREE + 1],
            per_time: 0.0,
            rest_value: value,
            rest_rate: rate,
        }
    }

    /// Returns the bounds of a constant.
    pub fn constant(value: f64) -> Self {
        Self::from_bounds(exact(value), ZERO)
    }

    /// Returns the bounds of a polynomial with these control points over a `duration` in s.
    pub fn polynomial(controls: [f64; DEGREE + 1], duration: f64) -> Self {
        Self {
            controls,
            per_time: match duration > 0.0 {
                true => DEGREE as f64 / duration,
                false => 0.0,
            },
            rest_value: ZERO,
            rest_rate: ZERO,
        }
    }

    /// Returns the bounds of the time itself from `begin` to `end`, in s.
    pub fn time(begin: f64, end: f64) -> Self {
        let part = |place: usize| place as f64 / DEGREE as f64;
        let controls = std::array::from_fn(|place| begin + part(place) * (end - begin));
        Self::polynomial(controls, end - begin)
    }

    /// Returns the bounds of the quantity.
    pub fn value(&self) -> Interval {
        hull(self.controls.iter().copied()).add_interval(self.rest_value)
    }

    /// Returns the bounds of the rate, per second.
    pub fn rate(&self) -> Interval {
        let differences = self.controls.windows(2).map(|pair| pair[1] - pair[0]);
        let rates = differences.map(|difference| difference * self.per_time);
        hull(rates).add_interval(self.rest_rate)
    }

    /// Returns true if neither the quantity nor its rate is bounded on any side.
    pub fn is_unknown(&self) -> bool {
        self.rest_value == Interval::ALL && self.rest_rate == Interval::ALL
    }

    /// Returns the value if the quantity is a known constant.
    fn number(&self) -> Option<f64> {
        let Interval { low, high } = self.rest_value;
        let is_number = low == high && self.rest_rate == ZERO && self.controls == [0.0; DEGREE + 1];
        is_number.then_some(low)
    }

    /// Returns the bounds of a sum.
    #[must_use]
    pub fn add_enclosure(self, other: Self) -> Self {
        let controls: [f64; DEGREE + 1] =
            std::array::from_fn(|place| self.controls[place] + other.controls[place]);
        let terms = self.controls.iter().chain(&other.controls);
        let rounding = ROUNDING * terms.fold(0.0, |most: f64, term| most.max(term.abs()));
        let rounding = Interval {
            low: -rounding,
            high: rounding,
        };
        let rest = match (self.number(), other.number()) {
            (Some(a), Some(b)) => exact(a + b),
            _ => self.rest_value.add_interval(other.rest_value),
        };
        Self {
            controls,
            per_time: self.per_time.max(other.per_time),
            rest_value: rest.add_interval(rounding),
            rest_rate: self.rest_rate.add_interval(other.rest_rate),
        }
    }

    fn scale(self, factor: f64) -> Self {
        let exact = exact(factor);
        Self {
            controls: self.controls.map(|control| control * factor),
            per_time: self.per_time,
            rest_value: self.rest_value.multiply(exact),
            rest_rate: self.rest_rate.multiply(exact),
        }
    }

    pub(super) fn negate(self) -> Self {
        Self {
            controls: self.controls.map(|control| -control),
            per_time: self.per_time,
            rest_value: self.rest_value.negate(),
            rest_rate: self.rest_rate.negate(),
        }
    }

    pub(super) fn subtract(self, other: Self) -> Self {
        self.add_enclosure(other.negate())
    }

    /// Returns the bounds of a product.
    #[must_use]
    pub fn multiply(self, other: Self) -> Self {
        if let Some(factor) = self.number() {
            return other.scale(factor);
        }
        if let Some(factor) = other.number() {
            return self.scale(factor);
        }
        let (a, b) = (self.value(), other.value());
        let rate = self.rate().multiply(b);
        Self::from_bounds(a.multiply(b), rate.add_interval(a.multiply(other.rate())))
    }

    pub(super) fn divide(self, other: Self) -> Self {
        if let Some(divisor) = other.number().filter(|divisor| *divisor != 0.0) {
            return self.scale(1.0 / divisor);
        }
        let reciprocal = other.value().reciprocal();
        let value = self.value().multiply(reciprocal);
        let rate = self.rate().subtract(value.multiply(other.rate()));
        Self::from_bounds(value, rate.multiply(reciprocal))
    }

    /// Returns the bounds of a power; unknown if the exponent varies.
    pub(super) fn raise(self, exponent: Self) -> Self {
        let Some(exponent) = exponent.number() else {
            return Self::UNKNOWN;
        };
        let value = self.value();
        let slope = exact(exponent).multiply(value.raise(exponent - 1.0));
        Self::from_bounds(value.raise(exponent), slope.multiply(self.rate()))
    }

    /// Returns the bounds of `if a > b { then } else { otherwise }`.
    pub(super) fn select(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        let difference = a.subtract(b).value();
        match () {
            () if difference.low > 0.0 => then,
            () if difference.high <= 0.0 => otherwise,
            () => Self::from_bounds(then.value().hull(otherwise.value()), Interval::ALL),
        }
    }

    /// Returns the bounds of a function of the expression language.
    pub(super) fn call(function: Function, arguments: &[Self]) -> Self {
        if let Some(branch) = select_linear_branch(function, arguments) {
            return branch;
        }
        let values: Vec<Interval> = arguments.iter().map(Self::value).collect();
        let value = Interval::apply_function(function, &values);
        let rate = match arguments {
            [x] => slope(function, values[0], value).multiply(x.rate()),
            [x, y] => bound_binary_rate(function, *x, *y),
            _ => Interval::ALL,
        };
        Self::from_bounds(value, rate)
    }
}

fn hull(values: impl Iterator<Item = f64>) -> Interval {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    Interval::from_ends(low, high)
}

/// Returns the interval that contains only this number.
fn exact(value: f64) -> Interval {
    match value.is_nan() {
        true => Interval::ALL,
        false => Interval {
            low: value,
            high: value,
        },
    }
}

/// Returns the bounds of a piecewise linear function if its arguments stay on one side of its kinks.
fn select_linear_branch(function: Function, arguments: &[Enclosure]) -> Option<Enclosure> {
    let is_positive = |x: Enclosure| x.value().low >= 0.0;
    match (function, arguments) {
        (Function::Abs, &[x]) if is_positive(x) => Some(x),
        (Function::Abs, &[x]) if is_positive(x.negate()) => Some(x.negate()),
        (Function::Min, &[x, y]) if is_positive(y.subtract(x)) => Some(x),
        (Function::Min, &[x, y]) if is_positive(x.subtract(y)) => Some(y),
        (Function::Max, &[x, y]) if is_positive(x.subtract(y)) => Some(x),
        (Function::Max, &[x, y]) if is_positive(y.subtract(x)) => Some(y),
        (Function::Contact, &[x, width]) => {
            let outside = |distance: Enclosure| distance.value().low > 0.0;
            let (above, below) = (x.subtract(width), x.negate().subtract(width));
            match () {
                () if outside(above) || outside(below) => Some(Enclosure::constant(1.0)),
                () if is_positive(above.negate()) && is_positive(below.negate()) => {
                    Some(Enclosure::constant(0.0))
                }
                () => None,
            }
        }
        (Function::Deadzone, &[x, width]) => {
            let (above, below) = (x.subtract(width), x.add_enclosure(width));
            match () {
                () if is_positive(above) => Some(above),
                () if is_positive(below.negate()) => Some(below),
                () if is_positive(above.negate()) && is_positive(below) => {
                    Some(Enclosure::constant(0.0))
                }
                () => None,
            }
        }
        _ => None,
    }
}

/// Returns the bounds of the derivative of a function for arguments in `x`; `value` has the bounds of the function
/// there.
fn slope(function: Function, x: Interval, value: Interval) -> Interval {
    let smooth = x.differentiate(function, value);
    smooth.unwrap_or(match function {
        Function::Abs => ONE.hull(ONE.negate()),
        Function::Sign | Function::Above if x.low > 0.0 || x.high < 0.0 => ZERO,
        _ => Interval::ALL,
    })
}

fn bound_binary_rate(function: Function, x: Enclosure, y: Enclosure) -> Interval {
    let (x_value, y_value) = (x.value(), y.value());
    match function {
        Function::Atan2 => {
            // The first argument of `atan2` is the ordinate.
            if x_value.contains(0.0) && y_value.low <= 0.0 {
                return Interval::ALL;
            }
            let turned = y_value.multiply(x.rate());
            let turned = turned.subtract(x_value.multiply(y.rate()));
            let distance = x_value.square().add_interval(y_value.square());
            turned.multiply(distance.reciprocal())
        }
        Function::Min | Function::Max => x.rate().hull(y.rate()),
        Function::Deadzone => ZERO
            .hull(x.subtract(y).rate())
            .hull(x.add_enclosure(y).rate()),
        _ => Interval::ALL,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the bounds of the polynomials t^2 + c and t^3 from 0 to 2 s.
    fn polynomials(constant: f64) -> [Enclosure; 2] {
        let choose = |n: usize, k: usize| {
            (0..k).fold(1.0, |value, j| value * (n - j) as f64 / (j + 1) as f64)
        };
        let power = |degree: usize| {
            std::array::from_fn(|place| match place >= degree {
                true => 2.0_f64.powi(degree as i32) * choose(place, degree) / choose(7, degree),
                false => 0.0,
            })
        };
        let square = Enclosure::polynomial(power(2), 2.0);
        let cube = Enclosure::polynomial(power(3), 2.0);
        [square.add_enclosure(Enclosure::constant(constant)), cube]
    }

    #[test]
    fn difference_of_equal_polynomials_has_no_width() {
        let [square, _] = polynomials(5.0);
        let difference = square.subtract(square).value();
        assert!(difference.contains(0.0) && difference.high - difference.low < 1e-13);
    }

    #[test]
    fn operations_bound_values_and_rates() {
        let [a, b] = polynomials(0.5);
        let value = |t: f64| (t * t + 0.5, t * t * t);
        type Pair = (Enclosure, fn(f64, f64) -> f64);
        let cases: [Pair; 9] = [
            (a.add_enclosure(b), |a, b| a + b),
            (a.multiply(b), |a, b| a * b),
            (b.divide(a), |a, b| b / a),
            (a.raise(Enclosure::constant(1.5)), |a, _| a.powf(1.5)),
            (Enclosure::call(Function::Sin, &[b]), |_, b| b.sin()),
            (Enclosure::call(Function::Atan2, &[b, a]), |a, b| b.atan2(a)),
            (Enclosure::call(Function::Max, &[a, b]), f64::max),
            (
                Enclosure::call(Function::Deadzone, &[b, Enclosure::constant(1.0)]),
                |_, b| (b - 1.0).max(0.0) + (b + 1.0).min(0.0),
            ),
            (Enclosure::call(Function::Sqrt, &[a]), |a, _| a.sqrt()),
        ];
        for (place, (bounds, function)) in cases.into_iter().enumerate() {
            let at = |t: f64| {
                let (a, b) = value(t);
                function(a, b)
            };
            for step in 0..200 {
                let t = 0.01 * f64::from(step);
                let (here, rate) = (at(t), (at(t + 0.01) - at(t)) / 0.01);
                assert!(bounds.value().contains(here), "{place} at {t}: {here}");
                assert!(bounds.rate().contains(rate), "{place} at {t}: {rate}");
            }
            assert!(!bounds.is_unknown());
        }
    }
}
