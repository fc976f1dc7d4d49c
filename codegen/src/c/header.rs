//! Header of the emitted C: sizes, names, structures, declarations.

use super::comments::{comment, resolve_links};
use super::controllers;
use super::expression::number;
use super::jacobians;
use super::names::{fill_template, item_name};
use super::real::Real;
use super::regimes::{REGIME, write_regime_head};
use super::stages::{nest_lines, write_declaration};
use super::standard_macros::{find_macros, hide_macros};
use super::step;
use super::types;
use super::types::write_structures;
use crate::program::{Output, Program};
use crate::statements::{
    DataElements, EmitResult, File, Indices, Preparation, Stage, list_data_arrays, list_indices,
};

/// Returns title and origin of a file, one string per line.
pub(super) fn describe_file(program: &Program) -> Vec<String> {
    let orders: Vec<String> = program.fields.iter().map(|f| f.order.to_string()).collect();
    let order = if orders.is_empty() {
        "rigid".to_owned()
    } else {
        format!("modal truncation order {}", orders.join(", "))
    };
    vec![
        format!(
            "{}: equations of motion, {order}.",
            program.title.trim_end_matches('.')
        ),
        String::new(),
        format!(
            "Emitted by eomgen {} from the specification `{}` (SHA-256 {}).",
            env!("CARGO_PKG_VERSION"),
            program.specification,
            program.spec_hash
        ),
        "Do not edit: change the specification and generate again.".to_owned(),
    ]
}

/// Instructions for a source file with a header.
pub(super) const TWO_FILES: &str = "Compile NAME.c as C99 or C++.";

/// Instructions for a single header that contains the functions.
pub(super) const HEADER_ONLY: &str = "Define NAME_IMPLEMENTATION in one C99 or C++ file of the program before it includes this header: that file\n\
     then contains the functions, and the files that include the header without it call them.";

/// Returns the comment at the top of the header, with the notes for callers.
pub(super) fn write_notes(program: &Program, real: Real, usage: &str) -> String {
    let mut lines = describe_file(program);
    let (other, precision) = match real {
        Real::Double => ("float", "single"),
        Real::Single => ("double", "double"),
    };
    let state = program.state_names().join(", ");
    let name = &program.name;
    let text = format!(
        "\nState: {state}.\n\
         All quantities are in SI units. The code does not allocate or call a library. Functions are\n\
         reentrant. Their output arguments must not overlap their input arguments.\n\
         \n\
         {}\n\
         The results are bit-identical with every compiler that does not contract products and sums. For gcc,\n\
         Clang and MSVC the source ensures this; other compilers need -std=c99. For {precision} precision, use -D{name}_REAL={other} for\n\
         every file that includes this one.",
        usage.replace("NAME", name)
    );
    lines.extend(text.split('\n').map(str::to_owned));
    comment(&lines)
}

pub(super) fn write_header(
    file: &File<'_>,
    prepared: &Preparation,
    stages: &[Stage],
    real: Real,
) -> EmitResult<String> {
    let program = file.program;
    let number = match real {
        Real::Double => "double",
        Real::Single => "float",
    };
    let text = fill_template(
        program,
        &"#ifndef NAME_H\n#define NAME_H\n#include <stdint.h>\n\
         #ifdef __cplusplus\nextern \"C\" {\n#endif\n\
         /** Type of all numbers. */\n\
         #ifndef NAME_REAL\n#define NAME_REAL NUMBER\n#endif\n\
         typedef NAME_REAL NAME_real;\n\
         /** 1 if the type of numbers is float: elementary functions are then computed in single precision. */\n\
         #define NAME_TYPE_float 1\n\
         #define NAME_TYPE_double 0\n\
         #define NAME_IS_TYPE(type) NAME_TYPE_##type\n\
         #define NAME_IS_SINGLE(type) NAME_IS_TYPE(type)\n"
            .replace("NUMBER", number),
    );
    let text = text + &write_external_names(program, stages);
    let mut declared = write_sizes(file);
    declared += &jacobians::write_sizes(program);
    declared += &step::write_sizes(program);
    declared += &write_structures(file, prepared)?;
    declared += &types::write_declarations(program);
    for stage in stages {
        declared += &write_declaration(program, stage);
    }
    if program.outputs.regimes.is_some() {
        declared += &comment(&resolve_links(program, REGIME));
        declared += &format!("{};\n", write_regime_head(program, false));
    }
    declared += &step::write_declaration(program);
    declared += &jacobians::write_declarations(program);
    declared += &controllers::write_declarations(program);
    let [hide, restore] = hide_macros(find_macros(&declared));
    Ok(text + &hide + &declared + &restore + "#ifdef __cplusplus\n}\n#endif\n#endif\n")
}

