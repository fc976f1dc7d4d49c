//! Stages as emitted functions.

use super::expression::{Writer, array, call, write_assignment, zeros};
use super::generics::{inlined_prefix, type_with_generics};
use super::literals::{write_doc, write_linked_doc};
use super::signature::{Signature, stage_with};
use super::types::write_literal;
use crate::statements::{
    Argument, Expression, File, Outcome, RATES_ORDER_DOC, Size, Stage, describe_rate_limits,
};

/// Writes the rates as two functions. One fills an array of the caller; the other returns an array, which it first
/// fills with zeros.
pub(super) fn write_rates(file: &File<'_>, written: &Stage, writer: &mut Writer) -> String {
    let call = format!(
        "let mut rates = [T::number(0.0); STATES];\n\
         {}rates_into(t, state, inputs, coefficients, &mut rates);\n\
         rates\n",
        inlined_prefix(file)
    );
    let lines = format!(
        "Returns the rates of the state.\n\n{RATES_ORDER_DOC}{}",
        describe_rate_limits(file)
    );
    let signature = Signature::new("rates", "[T; STATES]");
    write_stage(file, written, writer)
        + &stage_with(file, &write_linked_doc(&lines), &signature, &call)
}

pub(super) fn write_stage(file: &File<'_>, stage: &Stage, writer: &mut Writer) -> String {
    // An array with one element per state is never empty, so `mut` is always needed.
    let mutable = match stage.outcome {
        Outcome::Array(_, Size::States) => false,
        Outcome::Array(..) | Outcome::MassMatrix => true,
        _ => false,
    };
    let unused = if mutable {
        "#[allow(unused_variables, unused_mut)]\n"
    } else {
        "#[allow(unused_variables)]\n"
    };
    let mut arguments = String::new();
    let mut constant = "";
    for argument in &stage.arguments {
        match argument {
            Argument::Regime => constant = "const REGIME: u32, ",
            Argument::Accelerations => {
                arguments += "accelerations: &[T; DEGREES_OF_FREEDOM],\n";
            }
            Argument::Direction => arguments += "direction: &[T; STATES],\n",
            Argument::InputDirection => {
                arguments += &format!(
                    "input_direction: &{},\n",
                    type_with_generics(file, "Inputs")
                );
            }
            Argument::PointDirection => arguments += "direction: &[T; POINT],\n",
            Argument::Weights => arguments += "weights: &[T; STATES],\n",
            Argument::Sides => arguments += "sides: &[T; SIDES],\n",
        }
    }
    writer.notes.clone_from(&stage.notes);
    let mut statements = writer.statements(&stage.computed);
    let written = writer.statements(&stage.written);
    let result = match &stage.outcome {
        Outcome::Rates => {
            arguments += "rates: &mut [T; STATES],\n";
            statements += &written;
            String::new()
        }
        Outcome::Number(value) => {
            statements += &(writer.expression(value) + "\n");
            "T".to_owned()
        }
        Outcome::Observables(values) => {
            statements += &(array(&writer.expressions(values)) + "\n");
            "[T; OBSERVABLES]".to_owned()
        }
        Outcome::Array(name, size) => {
            let size = length(size);
            statements += &(zeros(name, std::slice::from_ref(&size)) + &written);
            statements += &format!("{name}\n");
            format!("[T; {size}]")
        }
        Outcome::MassMatrix => {
            let size = length(&Size::DegreesOfFreedom);
            statements += &(zeros("values", &[size.clone(), size]) + &written);
            statements += "values\n";
            "[[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM]".to_owned()
        }
        Outcome::ArrayAndInputs(values) => {
            statements += &(zeros("product", &["STATES".to_owned()]) + &written);
            statements += &(write_input_product(values, writer) + "(product, input_product)\n");
            format!("([T; STATES], {})", type_with_generics(file, "Inputs"))
        }
    };
    let head = write_linked_doc(&stage.doc) + &write_doc(&stage.list) + unused;
    let signature = Signature {
        name: stage.name,
        constant,
        arguments: &arguments,
        result: &result,
    };
    stage_with(file, &head, &signature, &statements)
}

fn write_input_product(values: &[(String, Expression)], writer: &mut Writer) -> String {
    let fields: Vec<String> = values
        .iter()
        .map(|(name, value)| format!("{name}: {}", writer.expression(value)))
        .collect();
    let literal = write_literal("Inputs", &fields);
    write_assignment("let input_product", literal.trim_end()) + "\n"
}

/// Returns the length as the name of a constant.
fn length(size: &Size) -> String {
    match size {
        Size::States => "STATES".to_owned(),
        Size::DegreesOfFreedom => "DEGREES_OF_FREEDOM".to_owned(),
        Size::Guards => "GUARDS".to_owned(),
        Size::Parameters => "PARAMETERS".to_owned(),
        Size::Point => "POINT".to_owned(),
        Size::ReactionFunctions => "REACTION_FUNCTIONS".to_owned(),
        Size::ReactionEffects => "REACTION_EFFECTS".to_owned(),
        Size::Nonzeros(jacobian) => format!("{}_NONZEROS", jacobian.to_uppercase()),
    }
}

/// Writes the call of another stage with the same arguments.
pub(super) fn call_stage(file: &File<'_>, stage: &str) -> String {
    let arguments = ["t", "state", "inputs", "coefficients"].map(str::to_owned);
    call(&format!("{}{stage}", inlined_prefix(file)), &arguments)
}
