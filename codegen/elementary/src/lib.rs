//! Elementary functions as plain floating-point operations, bit-identical on every machine.
//!
//! ```
//! use eomgen_elementary::{Function, exp, sin_cos};
//!
//! let (sine, cosine) = sin_cos(0.5_f64);
//! assert!((sine * sine + cosine * cosine - 1.0).abs() < 1e-15);
//!
// The recorded operations of the exponential give the bit-identical result.
//! let kernel = Function::Exp.kernel();
//! assert_eq!(kernel.evaluate(&[0.5]), [exp(0.5_f64)]);
//! ```
//!
//! `core` lacks these functions, even the square root, and system libraries differ in the last bit. Each
//! function here is a branch-free sequence of IEEE 754 operations in a fixed order, generic over [`Real`]:
//!
//! * for `f64` and `f32` it is an ordinary function without allocation or standard library, in the operations
//!   and with the constants of that format;
//! * with the feature `trace`, `Function::kernel` returns the operations as data (a `Kernel`), which code generators
//!   print or compile. Native value and kernel are bit-identical.
//!
//! There is no fused multiply-add, no conversion or rounding instruction, no table and no branch: a compiler
//! can vectorise the code but cannot change a result. The sign and payload of NaN are not specified. The
//! rounding mode must be to nearest, and subnormals must not be flushed; Rust assumes both.
//!
//! # The pipeline
//! `precision` (constants of the formats) -> `real` (the primitive operations) -> `approximation`, `pair` (polynomials, reductions, error-free sums and
//! products) -> `sine`, `exponential`, `logarithm`, `root`, `inverse_trigonometric`, `power`, `trivial`,
//! `piecewise` (the functions) -> `record` -> `kernel` -> `function` (tracing).
//!
//! # Accuracy and size
//! Errors are the largest measured, in units in the last place of the result, compared with 128-bit arithmetic: 150
//! 000 pseudo-random arguments per range (all magnitudes, dense near changes of method) and hard cases (doubles
//! nearest to multiples of pi/2, results near overflow and in the subnormal range, arguments next to 1). The
//! operations are counted in the kernel; a selection counts as one. The table applies to double precision. In single
//! precision no error exceeds two units in the last place, for angles up to 1e5.
//!
//! | function | domain | largest error (ulp) | operations |
//! | --- | --- | --- | --- |
//! | [`sin`] | `abs(x) <=` [`LARGEST_ANGLE`], NaN beyond | 0.76 | 67 |
//! | [`cos`] | as `sin` | 0.77 | 68 |
//! | [`sin_cos`] | as `sin` | as both | 71 |
//! | [`tan`] | as `sin` | 0.94 | 103 |
//! | [`exp`] | all | 0.76 | 50 |
//! | [`exp_minus_one`] | all | 1.10 | 56 |
//! | [`sinh`] | all | 1.15 | 81 |
//! | [`cosh`] | all | 0.88 | 53 |
//! | [`tanh`] | all | 0.91 | 93 |
//! | [`ln`] | `x >= 0`, NaN below | 0.81 | 42 |
//! | [`sqrt`] | `x >= 0`, NaN below | 0.5: correctly rounded | 84 |
//! | [`asin`] | `[-1, 1]`, NaN beyond | 0.63 | 116 |
//! | [`acos`] | `[-1, 1]`, NaN beyond | 0.60 | 120 |
//! | [`atan`] | all | 0.75 | 62 |
//! | [`atan2`] | all | 1.45 | 77 |
//! | [`pow`] | all; `x < 0` with integral `y` | 0.76 | 228 |
//! | [`abs`], [`sign`], [`min`], [`max`] | all | exact | 1, 2, 2, 2 |
//! | [`deadzone`], [`contact`], [`above`] | all | exact; `p - b` rounded | 4, 3, 1 |
//! | [`pivot_reciprocal`] | `pivot > 0`, NaN else | 0.5: correctly rounded | 2 |
//! | [`quantise`] | up to `2^51` steps | a rounded quotient and product | 10 |
#![cfg_attr(not(feature = "trace"), no_std)]

mod approximation;
mod exponential;
mod inverse_trigonometric;
mod logarithm;
mod pair;
mod piecewise;
mod power;
mod precision;
mod real;
mod root;
mod sine;
mod trivial;

#[cfg(feature = "trace")]
mod function;
#[cfg(feature = "trace")]
mod kernel;
#[cfg(feature = "trace")]
mod record;

pub use exponential::{cosh, exp, exp_minus_one, sinh, tanh};
pub use inverse_trigonometric::{acos, asin, atan, atan2};
pub use logarithm::ln;
pub use piecewise::{above, contact, deadzone, pivot_reciprocal};
pub use power::pow;
pub use precision::{Double, Precision, Single};
pub use real::Real;
pub use root::sqrt;
pub use sine::{LARGEST_ANGLE, LARGEST_SINGLE_ANGLE, cos, sin, sin_cos, tan};
pub use trivial::{abs, max, min, quantise, sign};

#[cfg(feature = "trace")]
pub use function::{Function, sin_cos_kernel};
#[cfg(feature = "trace")]
pub use kernel::{Kernel, Operation};
