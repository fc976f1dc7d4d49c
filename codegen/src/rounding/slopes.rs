//! Functions on intervals: bounds of their slopes, their evaluation errors, and arguments for which there is no
//! bound.

use eomgen_elementary::LARGEST_ANGLE;
use eomgen_model_spec::function::Function;
use eomgen_model_spec::interval::Interval;

use super::format::Format;
use super::obstacle::Cause;

const ZERO: Interval = number(0.0);
const ONE: Interval = number(1.0);

/// Returns the interval that contains only this number.
pub(super) const fn number(value: f64) -> Interval {
    Interval {
        low: value,
        high: value,
    }
}

/// Largest angle in rad for which the errors of sine, cosine and tangent in single precision are known.
const ACCURATE_SINGLE_ANGLE: f64 = 1e5;

/// Returns the error of a function for exact arguments, in units in the last place, as asserted by the tests of the
/// elementary functions; `None` if only its last operation rounds.
pub(super) fn error_in_last_places(function: Function, format: Format) -> Option<f64> {
    let (double, single) = match function {
        Function::Sin => (0.76, 1.72),
        Function::Cos => (0.77, 1.77),
        Function::Tan => (0.94, 0.80),
        Function::Asin => (0.63, 0.59),
        Function::Acos => (0.60, 0.55),
        Function::Atan => (0.75, 0.70),
        Function::Atan2 => (1.45, 1.45),
        Function::Sinh => (1.15, 0.87),
        Function::Cosh => (0.88, 0.89),
        Function::Tanh => (0.91, 0.73),
        Function::Exp => (0.76, 0.63),
        Function::Ln => (0.81, 0.75),
        Function::Sqrt => (0.5, 0.5),
        Function::Abs
        | Function::Sign
        | Function::Min
        | Function::Max
        | Function::Contact
        | Function::Above => (0.0, 0.0),
        Function::Deadzone => return None,
    };
    Some(match format {
        Format::Double => double,
        Format::Single => single,
    })
}

/// Error of x^y in units in the last place.
pub(super) const POWER_LAST_PLACES: f64 = 0.76;

/// Returns the reason if a function has no bound for arguments in `x` and `y`.
pub(super) fn find_obstacle(
    function: Function,
    format: Format,
    x: Interval,
    y: Interval,
) -> Option<Cause> {
    let largest_angle = match format {
        Format::Double => LARGEST_ANGLE,
        Format::Single => ACCURATE_SINGLE_ANGLE,
    };
    let outside = |low: f64, high: f64| x.low < low || x.high > high;
    let found = match function {
        Function::Sin | Function::Cos | Function::Tan if outside(-largest_angle, largest_angle) => {
            Cause::LargeAngle(largest_angle)
        }
        Function::Asin | Function::Acos if outside(-1.0, 1.0) => Cause::OutsideDomain,
        Function::Ln if x.low <= 0.0 => Cause::OutsideDomain,
        Function::Sqrt if x.low < 0.0 => Cause::OutsideDomain,
        Function::Atan2 if x.contains(0.0) && y.low <= 0.0 => Cause::Cut,
        Function::Deadzone | Function::Contact if y.low < 0.0 => Cause::NegativeWidth,
        _ => return None,
    };
    Some(found)
}

/// Returns bounds of the derivatives by both arguments; for piecewise functions, bounds of all difference quotients
/// between points on the same side of the jumps.
pub(super) fn slopes(function: Function, x: Interval, y: Interval) -> [Interval; 2] {
    if let Some(slope) = x.differentiate(function, Interval::apply_function(function, &[x])) {
        return [slope, ZERO];
    }
    match function {
        Function::Abs if x.low >= 0.0 => [ONE, ZERO],
        Function::Abs if x.high <= 0.0 => [ONE.negate(), ZERO],
        Function::Abs => [ONE.negate().hull(ONE), ZERO],
        Function::Atan2 | Function::Min | Function::Max | Function::Deadzone => {
            bound_slopes_of_two(function, x, y)
        }
        // Functions that jump have slope 0 on each side.
        _ => [ZERO, ZERO],
    }
}

fn bound_slopes_of_two(function: Function, x: Interval, y: Interval) -> [Interval; 2] {
    let part = ZERO.hull(ONE);
    match function {
        Function::Atan2 => {
            let per_square = x.square().add_interval(y.square()).reciprocal();
            [y.multiply(per_square), x.negate().multiply(per_square)]
        }
        Function::Min if x.high <= y.low => [ONE, ZERO],
        Function::Min if y.high <= x.low => [ZERO, ONE],
        Function::Max if x.low >= y.high => [ONE, ZERO],
        Function::Max if y.low >= x.high => [ZERO, ONE],
        // If the comparison of a minimum or maximum is undecided, both slopes are between 0 and 1. The following arms
        // are for the dead zone.
        Function::Min | Function::Max => [part, part],
        _ if x.low >= y.high => [ONE, ONE.negate()],
        _ if x.high <= -y.high => [ONE, ONE],
        _ if x.high <= y.low && x.low >= -y.low => [ZERO, ZERO],
        _ => {
            let low = match x.high >= y.low {
                true => -1.0,
                false => 0.0,
            };
            let high = match x.low <= -y.low {
                true => 1.0,
                false => 0.0,
            };
            [part, Interval { low, high }]
        }
    }
}

/// Returns the bounds of a^b; the interval of all numbers if a^b is not bounded.
pub(super) fn raise(a: Interval, b: Interval) -> Interval {
    match () {
        () if b.low == b.high => a.raise(b.low),
        () if a.low > 0.0 => {
            let logarithm = Interval::apply_function(Function::Ln, &[a]);
            Interval::apply_function(Function::Exp, &[logarithm.multiply(b)])
        }
        () => Interval::ALL,
    }
}

/// Returns the reason if a^b has no bound.
pub(super) fn find_power_obstacle(a: Interval, b: Interval) -> Option<Cause> {
    let is_constant = b.low == b.high;
    let is_whole = is_constant && b.low.fract() == 0.0;
    let is_defined = match () {
        () if a.low > 0.0 => true,
        () if is_whole && b.low >= 0.0 => true,
        () if is_whole => a.high < 0.0,
        () => is_constant && a.low >= 0.0 && b.low > 0.0,
    };
    (!is_defined).then_some(Cause::OutsideDomain)
}

/// Returns the derivatives of a^b by a and b.
pub(super) fn bound_power_slopes(a: Interval, b: Interval) -> [Interval; 2] {
    let is_constant = b.low == b.high;
    let by_base = match is_constant {
        true if b.low == 0.0 => ZERO,
        true => b.multiply(a.raise(b.low - 1.0)),
        false => b.multiply(raise(a, b.subtract(ONE))),
    };
    let by_exponent = match is_constant {
        true => ZERO,
        false => raise(a, b).multiply(Interval::apply_function(Function::Ln, &[a])),
    };
    [by_base, by_exponent]
}
