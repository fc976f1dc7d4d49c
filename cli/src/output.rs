//! Files are written beside their place and moved there when whole, so that an error or a
//! kill leaves nothing half written.

use std::io::Write;
use std::path::Path;

use tempfile::NamedTempFile;

use crate::problem::{Outcome, Problem};

/// Writes a file, or leaves what was there. Folders on the way are made.
pub fn write_file(path: &Path, contents: &[u8]) -> Outcome {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let failed = |error: &dyn std::fmt::Display| Problem::file("write", path, error);
    std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    let mut file = NamedTempFile::new_in(folder).map_err(|error| failed(&error))?;
    file.write_all(contents).map_err(|error| failed(&error))?;
    make_readable(file.as_file()).map_err(|error| failed(&error))?;
    file.persist(path).map_err(|error| failed(&error.error))?;
    Ok(())
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
