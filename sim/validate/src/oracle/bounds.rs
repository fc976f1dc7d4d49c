//! Interval bounds of expressions over all states within their ranges, in one regime.

use super::switches::{PrescribedSides, Side};
use super::tree::Tree;
use super::{Oracle, functions};
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::interval::Interval;
use eomgen_model_spec::model::Function;

impl Oracle {
    pub(super) fn bounds(&self, tree: &Tree, imposed: PrescribedSides<'_>) -> Interval {
        let of = |tree: &Tree| self.bounds(tree, imposed);
        let within = |range: Option<(f64, f64)>| {
            range.map_or(Interval::ALL, |(low, high)| Interval::from_ends(low, high))
        };
        let entry = |place: usize| within(self.ranges.state.get(place).copied().flatten());
        match tree {
            Tree::Constant(value) => Interval::from_ends(*value, *value),
            Tree::Coordinate(index) => entry(*index),
            Tree::State(index) => entry(2 * self.size() + index),
            Tree::Input(index) | Tree::PrescribedInput { input: index, .. } => {
                within(self.ranges.inputs.get(*index).copied().flatten())
            }
            Tree::Definition(index) => {
                let definition = self.system.definitions.get(*index);
                definition.map_or(Interval::ALL, of)
            }
            Tree::Negate(operand) => of(operand).negate(),
            Tree::Binary(BinaryOperator::Multiply, left, right) if left == right => {
                of(left).raise(2.0)
            }
            Tree::Binary(operator, left, right) => combine_bounds(*operator, of(left), of(right)),
            Tree::Power(base, exponent) => of(base).raise(*exponent),
            Tree::Call(function, arguments) => {
                let bounds: Vec<Interval> = arguments.iter().map(of).collect();
                let side = imposed.side(*function, arguments);
                bound_call(*function, &bounds, side)
            }
            _ => Interval::ALL,
        }
    }
}

fn combine_bounds(operator: BinaryOperator, left: Interval, right: Interval) -> Interval {
    match operator {
        BinaryOperator::Add => left.add_interval(right),
        BinaryOperator::Subtract => left.add_interval(right.negate()),
        BinaryOperator::Multiply => left.multiply(right),
        BinaryOperator::Divide => left.multiply(right.reciprocal()),
        BinaryOperator::Power => Interval::ALL,
    }
}

fn bound_call(function: Function, bounds: &[Interval], side: Option<Side>) -> Interval {
    match (bounds, side) {
        ([x, y], Some(side)) if matches!(function, Function::Min | Function::Max) => {
            let first = (function == Function::Min) == (side == Side::Minus);
            *(if first { x } else { y })
        }
        (_, Some(side)) if has_levels(function, side) => {
            let value = functions::evaluate_on_side(function, side, &vec![0.0; bounds.len()]);
            value.map_or(Interval::ALL, |value| Interval::from_ends(value, value))
        }
        _ => Interval::apply_function(function, bounds),
    }
}

/// Returns true if the function is constant on this side.
fn has_levels(function: Function, side: Side) -> bool {
    match function {
        Function::Sign | Function::Above | Function::Contact => true,
        Function::Deadzone | Function::Abs => side == Side::Free,
        _ => false,
    }
}
