//! Shared library of units for this platform.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::path::{Path, PathBuf};

use super::version::Version;
use crate::error::{EmissionError, Result};

/// Content of the library, if it was built before this program and `EOMGEN_UNIT` named its path at compile time.
#[cfg(eomgen_unit)]
const EMBEDDED: Option<&[u8]> = Some(include_bytes!(env!("EOMGEN_UNIT")));
#[cfg(not(eomgen_unit))]
const EMBEDDED: Option<&[u8]> = None;

/// Returns the folder that the standard defines for binaries of this platform, if any.
fn folder(version: Version) -> Option<String> {
    let system = match OS {
        "linux" => "linux",
        "macos" => "darwin",
        "windows" => "windows",
        _ => return None,
    };
    match (version, ARCH) {
        (Version::Two, "x86_64") => Some(format!("{}64", system.trim_end_matches("dows"))),
        (Version::Two, "x86") => Some(format!("{}32", system.trim_end_matches("dows"))),
        (Version::Two, _) => None,
        (Version::Three, "x86_64" | "x86" | "aarch64") => Some(format!("{ARCH}-{system}")),
        (Version::Three, _) => None,
    }
}

/// Returns the library's path in a unit of this name, and its contents.
///
/// # Errors
/// The standard defines no folder for this platform, or there is no library.
pub fn read(name: &str, version: Version) -> Result<(String, Vec<u8>)> {
    let folder = folder(version).ok_or_else(|| {
        let version = match version {
            Version::Two => "2.0; use --target fmu3",
            Version::Three => "3.0",
        };
        EmissionError::request(format!(
            "the standard defines no folder for binaries of this kind of machine ({OS}, {ARCH}) in version {version}"
        ))
    })?;
    let contents = match EMBEDDED {
        Some(contents) => contents.to_vec(),
        None => read_beside_program()?,
    };
    Ok((format!("binaries/{folder}/{name}{DLL_SUFFIX}"), contents))
}

/// Reads the library from the program's folder, or from `deps` in it, where cargo writes it.
fn read_beside_program() -> Result<Vec<u8>> {
    let file = format!("{DLL_PREFIX}eomgen_unit{DLL_SUFFIX}");
    let program = std::env::current_exe().and_then(|path| path.canonicalize());
    let program = program.map_err(|error| {
        EmissionError::request(format!("cannot find the folder of the program: {error}"))
    })?;
    let folder = program.parent().unwrap_or(Path::new(""));
    let places: [PathBuf; 2] = [folder.join(&file), folder.join("deps").join(&file)];
    let Some(place) = places.iter().find(|place| place.is_file()) else {
        return Err(EmissionError::request(format!(
            "the library of functional mock-up units, {file}, is not in {0}: copy it there from a release, or run \
             `cp target/release/deps/{file} {0}` in the clone from which the program was installed",
            folder.display()
        )));
    };
    std::fs::read(place).map_err(|error| {
        EmissionError::request(format!("cannot read {}: {error}", place.display()))
    })
}
