//! Function that returns the regime number of a state. The rates in a given regime are an ordinary stage.

use super::names::fill_template;
use super::stages::{GIVEN, call_stage, write_head};
use crate::program::{Program, SURFACES_OF_A_REGIME};
use crate::statements::File;
use crate::statements::layout::block;

pub(super) const REGIME: &str = "Regime of a state: bit k is set if number k of [`guards`] is positive, for up to 32 of\n\
     them. Crossing a surface flips its bit.";

pub(super) fn write_regime_head(program: &Program, definition: bool) -> String {
    write_head(program, ("uint32_t ", "regime"), &GIVEN, definition)
}

/// Writes the definition, if regimes are requested.
pub(super) fn write_regime(file: &File<'_>) -> String {
    let program = file.program;
    if program.outputs.regimes.is_none() {
        return String::new();
    }
    let bits = file.guard_count().min(SURFACES_OF_A_REGIME);
    let head = format!("{} {{", write_regime_head(program, true));
    if bits == 0 {
        let unused = GIVEN.map(|(_, name)| format!("(void){name};\n")).concat();
        return block(&head, &(unused + "return 0U;\n"), "}");
    }
    let declared = fill_template(
        program,
        "NAME_real guards[NAME_GUARDS];\nuint32_t regime = 0U;\n",
    );
    let set = format!(
        "for (int k = 0; k < {bits}; ++k) {{\n    if (guards[k] > R(0.0)) {{\n        \
         regime |= (uint32_t)1 << (uint32_t)k;\n    }}\n}}\nreturn regime;\n"
    );
    block(
        &head,
        &(declared + &call_stage(program, "guards", "guards") + &set),
        "}",
    )
}
