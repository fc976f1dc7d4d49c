//! Emitted functions for regimes: the number of a state's regime, and the rates in a constant regime, with
//! every branch decided at compile time. One function serves all regimes, so that the source does not grow
//! with their number.

use super::expression::{Writer, assignment, write_loop};
use super::literals::linked_doc;
use super::signature::{Signature, stage_with};
use super::stages::{call_stage, function};
use crate::program::SURFACES_OF_A_REGIME;
use crate::statements::layout::block;
use crate::statements::{EmitResult, File, RequiredFunctions, rates_in_regime};

pub(super) fn regimes(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
    writer: &mut Writer,
) -> EmitResult<String> {
    let Some(rates) = rates_in_regime(file, needed)? else {
        return Ok(String::new());
    };
    Ok(regime(file) + &function(file, &rates, writer))
}

fn regime(file: &File<'_>) -> String {
    let bits = file.guard_count().min(SURFACES_OF_A_REGIME);
    let statements = if bits == 0 {
        "0\n".to_owned()
    } else {
        let set = block(
            "if T::all_greater(guards[k], T::number(0.0)) {",
            "regime = regime | 1 << k;\n",
            "}",
        );
        let guards = assignment("let guards", call_stage(file, "guards"));
        let set = write_loop("k", bits, &set);
        format!("{guards}\nlet mut regime = 0;\n{set}regime\n")
    };
    let head = linked_doc(
        "Regime of a state: bit k is set if number k of [`guards`] is positive, for up to 32 of\n\
         them. Crossing a surface flips its bit. SIMD lanes must be in one regime: a bit is set\n\
         if it is set in all of them.",
    ) + "#[allow(unused_variables)]\n";
    stage_with(file, &head, &Signature::new("regime", "u32"), &statements)
}
