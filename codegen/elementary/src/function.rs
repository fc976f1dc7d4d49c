//! The functions by name: their arity, native value and kernel.

use crate::kernel::Kernel;
use crate::real::Real;
use crate::record::record;

/// An elementary function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function {
    /// [`crate::abs`].
    Abs,
    /// [`crate::sign`].
    Sign,
    /// [`crate::min`].
    Min,
    /// [`crate::max`].
    Max,
    /// [`crate::sqrt`].
    Sqrt,
    /// [`crate::exp`].
    Exp,
    /// [`crate::exp_minus_one`].
    ExpMinusOne,
    /// [`crate::ln`].
    Ln,
    /// [`crate::sinh`].
    Sinh,
    /// [`crate::cosh`].
    Cosh,
    /// [`crate::tanh`].
    Tanh,
    /// [`crate::sin`].
    Sin,
    /// [`crate::cos`].
    Cos,
    /// [`crate::tan`].
    Tan,
    /// [`crate::asin`].
    Asin,
    /// [`crate::acos`].
    Acos,
    /// [`crate::atan`].
    Atan,
    /// [`crate::atan2`], arguments `y, x`.
    Atan2,
    /// [`crate::pow`], arguments `x, y`.
    Pow,
}

impl Function {
    /// Every function.
    pub const ALL: [Function; 19] = [
        Function::Abs,
        Function::Sign,
        Function::Min,
        Function::Max,
        Function::Sqrt,
        Function::Exp,
        Function::ExpMinusOne,
        Function::Ln,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Sin,
        Function::Cos,
        Function::Tan,
        Function::Asin,
        Function::Acos,
        Function::Atan,
        Function::Atan2,
        Function::Pow,
    ];

    /// The name of the generic function in this crate.
    pub fn name(self) -> &'static str {
        match self {
            Function::Abs => "abs",
            Function::Sign => "sign",
            Function::Min => "min",
            Function::Max => "max",
            Function::Sqrt => "sqrt",
            Function::Exp => "exp",
            Function::ExpMinusOne => "exp_minus_one",
            Function::Ln => "ln",
            Function::Sinh => "sinh",
            Function::Cosh => "cosh",
            Function::Tanh => "tanh",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Tan => "tan",
            Function::Asin => "asin",
            Function::Acos => "acos",
            Function::Atan => "atan",
            Function::Atan2 => "atan2",
            Function::Pow => "pow",
        }
    }

    /// The number of arguments.
    pub fn arity(self) -> usize {
        match self {
            Function::Min | Function::Max | Function::Atan2 | Function::Pow => 2,
            _ => 1,
        }
    }

    /// The function's primitive operations, as many inputs as its arity, one output.
    pub fn kernel(self) -> Kernel {
        record(self.arity(), |arguments| match *arguments {
            [first] => vec![self.of(first, first)],
            [first, second] => vec![self.of(first, second)],
            _ => Vec::new(),
        })
    }

    /// The value, computed natively: bit for bit the kernel's. A missing argument reads as NaN.
    pub fn apply(self, arguments: &[f64]) -> f64 {
        let argument = |i: usize| arguments.get(i).copied().unwrap_or(f64::NAN);
        self.of(argument(0), argument(1))
    }

    /// The generic function; those of one argument ignore the second.
    fn of<R: Real>(self, first: R, second: R) -> R {
        match self {
            Function::Abs => crate::abs(first),
            Function::Sign => crate::sign(first),
            Function::Min => crate::min(first, second),
            Function::Max => crate::max(first, second),
            Function::Sqrt => crate::sqrt(first),
            Function::Exp => crate::exp(first),
            Function::ExpMinusOne => crate::exp_minus_one(first),
            Function::Ln => crate::ln(first),
            Function::Sinh => crate::sinh(first),
            Function::Cosh => crate::cosh(first),
            Function::Tanh => crate::tanh(first),
            Function::Sin => crate::sin(first),
            Function::Cos => crate::cos(first),
            Function::Tan => crate::tan(first),
            Function::Asin => crate::asin(first),
            Function::Acos => crate::acos(first),
            Function::Atan => crate::atan(first),
            Function::Atan2 => crate::atan2(first, second),
            Function::Pow => crate::pow(first, second),
        }
    }
}

/// Sine and cosine of one argument sharing all their work: outputs `sin`, `cos`, the very bits of
/// the two kernels.
pub fn sin_cos_kernel() -> Kernel {
    record(1, |arguments| match *arguments {
        [x] => {
            let (sine, cosine) = crate::sin_cos(x);
            vec![sine, cosine]
        }
        _ => Vec::new(),
    })
}
