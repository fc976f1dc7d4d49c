//! Functional mock-up units: the emitted C with the functions of the standard around it, the
//! description of its variables, and a binary, packed into one file.
//!
//! `variables` lists what a unit has, by name and value reference; `units` are those of measurement;
//! `description` (with `fmi2` and `fmi3`, which differ in how they say it) writes both as XML;
//! `sources` lays out the C; `binary` compiles it where there is a compiler; [`crate::archive`] packs all.
//! The C that every unit has alike is in the folder `runtime`.

mod binary;
mod description;
mod fmi2;
mod fmi3;
mod sources;
mod units;
mod variables;
mod version;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;

use crate::archive::pack;
use crate::error::{Result, warn};

pub use version::Version;

/// What a model has to be derived with.
pub const OUTPUTS: [Output; 3] = [Output::GuardRates, Output::Jacobians, Output::Regimes];

/// The name and the bytes of a unit.
///
/// # Errors
/// If the model's names are no names in C, or its initial state is none.
pub fn file(model: &Model, variant: &Variant, version: Version) -> Result<(String, Vec<u8>)> {
    let program = &variant.program;
    let unit = variables::Unit::of(model, variant)?;
    let sources = sources::files(program, &unit, version)?;
    let mut files = vec![(
        "modelDescription.xml".to_owned(),
        match version {
            Version::Two => fmi2::description(&unit)?,
            Version::Three => fmi3::description(&unit)?,
        },
    )];
    if version == Version::Three {
        let text = fmi3::build_description(&unit)?;
        files.push(("sources/buildDescription.xml".to_owned(), text));
    }
    match binary::compile(&program.name, &sources, version) {
        Ok((name, contents)) => files.push((name, contents)),
        Err(reason) => warn(&format!(
            "warning: {}.fmu holds sources and no binary: {reason}",
            program.name
        )),
    }
    for (name, text) in sources {
        files.push((format!("sources/{name}"), text.into_bytes()));
    }
    Ok((format!("{}.fmu", program.name), pack(files)?))
}
