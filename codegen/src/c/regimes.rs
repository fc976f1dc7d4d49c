//! The function that gives the number of the regime that a state is in. The rates in a regime are a
//! stage like others.

use super::names::named;
use super::stages::{GIVEN, head, passed_on};
use crate::program::{Program, SURFACES_OF_A_REGIME};
use crate::statements::File;
use crate::statements::layout::block;

/// What the function gives.
pub(super) const REGIME: &str = "The regime that a state is in: bit k is set where number k of [`guards`] is positive,\n\
                                 for up to 32 of them. Crossing one flips its bit.";

/// The head of the function that gives the number of a regime.
pub(super) fn regime_head(program: &Program, definition: bool) -> String {
    head(program, ("uint32_t ", "regime"), &GIVEN, definition)
}

/// The definition, if regimes are asked for.
pub(super) fn regime(file: &File<'_>) -> String {
    let program = file.program;
    if program.outputs.regimes.is_none() {
        return String::new();
    }
    let bits = file.guard_count().min(SURFACES_OF_A_REGIME);
    let head = format!("{} {{", regime_head(program, true));
    if bits == 0 {
        let unused = GIVEN.map(|(_, name)| format!("(void){name};\n")).concat();
        return block(&head, &(unused + "return 0;\n"), "}");
    }
    let declared = named(
        program,
        "NAME_real guards[NAME_GUARDS];\nuint32_t regime = 0;\n",
    );
    let set = format!(
        "for (int k = 0; k < {bits}; ++k) {{\n    if (guards[k] > R(0.0)) {{\n        \
         regime |= (uint32_t)1 << k;\n    }}\n}}\nreturn regime;\n"
    );
    block(
        &head,
        &(declared + &passed_on(program, "guards", "guards") + &set),
        "}",
    )
}
