//! Controllers in Rust: one module for each, with its types and functions.

use super::expression::Writer;
use super::generics::type_with_generics;
use super::literals::{write_doc, write_linked_doc};
use super::types::write_literal;
use crate::program::{ProgramController, Quantity};
use crate::statements::layout::{DEEPER, SHALLOWER, block};
use crate::statements::{
    ControllerStage, EmitResult, File, RequiredFunctions, TIME_FIELDS, build_controller_stages,
    describe_quantity,
};

/// Writes the modules of all controllers.
pub(super) fn write_controllers(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
    writer: &mut Writer,
) -> EmitResult<String> {
    let mut text = String::new();
    for controller in &file.program.controllers {
        let stages = build_controller_stages(file, controller, needed)?;
        let mut items = "#[allow(unused_imports)]\nuse super::*;\n".to_owned();
        items += &write_types(controller);
        let parameters = type_with_generics(file, "Parameters");
        let mut start = writer.statements(&stages.start.computed);
        start += &write_literal("Self", &write_fields(&stages.start.memory, writer));
        let head = "/// Returns the times and the initial states.\n\
                    #[allow(unused_variables)]\n";
        let start = block(
            &format!("{head}pub fn start(parameters: &{parameters}) -> Self {{"),
            &start,
            "}",
        );
        items += &block("impl<T: Scalar> Memory<T> {", &start, "}");
        items += &write_update(controller, &stages.update, &parameters, writer);
        let described = match controller.doc.is_empty() {
            true => format!("Controller `{}`.", controller.name),
            false => format!("Controller `{}`: {}.", controller.name, controller.doc),
        };
        let head = write_doc(&[described]);
        let head = format!("{head}pub mod controller_{} {{", controller.name);
        text += &block(&head, &items, "}");
    }
    Ok(text)
}

fn write_fields(
    values: &[(String, crate::statements::Expression)],
    writer: &mut Writer,
) -> Vec<String> {
    let field = |(name, value): &(String, _)| format!("{name}: {}", writer.expression(value));
    values.iter().map(field).collect()
}

fn write_types(controller: &ProgramController) -> String {
    let field = |quantity: &Quantity| {
        let lines = write_doc(&[describe_quantity(&quantity.doc, &quantity.unit, "")]);
        format!("{lines}pub {}: T,\n", quantity.name)
    };
    let quantities = |all: &[Quantity]| -> String { all.iter().map(field).collect() };
    let times = TIME_FIELDS.map(|(name, meaning)| {
        format!(
            "{}pub {name}: T,\n",
            write_doc(&[describe_quantity(meaning, "s", "")])
        )
    });
    let memory = times.concat() + &quantities(&controller.states);
    let mut text = write_structure("Memory", "Times and states.", &memory);
    text += &write_structure(
        "Measured",
        "Quantities that the controller measures at a sample, before it changes an input.",
        &quantities(&controller.measured),
    );
    text + &write_structure(
        "Outputs",
        "Driven inputs: they act after the delay, and are held until the next ones act.",
        &quantities(&controller.outputs),
    )
}

fn write_structure(name: &str, meaning: &str, fields: &str) -> String {
    let generics = if fields.is_empty() { "" } else { "<T = f64>" };
    let head = format!(
        "/// {meaning}\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {name}{generics} {{"
    );
    block(&head, fields, "}")
}

fn write_update(
    controller: &ProgramController,
    stage: &ControllerStage,
    parameters: &str,
    writer: &mut Writer,
) -> String {
    let of = |name: &str, all: &[Quantity]| match all.is_empty() {
        true => name.to_owned(),
        false => format!("{name}<T>"),
    };
    let mut lines = writer.statements(&stage.computed);
    for (name, value) in &stage.memory {
        lines += &format!("memory.{name} = {};\n", writer.expression(value));
    }
    lines += &write_literal("Outputs", &write_fields(&stage.outputs, writer));
    let head = write_linked_doc("Computes the outputs and the next states of a sample.");
    let measured = of("Measured", &controller.measured);
    let outputs = of("Outputs", &controller.outputs);
    let head = format!(
        "{head}#[allow(unused_variables)]\n\
         pub fn update<T: Scalar>(\n\
         {DEEPER}memory: &mut Memory<T>,\n\
         measured: &{measured},\n\
         parameters: &{parameters},\n\
         {SHALLOWER}) -> {outputs} {{"
    );
    block(&head, &lines, "}")
}