/// Writes macros that add the number type, unless it is double, to the external names of all functions and arrays with
/// numbers. A linker cannot compare types, but rejects missing names.
fn write_external_names(program: &Program, stages: &[Stage]) -> String {
    let mut text = fill_template(
        program,
        "/** 1 if the type of numbers is double. External names contain any other type: files that are compiled with \
         different types do not link. */\n\
         #define NAME_DOUBLE_float 0\n\
         #define NAME_DOUBLE_double 1\n\
         #define NAME_IS_DOUBLE_TYPE(type) NAME_DOUBLE_##type\n\
         #define NAME_IS_DOUBLE(type) NAME_IS_DOUBLE_TYPE(type)\n\
         #if !NAME_IS_DOUBLE(NAME_REAL)\n\
         #define NAME_JOIN(name, type) name##type\n\
         #define NAME_WITH_TYPE(name, type) NAME_JOIN(name, type)\n",
    );
    for name in list_external_names(program, stages) {
        let line = format!("#define {name} NAME_WITH_TYPE({name}_, NAME_REAL)\n");
        text += &fill_template(program, &line);
    }
    text + "#endif\n"
}

/// Returns the external names of functions and arrays with numbers.
fn list_external_names(program: &Program, stages: &[Stage]) -> Vec<String> {
    let has = |output: Output| program.outputs.kinds.contains(&output);
    let optional = [
        (program.outputs.regimes.is_some(), "regime"),
        (has(Output::Step), "step"),
        (jacobians::has_linearisation(program), "linearise"),
    ];
    let filling = types::FILLING.iter().map(|(name, _, _)| *name);
    let optional = optional.iter().filter(|(is_emitted, _)| *is_emitted);
    let items = filling
        .chain(stages.iter().map(|stage| stage.name))
        .chain(optional.map(|(_, name)| *name));
    let arrays = list_data_arrays(program).into_iter();
    let arrays = arrays.filter(|array| matches!(array.elements, DataElements::Numbers(_)));
    let arrays: Vec<String> = arrays
        .map(|array| format!("{}_{}", program.name, array.name))
        .collect();
    let mut names: Vec<String> = items.map(|item| item_name(program, item)).collect();
    names.extend(controllers::list_functions(program));
    names.extend(arrays);
    names
}

fn write_sizes(file: &File<'_>) -> String {
    let program = file.program;
    let mut text = String::new();
    for (name, count, doc) in [
        (
            "DEGREES_OF_FREEDOM",
            program.degrees_of_freedom(),
            "Number of degrees of freedom: coordinates and modes.",
        ),
        (
            "STATES",
            program.states(),
            "Number of states: coordinates, modes, and the rates of both.",
        ),
        (
            "OBSERVABLES",
            program.observables.len(),
            "Number of observables.",
        ),
        (
            "GUARDS",
            file.guard_count(),
            "Number of switching surfaces.",
        ),
        ("INPUTS", program.inputs.len(), "Number of inputs."),
        (
            "PARAMETERS",
            program.parameters.len(),
            "Number of parameters.",
        ),
        ("FIELDS", program.fields.len(), "Number of flexible fields."),
    ] {
        text += &comment(&[doc.to_owned()]);
        text += &fill_template(program, &format!("#define NAME_{name} {count}\n"));
    }
    for (name, value, doc) in [
        (
            "SPECIFICATION_SHA256",
            program.spec_hash.as_str(),
            "SHA-256 of the specification.",
        ),
        (
            "GENERATOR_VERSION",
            env!("CARGO_PKG_VERSION"),
            "Version of the generator.",
        ),
    ] {
        text += &comment(&[doc.to_owned()]);
        text += &fill_template(program, &format!("#define NAME_{name} \"{value}\"\n"));
    }
    for (head, _, doc) in lists(program) {
        text += &comment(&[doc.to_owned()]);
        text += &format!("extern {head};\n");
    }
    text += &comment(&[
        "Identity, for `eomgen identify`; `source` is the SHA-256 of the C file without the line of its identity."
            .to_owned(),
    ]);
    text += &fill_template(program, "extern const char NAME_identity[];\n");
    text + &write_index_constants(program)
}

