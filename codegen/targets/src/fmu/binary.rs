//! Shared library of a unit for this machine.

use std::env::consts::{ARCH, DLL_SUFFIX, OS};
use std::process::{Command, Stdio};

use super::sources::MAIN;
use super::version::Version;

/// Returns the standard's folder for binaries of this machine, if defined.
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

/// Compiles the library. Returns its path in the unit and its contents, or the reason for a failure.
pub fn compile(
    name: &str,
    sources: &[(String, String)],
    version: Version,
) -> Result<(String, Vec<u8>), String> {
    let folder =
        folder(version).ok_or("the standard defines no folder for this kind of machine")?;
    let place = tempfile::tempdir().map_err(|error| error.to_string())?;
    for (file, text) in sources {
        std::fs::write(place.path().join(file), text).map_err(|error| error.to_string())?;
    }
    // Compiled from within the folder, whose name would otherwise be part of the library.
    let library = format!("{name}{DLL_SUFFIX}");
    let output = Command::new("cc")
        .args(["-std=c99", "-O2", "-shared", "-fPIC", "-fvisibility=hidden"])
        .args([MAIN, "-o", &library])
        .current_dir(place.path())
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("cannot run the C compiler cc: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("the C compiler cc failed:\n{}", said.trim_end()));
    }
    let contents = std::fs::read(place.path().join(&library)).map_err(|error| error.to_string())?;
    Ok((format!("binaries/{folder}/{library}"), contents))
}
