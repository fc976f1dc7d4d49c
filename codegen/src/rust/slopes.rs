//! Derivatives of the elementary functions as emitted Rust, for dual numbers. They are written by hand,
//! independently of `differentiate`, so that each can check the other.

use std::collections::BTreeSet;

use crate::statements::layout::block;
use eomgen_elementary::Function as Elementary;

/// Returns the emitted type that represents a function.
pub fn type_name(function: Elementary) -> String {
    let mut name = String::new();
    for word in function.name().split('_') {
        let (first, rest) = word.split_at(1);
        name += &(first.to_uppercase() + rest);
    }
    name
}

/// Adds the functions that the derivatives call.
pub fn with_slopes(functions: &BTreeSet<Elementary>) -> BTreeSet<Elementary> {
    let mut all = functions.clone();
    for function in functions {
        all.extend(match function {
            Elementary::Sin | Elementary::Cos => vec![Elementary::Sin, Elementary::Cos],
            Elementary::Sinh | Elementary::Cosh => vec![Elementary::Sinh, Elementary::Cosh],
            Elementary::Asin | Elementary::Acos => vec![Elementary::Sqrt],
            Elementary::Pow => vec![Elementary::Ln],
            _ => Vec::new(),
        });
    }
    all
}

/// Writes the function `slope`, or `slopes` by both arguments; None for a generic function.
pub fn write_slope(function: Elementary) -> Option<String> {
    let signature = match function {
        Elementary::Atan2 => "fn slopes<T: Scalar>(y: T, x: T, _: T) -> [T; 2] {",
        Elementary::Min | Elementary::Max => "fn slopes<T: Scalar>(x: T, y: T, _: T) -> [T; 2] {",
        Elementary::Pow => "fn slopes<T: Scalar>(x: T, y: T, value: T) -> [T; 2] {",
        Elementary::Quantise => "fn slopes<T: Scalar>(_: T, _: T, _: T) -> [T; 2] {",
        Elementary::Exp
        | Elementary::ExpMinusOne
        | Elementary::Sqrt
        | Elementary::Tan
        | Elementary::Tanh => "fn slope<T: Scalar>(_: T, value: T) -> T {",
        Elementary::Sign => "fn slope<T: Scalar>(_: T, _: T) -> T {",
        _ => "fn slope<T: Scalar>(x: T, _: T) -> T {",
    };
    Some(block(
        &format!("#[inline(always)]\n{signature}"),
        write_lines(function)?,
        "}",
    ))
}

fn write_lines(function: Elementary) -> Option<&'static str> {
    Some(match function {
        Elementary::Abs => {
            "let (one, zero) = (T::number(1.0), T::number(0.0));\n\
             T::select_greater(x, zero, one, T::select_greater(zero, x, -one, zero))\n"
        }
        Elementary::Sign => "T::number(0.0)\n",
        Elementary::Min => {
            "let (one, zero) = (T::number(1.0), T::number(0.0));\n\
             [T::select_greater(x, y, zero, one), T::select_greater(x, y, one, zero)]\n"
        }
        Elementary::Max => {
            "let (one, zero) = (T::number(1.0), T::number(0.0));\n\
             [T::select_greater(y, x, zero, one), T::select_greater(y, x, one, zero)]\n"
        }
        Elementary::Sqrt => "T::number(0.5) / value\n",
        Elementary::Exp => "value\n",
        Elementary::ExpMinusOne => "value + T::number(1.0)\n",
        Elementary::Ln => "T::number(1.0) / x\n",
        Elementary::Sinh => "cosh(x)\n",
        Elementary::Cosh => "sinh(x)\n",
        Elementary::Tanh => "T::number(1.0) - value * value\n",
        Elementary::Sin => "cos(x)\n",
        Elementary::Cos => "-sin(x)\n",
        Elementary::Tan => "T::number(1.0) + value * value\n",
        Elementary::Asin => "T::number(1.0) / sqrt(T::number(1.0) - x * x)\n",
        Elementary::Acos => "-(T::number(1.0) / sqrt(T::number(1.0) - x * x))\n",
        Elementary::Atan => "T::number(1.0) / (T::number(1.0) + x * x)\n",
        Elementary::Atan2 => {
            "let square = x * x + y * y;\n\
             [x / square, -(y / square)]\n"
        }
        Elementary::Pow => {
            "let by_base = y * pow(x, y - T::number(1.0));\n\
             [by_base, value * ln(x)]\n"
        }
        Elementary::Quantise => "[T::number(0.0), T::number(0.0)]\n",
        Elementary::Deadzone
        | Elementary::Contact
        | Elementary::Above
        | Elementary::PivotReciprocal => return None,
    })
}
