//! Files are written beside their place and moved there when whole, so that an error or a
//! kill leaves nothing half written.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Result, say, say_bytes, warn};

/// Version of the JSON documents that the commands print and write.
pub const SCHEMA: u32 = 2;

/// Destination of a command's output file.
pub enum Destination {
    /// To stdout, for the name `-`.
    Stdout,
    /// To a device, which stays what it is.
    Device(PathBuf),
    /// To a file, which is there whole or not at all.
    File(PathBuf),
}

impl Destination {
    /// Where a name leads. `json`: whether something else is to be read on stdout.
    ///
    /// # Errors
    /// A folder, a pipe or a place that cannot be, and stdout where `json` takes it.
    pub fn of(path: &Path, json: bool) -> Result<Self> {
        Self::named("--out", path, json)
    }

    /// The same for a figure beside it, which has a place of its own.
    ///
    /// # Errors
    /// As [`Destination::of`], the place of the other file, and a name of another kind of figure.
    pub fn of_figure(figure: &Path, beside: Option<&Path>, json: bool) -> Result<Self> {
        let place = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if beside.is_some_and(|other| place(other) == place(figure)) && !is_device(figure) {
            let shown = figure.display();
            return Err(Error::input(format!(
                "--out {shown} and --plot {shown} are one place: give --plot another"
            )));
        }
        let ending = figure.extension().filter(|_| !is_device(figure));
        if ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("svg")) {
            return Err(Error::input(format!(
                "--plot {}: a figure is an SVG: give it a name that ends in .svg",
                figure.display()
            )));
        }
        Self::named("--plot", figure, json)
    }

    fn named(option: &str, path: &Path, json: bool) -> Result<Self> {
        if path == Path::new("-") {
            return if json {
                Err(Error::input(format!(
                    "--json and {option} - both write to stdout: give {option} the name of a file"
                )))
            } else {
                Ok(Self::Stdout)
            };
        }
        if is_device(path) {
            return Ok(Self::Device(path.to_owned()));
        }
        file_place(path)?;
        Ok(Self::File(path.to_owned()))
    }

    /// Writes the contents.
    pub fn write(&self, contents: &[u8]) -> Result {
        match self {
            Self::Stdout => say_bytes(contents),
            Self::Device(path) => std::fs::OpenOptions::new()
                .write(true)
                .open(path)
                .and_then(|mut device| device.write_all(contents))
                .map_err(|error| Error::file("write", path, &error)),
            Self::File(path) => write_file(path, contents),
        }
    }

    /// Says what was done: on stderr where the contents are on stdout.
    pub fn summarise(&self, summary: &str) -> Result {
        match self {
            Self::Stdout => {
                warn(summary.trim_end());
                Ok(())
            }
            _ => say(summary),
        }
    }
}

/// Whether this is something like `/dev/null`. A pipe is none: it might never be read.
#[cfg(unix)]
fn is_device(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    std::fs::metadata(path).is_ok_and(|found| found.file_type().is_char_device())
}

#[cfg(not(unix))]
fn is_device(_path: &Path) -> bool {
    false
}

/// Writes a file, or leaves what was there. Folders on the way are made.
pub fn write_file(path: &Path, contents: &[u8]) -> Result {
    let place = file_place(path)?;
    let failed = |error: &dyn std::fmt::Display| Error::file("write", path, error);
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
pub fn file_place(path: &Path) -> Result<PathBuf> {
    let failed = |error: &dyn std::fmt::Display| Error::file("write", path, error);
    match std::fs::metadata(path) {
        Ok(found) if found.is_file() => std::fs::canonicalize(path).map_err(|error| failed(&error)),
        Ok(_) => Err(failed(
            &"it is not a file; give the name of a file, or - for stdout",
        )),
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
