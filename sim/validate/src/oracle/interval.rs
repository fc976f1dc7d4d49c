//! Interval arithmetic on trees: bounds of a quantity over all states within their ranges, in a
//! regime of the piecewise functions.

use super::switches::{Imposed, Side};
use super::tree::Tree;
use super::{Oracle, functions};
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::Function;
use std::f64::consts::{FRAC_PI_2, PI};

/// A closed interval; its ends may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Relative widening of every result, a few roundings.
const ROUNDING: f64 = 1e-15;

impl Interval {
    /// All real numbers.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// The interval between two ends, a few roundings wider; all numbers if an end is no number.
    pub fn between(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ALL;
        }
        Self {
            low: low - ROUNDING * low.abs(),
            high: high + ROUNDING * high.abs(),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self::between(self.low + other.low, self.high + other.high)
    }

    fn negated(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }

    fn times(self, other: Self) -> Self {
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

    fn reciprocal(self) -> Self {
        if self.low > 0.0 || self.high < 0.0 {
            Self::between(1.0 / self.high, 1.0 / self.low)
        } else {
            Self::ALL
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

    /// The image under a function that does not fall, defined from `from` to `to`.
    fn rising(self, (from, to): (f64, f64), function: impl Fn(f64) -> f64) -> Self {
        let end = |x: f64| function(x.clamp(from, to));
        Self::between(end(self.low), end(self.high))
    }
}

impl Oracle {
    /// Bounds of `tree` in a regime; all numbers if nothing is known.
    pub(super) fn bounds(&self, tree: &Tree, imposed: Imposed<'_>) -> Interval {
        let of = |tree: &Tree| self.bounds(tree, imposed);
        let within = |range: Option<(f64, f64)>| {
            range.map_or(Interval::ALL, |(low, high)| Interval::between(low, high))
        };
        let entry = |place: usize| within(self.ranges.state.get(place).copied().flatten());
        match tree {
            Tree::Constant(value) => Interval::between(*value, *value),
            Tree::Coordinate(index) => entry(*index),
            Tree::State(index) => entry(2 * self.size() + index),
            Tree::Input(index) | Tree::PrescribedInput { input: index, .. } => {
                within(self.ranges.inputs.get(*index).copied().flatten())
            }
            Tree::Definition(index) => {
                let definition = self.system.definitions.get(*index);
                definition.map_or(Interval::ALL, of)
            }
            Tree::Negate(operand) => of(operand).negated(),
            Tree::Binary(BinaryOperator::Multiply, left, right) if left == right => {
                power(of(left), 2.0)
            }
            Tree::Binary(operator, left, right) => combined(*operator, of(left), of(right)),
            Tree::Power(base, exponent) => power(of(base), *exponent),
            Tree::Call(function, arguments) => {
                let bounds: Vec<Interval> = arguments.iter().map(of).collect();
                let side = imposed.side(*function, arguments);
                called(*function, &bounds, side)
            }
            _ => Interval::ALL,
        }
    }
}

fn combined(operator: BinaryOperator, left: Interval, right: Interval) -> Interval {
    match operator {
        BinaryOperator::Add => left.plus(right),
        BinaryOperator::Subtract => left.plus(right.negated()),
        BinaryOperator::Multiply => left.times(right),
        BinaryOperator::Divide => left.times(right.reciprocal()),
        BinaryOperator::Power => Interval::ALL,
    }
}

fn power(base: Interval, exponent: f64) -> Interval {
    let raised = |x: f64| functions::constant_power(x, exponent);
    if exponent < 0.0 {
        return power(base, -exponent).reciprocal();
    }
    match (exponent.fract() == 0.0, exponent % 2.0 == 0.0) {
        (true, true) => base.magnitude().rising((0.0, f64::INFINITY), raised),
        (true, false) => base.rising((f64::NEG_INFINITY, f64::INFINITY), raised),
        // Not defined below 0.
        (false, _) => base.rising((0.0, f64::INFINITY), raised),
    }
}

fn called(function: Function, bounds: &[Interval], side: Option<Side>) -> Interval {
    match (bounds, side) {
        ([x, y], Some(side)) if matches!(function, Function::Min | Function::Max) => {
            let first = (function == Function::Min) == (side == Side::Minus);
            *(if first { x } else { y })
        }
        (_, Some(side)) if has_levels(function, side) => {
            let value = functions::on_side(function, side, &vec![0.0; bounds.len()]);
            value.map_or(Interval::ALL, |value| Interval::between(value, value))
        }
        ([only], _) => of_one(function, *only),
        ([first, second], _) => of_two(function, *first, *second),
        _ => Interval::ALL,
    }
}

/// Whether the value on this side does not change with the arguments.
fn has_levels(function: Function, side: Side) -> bool {
    match function {
        Function::Sign | Function::Above | Function::Contact => true,
        Function::Deadzone | Function::Abs => side == Side::Free,
        _ => false,
    }
}

fn of_one(function: Function, x: Interval) -> Interval {
    let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
    let value = |x: f64| functions::apply(function, &[x]);
    match function {
        Function::Sin | Function::Cos => Interval::between(-1.0, 1.0),
        Function::Asin => x.rising((-1.0, 1.0), value),
        Function::Acos => Interval::between(0.0, PI),
        Function::Atan | Function::Sinh | Function::Tanh | Function::Exp => {
            x.rising(everywhere, value)
        }
        Function::Cosh => x.magnitude().rising((0.0, f64::INFINITY), value),
        Function::Ln | Function::Sqrt => x.rising((0.0, f64::INFINITY), value),
        Function::Abs => x.magnitude(),
        Function::Sign => x.rising(everywhere, functions::sign),
        Function::Above => x.rising(everywhere, value),
        _ => Interval::ALL,
    }
}

fn of_two(function: Function, x: Interval, y: Interval) -> Interval {
    match function {
        Function::Atan2 => Interval::between(-PI - FRAC_PI_2 * ROUNDING, PI),
        Function::Min => Interval::between(x.low.min(y.low), x.high.min(y.high)),
        Function::Max => Interval::between(x.low.max(y.low), x.high.max(y.high)),
        Function::Deadzone => {
            // The half-width narrows the argument towards 0 and never past it.
            let width = y.low.max(0.0);
            Interval::between((x.low + width).min(0.0), (x.high - width).max(0.0))
        }
        Function::Contact => Interval::between(0.0, 1.0),
        _ => Interval::ALL,
    }
}
