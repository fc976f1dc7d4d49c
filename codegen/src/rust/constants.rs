//! Constants of an emitted file: sizes and names.

use super::expression::array;
use super::literals::number;
use crate::identity::write_unsealed_identity;
use crate::statements::layout::block;
use crate::statements::{
    DataElements, File, Indices, list_data_arrays, list_indices, reaction_constants,
};

pub(super) fn write_constants(file: &File<'_>) -> String {
    let program = file.program;
    let orders: Vec<String> = program.fields.iter().map(|f| f.order.to_string()).collect();
    let states = program.state_names();
    let state_names = quoted(states.iter().map(String::as_str));
    let observables = program.observables.iter().map(|o| o.name.as_str());
    format!(
        "/// Modal truncation order of each field.\n\
         pub const ORDERS: [usize; {}] = {};\n\
         /// Number of degrees of freedom: coordinates and modes.\n\
         pub const DEGREES_OF_FREEDOM: usize = {};\n\
         /// Number of states: coordinates, modes, and the rates of both.\n\
         pub const STATES: usize = {};\n\
         /// Names of the states, in their order.\n\
         pub const STATE_NAMES: [&'static str; STATES] = {state_names};\n\
         /// Number of observables.\n\
         pub const OBSERVABLES: usize = {};\n\
         /// Names of the observables, in their order.\n\
         pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = {};\n\
         /// Number of switching surfaces.\n\
         pub const GUARDS: usize = {};\n\
         /// SHA-256 of the specification.\n\
         pub const SPECIFICATION_SHA256: &'static str = \"{}\";\n\
         /// Version of the generator.\n\
         pub const GENERATOR_VERSION: &'static str = \"{}\";\n",
        orders.len(),
        array(&orders),
        program.degrees_of_freedom(),
        program.states(),
        program.observables.len(),
        quoted(observables),
        file.guard_count(),
        program.spec_hash,
        env!("CARGO_PKG_VERSION"),
    ) + &write_reactions(file)
        + &write_names(file)
        + &write_data(file)
        + &write_index_modules(file)
        + &write_identity(file)
}

/// Writes one module of constants for each kind of index: names of parameters and of states may be equal.
fn write_index_modules(file: &File<'_>) -> String {
    let mut text = String::new();
    for Indices { kind, doc, entries } in list_indices(file.program) {
        let constant = |(place, (name, constant)): (usize, &(String, String))| {
            format!("/// `{name}`\npub const {constant}: usize = {place};\n")
        };
        let lines: String = entries.iter().enumerate().map(constant).collect();
        text += &format!("/// {doc}\n#[allow(non_upper_case_globals)]\n");
        text += &block(&format!("pub mod {kind} {{"), &lines, "}");
    }
    text
}

fn write_identity(file: &File<'_>) -> String {
    let text = write_unsealed_identity(file.program);
    format!(
        "/// Identity, for `eomgen identify`; `source` is the SHA-256 of this file without the line below.\n\
         pub static IDENTITY: [u8; {}] = *b\"{text}\";\n",
        text.len()
    )
}

fn write_reactions(file: &File<'_>) -> String {
    let constants = reaction_constants(file.program);
    let constants = constants.iter();
    constants
        .map(|(name, count, doc)| format!("/// {doc}\npub const {name}: usize = {count};\n"))
        .collect()
}

fn write_names(file: &File<'_>) -> String {
    let program = file.program;
    let parameters = program.parameters.iter().map(|p| p.quantity.name.as_str());
    format!(
        "/// Number of inputs.\n\
         pub const INPUTS: usize = {};\n\
         /// Names of the inputs, in their order.\n\
         pub const INPUT_NAMES: [&'static str; INPUTS] = {};\n\
         /// Number of parameters.\n\
         pub const PARAMETERS: usize = {};\n\
         /// Names of the parameters, in their order.\n\
         pub const PARAMETER_NAMES: [&'static str; PARAMETERS] = {};\n",
        program.inputs.len(),
        quoted(program.inputs.iter().map(|i| i.name.as_str())),
        program.parameters.len(),
        quoted(parameters),
    )
}

/// Writes units, initial state and ranges.
fn write_data(file: &File<'_>) -> String {
    let mut text = String::new();
    for of in list_data_arrays(file.program) {
        let (item, elements) = match &of.elements {
            DataElements::Texts(texts) => {
                ("&'static str", quoted(texts.iter().map(String::as_str)))
            }
            DataElements::Numbers(numbers) => {
                let numbers: Vec<String> = numbers.iter().map(|value| number(*value)).collect();
                ("f64", array(&numbers))
            }
        };
        let (name, length) = (of.name.to_uppercase(), of.length);
        text += &format!(
            "/// {}\npub const {name}: [{item}; {length}] = {elements};\n",
            of.doc
        );
    }
    text
}

fn quoted<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let quoted: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    array(&quoted)
}
