//! Files of `--with baked` and `--with self_test`: constant coefficients, test vectors and a function that compares
//! them.

use eomgen_codegen::program::Program;
use eomgen_codegen::vectors::{CallArguments, TestVector, TestVectors};
use eomgen_codegen::{c, rust};
use eomgen_model_spec::model::Model;
use eomgen_validate::oracle::Oracle;
use eomgen_validate::sampler::Sampler;
use serde_json::{Value, json};

use crate::arguments::{Extra, Target};
use crate::document::SCHEMA;
use crate::error::{Error, Result};

/// Number of calls in the test vectors.
const CALLS: usize = 8;
/// Seed of the calls. The calls differ from the calls of the certificate.
const SEED: u64 = 0x7e57_7e57;

/// Returns names and contents of the requested files for a target.
///
/// # Errors
/// A target other than Rust and C, or a model for which no state in its domain was found.
pub fn files(
    model: &Model,
    orders: &[usize],
    program: &Program,
    with: &[Extra],
    target: Target,
) -> Result<Vec<(String, Vec<u8>)>> {
    let is_tested = with.contains(&Extra::SelfTest);
    if !is_tested && !with.contains(&Extra::Baked) {
        return Ok(Vec::new());
    }
    let name = &program.name;
    let mut files = match target {
        Target::Rust => vec![("baked.rs".to_owned(), rust::baked(program)?)],
        Target::C99 => vec![(format!("{name}_baked.h"), c::baked(program)?)],
        _ => {
            return Err(Error::input(
                "--with baked and --with self_test need --target rust or --target c99",
            ));
        }
    };
    if is_tested {
        let vectors = TestVectors::new(program, &calls(model, orders)?);
        files.push(match target {
            Target::Rust => ("vectors.rs".to_owned(), rust::vectors(program, &vectors)?),
            _ => ("vectors.h".to_owned(), c::vectors(program, &vectors)?),
        });
        files.push(("vectors.json".to_owned(), document(program, &vectors)?));
    }
    let files = files.into_iter();
    Ok(files
        .map(|(name, text)| (name, text.into_bytes()))
        .collect())
}

/// Draws the arguments of the calls of the test vectors.
fn calls(model: &Model, orders: &[usize]) -> Result<Vec<CallArguments>> {
    let of_model =
        |error: eomgen_model_spec::variant::ModelError| Error::model(&model.source, error);
    let values = model.parameter_values().map_err(of_model)?;
    let order = orders.first().copied().unwrap_or(0);
    if orders.iter().any(|other| *other != order) {
        return Err(Error::input(
            "--with self_test needs one order for all fields: give --order",
        ));
    }
    let failed = |error: eomgen_validate::oracle::OracleError| {
        Error::input(format!(
            "the states of the test vectors cannot be sampled: {error}"
        ))
    };
    let oracle = Oracle::new(model, order, &values).map_err(failed)?;
    let mut sampler = Sampler::new(&oracle, SEED).map_err(failed)?;
    let mut calls = Vec::new();
    while calls.len() < CALLS
        && let Some(drawn) = sampler.draw_inside().map_err(failed)?
    {
        calls.push(CallArguments {
            time: drawn.sample.time,
            state: drawn.sample.state,
            inputs: drawn.sample.inputs,
        });
    }
    match calls.is_empty() {
        false => Ok(calls),
        true => Err(Error::input(
            "no state in the model's domain was found for the test vectors",
        )),
    }
}

/// Returns the vectors as JSON, with numbers as decimals and as bits.
fn document(program: &Program, vectors: &TestVectors) -> Result<String> {
    let of_double = |number: &f64| format!("{:016x}", number.to_bits());
    let of_single = |number: &f64| format!("{:08x}", (*number as f32).to_bits());
    let document = json!({
        "schema": SCHEMA,
        "model": program.name,
        "specification_sha256": program.spec_hash,
        "states": program.state_names(),
        "inputs": program.inputs.iter().map(|input| &input.name).collect::<Vec<_>>(),
        "observables": program.observables.iter().map(|one| &one.name).collect::<Vec<_>>(),
        "results": ["rates", "observables", "energy", "power", "guards", "mass_matrix"],
        "double": list(&vectors.double, of_double),
        "single": list(&vectors.single, of_single),
    });
    let text = serde_json::to_string_pretty(&document);
    Ok(text.map_err(|error| Error::input(error.to_string()))? + "\n")
}

fn list(vectors: &[TestVector], bits: impl Fn(&f64) -> String) -> Vec<Value> {
    let all = |numbers: &[f64]| numbers.iter().map(&bits).collect::<Vec<String>>();
    let vectors = vectors.iter().map(
        |TestVector {
             arguments,
             expected,
         }| {
            json!({
                "time": arguments.time,
                "state": arguments.state,
                "inputs": arguments.inputs,
                "given_bits": all(&arguments.numbers()),
                "expected": expected,
                "expected_bits": all(expected),
            })
        },
    );
    vectors.collect()
}
