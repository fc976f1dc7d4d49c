//! Kernel of a function: a sequence of primitive operations, which code generators print or compile and `evaluate`
//! executes. `record` builds kernels.

use crate::real::Real;

/// Primitive operation. The method of [`Real`] of the same name defines it. Every `usize` except that of
/// [`Operation::Input`] is the index of an earlier operation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// Argument with this index.
    Input(usize),
    /// Literal, to be printed with all its bits; infinities and NaN occur.
    Constant(f64),
    /// `a + b`.
    Add(usize, usize),
    /// `a - b`.
    Sub(usize, usize),
    /// `a b`.
    Mul(usize, usize),
    /// `a / b`.
    Div(usize, usize),
    /// `a` with the sign bit flipped.
    Neg(usize),
    /// `a` with the sign bit cleared.
    Abs(usize),
    /// Magnitude with the sign bit of another value.
    CopySign {
        /// Source of all bits except the sign.
        magnitude: usize,
        /// Source of the sign bit.
        sign: usize,
    },
    /// `then` if `left < right`, else `otherwise`.
    SelectLess {
        /// Left side of the comparison.
        left: usize,
        /// Right side of the comparison.
        right: usize,
        /// Result if the comparison is true.
        then: usize,
        /// Result otherwise, also if either side is NaN.
        otherwise: usize,
    },
    /// `then` if `left == right`, else `otherwise`.
    SelectEqual {
        /// Left side of the comparison.
        left: usize,
        /// Right side of the comparison.
        right: usize,
        /// Result if the comparison is true.
        then: usize,
        /// Result otherwise, also if either side is NaN.
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
    /// Applies `change` to the index of each operand, in order.
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

    /// Returns false for an input or a constant.
    pub fn is_computed(self) -> bool {
        !matches!(self, Operation::Input(_) | Operation::Constant(_))
    }

    /// Computes the value; `operand` returns the values of earlier operations, `input` the arguments.
    fn value<R: Real>(self, operand: impl Fn(usize) -> R, input: impl Fn(usize) -> R) -> R {
        use Operation::*;
        match self {
            Input(i) => input(i),
            Constant(value) => R::constant(value),
            Add(a, b) => operand(a) + operand(b),
            Sub(a, b) => operand(a) - operand(b),
            Mul(a, b) => operand(a) * operand(b),
            Div(a, b) => operand(a) / operand(b),
            Neg(a) => -operand(a),
            Abs(a) => operand(a).abs(),
            CopySign { magnitude, sign } => operand(magnitude).copysign(operand(sign)),
            SelectLess {
                left,
                right,
                then,
                otherwise,
            } => R::select_less(
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
            } => R::select_equal(
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
/// No operation is repeated or unused, and no operation refers to a later one.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// Number of arguments.
    pub inputs: usize,
    /// Operations in the order of execution.
    pub operations: Vec<Operation>,
    /// Indices of the results.
    pub outputs: Vec<usize>,
}

impl Kernel {
    /// Executes the operations in the format of `R`, which must be that of the kernel. A missing argument is NaN.
    pub fn evaluate<R: Real>(&self, arguments: &[R]) -> Vec<R> {
        let nan = R::constant(f64::NAN);
        let read = |values: &[R], i: usize| values.get(i).copied().unwrap_or(nan);
        let mut values: Vec<R> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let value = operation.value(|i| read(&values, i), |i| read(arguments, i));
            values.push(value);
        }
        self.outputs.iter().map(|&i| read(&values, i)).collect()
    }

    /// Returns the number of operations without inputs and constants.
    pub fn operation_count(&self) -> usize {
        self.operations.iter().filter(|o| o.is_computed()).count()
    }
}
