//! Functions of one or two numbers, with the results that every backend must give.

use eomgen_elementary::{Function as Elementary, Real};
use eomgen_model_spec::function::Function;

/// Definition of a function of the expression language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PiecewiseFunction {
    /// Elementary function of the same name.
    Elementary(Elementary),
    /// f_k of Eq. (7).
    Deadzone,
    /// Indicator of |p| > b, Eq. (8).
    Contact,
    /// Indicator of p > 0.
    Above,
}

/// Computes a function of the expression language; functions of one argument ignore `b`.
pub fn call<N: Real + PartialOrd>(function: Function, a: N, b: N) -> N {
    match piecewise_function(function) {
        PiecewiseFunction::Elementary(elementary) => elementary.apply(&[a, b]),
        PiecewiseFunction::Deadzone => deadzone(a, b),
        PiecewiseFunction::Contact => contact(a, b),
        PiecewiseFunction::Above => above(a),
    }
}

/// Computes f_k of Eq. (7).
fn deadzone<N: Real + PartialOrd>(p: N, b: N) -> N {
    let held = if p > b { b } else { p };
    p - if -b > held { -b } else { held }
}

/// Computes the indicator of |p| > b, Eq. (8).
fn contact<N: Real + PartialOrd>(p: N, b: N) -> N {
    N::constant(if p > b || p < -b { 1.0 } else { 0.0 })
}

fn above<N: Real + PartialOrd>(p: N) -> N {
    N::constant(if p > N::constant(0.0) { 1.0 } else { 0.0 })
}

/// Returns the definition of a function.
pub fn piecewise_function(function: Function) -> PiecewiseFunction {
    PiecewiseFunction::Elementary(match function {
        Function::Sin => Elementary::Sin,
        Function::Cos => Elementary::Cos,
        Function::Tan => Elementary::Tan,
        Function::Asin => Elementary::Asin,
        Function::Acos => Elementary::Acos,
        Function::Atan => Elementary::Atan,
        Function::Atan2 => Elementary::Atan2,
        Function::Sinh => Elementary::Sinh,
        Function::Cosh => Elementary::Cosh,
        Function::Tanh => Elementary::Tanh,
        Function::Exp => Elementary::Exp,
        Function::Ln => Elementary::Ln,
        Function::Sqrt => Elementary::Sqrt,
        Function::Abs => Elementary::Abs,
        Function::Sign => Elementary::Sign,
        Function::Min => Elementary::Min,
        Function::Max => Elementary::Max,
        Function::Deadzone => return PiecewiseFunction::Deadzone,
        Function::Contact => return PiecewiseFunction::Contact,
        Function::Above => return PiecewiseFunction::Above,
    })
}
