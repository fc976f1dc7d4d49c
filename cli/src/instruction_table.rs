//! Formats bounds of instructions and stack as a table.

use eomgen_validate::instructions::{FunctionBounds, InstructionBounds};

/// Returns the compiler command and one line for each function.
pub fn table(bounds: &InstructionBounds) -> String {
    let InstructionBounds {
        source,
        command,
        compiler,
        functions,
        ..
    } = bounds;
    let mut text = format!("{source}, {command} ({compiler})\n");
    let names = functions.iter().map(|function| function.name.len());
    let width = names.max().unwrap_or(0);
    for function in functions {
        text += &format!("  {:width$}  {}\n", function.name, line(function));
    }
    text
}

fn line(function: &FunctionBounds) -> String {
    let (Some(instructions), Some(stack)) = (function.instructions, function.stack) else {
        let reason = function.reason.as_deref().unwrap_or_default();
        return format!("not bounded: {reason}");
    };
    let normal = function.instructions_without_subnormals;
    let note = match normal.filter(|normal| *normal != instructions) {
        Some(normal) => format!(" ({normal} without subnormal numbers)"),
        None => String::new(),
    };
    format!("{instructions:>6} instructions{note}, {stack} bytes of stack")
}
