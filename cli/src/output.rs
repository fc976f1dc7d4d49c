//! Output files. A complete temporary file replaces the target, so that an interruption leaves no partial file.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Result, print_bytes, print_text, warn};
use crate::input_file::check_is_no_input;

/// Destination of a command's output file.
pub enum Destination {
    /// Stdout, for the name `-`.
    Stdout,
    /// Device such as `/dev/null`, which must not be replaced by a file.
    Device(PathBuf),
    /// File.
    File(PathBuf),
}

impl Destination {
    /// Returns the destination of `--out`. `json`: true if `--json` uses stdout.
    ///
    /// # Errors
    /// A folder, a pipe or an invalid path; stdout if `json` is set.
    pub fn for_output(path: &Path, json: bool) -> Result<Self> {
        Self::resolve("--out", path, json)
    }

    /// Returns the destination of a table in `--out`, a CSV or Parquet file.
    ///
    /// # Errors
    /// The errors of [`Destination::for_output`], or another file format.
    pub fn for_table(path: &Path, json: bool) -> Result<Self> {
        let ending = path.extension().filter(|_| !is_device(path));
        let is_known = |ending: &std::ffi::OsStr| {
            ["csv", "parquet"]
                .iter()
                .any(|known| ending.eq_ignore_ascii_case(known))
        };
        if ending.is_some_and(|ending| !is_known(ending)) {
            return Err(Error::input(format!(
                "--out {}: the trajectory is a CSV or a Parquet file: give a name that ends in .csv or .parquet",
                path.display()
            )));
        }
        Self::for_output(path, json)
    }

    /// Returns the destination of a page in `--out`.
    ///
    /// # Errors
    /// The errors of [`Destination::for_output`], or a format other than HTML.
    pub fn for_page(path: &Path, json: bool) -> Result<Self> {
        let ending = path.extension().filter(|_| !is_device(path));
        if ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("html")) {
            return Err(Error::input(format!(
                "--out {}: a page is an HTML file: give a name that ends in .html",
                path.display()
            )));
        }
        Self::for_output(path, json)
    }

    /// Returns the destination of `--plot`. `output` is the path of `--out`.
    ///
    /// # Errors
    /// The errors of [`Destination::for_output`], the path of `--out`, or a format other than SVG.
    pub fn for_figure(figure: &Path, output: Option<&Path>, json: bool) -> Result<Self> {
        if let Some(output) = output {
            check_distinct("--plot", figure, ("--out", output))?;
        }
        let ending = figure.extension().filter(|_| !is_device(figure));
        if ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("svg")) {
            return Err(Error::input(format!(
                "--plot {}: figures are SVG files: give a name that ends in .svg",
                figure.display()
            )));
        }
        Self::resolve("--plot", figure, json)
    }

    /// Returns the destination of `--events`, a CSV file. `others` contains the option and the path of each other
    /// output.
    ///
    /// # Errors
    /// The errors of [`Destination::for_output`], the path of another output, or stdout.
    pub fn for_events(path: &Path, others: &[(&str, &Path)]) -> Result<Self> {
        const OPTION: &str = "--events";
        if path == Path::new("-") {
            return Err(Error::input(format!(
                "{OPTION} -: stdout is for --out: give {OPTION} the name of a file"
            )));
        }
        for other in others {
            check_distinct(OPTION, path, *other)?;
        }
        let ending = path.extension().filter(|_| !is_device(path));
        if ending.is_some_and(|ending| !ending.eq_ignore_ascii_case("csv")) {
            return Err(Error::input(format!(
                "{OPTION} {}: the event log is a CSV file: give a name that ends in .csv",
                path.display()
            )));
        }
        Self::resolve(OPTION, path, false)
    }

    fn resolve(option: &str, path: &Path, json: bool) -> Result<Self> {
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

    pub fn write(&self, contents: &[u8]) -> Result {
        match self {
            Self::Stdout => print_bytes(contents),
            Self::Device(path) => std::fs::OpenOptions::new()
                .write(true)
                .open(path)
                .and_then(|mut device| device.write_all(contents))
                .map_err(|error| Error::file("write", path, &error)),
            Self::File(path) => write_file(&file_place(path)?, contents),
        }
    }

    /// Prints a summary: to stderr if the contents are written to stdout, otherwise to stdout.
    pub fn summarise(&self, summary: &str) -> Result {
        match self {
            Self::Stdout => {
                warn(summary.trim_end());
                Ok(())
            }
            _ => print_text(summary),
        }
    }
}

/// Rejects an output that has the same path as another output.
fn check_distinct(option: &str, path: &Path, (other_option, other): (&str, &Path)) -> Result {
    let place = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if place(other) != place(path) || is_device(path) {
        return Ok(());
    }
    let shown = path.display();
    Err(Error::input(format!(
        "{other_option} {shown} and {option} {shown} are the same file: give {option} another name"
    )))
}

/// Returns true if a path is a device such as `/dev/null`. Pipes are excluded, because they may never be read.
#[cfg(unix)]
fn is_device(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    std::fs::metadata(path).is_ok_and(|found| found.file_type().is_char_device())
}

#[cfg(not(unix))]
fn is_device(_path: &Path) -> bool {
    false
}

/// Writes a file and creates its parent folders. If an error occurs, an existing file is unchanged. A symbolic link is
/// replaced, and the file that it refers to is unchanged.
pub fn write_file(path: &Path, contents: &[u8]) -> Result {
    file_place(path)?;
    let failed = |error: &dyn std::fmt::Display| Error::file("write", path, error);
    let folder = folder_of(path);
    std::fs::create_dir_all(folder).map_err(|error| failed(&error))?;
    // The error's own message would contain the path of the temporary file.
    let mut file = NamedTempFile::new_in(folder)
        .map_err(|error| failed(&std::io::Error::from(error.kind())))?;
    file.write_all(contents).map_err(|error| failed(&error))?;
    make_readable(file.as_file()).map_err(|error| failed(&error))?;
    file.persist(path).map_err(|error| failed(&error.error))?;
    Ok(())
}

/// Returns the path to write to, with resolved symbolic links. Inputs of the command, devices and pipes are rejected,
/// because the output would replace them.
pub fn file_place(path: &Path) -> Result<PathBuf> {
    check_is_no_input(path)?;
    let failed = |error: &dyn std::fmt::Display| Error::file("write", path, error);
    match std::fs::metadata(path) {
        Ok(found) if found.is_file() => std::fs::canonicalize(path).map_err(|error| failed(&error)),
        Ok(_) => Err(failed(
            &"it is not a file; give the name of a file, or - for stdout",
        )),
        Err(_) if path.file_name().is_none() => Err(failed(&"give the name of a file")),
        Err(_) => {
            // The first existing folder or link; the link may be broken.
            let mut folders = folder_of(path).ancestors();
            match folders.find(|folder| folder.symlink_metadata().is_ok()) {
                Some(found) if !found.is_dir() => Err(failed(&describe_no_folder(found))),
                _ => Ok(path.to_owned()),
            }
        }
    }
}

fn describe_no_folder(path: &Path) -> String {
    let shown = path.display();
    match std::fs::read_link(path) {
        Ok(target) if !path.exists() => format!(
            "{shown} is a link to {}, which does not exist: create that folder, or remove the link",
            target.display()
        ),
        _ => format!("{shown} is not a folder"),
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Makes a file readable for other users, because temporary files are private.
#[cfg(unix)]
fn make_readable(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}
