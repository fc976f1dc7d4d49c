//! Functional mock-up units. A unit is an archive that contains the description of the variables, the specification,
//! and the library that simulates the model.
//!
//! `variables` lists the variables of a unit, `units` their units of measurement; `description`, `fmi2` and `fmi3`
//! write both as XML; `library` finds the library, which is built from the crate `eomgen-unit`; [`crate::archive`]
//! packs all files.

mod description;
mod fmi2;
mod fmi3;
mod library;
mod units;
mod variables;
mod version;

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_model_spec::edit::{self, Edit, SetParameter};
use eomgen_model_spec::model::{Model, ParameterValue};

use crate::archive::pack;
use crate::error::{EmissionError, Result};
use crate::file::EmittedFile;

pub use version::Version;

/// Returns a unit of a model at these orders of its fields.
///
/// # Errors
/// There is no library, a value cannot be written to the specification, or a table cannot be read.
pub fn emit_file(model: &Model, orders: &[usize], version: Version) -> Result<EmittedFile> {
    let library = library::read(&model.name, version)?;
    let model = write_parameters(model)?;
    let compiled = CompiledModel::derive(model, Orders::PerField(orders));
    let compiled = compiled.map_err(EmissionError::request)?;
    let unit = variables::Unit::new(&compiled)?;
    let mut files = vec![(
        "modelDescription.xml".to_owned(),
        match version {
            Version::Two => fmi2::write_description(&unit)?,
            Version::Three => fmi3::write_description(&unit)?,
        },
    )];
    files.push(library);
    files.extend(read_resources(compiled.model())?);
    Ok(EmittedFile {
        name: format!("{}.fmu", compiled.program().name),
        contents: pack(files)?,
    })
}

/// Returns the model with its parameter values written to the text of its specification, because the FMU contains
/// this text.
fn write_parameters(model: &Model) -> Result<Model> {
    let checked = eomgen_model_spec::check(model.source.clone());
    let declared = checked.map_err(EmissionError::Specification)?.model;
    let edits: Vec<Edit> = (model.parameters.iter().zip(&declared.parameters))
        .filter_map(|(own, known)| match (&own.value, &known.value) {
            (ParameterValue::Number(value), ParameterValue::Number(known)) if value == known => {
                None
            }
            (ParameterValue::Number(value), _) => Some(Edit::SetParameter(SetParameter {
                name: own.name.clone(),
                value: own.unit.from_si(*value),
                source: String::new(),
            })),
            _ => None,
        })
        .collect();
    if edits.is_empty() {
        return Ok(declared);
    }
    let edited = edit::apply(&model.source, &edits).map_err(EmissionError::request)?;
    let checked = eomgen_model_spec::check(model.source.with_text(edited));
    Ok(checked.map_err(EmissionError::Specification)?.model)
}

/// Returns the specification and the tables that it names.
fn read_resources(model: &Model) -> Result<Vec<(String, Vec<u8>)>> {
    let text = model.source.text.as_bytes().to_vec();
    let mut files = vec![(format!("resources/{}.toml", model.name), text)];
    let folder = model.source.folder.as_deref().unwrap_or("".as_ref());
    for table in model.fields.iter().filter_map(|field| field.basis.table()) {
        let name = format!("resources/{}", table.file);
        if files.iter().any(|(known, _)| *known == name) {
            continue;
        }
        let contents = std::fs::read(folder.join(&table.file));
        let contents = contents.map_err(|error| {
            EmissionError::Request(format!("cannot read the table {}: {error}", table.file))
        })?;
        files.push((name, contents));
    }
    Ok(files)
}
