//! Controllers in C: structures, and functions that start and update them.

use std::collections::BTreeMap;

use super::comments::comment;
use super::expression::{Writer, write_assignment};
use super::names::fill_template;
use super::stages::{nest_lines, write_head};
use crate::program::{Program, ProgramController, Quantity};
use crate::statements::layout::block;
use crate::statements::{
    ControllerStage, ControllerStages, EmitError, EmitResult, TIME_FIELDS, describe_quantity,
};

/// Types and names of the arguments of `start` and `update`; OWN stands for the name of the controller.
const START_ARGUMENTS: [(&str, &str); 2] = [
    ("const NAME_parameters *", "parameters"),
    ("NAME_controller_OWN *", "memory"),
];
const UPDATE_ARGUMENTS: [(&str, &str); 4] = [
    ("NAME_controller_OWN *", "memory"),
    ("const NAME_controller_OWN_measured *", "measured"),
    ("const NAME_parameters *", "parameters"),
    ("NAME_controller_OWN_outputs *", "outputs"),
];

/// Suffixes of the names of the types and functions of a controller, after NAME_controller_OWN.
const NAME_SUFFIXES: [&str; 5] = ["", "_measured", "_outputs", "_start", "_update"];

/// Checks that no two controllers have a type or function of the same name.
///
/// # Errors
/// Two controllers give the same name; the error contains the first such name.
pub(super) fn check_name_collisions(program: &Program) -> EmitResult<()> {
    let mut owners: BTreeMap<String, &str> = BTreeMap::new();
    for controller in &program.controllers {
        for end in NAME_SUFFIXES {
            let name = format!("{}_controller_{}{end}", program.name, controller.name);
            if let Some(other) = owners.insert(name.clone(), &controller.name) {
                return Err(EmitError::Collision {
                    name,
                    owners: [other, &controller.name].map(|own| format!("controllers.{own}")),
                });
            }
        }
    }
    Ok(())
}

/// Returns the names of all functions of controllers.
pub(super) fn list_functions(program: &Program) -> Vec<String> {
    let named = |controller: &ProgramController| {
        let stem = format!("{}_controller_{}", program.name, controller.name);
        ["start", "update"].map(|function| format!("{stem}_{function}"))
    };
    program.controllers.iter().flat_map(named).collect()
}

/// Returns the declarations for the header.
pub(super) fn write_declarations(program: &Program) -> String {
    let all = program.controllers.iter();
    all.map(|controller| write_declaration(program, controller))
        .collect()
}

fn write_declaration(program: &Program, controller: &ProgramController) -> String {
    let quantity = |quantity: &Quantity| {
        comment(&[describe_quantity(&quantity.doc, &quantity.unit, "")])
            + &fill_template(program, &format!("NAME_real {};\n", quantity.name))
    };
    let quantities = |all: &[Quantity]| -> String { all.iter().map(quantity).collect() };
    let times = TIME_FIELDS.map(|(name, doc)| {
        comment(&[describe_quantity(doc, "s", "")])
            + &fill_template(program, &format!("NAME_real {name};\n"))
    });
    let own = &controller.name;
    let memory = times.concat() + &quantities(&controller.states);
    let described = match controller.doc.is_empty() {
        true => format!("Controller `{own}`: its times and states."),
        false => format!(
            "Controller `{own}`: {}. Its times and states.",
            controller.doc
        ),
    };
    let measured = quantities(&controller.measured);
    let outputs = quantities(&controller.outputs);
    let mut text = write_structure(program, &described, own, memory);
    let doc = format!("Quantities that `{own}` measures at a sample, before it changes an input.");
    text += &write_structure(program, &doc, &format!("{own}_measured"), measured);
    let doc = format!(
        "Inputs that `{own}` drives: they act after its delay, and are held until the next ones act."
    );
    text += &write_structure(program, &doc, &format!("{own}_outputs"), outputs);
    for (function, doc) in [
        ("start", "Sets the times and the initial states."),
        (
            "update",
            "Computes the outputs and the next states of a sample.",
        ),
    ] {
        text += &comment(&[doc.to_owned()]);
        text += &format!("{};\n", write_function_head(program, own, function, false));
    }
    text
}

fn write_structure(program: &Program, doc: &str, name: &str, fields: String) -> String {
    let fields = match fields.is_empty() {
        true => comment(&["Placeholder: C has no empty structures.".to_owned()]) + "char none;\n",
        false => fields,
    };
    let closing = fill_template(program, &format!("}} NAME_controller_{name};"));
    comment(&[doc.to_owned()]) + &nest_lines("typedef struct {", &fields, &closing)
}

fn write_function_head(
    program: &Program,
    own: &str,
    function: &str,
    is_definition: bool,
) -> String {
    let arguments: &[(&str, &str)] = match function {
        "start" => &START_ARGUMENTS,
        _ => &UPDATE_ARGUMENTS,
    };
    let typed = arguments
        .iter()
        .map(|(of, name)| (of.replace("OWN", own), *name));
    let typed: Vec<(String, &str)> = typed.collect();
    let typed: Vec<(&str, &str)> = typed.iter().map(|(of, name)| (&**of, *name)).collect();
    let name = format!("controller_{own}_{function}");
    write_head(program, ("void ", &name), &typed, is_definition)
}

/// Returns the definitions of the functions of a controller.
pub(super) fn write_definitions(
    program: &Program,
    controller: &ProgramController,
    stages: &ControllerStages,
) -> String {
    let function = |name: &str, stage: &ControllerStage, unused: &[&str]| {
        let writer = Writer::new(program);
        let mut lines = writer.statements(&stage.computed);
        for (structure, fields) in [("outputs", &stage.outputs), ("memory", &stage.memory)] {
            for (field, value) in fields {
                let target = format!("{structure}->{field}");
                lines += &write_assignment(&target, &writer.expression(value));
            }
        }
        let is_unused = |name: &&&str| !lines.contains(&format!("{name}->"));
        let unused = unused.iter().filter(is_unused);
        let unused: String = unused.map(|name| format!("(void){name};\n")).collect();
        let head = write_function_head(program, &controller.name, name, true);
        block(&format!("{head} {{"), &(unused + &lines), "}")
    };
    let given = ["memory", "measured", "parameters", "outputs"];
    function("start", &stages.start, &given[2..3]) + &function("update", &stages.update, &given)
}
