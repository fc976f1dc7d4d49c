//! Functions by name: arity, native value and kernel.

use crate::kernel::Kernel;
use crate::precision::{Double, Precision};
use crate::real::Real;
use crate::record::record;

/// Elementary function.
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
    /// [`crate::quantise`], arguments `x, step`.
    Quantise,
}

impl Function {
    /// Every function.
    pub const ALL: [Function; 20] = [
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
        Function::Quantise,
    ];

    /// Returns the name of the generic function in this crate.
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
            Function::Quantise => "quantise",
        }
    }

    /// Returns the number of arguments.
    pub fn arity(self) -> usize {
        match self {
            Function::Min
            | Function::Max
            | Function::Atan2
            | Function::Pow
            | Function::Quantise => 2,
            _ => 1,
        }
    }

    /// Returns the primitive operations of the function in double precision, with one output.
    pub fn kernel(self) -> Kernel {
        self.kernel_in::<Double>()
    }

    /// Returns the primitive operations of the function in a format, with one output.
    pub fn kernel_in<P: Precision>(self) -> Kernel {
        record::<P>(self.arity(), |arguments| match *arguments {
            [first] => vec![self.apply_real(first, first)],
            [first, second] => vec![self.apply_real(first, second)],
            _ => Vec::new(),
        })
    }

    /// Computes the value natively, with the same bits as the kernel. A missing argument is NaN.
    pub fn apply<R: Real>(self, arguments: &[R]) -> R {
        let nan = R::constant(f64::NAN);
        let argument = |i: usize| arguments.get(i).copied().unwrap_or(nan);
        self.apply_real(argument(0), argument(1))
    }

    /// Calls the generic function; functions of one argument ignore the second.
    fn apply_real<R: Real>(self, first: R, second: R) -> R {
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
            Function::Quantise => crate::quantise(first, second),
        }
    }
}

/// Returns the joint kernel of sine and cosine in a format, with outputs `sin` and `cos`, which have the bits
/// of the two kernels.
pub fn sin_cos_kernel<P: Precision>() -> Kernel {
    record::<P>(1, |arguments| match *arguments {
        [x] => {
            let (sine, cosine) = crate::sin_cos(x);
            vec![sine, cosine]
        }
        _ => Vec::new(),
    })
}
