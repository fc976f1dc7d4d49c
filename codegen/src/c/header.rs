//! Header of the emitted C: sizes, names, structures, declarations.

use super::comments::{comment, resolve_links};
use super::controllers;
use super::jacobians;
use super::names::fill_template;
use super::real::Real;
use super::regimes::{REGIME, regime_head};
use super::stages::{declaration, nest_lines};
use super::step;
use super::types;
use super::types::structures;
use crate::program::Program;
use crate::statements::{EmitResult, File, Indices, Preparation, Stage, indices};

/// Returns title and origin of a file, by lines.
pub(super) fn documentation(program: &Program) -> Vec<String> {
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

/// Returns the notes for callers, by lines.
fn notes(program: &Program, (other, precision): (&str, &str)) -> Vec<String> {
    let mut lines = documentation(program);
    let state = program.state_names().join(", ");
    let name = &program.name;
    let text = format!(
        "\nState: {state}.\n\
         All quantities are in SI units. The code does not allocate or call a library. Functions are\n\
         reentrant. Their output arguments must not overlap their input arguments.\n\
         \n\
         Compile {name}.c as C99 or C++. The results have the same bits with every compiler that does\n\
         not contract products and sums: use -std=c99 or -ffp-contract=off. For {precision} precision,\n\
         use -D{name}_REAL={other} here and for every file that includes this one."
    );
    lines.extend(text.split('\n').map(str::to_owned));
    lines
}

pub(super) fn header(
    file: &File<'_>,
    prepared: &Preparation,
    stages: &[Stage],
    real: Real,
) -> EmitResult<String> {
    let program = file.program;
    let (number, other, precision) = match real {
        Real::Double => ("double", "float", "single"),
        Real::Single => ("float", "double", "double"),
    };
    let mut text = comment(&notes(program, (other, precision)));
    text += &fill_template(
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
    let [hide, restore] = hidden_macros(file);
    text += &hide;
    text += &sizes(file);
    text += &jacobians::sizes(program);
    text += &structures(file, prepared)?;
    text += &types::declarations(program);
    for stage in stages {
        text += &declaration(program, stage);
    }
    if program.outputs.regimes.is_some() {
        text += &comment(&resolve_links(program, REGIME));
        text += &format!("{};\n", regime_head(program, false));
    }
    text += &step::declaration(program);
    text += &jacobians::declarations(program);
    text += &controllers::declarations(program);
    Ok(text + &restore + "#ifdef __cplusplus\n}\n#endif\n#endif\n")
}

/// Macros of `<complex.h>`, which a caller can include before this header.
const COMPLEX_MACROS: [&str; 3] = ["I", "complex", "imaginary"];

/// Returns the lines that hide macros with the name of a field, and those that restore them.
fn hidden_macros(file: &File<'_>) -> [String; 2] {
    let program = file.program;
    let parameters = program
        .parameters
        .iter()
        .map(|parameter| &parameter.quantity.name);
    let inputs = program.inputs.iter().map(|input| &input.name);
    let fields: Vec<&String> = parameters
        .chain(inputs)
        .chain(file.field_names.values())
        .collect();
    let [mut hide, mut restore] = [String::new(), String::new()];
    for name in COMPLEX_MACROS {
        if fields.iter().any(|field| *field == name) {
            hide += &format!("#pragma push_macro(\"{name}\")\n#undef {name}\n");
            restore += &format!("#pragma pop_macro(\"{name}\")\n");
        }
    }
    if !hide.is_empty() {
        hide = "/** The header <complex.h> defines macros with the name of a field. */\n"
            .to_owned()
            + &hide;
    }
    [hide, restore]
}

fn sizes(file: &File<'_>) -> String {
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
    text + &index_constants(program)
}

/// Writes one enumeration for each kind of index, `NAME_STATE_X` and so on.
fn index_constants(program: &Program) -> String {
    let mut text = String::new();
    for Indices { kind, doc, entries } in indices(program) {
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

/// Returns the arrays of names and orders: head, elements, documentation. An empty array has one null pointer
/// or 0, because C has no empty arrays.
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
    lists
}
