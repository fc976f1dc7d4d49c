//! Coefficients of the default parameters as a constant, and test vectors with the function that compares them, as
//! headers next to the emitted C.

use super::comments::comment;
use super::expression::{number, write_initialiser};
use super::names::{WORDS, fill_template};
use crate::program::Program;
use crate::statements::layout;
use crate::statements::{EmitError, File};
use crate::vectors::{TestVector, TestVectors, compute_default_coefficients};

/// Writes the header `NAME_baked.h`: the coefficients of the default parameters, prepared in double precision, as a
/// constant for read-only memory.
///
/// # Errors
/// As for [`emit`](super::emit()), and coefficients that are not finite.
pub fn baked(program: &Program) -> Result<String, EmitError> {
    let file = File::new(program, &WORDS)?;
    let found = compute_default_coefficients(&file, literal, write_initialiser)?;
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
                write_initialiser(&fields)
            )
            .replace("HEADER", &format!("{}.h", program.name)),
        );
    Ok(layout::source(&text))
}

/// Writes the header `vectors.h`: the test vectors in both precisions and `NAME_self_test`, which computes the
/// outputs with the coefficients of `NAME_baked.h` and returns 0, or the position of the first number that is not
/// bit-identical.
pub fn vectors(program: &Program, vectors: &TestVectors) -> Result<String, EmitError> {
    let outputs = Outputs::new(program)?;
    let text = SELF_TEST
        .replace("DOUBLE_COUNT", &vectors.double.len().to_string())
        .replace("SINGLE_COUNT", &vectors.single.len().to_string())
        .replace("DOUBLE_VECTORS", &write_rows(&vectors.double))
        .replace("SINGLE_VECTORS", &write_rows(&vectors.single))
        .replace("OUTPUT_FIELDS", &outputs.fields)
        .replace("OUTPUT_CALLS", &outputs.calls)
        .replace("OUTPUTS", &outputs.numbers.to_string());
    Ok(layout::source(&fill_template(program, &text)))
}

/// Outputs that the self-test compares: fields of a structure, the calls that fill these fields, and the count of the
/// numbers.
struct Outputs {
    fields: String,
    calls: String,
    numbers: usize,
}

impl Outputs {
    /// Lists the outputs that are not empty, because C has no empty arrays.
    fn new(program: &Program) -> Result<Self, EmitError> {
        let degrees = program.degrees_of_freedom();
        let guards = File::new(program, &WORDS)?.guard_count();
        let mut outputs = Self {
            fields: String::new(),
            calls: String::new(),
            numbers: 0,
        };
        for (function, extents, numbers) in [
            ("rates", "[NAME_STATES]", program.states()),
            (
                "observables",
                "[NAME_OBSERVABLES]",
                program.observables.len(),
            ),
            ("energy", "", 1),
            ("power", "", 1),
            ("guards", "[NAME_GUARDS]", guards),
            (
                "mass_matrix",
                "[NAME_DEGREES_OF_FREEDOM][NAME_DEGREES_OF_FREEDOM]",
                degrees * degrees,
            ),
        ] {
            if numbers == 0 {
                continue;
            }
            outputs.numbers += numbers;
            outputs.fields += &format!("        NAME_real {function}{extents};\n");
            let given = "given[0], state, &inputs, coefficients";
            outputs.calls += &match extents {
                "" => format!("        found.{function} = NAME_{function}({given});\n"),
                _ => format!("        NAME_{function}({given}, found.{function});\n"),
            };
        }
        Ok(outputs)
    }
}

fn write_rows(vectors: &[TestVector]) -> String {
    let rows = vectors.iter().map(|vector| {
        let literals: Vec<String> = vector
            .numbers()
            .iter()
            .map(|value| literal(*value))
            .collect();
        write_initialiser(&literals)
    });
    let rows: Vec<String> = rows.collect();
    write_initialiser(&rows)
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
    struct {
OUTPUT_FIELDS    } found;
    NAME_inputs inputs;
    const NAME_coefficients *coefficients = &NAME_baked.coefficients;
    for (int vector = 0; vector < NAME_VECTORS; ++vector) {
        const NAME_real *const given = NAME_vectors[vector];
        const NAME_real *const state = &given[1];
        const NAME_real *const numbers = &state[NAME_STATES];
        const unsigned char *const expected = (const unsigned char *)&numbers[NAME_INPUTS];
        const unsigned char *const bytes = (const unsigned char *)&found;
        NAME_inputs_from_array(numbers, &inputs);
OUTPUT_CALLS        for (int i = 0; i < (int)sizeof found; ++i) {
            if (bytes[i] != expected[i]) {
                return 1 + (vector * OUTPUTS) + (i / (int)sizeof(NAME_real));
            }
        }
    }
    return 0;
}
#endif
";
