//! Generic parameters of emitted types and functions.

use crate::program::Output;
use crate::statements::File;

/// Returns true if every function is also emitted in a version for SIMD lanes.
pub(super) fn for_lanes(file: &File<'_>) -> bool {
    file.program.outputs.kinds.contains(&Output::Lanes)
}

/// Returns the prefix of functions that emitted functions call.
pub(super) fn inlined_prefix(file: &File<'_>) -> &'static str {
    if for_lanes(file) { "inlined_" } else { "" }
}

/// Returns the type of the parameters, inputs or coefficients; it is generic if it contains a number.
pub(super) fn type_with_generics(file: &File<'_>, name: &str) -> String {
    let numbers = match name {
        "Parameters" => file.program.parameters.len(),
        "Inputs" => file.program.inputs.len(),
        _ => file.fields.len(),
    };
    format!("{name}{}", if numbers > 0 { "<T>" } else { "" })
}
