//! Files are written beside their place and moved there when whole, so that an error or a
//! kill leaves nothing half written.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::problem::{Outcome, Problem};

/// Writes a file, or leaves what was there. Folders on the way are made.
pub fn write_file(path: &Path, contents: &[u8]) -> Outcome {
    let place = file_place(path)?;
    let failed = |error: &dyn std::fmt::Display| Problem::file("write", path, error);
    let folder = folder_of(&place);
    std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    let mut file = NamedTempFile::new_in(folder).map_err(|error| failed(&error))?;
    file.write_all(contents).map_err(|error| failed(&error))?;
    make_readable(file.as_file()).map_err(|error| failed(&error))?;
    file.persist(place).map_err(|error| failed(&error.error))?;
    Ok(())
}

/// Where a file's name leads: to a file, also by a link, or to nothing yet. Moving a file
/// onto a device or a pipe would put the file in its place.
pub fn file_place(path: &Path) -> Outcome<PathBuf> {
    let failed = |error: &dyn std::fmt::Display| Problem::file("write", path, error);
    match std::fs::metadata(path) {
        Ok(found) if found.is_file() => std::fs::canonicalize(path).map_err(|error| failed(&error)),
        Ok(_) => Err(failed(&"it is not a file; give the name of a file")),
        Err(_) if path.file_name().is_none() => Err(failed(&"give the name of a file")),
        Err(_) => match folder_of(path).ancestors().find(|folder| folder.exists()) {
            Some(found) if !found.is_dir() => {
                Err(failed(&format!("{} is not a folder", found.display())))
            }
            _ => Ok(path.to_owned()),
        },
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Temporary files are private; what a command leaves is to be read by others.
#[cfg(unix)]
fn make_readable(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}