/// Writes one enumeration for each kind of index, `NAME_STATE_X` and so on.
fn write_index_constants(program: &Program) -> String {
    let mut text = String::new();
    for Indices { kind, doc, entries } in list_indices(program) {
        let stem = format!("{}_{}", program.name, kind.to_uppercase());
        let last = entries.len() - 1;
        let constant = |(place, (_, constant)): (usize, &(String, String))| {
            let comma = if place < last { "," } else { "" };
            format!("{stem}_{constant} = {place}{comma}\n")
        };
        let lines: String = entries.iter().enumerate().map(constant).collect();
        text += &comment(&[doc.to_owned()]);
        text += &nest_lines("enum {", &lines, "};");
    }
    text
}

/// Returns the arrays of names, orders, units, initial state and ranges: head, elements, documentation. An empty array
/// has one null pointer or 0, because C has no empty arrays.
pub(super) fn lists(program: &Program) -> Vec<(String, Vec<String>, &'static str)> {
    let quoted = |names: Vec<String>| -> Vec<String> {
        names
            .into_iter()
            .map(|name| format!("\"{name}\""))
            .collect()
    };
    let states = program.state_names();
    let observables = program.observables.iter().map(|o| o.name.clone()).collect();
    let inputs = program.inputs.iter().map(|i| i.name.clone()).collect();
    let parameters = program
        .parameters
        .iter()
        .map(|p| p.quantity.name.clone())
        .collect();
    let mut lists = Vec::new();
    for (name, elements, doc) in [
        (
            "state_names",
            states,
            "Names of the states, in their order.",
        ),
        (
            "observable_names",
            observables,
            "Names of the observables, in their order.",
        ),
        (
            "input_names",
            inputs,
            "Names of the inputs, in their order.",
        ),
        (
            "parameter_names",
            parameters,
            "Names of the parameters, in their order.",
        ),
    ] {
        let mut elements = quoted(elements);
        if elements.is_empty() {
            elements.push("0".to_owned());
        }
        let head = format!("const char *const NAME_{name}[{}]", elements.len());
        lists.push((fill_template(program, &head), elements, doc));
    }
    let mut orders: Vec<String> = program.fields.iter().map(|f| f.order.to_string()).collect();
    if orders.is_empty() {
        orders.push("0".to_owned());
    }
    let head = format!("const int NAME_orders[{}]", orders.len());
    let doc = "Modal truncation order of each field.";
    lists.push((fill_template(program, &head), orders, doc));
    for of in list_data_arrays(program) {
        let (item, mut elements) = match of.elements {
            DataElements::Texts(texts) => ("char *const", quoted(texts)),
            DataElements::Numbers(numbers) => {
                let numbers = numbers
                    .into_iter()
                    .map(|value| write_data_number(program, value));
                ("NAME_real", numbers.collect())
            }
        };
        if elements.is_empty() {
            elements.push("0".to_owned());
        }
        let head = format!("const {item} NAME_{}[{}]", of.name, elements.len());
        lists.push((fill_template(program, &head), elements, of.doc));
    }
    lists
}

/// Writes a number of a constant array; see [`UNBOUNDED`].
fn write_data_number(program: &Program, value: f64) -> String {
    match value.is_infinite() {
        true if value > 0.0 => fill_template(program, "R(NAME_UNBOUNDED)"),
        true => fill_template(program, "R(-NAME_UNBOUNDED)"),
        false => format!("R({})", number(value)),
    }
}

/// Constant for infinity. GNU compilers have a builtin function, which needs no `<math.h>`; toolchains for
/// microcontrollers can lack this header.
pub(super) const UNBOUNDED: &str = "\
/** Infinity: end of a range that the specification does not give. */
#if defined(__GNUC__)
#define NAME_UNBOUNDED __builtin_inf()
#else
#include <math.h>
#define NAME_UNBOUNDED INFINITY
#endif
";
