//! Functions of one or two numbers, as every backend defines them.

use eomgen_elementary::Function as Elementary;
use eomgen_model_spec::model::Function;

/// 1/a for a positive pivot, NaN elsewhere.
pub(super) fn pivot_reciprocal(a: f64) -> f64 {
    if a > 0.0 { 1.0 / a } else { f64::NAN }
}

/// How a function of the expression language is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// As the elementary function of the same name.
    Elementary(Elementary),
    /// f_k of Eq. (7).
    Deadzone,
    /// 1 where |p| > b, 0 elsewhere, Eq. (8).
    Contact,
    /// 1 where p > 0, 0 elsewhere.
    Above,
}

/// A function of the expression language; `b` is read by those of two arguments.
pub fn call(function: Function, a: f64, b: f64) -> f64 {
    match law(function) {
        Law::Elementary(elementary) => elementary.apply(&[a, b]),
        Law::Deadzone => deadzone(a, b),
        Law::Contact => contact(a, b),
        Law::Above => above(a),
    }
}

/// f_k of Eq. (7).
fn deadzone(p: f64, b: f64) -> f64 {
    let held = if p > b { b } else { p };
    p - if -b > held { -b } else { held }
}

/// 1 where |p| > b, 0 elsewhere, Eq. (8).
fn contact(p: f64, b: f64) -> f64 {
    if p > b || p < -b { 1.0 } else { 0.0 }
}

/// 1 where p > 0, 0 elsewhere.
fn above(p: f64) -> f64 {
    if p > 0.0 { 1.0 } else { 0.0 }
}

/// How a function is computed.
pub fn law(function: Function) -> Law {
    Law::Elementary(match function {
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
        Function::Deadzone => return Law::Deadzone,
        Function::Contact => return Law::Contact,
        Function::Above => return Law::Above,
    })
}
