//! Fixed-length step in C: the classical Runge-Kutta method. The module `reactions` adds the reactions of frictions
//! and contacts.

use super::comments::comment;
use super::expression::write_loop;
use super::names::fill_template;
use super::reactions;
use super::stages::write_head;
use crate::program::{Output, Program, Reactions};
use crate::statements::layout::block;
use crate::statements::{describe_step, reaction_constants};

const ARGUMENTS: [(&str, &str); 5] = [
    ("NAME_real ", "t"),
    ("NAME_real ", "h"),
    ("NAME_real *", "state"),
    ("const NAME_inputs *", "inputs"),
    ("const NAME_coefficients *", "coefficients"),
];

/// Returns the sizes of the arrays of reactions.
pub(super) fn write_sizes(program: &Program) -> String {
    let constants = reaction_constants(program);
    let constants = constants.iter().map(|(name, count, doc)| {
        let line = fill_template(program, &format!("#define NAME_{name} {count}\n"));
        comment(&[(*doc).to_owned()]) + &line
    });
    constants.collect()
}

/// Returns the declaration if the step is requested.
pub(super) fn write_declaration(program: &Program) -> String {
    if !program.outputs.kinds.contains(&Output::Step) {
        return String::new();
    }
    let doc = describe_step(program);
    let lines: Vec<String> = doc.split('\n').map(str::to_owned).collect();
    comment(&lines) + &write_head(program, ("void ", "step"), &ARGUMENTS, false) + ";\n"
}

/// Returns the definition, with the functions that it calls, if the step is requested.
pub(super) fn write_definition(program: &Program) -> String {
    if !program.outputs.kinds.contains(&Output::Step) {
        return String::new();
    }
    let head = write_head(program, ("void ", "step"), &ARGUMENTS, true);
    let whole = |lines: &str| block(&format!("{head} {{"), &fill_template(program, lines), "}");
    match &program.outputs.reactions {
        None => {
            let sum = "state[i] = state[i] + sixth * (k1[i] + k4[i] + R(2.0) * inner);\n";
            whole(&(RATES_OF_STAGES.to_owned() + &write_runge_kutta(program, sum)))
        }
        Some(known) => {
            let sum = "next[i] = state[i] + sixth * (k1[i] + k4[i] + R(2.0) * inner);\n";
            reactions::write_functions(program, known)
                + &whole(&reactions::write_step(
                    program,
                    known,
                    [RATES_OF_STAGES, &write_runge_kutta(program, sum)],
                ))
        }
    }
}

const RATES_OF_STAGES: &str = "\
    NAME_real k1[NAME_STATES];\n\
    NAME_real k2[NAME_STATES];\n\
    NAME_real k3[NAME_STATES];\n\
    NAME_real k4[NAME_STATES];\n\
    NAME_real stage[NAME_STATES];\n\
    const NAME_real half = R(0.5) * h;\n\
    const NAME_real sixth = h / R(6.0);\n";

/// Writes a step of the Runge-Kutta method; `sum` is the statement that computes one element of the new state.
fn write_runge_kutta(program: &Program, sum: &str) -> String {
    let states = program.states();
    let held = program
        .outputs
        .reactions
        .as_ref()
        .map_or(0, Reactions::sides)
        > 0;
    let rates = |time: &str, state: &str, k: usize| match held {
        true => {
            format!("NAME_rates_with_sides({time}, {state}, inputs, coefficients, sides, k{k});\n")
        }
        false => format!("NAME_rates({time}, {state}, inputs, coefficients, k{k});\n"),
    };
    let advance = |h: &str, k: usize| {
        write_loop(
            "i",
            states,
            &format!("stage[i] = state[i] + {h} * k{k}[i];\n"),
        )
    };
    let mut lines = rates("t", "state", 1) + &advance("half", 1);
    lines += &(rates("t + half", "stage", 2) + &advance("half", 2));
    lines += &(rates("t + half", "stage", 3) + &advance("h", 3));
    lines += &rates("t + h", "stage", 4);
    let inner = "const NAME_real inner = k2[i] + k3[i];\n".to_owned();
    lines + &write_loop("i", states, &(inner + sum))
}
