//! Finds a Rust compiler and runs it and the compiled programs within a time limit.

use std::ffi::OsStr;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const TIME_LIMIT: Duration = Duration::from_secs(240);
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// Rust compiler that accepts edition 2024.
#[derive(Clone, Debug)]
pub struct Compiler {
    program: std::ffi::OsString,
}

/// Optimisation level of the emitted source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Optimization {
    /// Full optimisation as in a release build, because optimisation could change a result.
    Full,
    /// No optimisation: compilation takes a sixth of the time. It suits many instances with few calls.
    None,
}

/// Output of a finished process.
#[derive(Debug)]
pub struct Output {
    /// True if the process exited with status 0.
    pub success: bool,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Compiler {
    /// Finds the compiler (environment variable `RUSTC`, otherwise `rustc`) and tests it in `folder`.
    pub fn find(folder: &Path) -> Result<Self, String> {
        let program = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        Self::from_program(program, folder)
    }

    /// Tests the compiler `program` in `folder`.
    pub fn from_program(program: std::ffi::OsString, folder: &Path) -> Result<Self, String> {
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
            .map_err(|message| format!("cannot run rustc; set RUSTC to its path: {message}"))?;
        if output.success {
            Ok(compiler)
        } else {
            Err(format!(
                "rustc failed to compile a test file: {}",
                first_line(&output.stderr)
            ))
        }
    }

    /// Compiles `source` to `target` with the additional arguments `more`.
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

/// Runs `program` with `input` on its standard input.
pub fn execute(program: &Path, input: &str) -> Result<Output, String> {
    run(&mut Command::new(program), input)
}

/// Writes a file.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Returns the first line of a compiler's message that contains an error, otherwise its first nonblank line.
pub fn first_line(text: &str) -> &str {
    let mut lines = text.lines();
    (lines.clone().find(|line| line.contains("error:")))
        .or_else(|| lines.find(|line| !line.trim().is_empty()))
        .unwrap_or("no message")
}

/// Runs a command with `input` on its standard input. The process is stopped after the time limit.
pub fn run(command: &mut Command, input: &str) -> Result<Output, String> {
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
        // A write error is ignored, because the exit status reports a failure of the process.
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

/// Reads a pipe in a separate thread, so that full pipes cannot block the process.
fn collect(mut pipe: impl Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        drop(pipe.read_to_end(&mut bytes));
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

fn wait(child: &mut Child, name: &OsStr) -> Result<bool, String> {
    let start = Instant::now();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(status.success()),
            Ok(None) if start.elapsed() < TIME_LIMIT => std::thread::sleep(POLL_INTERVAL),
            Ok(None) => {
                drop(child.kill());
                drop(child.wait());
                let seconds = TIME_LIMIT.as_secs();
                return Err(format!(
                    "{} did not finish within {seconds} s",
                    name.display()
                ));
            }
            Err(error) => return Err(format!("{}: {error}", name.display())),
        }
    }
}
