//! Functional mock-up units: an archive of the emitted C with the functions of the standard, the description of its
//! variables, and a binary.
//!
//! `variables` lists the variables of a unit, `units` their units of measurement; `description`, `fmi2` and `fmi3` write
//! both as XML; `sources` arranges the C; `binary` compiles it; [`crate::archive`] packs all files. The folder `runtime`
//! contains the C that is common to all units.

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
use crate::error::Result;
use crate::file::EmittedFile;

pub use version::Version;

/// Outputs that a unit needs.
pub const OUTPUTS: [Output; 3] = [Output::GuardRates, Output::Jacobians, Output::Regimes];

/// Returns a unit. `warn` receives the reason if it has no binary.
///
/// # Errors
/// Names that C does not allow, or an invalid initial state.
pub fn file(
    model: &Model,
    variant: &Variant,
    version: Version,
    warn: &dyn Fn(&str),
) -> Result<EmittedFile> {
    let program = &variant.program;
    let unit = variables::Unit::new(model, variant)?;
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
            "warning: {}.fmu contains sources but no binary: {reason}",
            program.name
        )),
    }
    for (name, text) in sources {
        files.push((format!("sources/{name}"), text.into_bytes()));
    }
    Ok(EmittedFile {
        name: format!("{}.fmu", program.name),
        contents: pack(files)?,
    })
}
