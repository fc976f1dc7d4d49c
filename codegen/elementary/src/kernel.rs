//! A function as a straight line of primitive operations: what code generators print or compile.
//!
//! Holds the data and its evaluation in plain `f64`; how it comes to be is in `record`.

use crate::real::Real;

/// One primitive operation. Every `usize` but [`Operation::Input`]'s is the index of an earlier
/// operation. The meaning of each is that of the method of [`Real`] of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// The argument with this number.
    Input(usize),
    /// A literal, to be printed with all its bits (infinities and NaN occur).
    Constant(f64),
    /// `a + b`.
    Add(usize, usize),
    /// `a - b`.
    Sub(usize, usize),
    /// `a b`.
    Mul(usize, usize),
    /// `a / b`.
    Div(usize, usize),
    /// The sign bit flipped.
    Neg(usize),
    /// The sign bit cleared.
    Abs(usize),
    /// A magnitude with the sign bit of another value.
    CopySign {
        /// Gives all bits but the sign.
        magnitude: usize,
        /// Gives the sign bit.
        sign: usize,
    },
    /// `then` if `left < right`, else `otherwise`.
    SelectLess {
        /// Left of the comparison.
        left: usize,
        /// Right of the comparison.
        right: usize,
        /// The result if it holds.
        then: usize,
        /// The result if not, or if either side is NaN.
        otherwise: usize,
    },
    /// `then` if `left == right`, else `otherwise`.
    SelectEqual {
        /// Left of the comparison.
        left: usize,
        /// Right of the comparison.
        right: usize,
        /// The result if it holds.
        then: usize,
        /// The result if not, or if either side is NaN.
        otherwise: usize,
    },
    /// [`Real::power_of_two`].
    PowerOfTwo(usize),
    /// [`Real::exponent`].
    Exponent(usize),
    /// [`Real::significand`].
    Significand(usize),
}

impl Operation {
    /// The operation with `change` applied to the index of each operand, in order.
    pub fn map_operands(self, mut change: impl FnMut(usize) -> usize) -> Operation {
        use Operation::*;
        match self {
            Input(_) | Constant(_) => self,
            Add(a, b) => Add(change(a), change(b)),
            Sub(a, b) => Sub(change(a), change(b)),
            Mul(a, b) => Mul(change(a), change(b)),
            Div(a, b) => Div(change(a), change(b)),
            Neg(a) => Neg(change(a)),
            Abs(a) => Abs(change(a)),
            CopySign { magnitude, sign } => CopySign {
                magnitude: change(magnitude),
                sign: change(sign),
            },
            SelectLess {
                left,
                right,
                then,
                otherwise,
            } => SelectLess {
                left: change(left),
                right: change(right),
                then: change(then),
                otherwise: change(otherwise),
            },
            SelectEqual {
                left,
                right,
                then,
                otherwise,
            } => SelectEqual {
                left: change(left),
                right: change(right),
                then: change(then),
                otherwise: change(otherwise),
            },
            PowerOfTwo(a) => PowerOfTwo(change(a)),
            Exponent(a) => Exponent(change(a)),
            Significand(a) => Significand(change(a)),
        }
    }

    /// Whether this computes anything (an input or a constant does not).
    pub fn is_computed(self) -> bool {
        !matches!(self, Operation::Input(_) | Operation::Constant(_))
    }

    /// The value, with `operand` giving those of earlier operations and `input` the arguments.
    fn value(self, operand: impl Fn(usize) -> f64, input: impl Fn(usize) -> f64) -> f64 {
        use Operation::*;
        match self {
            Input(i) => input(i),
            Constant(value) => value,
            Add(a, b) => operand(a) + operand(b),
            Sub(a, b) => operand(a) - operand(b),
            Mul(a, b) => operand(a) * operand(b),
            Div(a, b) => operand(a) / operand(b),
            Neg(a) => -operand(a),
            Abs(a) => Real::abs(operand(a)),
            CopySign { magnitude, sign } => Real::copysign(operand(magnitude), operand(sign)),
            SelectLess {
                left,
                right,
                then,
                otherwise,
            } => Real::select_less(
                operand(left),
                operand(right),
                operand(then),
                operand(otherwise),
            ),
            SelectEqual {
                left,
                right,
                then,
                otherwise,
            } => Real::select_equal(
                operand(left),
                operand(right),
                operand(then),
                operand(otherwise),
            ),
            PowerOfTwo(a) => operand(a).power_of_two(),
            Exponent(a) => operand(a).exponent(),
            Significand(a) => operand(a).significand(),
        }
    }
}

/// Straight-line code in single-assignment form: operation `i` defines value `i`.
///
/// No operation is repeated, none is without use, and none refers to a later one.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// The number of arguments.
    pub inputs: usize,
    /// The operations, in an order in which they can be carried out.
    pub operations: Vec<Operation>,
    /// The operations whose values are the results.
    pub outputs: Vec<usize>,
}

impl Kernel {
    /// Carries the operations out in order. An argument that is not there reads as NaN.
    pub fn evaluate(&self, arguments: &[f64]) -> Vec<f64> {
        let read = |values: &[f64], i: usize| values.get(i).copied().unwrap_or(f64::NAN);
        let mut values: Vec<f64> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let value = operation.value(|i| read(&values, i), |i| read(arguments, i));
            values.push(value);
        }
        self.outputs.iter().map(|&i| read(&values, i)).collect()
    }

    /// The number of operations, inputs and constants not counted.
    pub fn operation_count(&self) -> usize {
        self.operations.iter().filter(|o| o.is_computed()).count()
    }
}
