//! Finds a Rust compiler and runs it, and what it made, within a time limit.

use std::ffi::OsStr;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The longest any one process may take.
const LIMIT: Duration = Duration::from_secs(240);
/// How often a running process is looked at.
const INTERVAL: Duration = Duration::from_millis(5);

/// A compiler that accepts this edition.
#[derive(Clone, Debug)]
pub struct Compiler {
    program: std::ffi::OsString,
}

/// How far emitted source is optimised before it is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Optimization {
    /// As in a release build, where a compiler's rewriting could change a number.
    Full,
    /// Not at all: a sixth of the time, for functions that come in many instances and are
    /// each called a few times.
    None,
}

/// What a process left.
#[derive(Debug)]
pub struct Output {
    /// Whether it ended well.
    pub success: bool,
    /// Its standard output.
    pub stdout: String,
    /// Its standard error.
    pub stderr: String,
}

impl Compiler {
    /// The compiler the environment variable `RUSTC` names, else `rustc` on the path.
    ///
    /// # Errors
    /// Why none can be used.
    pub fn find(folder: &Path) -> Result<Self, String> {
        let program = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        Self::named(program, folder)
    }

    /// The compiler `program`, tried out in `folder`.
    ///
    /// # Errors
    /// Why it cannot be used.
    pub fn named(program: std::ffi::OsString, folder: &Path) -> Result<Self, String> {
        let compiler = Self { program };
        let probe = folder.join("probe.rs");
        write(&probe, "//! A probe.\n")?;
        let output = compiler
            .compile(
                &probe,
                &folder.join("libprobe.rlib"),
                Optimization::None,
                &["--crate-type", "rlib"],
            )
            .map_err(|message| format!("no rustc was found: {message}"))?;
        if output.success {
            Ok(compiler)
        } else {
            Err(format!(
                "rustc cannot be used: {}",
                first_line(&output.stderr)
            ))
        }
    }

    /// Compiles `source` to `target`.
    ///
    /// # Errors
    /// Why the compiler could not be run to its end.
    pub fn compile(
        &self,
        source: &Path,
        target: &Path,
        optimization: Optimization,
        more: &[&str],
    ) -> Result<Output, String> {
        let level = match optimization {
            Optimization::Full => "opt-level=3",
            Optimization::None => "opt-level=0",
        };
        let mut command = Command::new(&self.program);
        command
            .args(["--edition", "2024", "-C", level])
            .args(more)
            .arg("-o")
            .args([target.as_os_str(), source.as_os_str()]);
        if let Some(folder) = source.parent() {
            command.current_dir(folder);
        }
        run(&mut command, "")
    }
}

/// Runs `program` on `input`.
///
/// # Errors
/// Why it could not be run to its end.
pub fn execute(program: &Path, input: &str) -> Result<Output, String> {
    run(&mut Command::new(program), input)
}

/// Writes a file.
///
/// # Errors
/// Why it could not be written.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// The first line of a compiler's message.
pub fn first_line(text: &str) -> &str {
    text.lines()
        .find(|line| !line.trim().is_empty())
        .unwrap_or("no message")
}

fn run(command: &mut Command, input: &str) -> Result<Output, String> {
    let name = command.get_program().to_os_string();
    let failed = |error: std::io::Error| format!("{}: {error}", Path::new(&name).display());
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    let stdout = child.stdout.take().map(collect);
    let stderr = child.stderr.take().map(collect);
    let writer = child.stdin.take().map(|mut stdin| {
        let input = input.to_owned();
        // A process that stops reading early is judged by how it ends.
        std::thread::spawn(move || drop(stdin.write_all(input.as_bytes())))
    });
    let success = wait(&mut child, &name);
    if let Some(writer) = writer {
        drop(writer.join());
    }
    let text = |thread: Option<JoinHandle<String>>| {
        thread
            .and_then(|thread| thread.join().ok())
            .unwrap_or_default()
    };
    let (stdout, stderr) = (text(stdout), text(stderr));
    Ok(Output {
        success: success?,
        stdout,
        stderr,
    })
}

/// Reads a pipe on a thread of its own, so that neither side waits for the other.
fn collect(mut pipe: impl Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        drop(pipe.read_to_end(&mut bytes));
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// Waits for the end of a process, or ends it at the time limit.
fn wait(child: &mut Child, name: &OsStr) -> Result<bool, String> {
    let start = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status.success()),
            Ok(None) if start.elapsed() < LIMIT => std::thread::sleep(INTERVAL),
            Ok(None) => {
                drop(child.kill());
                drop(child.wait());
                let seconds = LIMIT.as_secs();
                return Err(format!("{} took longer than {seconds} s", name.display()));
            }
            Err(error) => return Err(format!("{}: {error}", name.display())),
        }
    }
}
