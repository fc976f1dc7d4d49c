//! Elementary functions as emitted Rust, from their kernels. `slopes` writes their derivatives.

use super::expression::Writer;
use super::slopes;
use crate::statements::layout::block;
use crate::statements::layout::{DEEPER, SHALLOWER};
use crate::statements::{KernelStatements, describe_elementary};
use eomgen_elementary::{Double, Function as Elementary, Single};

/// Writes the function that stages call, and the type that represents it.
pub(super) fn elementary_function(function: Elementary) -> String {
    let (name, type_name) = (function.name(), slopes::type_name(function));
    let description = describe_elementary(function);
    let binary = function.arity() == 2;
    let (family, apply, [x, y]) = match (function, binary) {
        (Elementary::Atan2, _) => ("FunctionOfTwo", "function_of_two", ["y", "x"]),
        (_, true) => ("FunctionOfTwo", "function_of_two", ["x", "y"]),
        (_, false) => ("Function", "function", ["x", ""]),
    };
    let (second, argument) = if binary {
        (format!(", {y}: T"), y)
    } else {
        (String::new(), "")
    };
    let call = format!(
        "/// {description}\n#[inline(always)]\nfn {name}<T: Scalar>({x}: T{second}) -> T {{\n"
    ) + &format!("{DEEPER}{x}.{apply}::<{type_name}>({argument})\n{SHALLOWER}}}\n");
    let arguments: &[&str] = if binary { &[x, y] } else { &[x] };
    let function_of_kernel = |name: &str, kernel: KernelStatements| {
        block(
            &format!("#[inline(always)]\nfn {name}<T: Real>({x}: T{second}) -> T {{"),
            &lines(&kernel),
            "}",
        )
    };
    let value = function_of_kernel(
        "value",
        KernelStatements::new::<Double>(function, arguments),
    ) + &function_of_kernel(
        "single",
        KernelStatements::new::<Single>(function, arguments),
    );
    call + &format!("enum {type_name} {{}}\n")
        + &block(
            &format!("impl {family} for {type_name} {{"),
            &(value + &slopes::slope(function)),
            "}",
        )
}

fn lines(kernel: &KernelStatements) -> String {
    let mut writer = Writer::default();
    let mut lines = writer.statements(&kernel.computed);
    if let Some(value) = kernel.value() {
        lines.push_str(&writer.expression(value));
        lines.push('\n');
    }
    lines
}
