//! Mapping of the functions of the expression language to elementary functions with one definition for all backends.

use eomgen_elementary::{Function as Elementary, Real};
use eomgen_model_spec::function::Function;

/// Computes a function of the expression language; functions of one argument ignore `b`.
pub fn call<N: Real>(function: Function, a: N, b: N) -> N {
    elementary(function).apply(&[a, b])
}

/// Returns the elementary function for a function of the expression language.
pub fn elementary(function: Function) -> Elementary {
    match function {
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
        Function::Deadzone => Elementary::Deadzone,
        Function::Contact => Elementary::Contact,
        Function::Above => Elementary::Above,
    }
}
