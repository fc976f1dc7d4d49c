//! Forward analysis bounds every number and its rounding error. Backward analysis bounds the sensitivities of one
//! number to all roundings.

use eomgen_model_spec::function::Function;
use eomgen_model_spec::interval::Interval;

use crate::program::evaluator::elementary;

use super::format::above;
use super::obstacle::{Cause, Obstacle};
use super::scalars::{ScalarOp, Scalars};
use super::slopes::{
    POWER_LAST_PLACES, bound_power_slopes, error_in_last_places, find_obstacle,
    find_power_obstacle, number, raise, slopes,
};

/// Bounds of a number and of its rounding error.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    /// Bounds of the exact value.
    pub value: Interval,
    /// Bound of the error of the computed value.
    pub error: f64,
    /// Bound of the error that the operation itself adds.
    pub rounding: f64,
    /// Reason for a missing bound; the other fields have no meaning then.
    pub obstacle: Option<Obstacle>,
}

impl Bounded {
    fn without(obstacle: Obstacle) -> Self {
        Self {
            value: Interval::ALL,
            error: f64::INFINITY,
            rounding: f64::INFINITY,
            obstacle: Some(obstacle),
        }
    }

    /// Returns an interval that contains the exact and the computed value.
    fn hull_of_values(&self) -> Interval {
        widen(self.value, self.error)
    }

    fn is_number(&self, number: f64) -> bool {
        self.error == 0.0 && self.value.low == number && self.value.high == number
    }
}

/// Rounding of one operation with exact operands.
enum Rounding {
    /// No rounding.
    Exact,
    /// Rounding to the nearest number of the format.
    Nearest,
    /// Rounding of subnormal results only.
    Scaling,
    /// Error of at most this number of units in the last place.
    LastPlaces(f64),
}

/// Returns the bounds of the numbers `needed` (indices, operands first) over a box, which has the range of each
/// component of a point. Entries of the result for other numbers have no meaning.
pub fn bound_numbers(
    scalars: &Scalars,
    needed: &[usize],
    ranges: &[Option<Interval>],
) -> Vec<Bounded> {
    let unused = Bounded {
        value: number(0.0),
        error: 0.0,
        rounding: 0.0,
        obstacle: None,
    };
    let mut known = vec![unused; needed.last().map_or(0, |last| last + 1)];
    for index in needed {
        known[*index] = bound_number(scalars, *index, ranges, &known);
    }
    known
}

