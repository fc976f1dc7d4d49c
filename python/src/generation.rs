//! Emitted source of a model.

use std::sync::Mutex;

use eomgen_codegen::program::Output;
use eomgen_codegen::variant::Variant;
use eomgen_compiled_model::Error;
use eomgen_targets::{EmissionError, EmittedFile, Target, emit, outputs, parse_output};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Names and contents of emitted files, and warnings. The file with the equations is the first.
type EmissionTuple = (Vec<(String, Vec<u8>)>, Vec<String>);

/// Emits the source of a model for a target, with additional outputs.
#[pyfunction]
pub fn generate(
    py: Python<'_>,
    model: &Model,
    target: &str,
    extras: Vec<String>,
) -> PyResult<EmissionTuple> {
    let target = parse_target(target)?;
    let with = parse_outputs(&extras)?;
    let outputs = outputs(target, &with).map_err(emission_error)?;
    let warnings = Mutex::new(Vec::new());
    let warn = |text: &str| {
        let text = text.strip_prefix("warning: ").unwrap_or(text);
        if let Ok(mut warnings) = warnings.lock() {
            warnings.push(text.to_owned());
        }
    };
    let emitted = py.detach(|| -> PyResult<Vec<EmittedFile>> {
        let declared = model.instance().and_then(|run| run.valued_model());
        let declared = declared.map_err(error::model)?;
        let variant = Variant::derive_with_trace(&declared, model.compiled().orders(), &outputs);
        let variant = variant.map_err(|found| error::specification(&found))?;
        emit(&declared, &variant, target, &warn).map_err(emission_error)
    });
    let files = emitted?.into_iter();
    let files = files.map(|file| (file.name, file.contents)).collect();
    Ok((files, warnings.into_inner().unwrap_or_default()))
}

/// Returns the additional outputs with the given names.
pub fn parse_outputs(names: &[String]) -> PyResult<Vec<Output>> {
    let outputs = names.iter().map(|name| parse_output(name));
    let outputs: Result<Vec<Output>, String> = outputs.collect();
    outputs.map_err(PyValueError::new_err)
}

/// Returns the target with the given name. Functional mock-up units need a library that the Python package does not
/// contain.
fn parse_target(name: &str) -> PyResult<Target> {
    let is_unit = |target: &Target| matches!(target, Target::Fmu2 | Target::Fmu3);
    match Target::ALL.into_iter().find(|known| known.name() == name) {
        Some(target) if is_unit(&target) => Err(PyValueError::new_err(format!(
            "target = \"{name}\": the Python package does not contain the library of functional mock-up units; run \
             `eomgen generate SPEC --target {name} --out DIR`"
        ))),
        Some(target) => Ok(target),
        None => {
            let known = Target::ALL.into_iter().filter(|target| !is_unit(target));
            let names: Vec<String> = known.map(|known| format!("\"{}\"", known.name())).collect();
            Err(PyValueError::new_err(format!(
                "target = \"{name}\": expected one of {}",
                names.join(", ")
            )))
        }
    }
}

fn emission_error(error: EmissionError) -> PyErr {
    error::model(match error {
        EmissionError::Request(reason) => Error::Request(reason),
        EmissionError::Specification(found) => Error::Specification(found),
    })
}
