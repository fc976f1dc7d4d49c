//! Which emitted types and functions are generic in what.

use crate::program::Output;
use crate::statements::File;

/// Whether every function is written a second time, for lanes.
pub(super) fn for_lanes(file: &File<'_>) -> bool {
    file.program.outputs.kinds.contains(&Output::Lanes)
}

/// What the names of functions that emitted functions call begin with.
pub(super) fn inlined(file: &File<'_>) -> &'static str {
    if for_lanes(file) { "inlined_" } else { "" }
}

/// The type of the parameters, of the inputs or of the coefficients: generic if a number
/// stands in it.
pub(super) fn generic(file: &File<'_>, name: &str) -> String {
    let numbers = match name {
        "Parameters" => file.program.parameters.len(),
        "Inputs" => file.program.inputs.len(),
        _ => file.fields.len(),
    };
    format!("{name}{}", if numbers > 0 { "<T>" } else { "" })
}
