//! Coefficients of the default parameters as constants, and test vectors with the functions that compare them, as files
//! for a module next to the emitted Rust.

use super::expression::array;
use super::literals::number;
use super::words::WORDS;
use crate::program::Program;
use crate::statements::layout;
use crate::statements::{EmitError, File};
use crate::vectors::{TestVector, TestVectors, compute_default_coefficients};

/// Writes `baked.rs`: the coefficients of the default parameters, prepared in double precision, as constants for
/// read-only memory. The file refers to the emitted module as `model`.
///
/// # Errors
/// As for [`emit`](super::emit()), and coefficients that are not finite.
pub fn baked(program: &Program) -> Result<String, EmitError> {
    let file = File::new(program, &WORDS)?;
    let constant = |name: &str, argument: &str, convert: fn(f64) -> f64| {
        let found = compute_default_coefficients(&file, |value| number(convert(value)), array)?;
        let fields = found.fields.iter();
        let fields: String = fields
            .map(|(field, text)| format!("    {field}: {text},\n"))
            .collect();
        let argument = if found.fields.is_empty() {
            ""
        } else {
            argument
        };
        let is_definite = found.is_definite;
        Ok::<_, EmitError>(format!(
            "/// Coefficients of the default parameters.\npub const {name}: model::Coefficients{argument} = model::Coefficients {{\n\
             {fields}    positive_definite: {is_definite},\n}};\n"
        ))
    };
    let text = BAKED_HEAD.to_owned()
        + &constant("BAKED", "<f64>", |value| value)?
        + &constant("BAKED_SINGLE", "<f32>", |value| f64::from(value as f32))?;
    Ok(layout::source(&text))
}

const BAKED_HEAD: &str = "\
// Coefficients of the default parameters, prepared in double precision, for read-only memory. Include this file in a
// module in which `model` is the emitted module: mod baked { use super::arm as model; include!(\"baked.rs\"); }
";

/// Writes `vectors.rs`: the test vectors in both precisions, `self_test` and `self_test_single`, which compute the
/// outputs with the coefficients of `baked.rs`.
///
/// # Errors
/// As for [`emit`](super::emit()).
pub fn vectors(program: &Program, vectors: &TestVectors) -> Result<String, EmitError> {
    let file = File::new(program, &WORDS)?;
    let coefficients = match file.fields.is_empty() {
        true => "model::Coefficients",
        false => "model::Coefficients<T>",
    };
    let rows = |vectors: &[TestVector]| {
        let rows = vectors.iter().map(|vector| {
            let numbers = vector.numbers();
            array(
                &numbers
                    .iter()
                    .map(|value| number(*value))
                    .collect::<Vec<_>>(),
            )
        });
        array(&rows.collect::<Vec<_>>())
    };
    let text = SELF_TEST
        .replace("DOUBLE_COUNT", &vectors.double.len().to_string())
        .replace("SINGLE_COUNT", &vectors.single.len().to_string())
        .replace("DOUBLE_VECTORS", &rows(&vectors.double))
        .replace("SINGLE_VECTORS", &rows(&vectors.single))
        .replace("COEFFICIENTS", coefficients);
    Ok(layout::source(&text))
}

const SELF_TEST: &str = "\
// Test vectors: time, state and inputs of a call, then rates, observables, energy, power, guards and mass matrix, for
// the default parameters. Include this file in a module in which `model` is the emitted module:
// mod vectors { use super::arm as model; include!(\"vectors.rs\"); }
include!(\"baked.rs\");
/// Number of arguments in a test vector.
const GIVEN: usize = 1 + model::STATES + model::INPUT_NAMES.len();
/// Number of results in a test vector.
const OUTPUTS: usize =
    model::STATES + model::OBSERVABLES + 2 + model::GUARDS + model::DEGREES_OF_FREEDOM * model::DEGREES_OF_FREEDOM;
static DOUBLE: [[f64; GIVEN + OUTPUTS]; DOUBLE_COUNT] = DOUBLE_VECTORS;
static SINGLE: [[f32; GIVEN + OUTPUTS]; SINGLE_COUNT] = SINGLE_VECTORS;
/// Computes all vectors in double precision and compares the bits. Returns the place of the first number that differs,
/// counted over the outputs of all vectors.
pub fn self_test() -> Option<usize> {
    first_difference(&DOUBLE, &BAKED, |a, b| a.to_bits() == b.to_bits())
}
/// Computes all vectors in single precision, as `self_test`.
pub fn self_test_single() -> Option<usize> {
    first_difference(&SINGLE, &BAKED_SINGLE, |a, b| a.to_bits() == b.to_bits())
}
fn first_difference<T: model::Scalar>(
    vectors: &[[T; GIVEN + OUTPUTS]],
    coefficients: &COEFFICIENTS,
    is_same: fn(T, T) -> bool,
) -> Option<usize> {
    // The reference keeps the identity in programs that do not prepare coefficients.
    let _ = core::hint::black_box(&model::IDENTITY);
    for (place, vector) in vectors.iter().enumerate() {
        let (given, expected) = vector.split_at(GIVEN);
        let t = given[0];
        let (mut state, mut signals) = ([t; model::STATES], [t; GIVEN - 1 - model::STATES]);
        for (slot, number) in state.iter_mut().chain(&mut signals).zip(&given[1..]) {
            *slot = *number;
        }
        let inputs = model::Inputs::from(signals);
        let rates = model::rates(t, &state, &inputs, coefficients);
        let observables = model::observables(t, &state, &inputs, coefficients);
        let energy = model::energy(t, &state, &inputs, coefficients);
        let power = model::power(t, &state, &inputs, coefficients);
        let guards = model::guards(t, &state, &inputs, coefficients);
        let mass = model::mass_matrix(t, &state, &inputs, coefficients);
        let found = rates.iter().chain(&observables).chain([&energy, &power]).chain(&guards);
        let found = found.chain(mass.as_flattened());
        let mut pairs = found.zip(expected);
        if let Some(number) = pairs.position(|(found, expected)| !is_same(*found, *expected)) {
            return Some(place * OUTPUTS + number);
        }
    }
    None
}
";