fn bound_number(
    scalars: &Scalars,
    index: usize,
    ranges: &[Option<Interval>],
    known: &[Bounded],
) -> Bounded {
    let scalar = &scalars.list[index];
    let format = scalar.format;
    let blocked = |cause, bounds| {
        Bounded::without(Obstacle {
            scalar: index,
            cause,
            bounds,
        })
    };
    let result = |value: Interval, propagated: f64, rounding: Rounding| {
        let exact = widen(value, propagated);
        let rounding = match rounding {
            Rounding::Exact => 0.0,
            Rounding::Nearest => format.rounding(exact),
            Rounding::Scaling if smallest_magnitude(exact) >= format.smallest_normal() => 0.0,
            Rounding::Scaling => format.smallest_half(),
            Rounding::LastPlaces(0.0) => 0.0,
            Rounding::LastPlaces(count) => {
                2.0 * count * format.half_unit_in_last_place(magnitude(exact))
            }
        };
        let error = above(propagated + rounding);
        match magnitude(value) + error <= format.largest() {
            true => Bounded {
                value,
                error,
                rounding,
                obstacle: None,
            },
            false => blocked(Cause::Overflow, value),
        }
    };
    if let Some(obstacle) = scalar
        .op
        .operands()
        .find_map(|operand| known[operand].obstacle)
        && !matches!(scalar.op, ScalarOp::Select(_))
    {
        return Bounded::without(obstacle);
    }
    match scalar.op {
        ScalarOp::Constant(value) => {
            let rounding = (format.round(value) - value).abs();
            Bounded {
                rounding,
                ..result(number(value), rounding, Rounding::Exact)
            }
        }
        ScalarOp::Variable(place) => match ranges[place] {
            // At a single point, the caller has already rounded the number to the format.
            Some(range) if range.low == range.high => {
                result(number(format.round(range.low)), 0.0, Rounding::Exact)
            }
            Some(range) => result(range, 0.0, Rounding::Exact),
            None => blocked(Cause::NoRange(place), Interval::ALL),
        },
        ScalarOp::Convert(a) => result(known[a].value, known[a].error, Rounding::Nearest),
        ScalarOp::Negate(a) => result(known[a].value.negate(), known[a].error, Rounding::Exact),
        ScalarOp::Add(a, b) => {
            let (a, b) = (&known[a], &known[b]);
            let rounding = match a.is_number(0.0) || b.is_number(0.0) {
                true => Rounding::Exact,
                false => Rounding::Nearest,
            };
            result(a.value.add_interval(b.value), a.error + b.error, rounding)
        }
        ScalarOp::Subtract(a, b) => {
            let (a, b) = (&known[a], &known[b]);
            let rounding = match a.is_number(0.0) || b.is_number(0.0) {
                true => Rounding::Exact,
                false => Rounding::Nearest,
            };
            result(a.value.subtract(b.value), a.error + b.error, rounding)
        }
        ScalarOp::Multiply(a, b) if a == b => {
            let a = &known[a];
            let propagated = a.error * (2.0 * magnitude(a.value) + a.error);
            result(a.value.square(), propagated, Rounding::Nearest)
        }
        ScalarOp::Multiply(a, b) => {
            let (a, b) = (&known[a], &known[b]);
            let by_first = a.error * (magnitude(b.value) + b.error);
            let propagated = by_first + b.error * magnitude(a.value);
            let rounding = match () {
                () if is_unit(a) || is_unit(b) => Rounding::Exact,
                () if is_power_of_two(a) || is_power_of_two(b) => Rounding::Scaling,
                () => Rounding::Nearest,
            };
            result(a.value.multiply(b.value), propagated, rounding)
        }
        ScalarOp::Divide(a, b) => {
            let (a, b) = (&known[a], &known[b]);
            let least = smallest_magnitude(b.value) * (1.0 - 1e-15) - b.error;
            if least <= 0.0 {
                return blocked(Cause::Divisor, b.hull_of_values());
            }
            let value = a.value.multiply(b.value.reciprocal());
            let propagated = (a.error + magnitude(value) * b.error) / least;
            let rounding = match is_unit(b) {
                true => Rounding::Exact,
                false => Rounding::Nearest,
            };
            result(value, propagated, rounding)
        }
        ScalarOp::Power(a, b) => {
            let (a, b) = (&known[a], &known[b]);
            let (x, y) = (a.hull_of_values(), b.hull_of_values());
            if let Some(cause) = find_power_obstacle(x, y) {
                return blocked(cause, x);
            }
            let [by_base, by_exponent] = bound_power_slopes(x, y);
            let propagated = scale_error(by_base, a.error) + scale_error(by_exponent, b.error);
            let rounding = Rounding::LastPlaces(POWER_LAST_PLACES);
            result(raise(a.value, b.value), propagated, rounding)
        }
        ScalarOp::Call(function, a, b) => {
            let (a, b) = (&known[a], &known[b]);
            let (x, y) = (a.hull_of_values(), b.hull_of_values());
            if let Some(cause) = find_obstacle(function, format, x, y) {
                return blocked(cause, x);
            }
            let [by_first, by_second] = slopes(function, x, y);
            let mut propagated = scale_error(by_first, a.error) + scale_error(by_second, b.error);
            if function == Function::Sqrt {
                propagated = propagated.min(above(a.error.sqrt()));
            }
            let rounding = match error_in_last_places(function, format) {
                None => Rounding::Nearest,
                Some(count) => Rounding::LastPlaces(count),
            };
            let value = Interval::apply_function(
                function,
                &[a.value, b.value][..elementary(function).arity()],
            );
            result(value, propagated, rounding)
        }
        ScalarOp::Select([a, b, then, otherwise]) => match chosen(known, a, b) {
            Side::Unknown(obstacle) => Bounded::without(obstacle),
            Side::Then => select_branch(&known[then]),
            Side::Otherwise => select_branch(&known[otherwise]),
            Side::Both => {
                let (then, otherwise) = (&known[then], &known[otherwise]);
                Bounded {
                    value: then.value.hull(otherwise.value),
                    error: then.error.max(otherwise.error),
                    rounding: 0.0,
                    obstacle: then.obstacle.or(otherwise.obstacle),
                }
            }
        },
        ScalarOp::Positive(a) => {
            let a = &known[a];
            match a.hull_of_values().low > 0.0 {
                true => select_branch(a),
                false => blocked(Cause::Pivot, a.hull_of_values()),
            }
        }
    }
}

/// Branches that a selection may take.
enum Side {
    Then,
    Otherwise,
    Both,
    /// The compared numbers have no bounds.
    Unknown(Obstacle),
}

fn chosen(known: &[Bounded], a: usize, b: usize) -> Side {
    let (a, b) = (&known[a], &known[b]);
    let (x, y) = (a.hull_of_values(), b.hull_of_values());
    match a.obstacle.or(b.obstacle) {
        Some(obstacle) => Side::Unknown(obstacle),
        None if x.low > y.high => Side::Then,
        None if x.high <= y.low => Side::Otherwise,
        None => Side::Both,
    }
}

fn select_branch(operand: &Bounded) -> Bounded {
    Bounded {
        rounding: 0.0,
        ..*operand
    }
}

