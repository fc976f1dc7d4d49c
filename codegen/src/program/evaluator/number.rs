//! Numbers in which the steps of a program are computed.

use eomgen_elementary::Real;
use std::ops::AddAssign;

/// Number of the evaluator: `f64`, or `f32` for the bits of emitted code in single precision.
pub trait Number: Real + PartialOrd + AddAssign + Into<f64> {}

impl Number for f64 {}
impl Number for f32 {}
