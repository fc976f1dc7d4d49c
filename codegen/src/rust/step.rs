//! Step of the classical Runge-Kutta method in Rust.

use super::generics::type_with_generics;
use super::literals::linked_doc;
use crate::program::Output;
use crate::statements::layout::{DEEPER, SHALLOWER, block};
use crate::statements::{File, STEP_DOC};

/// Writes the function if it is requested.
pub(super) fn step(file: &File<'_>) -> String {
    if !file.program.outputs.kinds.contains(&Output::Step) {
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
        linked_doc(STEP_DOC)
    );
    let rates = |time: &str, state: &str, k: usize| {
        format!("rates_into({time}, {state}, inputs, coefficients, &mut k{k});\n")
    };
    let each = |lines: &str| block("for i in 0..STATES {", lines, "}");
    let advance = |h: &str, k: usize| each(&format!("stage[i] = state[i] + {h} * k{k}[i];\n"));
    let mut lines: String = (1..=4)
        .map(|k| format!("let mut k{k} = [T::number(0.0); STATES];\n"))
        .collect();
    lines += "let mut stage = [T::number(0.0); STATES];\n\
              let half = T::number(0.5) * h;\n\
              let sixth = h / T::number(6.0);\n";
    lines += &(rates("t", "state", 1) + &advance("half", 1));
    lines += &(rates("t + half", "&stage", 2) + &advance("half", 2));
    lines += &(rates("t + half", "&stage", 3) + &advance("h", 3));
    lines += &rates("t + h", "&stage", 4);
    lines += &each(
        "let inner = k2[i] + k3[i];\n\
         state[i] = state[i] + sixth * (k1[i] + k4[i] + T::number(2.0) * inner);\n",
    );
    block(&head, &lines, "}")
}
