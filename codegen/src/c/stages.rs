//! Stages as functions: declarations for the header, definitions for the source.

use super::comments::{comment, resolve_links};
use super::expression::{Writer, call, write_assignment, write_loop, write_target};
use super::names::{fill_template, item_name};
use crate::program::Program;
use crate::statements::layout::{BLOCK, CLOSE, DEEPER, SHALLOWER, SPACE, ZERO, ZERO_OUT, block};
use crate::statements::{Argument, Expression, Index, Outcome, Place, Size, Stage, UsedNames};

/// Returns type and name of each argument of a stage. Arrays are passed as pointers to their first element.
fn arguments(stage: &Stage) -> Vec<(&'static str, &'static str)> {
    let mut all = GIVEN.to_vec();
    all.extend(stage.arguments.iter().map(|argument| match argument {
        Argument::Regime => ("uint32_t ", "regime"),
        Argument::Accelerations => ("const NAME_real *", "accelerations"),
        Argument::Direction => ("const NAME_real *", "direction"),
        Argument::InputDirection => ("const NAME_inputs *", "input_direction"),
        Argument::PointDirection => ("const NAME_real *", "direction"),
        Argument::Weights => ("const NAME_real *", "weights"),
        Argument::Sides => ("const NAME_real *", "sides"),
    }));
    match &stage.outcome {
        Outcome::Rates => all.push(("NAME_real *", "rates")),
        Outcome::Observables(_) => all.push(("NAME_real *", "observables")),
        Outcome::Array(name, _) => all.push(("NAME_real *", name)),
        Outcome::MassMatrix => all.push(MATRIX),
        Outcome::ArrayAndInputs(_) => {
            all.extend([
                ("NAME_real *", "product"),
                ("NAME_inputs *", "input_product"),
            ]);
        }
        Outcome::Number(_) => {}
    }
    all
}

pub(super) const GIVEN: [(&str, &str); 4] = [
    ("NAME_real ", "t"),
    ("const NAME_real *", "state"),
    ("const NAME_inputs *", "inputs"),
    ("const NAME_coefficients *", "coefficients"),
];

const MATRIX: (&str, &str) = ("NAME_real (*", "values)[NAME_DEGREES_OF_FREEDOM]");

/// Writes the head of a function. In a definition, pointers are declared not to overlap.
pub(super) fn write_head(
    program: &Program,
    (result, name): (&str, &str),
    arguments: &[(&str, &str)],
    definition: bool,
) -> String {
    let typed = arguments.iter().map(|(of, name)| {
        let restricted = if definition && of.ends_with('*') {
            "NAME_RESTRICT "
        } else {
            ""
        };
        fill_template(program, &format!("{of}{restricted}{name}"))
    });
    let typed: Vec<String> = typed.collect();
    let separator = format!(",{SPACE}");
    format!(
        "{}({BLOCK}{ZERO}{}{ZERO_OUT}{CLOSE})",
        fill_template(program, result) + &item_name(program, name),
        typed.join(&separator)
    )
}

fn result(stage: &Stage) -> &'static str {
    match stage.outcome {
        Outcome::Number(_) => "NAME_real ",
        _ => "void ",
    }
}

pub(super) fn write_declaration(program: &Program, stage: &Stage) -> String {
    let mut lines = resolve_links(program, &stage.doc);
    lines.extend(stage.list.iter().cloned());
    let result = (result(stage), stage.name);
    comment(&lines) + &write_head(program, result, &arguments(stage), false) + ";\n"
}

pub(super) fn write_definition(program: &Program, stage: Stage) -> String {
    let arguments = arguments(&stage);
    let head = write_head(program, (result(&stage), stage.name), &arguments, true);
    let mut writer = Writer::new(program);
    writer.notes.clone_from(&stage.notes);
    let mut used = UsedNames::from_outcome(&stage.outcome);
    let written = used.retain(stage.written);
    let computed = used.retain(stage.computed);
    let mut lines = String::new();
    for (_, name) in &arguments {
        let name = name.split(')').next().unwrap_or(name);
        let result = matches!(name, "rates" | "values" | "product" | "observables");
        let given = !matches!(name, "input_product") || !program.inputs.is_empty();
        if !used.contains(name) && !result && (name != "input_product" || !given) {
            lines += &format!("(void){name};\n");
        }
    }
    lines += &writer.statements(&computed);
    lines += &match &stage.outcome {
        Outcome::Rates => String::new(),
        Outcome::Number(value) => format!("return {};\n", writer.expression(value)),
        Outcome::Observables(values) => {
            let places = values.iter().enumerate();
            let put = |(place, value): (usize, &Expression)| {
                write_assignment(&format!("observables[{place}]"), &writer.expression(value))
            };
            places.map(put).collect()
        }
        Outcome::Array(name, size) => write_zero_array(program, name, size),
        Outcome::MassMatrix => {
            let degrees = program.degrees_of_freedom();
            let entry = Place::new("values", ["i", "j"].map(Index::Variable));
            let zero = write_assignment(&write_target(&entry), "R(0.0)");
            write_loop("i", degrees, &write_loop("j", degrees, &zero))
        }
        Outcome::ArrayAndInputs(_) => write_zero_array(program, "product", &Size::States),
    };
    lines += &writer.statements(&written);
    if let Outcome::ArrayAndInputs(values) = &stage.outcome {
        for (name, value) in values {
            lines +=
                &write_assignment(&format!("input_product->{name}"), &writer.expression(value));
        }
    }
    block(&format!("{head} {{"), &lines, "}")
}

fn write_zero_array(program: &Program, name: &str, size: &Size) -> String {
    let length = length(program, size);
    if length == 0 {
        return format!("(void){name};\n");
    }
    write_loop(
        "i",
        length,
        &write_assignment(&format!("{name}[i]"), "R(0.0)"),
    )
}

fn length(program: &Program, size: &Size) -> usize {
    match size {
        Size::States => program.states(),
        Size::DegreesOfFreedom => program.degrees_of_freedom(),
        Size::Guards => {
            let guards = program.guards.iter();
            guards
                .map(|guard| program.value(guard.value).extent.length())
                .sum()
        }
        Size::Parameters => program.parameters.len(),
        Size::Point => program.point_length(),
        Size::ReactionFunctions => program.reaction_sizes()[0],
        Size::ReactionEffects => program.reaction_sizes()[1],
        Size::Nonzeros(name) => {
            let mut jacobians = program.outputs.jacobians.iter();
            let jacobian = jacobians.find(|jacobian| jacobian.name == *name);
            jacobian.map_or(0, |jacobian| jacobian.nonzeros())
        }
    }
}

/// Writes the call of another stage with the same arguments.
pub(super) fn call_stage(program: &Program, stage: &str, written: &str) -> String {
    let given = GIVEN.iter().map(|(_, name)| *name).chain([written]);
    let arguments: Vec<String> = given.map(str::to_owned).collect();
    call(&item_name(program, stage), &arguments) + ";\n"
}

/// Returns `lines` between an opening and a closing line.
pub(super) fn nest_lines(opening: &str, lines: &str, closing: &str) -> String {
    format!("{opening}\n{DEEPER}{lines}{SHALLOWER}{closing}\n")
}
