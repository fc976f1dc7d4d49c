//! Fixed-length step in Rust: the classical Runge-Kutta method. The module `reactions` adds the reactions of
//! frictions and contacts.

use super::generics::type_with_generics;
use super::literals::write_linked_doc;
use super::reactions;
use crate::program::{Output, Reactions};
use crate::statements::layout::{DEEPER, SHALLOWER, block};
use crate::statements::{File, describe_step};

/// Writes the function, with those that it calls, if it is requested.
pub(super) fn write_step(file: &File<'_>) -> String {
    let program = file.program;
    if !program.outputs.kinds.contains(&Output::Step) {
        return String::new();
    }
    let (inputs, coefficients) = (
        type_with_generics(file, "Inputs"),
        type_with_generics(file, "Coefficients"),
    );
    let head = format!(
        "{}pub fn step<T: Scalar>(\n\
         {DEEPER}t: T,\n\
         h: T,\n\
         state: &mut [T; STATES],\n\
         inputs: &{inputs},\n\
         coefficients: &{coefficients},\n\
         {SHALLOWER}) {{",
        write_linked_doc(&describe_step(program))
    );
    match &program.outputs.reactions {
        None => {
            let lines = RATES_OF_STAGES.to_owned() + &write_runge_kutta(file, "state[i]");
            block(&head, &lines, "}")
        }
        Some(known) => {
            let lines = reactions::write_step(
                known,
                [RATES_OF_STAGES, &write_runge_kutta(file, "next[i]")],
            );
            block(&head, &lines, "}") + &reactions::write_functions(known)
        }
    }
}

const RATES_OF_STAGES: &str = "\
    let mut k1 = [T::number(0.0); STATES];\n\
    let mut k2 = [T::number(0.0); STATES];\n\
    let mut k3 = [T::number(0.0); STATES];\n\
    let mut k4 = [T::number(0.0); STATES];\n\
    let mut stage = [T::number(0.0); STATES];\n\
    let half = T::number(0.5) * h;\n\
    let sixth = h / T::number(6.0);\n";

/// Writes a step of the Runge-Kutta method that assigns the new state to the elements `target`.
fn write_runge_kutta(file: &File<'_>, target: &str) -> String {
    let known = file.program.outputs.reactions.as_ref();
    let rates = |time: &str, state: &str, k: usize| match known.map_or(0, Reactions::sides) {
        0 => format!("rates_into({time}, {state}, inputs, coefficients, &mut k{k});\n"),
        _ => {
            format!("rates_with_sides({time}, {state}, inputs, coefficients, &sides, &mut k{k});\n")
        }
    };
    let each = |lines: &str| block("for i in 0..STATES {", lines, "}");
    let advance = |h: &str, k: usize| each(&format!("stage[i] = state[i] + {h} * k{k}[i];\n"));
    let mut lines = rates("t", "state", 1) + &advance("half", 1);
    lines += &(rates("t + half", "&stage", 2) + &advance("half", 2));
    lines += &(rates("t + half", "&stage", 3) + &advance("h", 3));
    lines += &rates("t + h", "&stage", 4);
    lines
        + &each(&format!(
            "let inner = k2[i] + k3[i];\n\
             {target} = state[i] + sixth * (k1[i] + k4[i] + T::number(2.0) * inner);\n"
        ))
}
