//! Functions by name: arguments, description, native value and kernel.

use crate::kernel::Kernel;
use crate::precision::{Double, Precision};
use crate::real::Real;
use crate::record::record;

/// Largest number of arguments.
const MAX_ARGUMENTS: usize = 2;

/// Defines [`Function`]. Each row contains the variant, the generic function of this crate, the names of its
/// arguments, and the description, which is also written to emitted code.
macro_rules! functions {
    ($($variant:ident $name:ident($($argument:ident),+) $description:literal;)+) => {
        /// Elementary or piecewise function.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Function {
            $(#[doc = $description] $variant,)+
        }

        impl Function {
            /// Every function.
            pub const ALL: [Function; [$(stringify!($name)),+].len()] = [$(Function::$variant),+];

            /// Returns the name of the generic function in this crate.
            pub fn name(self) -> &'static str {
                match self {
                    $(Function::$variant => stringify!($name),)+
                }
            }

            /// Returns the names of the arguments.
            pub fn arguments(self) -> &'static [&'static str] {
                match self {
                    $(Function::$variant => &[$(stringify!($argument)),+],)+
                }
            }

            /// Returns the description as one line.
            pub fn description(self) -> &'static str {
                match self {
                    $(Function::$variant => $description,)+
                }
            }

            /// Calls the generic function with the first arguments, as many as it has.
            #[inline]
            fn compute<R: Real>(self, arguments: [R; MAX_ARGUMENTS]) -> R {
                match self {
                    $(Function::$variant => {
                        let [$($argument,)+ ..] = arguments;
                        crate::$name($($argument),+)
                    })+
                }
            }
        }
    };
}

functions! {
    Abs abs(x) "Absolute value.";
    Sign sign(x) "Sign, with sign(0) = 0.";
    Min min(x, y) "Smaller of two numbers, NaN if either is NaN.";
    Max max(x, y) "Larger of two numbers, NaN if either is NaN.";
    Sqrt sqrt(x) "Square root.";
    Exp exp(x) "Exponential function.";
    ExpMinusOne exp_minus_one(x) "exp(x) - 1.";
    Ln ln(x) "Natural logarithm.";
    Sinh sinh(x) "Hyperbolic sine.";
    Cosh cosh(x) "Hyperbolic cosine.";
    Tanh tanh(x) "Hyperbolic tangent.";
    Sin sin(x) "Sine for |x| up to 1e9 (4194303 in single precision), NaN beyond.";
    Cos cos(x) "Cosine for |x| up to 1e9 (4194303 in single precision), NaN beyond.";
    Tan tan(x) "Tangent for |x| up to 1e9 (4194303 in single precision), NaN beyond.";
    Asin asin(x) "Inverse sine.";
    Acos acos(x) "Inverse cosine.";
    Atan atan(x) "Inverse tangent.";
    Atan2 atan2(y, x) "Angle of the point (x, y).";
    Pow pow(x, y) "x to the power y.";
    Quantise quantise(x, step)
        "Multiple of a step that is nearest to x, halves away from zero.";
    Deadzone deadzone(p, b) "Deflection beyond the play b: p - b above it, p + b below it, else 0.";
    Contact contact(p, b) "1 if |p| > b, else 0.";
    Above above(p) "1 if p > 0, else 0.";
    PivotReciprocal pivot_reciprocal(pivot)
        "1/pivot for a positive pivot, else NaN: the mass matrix is not positive definite.";
}

impl Function {
    /// Returns the number of arguments.
    pub fn arity(self) -> usize {
        self.arguments().len()
    }

    /// Returns true if emitted code contains one generic definition of the function for all number types. Such a
    /// function consists of arithmetic and [`Real::select_less`], so its derivatives follow by automatic
    /// differentiation.
    pub fn is_generic(self) -> bool {
        matches!(
            self,
            Function::Deadzone | Function::Contact | Function::Above | Function::PivotReciprocal
        )
    }

    /// Returns the primitive operations of the function in double precision, with one output.
    pub fn kernel(self) -> Kernel {
        self.kernel_in::<Double>()
    }

    /// Returns the primitive operations of the function in a number format, with one output.
    pub fn kernel_in<P: Precision>(self) -> Kernel {
        record::<P>(self.arity(), |arguments| match *arguments {
            [first] => vec![self.compute([first, first])],
            [first, second] => vec![self.compute([first, second])],
            _ => Vec::new(),
        })
    }

    /// Computes the value natively, bit-identical to the kernel. A missing argument is NaN.
    #[inline]
    pub fn apply<R: Real>(self, arguments: &[R]) -> R {
        let nan = R::constant(f64::NAN);
        let argument = |i: usize| arguments.get(i).copied().unwrap_or(nan);
        self.compute([argument(0), argument(1)])
    }
}

/// Returns the joint kernel of sine and cosine in a number format. Its outputs `sin` and `cos` are bit-identical to
/// those of the separate kernels.
pub fn sin_cos_kernel<P: Precision>() -> Kernel {
    record::<P>(1, |arguments| match *arguments {
        [x] => {
            let (sine, cosine) = crate::sin_cos(x);
            vec![sine, cosine]
        }
        _ => Vec::new(),
    })
}
