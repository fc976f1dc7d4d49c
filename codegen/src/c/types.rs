//! Structures of the emitted C, with units, and the functions that fill them.

use super::comments::comment;
use super::expression::{Writer, number, write_assignment, write_loop};
use super::names::fill_template;
use super::stages::{nest_lines, write_head};
use crate::program::{Extent, Program, Quantity};
use crate::statements::layout::block;
use crate::statements::{
    EmitResult, File, Preparation, PreparedValue, UsedNames, describe_coefficient,
    describe_quantity,
};

pub(super) fn write_structures(file: &File<'_>, prepared: &Preparation) -> EmitResult<String> {
    let program = file.program;
    let mut fields = String::new();
    for parameter in &program.parameters {
        fields += &write_field(file, &parameter.quantity, &parameter.origin)?;
    }
    let mut text = write_structure(file, "Parameters of the model.", "parameters", fields);
    let mut fields = String::new();
    for input in &program.inputs {
        fields += &write_field(file, input, "")?;
    }
    text += &write_structure(file, "Inputs at run time.", "inputs", fields);
    let mut fields = String::new();
    for id in &file.fields {
        let extents = match program.value(*id).extent {
            Extent::Scalar => String::new(),
            Extent::Vector(length) => format!("[{length}]"),
            Extent::Matrix(rows, columns) => format!("[{rows}][{columns}]"),
        };
        let name = &file.field_names[id];
        fields += &comment(&[describe_coefficient(file, prepared, *id)]);
        fields += &fill_template(program, &format!("NAME_real {name}{extents};\n"));
    }
    let mut lines = vec![
        "1 if all prepared pivots of the mass matrix are positive and finite, else 0. If it is 0,"
            .to_owned(),
        "the mass matrix is not positive definite and the rates are invalid.".to_owned(),
    ];
    if program.may_lose_definiteness() {
        lines.extend([
            "The mass matrix also varies with the state, which this flag does not include: if it is not"
                .to_owned(),
            "positive definite, rates are NaN.".to_owned(),
        ]);
    }
    fields += &comment(&lines);
    fields += "int positive_definite;\n";
    let doc = "Values that depend only on the parameters: prepare once, use in every call.";
    Ok(text + &write_structure(file, doc, "coefficients", fields))
}

fn write_structure(file: &File<'_>, doc: &str, name: &str, fields: String) -> String {
    let fields = if fields.is_empty() {
        comment(&["Placeholder: C has no empty structures.".to_owned()]) + "char none;\n"
    } else {
        fields
    };
    let closing = fill_template(file.program, &format!("}} NAME_{name};"));
    comment(&[doc.to_owned()]) + &nest_lines("typedef struct {", &fields, &closing)
}

fn write_field(file: &File<'_>, quantity: &Quantity, origin: &str) -> EmitResult<String> {
    let name = file.words.identifier(&quantity.name)?;
    let doc = comment(&[describe_quantity(&quantity.doc, &quantity.unit, origin)]);
    Ok(doc + &fill_template(file.program, &format!("NAME_real {name};\n")))
}

/// Function that fills a structure: name, arguments by type and name, documentation.
pub(super) type Filling = (
    &'static str,
    &'static [(&'static str, &'static str)],
    &'static str,
);

pub(super) const FILLING: [Filling; 4] = [
    (
        "default_parameters",
        &[("NAME_parameters *", "parameters")],
        "Sets the values of the specification.",
    ),
    (
        "parameters_from_array",
        &[
            ("const NAME_real *", "numbers"),
            ("NAME_parameters *", "parameters"),
        ],
        "Sets parameters from `NAME_PARAMETERS` numbers in the order of `NAME_parameter_names`.",
    ),
    (
        "inputs_from_array",
        &[
            ("const NAME_real *", "numbers"),
            ("NAME_inputs *", "inputs"),
        ],
        "Sets inputs from `NAME_INPUTS` numbers in the order of `NAME_input_names`.",
    ),
    (
        "prepare",
        &[
            ("const NAME_parameters *", "parameters"),
            ("NAME_coefficients *", "coefficients"),
        ],
        "Prepares the coefficients of these parameters.",
    ),
];

pub(super) fn write_declarations(program: &Program) -> String {
    let declared = FILLING.map(|(name, arguments, doc)| {
        let head = write_head(program, ("void ", name), arguments, false);
        comment(&[fill_template(program, doc)]) + &format!("{head};\n")
    });
    declared.concat()
}

pub(super) fn write_fill_functions(
    file: &File<'_>,
    preparation: Preparation,
) -> EmitResult<String> {
    let program = file.program;
    let [defaults, parameters, inputs, prepare] =
        FILLING.map(|(name, arguments, _)| write_head(program, ("void ", name), arguments, true));
    let mut lines = String::new();
    for parameter in &program.parameters {
        let target = format!("parameters->{}", parameter.quantity.name);
        lines += &write_assignment(&target, &format!("R({})", number(parameter.value)));
    }
    let mut text = write_function(&defaults, "parameters->none = '\\0';\n", lines);
    let names = program.parameters.iter().map(|p| p.quantity.name.as_str());
    text += &write_from_array(&parameters, "parameters", names);
    let names = program.inputs.iter().map(|input| input.name.as_str());
    text += &write_from_array(&inputs, "inputs", names);
    Ok(text + &write_prepare(file, &prepare, preparation))
}

fn write_from_array<'n>(head: &str, of: &str, names: impl Iterator<Item = &'n str>) -> String {
    let lines = names.enumerate().map(|(place, name)| {
        write_assignment(&format!("{of}->{name}"), &format!("numbers[{place}]"))
    });
    let none = format!("(void)numbers;\n{of}->none = '\\0';\n");
    write_function(head, &none, lines.collect())
}

fn write_function(head: &str, none: &str, lines: String) -> String {
    let lines = if lines.is_empty() {
        none.to_owned()
    } else {
        lines
    };
    block(&format!("{head} {{"), &lines, "}")
}

fn write_prepare(file: &File<'_>, head: &str, prepared: Preparation) -> String {
    let program = file.program;
    let mut used = UsedNames::from_preparation(&prepared);
    let mut writer = Writer::new(program);
    writer.notes.clone_from(&prepared.notes);
    let computed = used.retain(prepared.computed);
    // This reference keeps the identity in the image if the linker removes unused items.
    let kept = "const char *volatile identity = NAME_identity;\n(void)identity;\n";
    let mut lines = fill_template(program, kept);
    if !used.contains("parameters") {
        lines += "(void)parameters;\n";
    }
    lines += &writer.statements(&computed);
    for (id, coefficient) in file.fields.iter().zip(&prepared.coefficients) {
        let target = format!("coefficients->{}", file.field_names[id]);
        lines += &match (coefficient, program.value(*id).extent) {
            (PreparedValue::Number(value), _) => {
                write_assignment(&target, &writer.expression(value))
            }
            (PreparedValue::Numbers(array), Extent::Matrix(rows, columns)) => {
                let from = writer.array(array);
                let copy = write_assignment(&format!("{target}[i][j]"), &format!("{from}[i][j]"));
                write_loop("i", rows, &write_loop("j", columns, &copy))
            }
            (PreparedValue::Numbers(array), extent) => {
                let from = writer.array(array);
                let copy = write_assignment(&format!("{target}[i]"), &format!("{from}[i]"));
                write_loop("i", extent.length(), &copy)
            }
        };
    }
    lines += &writer.set_flag(
        "coefficients->positive_definite",
        &prepared.positive_definite,
    );
    block(&format!("{head} {{"), &lines, "}")
}