/// Returns a bound of the rounding error of the number `root`, from its sensitivities to the roundings of all
/// numbers. `needed` lists the numbers that `root` depends on. The bound may be infinite.
///
/// By the mean value theorem, the error is the sum of all roundings, each times a sensitivity at a point between the
/// exact and the computed values. The forward analysis bounds these points.
pub fn bound_by_sensitivities(scalars: &Scalars, needed: &[usize], known: &[Bounded]) -> f64 {
    let Some(root) = needed.last() else {
        return 0.0;
    };
    let mut sensitivities = vec![number(0.0); known.len()];
    sensitivities[*root] = number(1.0);
    let (mut sum, mut has_rounding) = (0.0, false);
    for index in needed.iter().rev() {
        let own = sensitivities[*index];
        if own.low == 0.0 && own.high == 0.0 {
            continue;
        }
        if known[*index].rounding > 0.0 {
            has_rounding = true;
            sum += magnitude(own) * known[*index].rounding;
        }
        for (operand, slope) in bound_partials(&scalars.list[*index].op, *index, known) {
            let part = own.multiply(slope);
            sensitivities[operand] = sensitivities[operand].add_interval(part);
        }
    }
    match sum.is_nan() {
        false if sum == 0.0 && !has_rounding => 0.0,
        true => f64::INFINITY,
        // The sum has one term for each number, and each term may underflow.
        false => {
            let terms = needed.len() as f64;
            above(sum) * (1.0 + f64::EPSILON * terms) + f64::from_bits(1) * terms
        }
    }
}

/// Returns the derivatives of an operation with respect to its operands.
fn bound_partials(
    op: &ScalarOp,
    index: usize,
    known: &[Bounded],
) -> impl Iterator<Item = (usize, Interval)> + use<> {
    let wide = |operand: usize| known[operand].hull_of_values();
    let one = number(1.0);
    let parts = match *op {
        ScalarOp::Constant(_) | ScalarOp::Variable(_) => [None; 2],
        ScalarOp::Convert(a) | ScalarOp::Positive(a) => [Some((a, one)), None],
        ScalarOp::Negate(a) => [Some((a, one.negate())), None],
        ScalarOp::Add(a, b) => [Some((a, one)), Some((b, one))],
        ScalarOp::Subtract(a, b) => [Some((a, one)), Some((b, one.negate()))],
        ScalarOp::Multiply(a, b) => [Some((a, wide(b))), Some((b, wide(a)))],
        ScalarOp::Divide(a, b) => {
            let reciprocal = wide(b).reciprocal();
            let by_divisor = wide(index).negate().multiply(reciprocal);
            [Some((a, reciprocal)), Some((b, by_divisor))]
        }
        ScalarOp::Power(a, b) => {
            let [by_base, by_exponent] = bound_power_slopes(wide(a), wide(b));
            [Some((a, by_base)), Some((b, by_exponent))]
        }
        ScalarOp::Call(function, a, b) => {
            let [by_first, by_second] = slopes(function, wide(a), wide(b));
            let second = (elementary(function).arity() == 2).then_some((b, by_second));
            [Some((a, by_first)), second]
        }
        ScalarOp::Select([a, b, then, otherwise]) => match chosen(known, a, b) {
            Side::Unknown(_) => [None; 2],
            Side::Then => [Some((then, one)), None],
            Side::Otherwise => [Some((otherwise, one)), None],
            Side::Both => {
                let part = number(0.0).hull(one);
                [Some((then, part)), Some((otherwise, part))]
            }
        },
    };
    parts.into_iter().flatten()
}

fn widen(value: Interval, error: f64) -> Interval {
    match error == 0.0 {
        true => value,
        false => Interval::from_ends(value.low - error, value.high + error),
    }
}

fn magnitude(interval: Interval) -> f64 {
    interval.low.abs().max(interval.high.abs())
}

/// Returns the smallest magnitude in an interval.
fn smallest_magnitude(interval: Interval) -> f64 {
    match interval.contains(0.0) {
        true => 0.0,
        false => interval.low.abs().min(interval.high.abs()),
    }
}

/// Returns the largest magnitude of an error after multiplication by a slope.
fn scale_error(slope: Interval, error: f64) -> f64 {
    match error == 0.0 {
        true => 0.0,
        false => magnitude(slope) * error,
    }
}

/// Returns true if the factor is exactly 1 or -1.
fn is_unit(factor: &Bounded) -> bool {
    factor.is_number(1.0) || factor.is_number(-1.0)
}

/// Returns true if the factor is exactly a power of two.
fn is_power_of_two(factor: &Bounded) -> bool {
    let number = factor.value.low;
    let significand = number.to_bits() & ((1 << 52) - 1);
    factor.is_number(number) && number.is_normal() && significand == 0
}
