//! Step of the classical Runge-Kutta method in C.

use super::comments::comment;
use super::expression::write_loop;
use super::names::fill_template;
use super::stages::head;
use crate::program::{Output, Program};
use crate::statements::STEP_DOC;
use crate::statements::layout::block;

const ARGUMENTS: [(&str, &str); 5] = [
    ("NAME_real ", "t"),
    ("NAME_real ", "h"),
    ("NAME_real *", "state"),
    ("const NAME_inputs *", "inputs"),
    ("const NAME_coefficients *", "coefficients"),
];

/// Returns the declaration if the step is requested.
pub(super) fn declaration(program: &Program) -> String {
    if !program.outputs.kinds.contains(&Output::Step) {
        return String::new();
    }
    let lines: Vec<String> = STEP_DOC.split('\n').map(str::to_owned).collect();
    comment(&lines) + &head(program, ("void ", "step"), &ARGUMENTS, false) + ";\n"
}

/// Returns the definition if the step is requested.
pub(super) fn definition(program: &Program) -> String {
    if !program.outputs.kinds.contains(&Output::Step) {
        return String::new();
    }
    let states = program.states();
    let rates = |time: &str, state: &str, k: usize| {
        format!("NAME_rates({time}, {state}, inputs, coefficients, k{k});\n")
    };
    let advance = |h: &str, k: usize| {
        write_loop(
            "i",
            states,
            &format!("stage[i] = state[i] + {h} * k{k}[i];\n"),
        )
    };
    let mut lines = "NAME_real k1[NAME_STATES];\n\
                     NAME_real k2[NAME_STATES];\n\
                     NAME_real k3[NAME_STATES];\n\
                     NAME_real k4[NAME_STATES];\n\
                     NAME_real stage[NAME_STATES];\n\
                     const NAME_real half = R(0.5) * h;\n\
                     const NAME_real sixth = h / R(6.0);\n"
        .to_owned();
    lines += &(rates("t", "state", 1) + &advance("half", 1));
    lines += &(rates("t + half", "stage", 2) + &advance("half", 2));
    lines += &(rates("t + half", "stage", 3) + &advance("h", 3));
    lines += &rates("t + h", "stage", 4);
    let sum = "const NAME_real inner = k2[i] + k3[i];\n\
               state[i] = state[i] + sixth * (k1[i] + k4[i] + R(2.0) * inner);\n";
    lines += &write_loop("i", states, sum);
    let head = head(program, ("void ", "step"), &ARGUMENTS, true);
    block(&format!("{head} {{"), &fill_template(program, &lines), "}")
}
