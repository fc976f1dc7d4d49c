//! Input files of a command. Outputs that would overwrite one of them are rejected.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use crate::error::{Error, Result};

/// Canonical paths of the input files of this command.
static INPUTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Options whose values name outputs.
const OUTPUT_OPTIONS: [&str; 3] = ["--out", "--plot", "--events"];

/// Registers a file as an input, if it exists.
pub fn register_input(path: &Path) {
    let found = std::fs::canonicalize(path)
        .ok()
        .filter(|path| path.is_file());
    if let (Some(path), Ok(mut inputs)) = (found, INPUTS.lock()) {
        inputs.push(path);
    }
}

/// Registers the files that the command line names as inputs.
pub fn register_arguments() {
    let mut is_output = false;
    for argument in std::env::args_os().skip(1) {
        let text = argument.to_string_lossy();
        let (option, value) = match text.split_once('=') {
            Some((option, value)) if option.starts_with("--") => (option, Path::new(value)),
            _ => ("", Path::new(&argument)),
        };
        if !is_output && !OUTPUT_OPTIONS.contains(&option) {
            register_input(value);
        }
        is_output = OUTPUT_OPTIONS.contains(&&*text);
    }
}

/// Rejects an output that would replace an input.
pub fn check_is_no_input(output: &Path) -> Result {
    let place = std::fs::canonicalize(output);
    let is_input = |place: &PathBuf| INPUTS.lock().is_ok_and(|inputs| inputs.contains(place));
    match place.is_ok_and(|place| is_input(&place)) {
        true => Err(Error::input(format!(
            "{} is also read by this command: give the output another name",
            output.display()
        ))),
        false => Ok(()),
    }
}

/// Maximum size of an input file in bytes, enough for a large firmware image with debugging information.
const MAX_BYTES: u64 = 1 << 30;

/// Reads a file. Devices and pipes are rejected because they may never end, and files of more than 1 GiB are rejected.
pub fn read_file(path: &Path) -> Result<Vec<u8>> {
    let failed = |error: &dyn std::fmt::Display| Error::file("read", path, error);
    let found = std::fs::metadata(path).map_err(|error| failed(&error))?;
    if !found.is_file() {
        return Err(failed(&"it is not a file"));
    }
    if found.len() > MAX_BYTES {
        let length = found.len();
        return Err(failed(&format!(
            "it has {length} bytes; the limit is {MAX_BYTES}"
        )));
    }
    std::fs::read(path).map_err(|error| failed(&error))
}
