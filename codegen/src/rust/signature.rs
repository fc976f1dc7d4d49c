//! Heads of emitted functions with prepared coefficients.

use super::expression::call;
use super::generics::{for_lanes, inlined_prefix, type_with_generics};
use crate::statements::File;
use crate::statements::layout::block;
use crate::statements::layout::{DEEPER, SHALLOWER};

/// Additional arguments and result of an emitted function.
pub(super) struct Signature<'a> {
    pub(super) name: &'a str,
    /// Constant generic parameters, each with its comma.
    pub(super) constant: &'a str,
    /// Additional arguments, one on each line.
    pub(super) arguments: &'a str,
    /// Result type; empty if there is none.
    pub(super) result: &'a str,
}

impl<'a> Signature<'a> {
    pub(super) fn new(name: &'a str, result: &'a str) -> Self {
        Self {
            name,
            constant: "",
            arguments: "",
            result,
        }
    }
}

pub(super) fn stage_with(
    file: &File<'_>,
    head: &str,
    with: &Signature<'_>,
    statements: &str,
) -> String {
    let &Signature {
        name,
        constant,
        arguments,
        result,
    } = with;
    let returned = if result.is_empty() {
        String::new()
    } else {
        format!(" -> {result}")
    };
    let signature = |name: &str, generics: &str, coefficients: &str| {
        format!(
            "pub fn {name}<{constant}{generics}>(\n\
             {DEEPER}t: T,\n\
             state: &[T; STATES],\n\
             inputs: &{},\n\
             coefficients: &{coefficients},\n\
             {arguments}{SHALLOWER}){returned} {{",
            type_with_generics(file, "Inputs"),
        )
    };
    let coefficients = type_with_generics(file, "Coefficients");
    let whole = format!("{head}{}", signature(name, "T: Scalar", &coefficients));
    if !for_lanes(file) {
        return block(&whole, statements, "}");
    }
    let further: Vec<&str> = arguments
        .lines()
        .filter_map(|line| line.split(':').next())
        .collect();
    let passed = [
        &["t", "state", "inputs", "coefficients"],
        further.as_slice(),
    ]
    .concat();
    let passed: Vec<String> = passed.into_iter().map(str::to_owned).collect();
    let inlined = format!("{}{name}", inlined_prefix(file));
    let call = call(
        &format!("{inlined}{}", rate_arguments(file, constant)),
        &passed,
    ) + "\n";
    let allowed = head.lines().filter(|line| line.starts_with("#["));
    let allowed: String = allowed.map(|line| format!("{line}\n")).collect();
    let inlined_head = format!(
        "/// [`{name}`], inlined into the calling function and compiled for its registers.\n\
         {allowed}#[inline(always)]\n"
    );
    let generics = if file.fields.is_empty() {
        "T: Scalar"
    } else {
        "T: Scalar, C: Coefficient<T>"
    };
    let read = coefficients.replace("<T>", "<C>");
    let signature = signature(&inlined, generics, &read);
    block(&whole, &call, "}") + &block(&format!("{inlined_head}{signature}"), statements, "}")
}

/// Returns the generic arguments in the call of a function for SIMD lanes.
fn rate_arguments(file: &File<'_>, constant: &str) -> String {
    let constants: Vec<&str> = constant
        .split(", ")
        .filter_map(|one| one.strip_prefix("const ")?.split(':').next())
        .collect();
    match (constants.is_empty(), file.fields.is_empty()) {
        (true, _) => String::new(),
        (false, true) => format!("::<{}, _>", constants.join(", ")),
        (false, false) => format!("::<{}, _, _>", constants.join(", ")),
    }
}
