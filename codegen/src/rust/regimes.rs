//! The emitted functions that know regimes: the number of the one a state is in, and the rates
//! in one that is a constant, where every branch is decided when the kernel is compiled. One
//! text serves all regimes, so that the source does not grow with their number.

use super::body::{Access, Body, looped};
use super::emit_error::Emitted;
use super::file::File;
use super::functions::Needed;
use super::literals::block;
use super::sides::Switches;
use super::signature::{ORDER, Signature, stage, stage_with};
use super::stages::{rates_statements, where_not_definite};
use crate::program::SURFACES_OF_A_REGIME;

/// The number of a state's regime, and the rates in a regime.
pub(super) fn regimes(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let Some(switches) = &file.program.outputs.regimes else {
        return Ok(String::new());
    };
    let switches = switches.iter().map(|switch| (switch.value, switch.decided));
    Ok(regime(file) + &rates_in_regime(file, switches.collect(), needed)?)
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
        format!(
            "let guards = {}guards(t, state, inputs, coefficients);\nlet mut regime = 0;\n{}regime\n",
            file.inlined(),
            looped("k", bits, &set)
        )
    };
    stage(
        file,
        "/// The regime that a state is in: bit k is set where number k of [`guards`] is positive,\n\
         /// for up to 32 of them. Crossing one flips its bit. Of lanes, which have to be in\n\
         /// one regime, a bit is set where it is in all.\n\
         #[allow(unused_variables)]\n",
        "regime",
        "u32",
        &statements,
    )
}

fn rates_in_regime(file: &File<'_>, switches: Switches, needed: &mut Needed) -> Emitted<String> {
    let rows = &file.program.accelerations;
    let access = Access::Coefficients(&file.field_names);
    let body = Body::in_regime(file.program, access, &rows.all(), needed, switches)?;
    let statements = rates_statements(file, body)?;
    Ok(stage_with(
        file,
        &format!(
            "/// Rates of the state within a regime, written to `rates`: those of [`rates_into`] where\n\
             /// [`regime`] is `REGIME`, for half-widths that are not negative. Beyond the regime they go\n\
             /// on as they are within, and on its surfaces they are those of its side.\n///\n/// {ORDER}\n{}\
             #[allow(unused_variables)]\n",
            where_not_definite(file)
        ),
        &Signature {
            constant: "const REGIME: u32, ",
            arguments: "rates: &mut [T; STATES],\n",
            ..Signature::of("rates_in_regime_into", "")
        },
        &statements,
    ))
}
