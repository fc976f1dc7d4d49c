//! Coefficients of the default parameters as a constant, and test vectors with the function that compares them, as
//! headers next to the emitted C.

use super::comments::comment;
use super::expression::{initialiser, number};
use super::names::{WORDS, fill_template};
use crate::program::Program;
use crate::statements::layout;
use crate::statements::{EmitError, File};
use crate::vectors::{TestVector, TestVectors, default_coefficients};

/// Writes the header `NAME_baked.h`: the coefficients of the default parameters, prepared in double precision, as a
/// constant for read-only memory.
///
/// # Errors
/// As for [`emit`](super::emit()), and coefficients that are not finite.
pub fn baked(program: &Program) -> Result<String, EmitError> {
    let file = File::new(program, &WORDS)?;
    let found = default_coefficients(&file, literal, initialiser)?;
    let mut fields: Vec<String> = found.fields.into_iter().map(|(_, text)| text).collect();
    fields.push(i32::from(found.is_definite).to_string());
    let text = comment(&[
        "Coefficients of the default parameters, prepared in double precision. The identity remains in programs"
            .to_owned(),
        "that do not prepare coefficients.".to_owned(),
    ]);
    let text = fill_template(program, &text)
        + &fill_template(
            program,
            &format!(
                "#ifndef NAME_BAKED_H\n#define NAME_BAKED_H\n#include \"HEADER\"\n\
                 static const struct {{\nNAME_coefficients coefficients;\nconst char *identity;\n}} NAME_baked = {{{}, NAME_identity}};\n#endif\n",
                initialiser(&fields)
            )
            .replace("HEADER", &format!("{}.h", program.name)),
        );
    Ok(layout::source(&text))
}

/// Writes the header `vectors.h`: the test vectors in both precisions and `NAME_self_test`, which computes the outputs
/// with the coefficients of `NAME_baked.h` and returns 0 or the place of the first number with other bits.
pub fn vectors(program: &Program, vectors: &TestVectors) -> Result<String, EmitError> {
    let guards = File::new(program, &WORDS)?.guard_count();
    let degrees = program.degrees_of_freedom();
    let observables = program.observables.len();
    let outputs = program.states() + observables + 2 + guards + degrees * degrees;
    let text = SELF_TEST
        .replace("DOUBLE_COUNT", &vectors.double.len().to_string())
        .replace("SINGLE_COUNT", &vectors.single.len().to_string())
        .replace("DOUBLE_VECTORS", &rows(&vectors.double))
        .replace("SINGLE_VECTORS", &rows(&vectors.single))
        .replace("OUTPUTS", &outputs.to_string())
        .replace(
            "ENERGY_PLACE",
            &(program.states() + observables).to_string(),
        )
        .replace(
            "GUARDS_PLACE",
            &(program.states() + observables + 2).to_string(),
        )
        .replace("MASS_PLACE", &(outputs - degrees * degrees).to_string());
    Ok(layout::source(&fill_template(program, &text)))
}

fn rows(vectors: &[TestVector]) -> String {
    let rows = vectors.iter().map(|vector| {
        let literals: Vec<String> = vector
            .numbers()
            .iter()
            .map(|value| literal(*value))
            .collect();
        initialiser(&literals)
    });
    let rows: Vec<String> = rows.collect();
    initialiser(&rows)
}

fn literal(value: f64) -> String {
    format!("(NAME_real){}", number(value))
}

const SELF_TEST: &str = "\
/** Test vectors: time, state and inputs of a call, then rates, observables, energy, power, guards and mass
 * matrix, for the default parameters. Include this file once. */
#ifndef NAME_VECTORS_H
#define NAME_VECTORS_H
#include \"NAME_baked.h\"
#if NAME_IS_SINGLE(NAME_REAL)
/** Number of vectors. */
#define NAME_VECTORS SINGLE_COUNT
static const NAME_real NAME_vectors[NAME_VECTORS][1 + NAME_STATES + NAME_INPUTS + OUTPUTS] = SINGLE_VECTORS;
#else
/** Number of vectors. */
#define NAME_VECTORS DOUBLE_COUNT
static const NAME_real NAME_vectors[NAME_VECTORS][1 + NAME_STATES + NAME_INPUTS + OUTPUTS] = DOUBLE_VECTORS;
#endif
/** Computes all vectors and compares the bits. Returns 0 if they are equal, else the place of the first number that
 * differs, counted from 1 over the outputs of all vectors, OUTPUTS of each. */
static int NAME_self_test(void) {
    NAME_real found[OUTPUTS];
    NAME_inputs inputs;
    const NAME_coefficients *coefficients = &NAME_baked.coefficients;
    for (int vector = 0; vector < NAME_VECTORS; ++vector) {
        const NAME_real *const given = NAME_vectors[vector];
        const NAME_real *const state = given + 1;
        const unsigned char *const expected = (const unsigned char *)(state + NAME_STATES + NAME_INPUTS);
        const unsigned char *const bytes = (const unsigned char *)found;
        NAME_inputs_from_array(state + NAME_STATES, &inputs);
        NAME_rates(given[0], state, &inputs, coefficients, found);
        NAME_observables(given[0], state, &inputs, coefficients, found + NAME_STATES);
        found[ENERGY_PLACE] = NAME_energy(given[0], state, &inputs, coefficients);
        found[ENERGY_PLACE + 1] = NAME_power(given[0], state, &inputs, coefficients);
        NAME_guards(given[0], state, &inputs, coefficients, found + GUARDS_PLACE);
        NAME_mass_matrix(
            given[0], state, &inputs, coefficients,
            (NAME_real (*)[NAME_DEGREES_OF_FREEDOM])(found + MASS_PLACE)
        );
        for (int i = 0; i < (int)sizeof found; ++i) {
            if (bytes[i] != expected[i]) {
                return 1 + vector * OUTPUTS + i / (int)sizeof(NAME_real);
            }
        }
    }
    return 0;
}
#endif
";
