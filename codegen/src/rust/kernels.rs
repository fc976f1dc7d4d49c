//! Elementary functions as emitted Rust, written from their kernels. `slopes` writes the derivatives of functions
//! that are not generic.

use super::expression::Writer;
use super::slopes;
use crate::statements::KernelStatements;
use crate::statements::layout::block;
use crate::statements::layout::{DEEPER, SHALLOWER};
use eomgen_elementary::{Double, Function as Elementary, Single};

/// Writes the function that stages call. If its derivative is given, also writes the type that represents the
/// function.
pub(super) fn function(function: Elementary) -> String {
    let call = format!(
        "/// {}\n#[inline(always)]\n{} {{\n",
        function.description(),
        write_head(function.name(), function, "Scalar")
    );
    let kernel = KernelStatements::new::<Double>(function);
    let Some(slope) = slopes::write_slope(function) else {
        return call + &format!("{DEEPER}{}{SHALLOWER}}}\n", write_lines(&kernel));
    };
    let type_name = slopes::type_name(function);
    let (family, apply, x, y) = match *function.arguments() {
        [x, y] => ("FunctionOfTwo", "function_of_two", x, y),
        [x, ..] => ("Function", "function", x, ""),
        [] => return String::new(),
    };
    let value = |name: &str, kernel: &KernelStatements| {
        let head = write_head(name, function, "Real");
        block(
            &format!("#[inline(always)]\n{head} {{"),
            &write_lines(kernel),
            "}",
        )
    };
    let values =
        value("value", &kernel) + &value("single", &KernelStatements::new::<Single>(function));
    call + &format!("{DEEPER}{x}.{apply}::<{type_name}>({y})\n{SHALLOWER}}}\n")
        + &format!("enum {type_name} {{}}\n")
        + &block(
            &format!("impl {family} for {type_name} {{"),
            &(values + &slope),
            "}",
        )
}

/// Writes the signature of a function for one number type.
fn write_head(name: &str, function: Elementary, numbers: &str) -> String {
    let arguments = function.arguments().iter();
    let typed: Vec<String> = arguments.map(|argument| format!("{argument}: T")).collect();
    format!("fn {name}<T: {numbers}>({}) -> T", typed.join(", "))
}

fn write_lines(kernel: &KernelStatements) -> String {
    let mut writer = Writer::default();
    let mut lines = writer.statements(&kernel.computed);
    if let Some(value) = kernel.value() {
        lines.push_str(&writer.expression(value));
        lines.push('\n');
    }
    lines
}
