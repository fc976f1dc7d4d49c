//! Emitted functions for regimes: the regime number of a state, and the rates in a constant regime, with every branch
//! decided at compile time. One generic function covers all regimes, so the length of the source does not depend on
//! the number of regimes.

use super::expression::{Writer, write_assignment, write_loop};
use super::literals::write_linked_doc;
use super::signature::{Signature, stage_with};
use super::stages::{call_stage, write_stage};
use crate::program::SURFACES_OF_A_REGIME;
use crate::statements::layout::block;
use crate::statements::{EmitResult, File, RequiredFunctions, build_rates_in_regime};

pub(super) fn write_regimes(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
    writer: &mut Writer,
) -> EmitResult<String> {
    let Some(rates) = build_rates_in_regime(file, needed)? else {
        return Ok(String::new());
    };
    Ok(write_regime(file) + &write_stage(file, &rates, writer))
}

fn write_regime(file: &File<'_>) -> String {
    let bits = file.guard_count().min(SURFACES_OF_A_REGIME);
    let statements = if bits == 0 {
        "0\n".to_owned()
    } else {
        let set = block(
            "if T::all_greater(guards[k], T::number(0.0)) {",
            "regime = regime | 1 << k;\n",
            "}",
        );
        let guards = write_assignment("let guards", call_stage(file, "guards"));
        let set = write_loop("k", bits, &set);
        format!("{guards}\nlet mut regime = 0;\n{set}regime\n")
    };
    let head = write_linked_doc(
        "Regime of a state: bit k is set if number k of [`guards`] is positive, for up to 32 of\n\
         them. Crossing a surface flips its bit. SIMD lanes must be in one regime: a bit is set\n\
         if it is set in all of them.",
    ) + "#[allow(unused_variables)]\n";
    stage_with(file, &head, &Signature::new("regime", "u32"), &statements)
}
