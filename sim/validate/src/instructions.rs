//! Upper bounds of the instructions and the stack of the functions of a C source, compiled for a Cortex-M.

use std::path::Path;
use std::process::Command;

use eomgen_instruction_bounds::bound_functions;
use eomgen_model_spec::source::sha256;
use serde::{Deserialize, Serialize};

use crate::compiler::{first_line, run, write};

/// Bounds of the functions of one C source with one compiler and its options.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InstructionBounds {
    /// Name of the source file.
    pub source: String,
    /// SHA-256 of the source file.
    pub source_sha256: String,
    /// Compiler with its options.
    pub command: String,
    /// First line of the compiler's `--version`.
    pub compiler: String,
    /// Functions that other files can call, in alphabetical order.
    pub functions: Vec<FunctionBounds>,
}

/// Upper bounds of one call of a function, including the functions that it calls.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FunctionBounds {
    /// Name.
    pub name: String,
    /// Executed instructions, including conditional instructions whose condition is false; `None` if there is no bound.
    pub instructions: Option<u64>,
    /// Executed instructions if no operand of a double-precision product or quotient in libgcc is subnormal.
    pub instructions_without_subnormals: Option<u64>,
    /// Stack in bytes, below the stack pointer of the caller.
    pub stack: Option<u64>,
    /// Reason why there is no bound.
    pub reason: Option<String>,
}

impl InstructionBounds {
    /// Compiles emitted C that has the prefix `name` and computes the bounds of its functions. An example of `command`
    /// is `arm-none-eabi-gcc -mcpu=cortex-m4 -O2`.
    ///
    /// # Errors
    /// As [`InstructionBounds::of_file`].
    pub fn of_source(
        name: &str,
        (source, header): (&str, &str),
        command: &str,
    ) -> Result<Self, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let path = |ending: &str| folder.path().join(format!("{name}.{ending}"));
        write(&path("h"), header)?;
        write(&path("c"), source)?;
        Self::of_file(&path("c"), command)
    }

    /// Compiles a C file with a command and computes the bounds of its functions. Headers are searched in the folder of
    /// the file.
    ///
    /// # Errors
    /// A compiler that cannot be run, a source that does not compile, or an object file for another processor.
    pub fn of_file(file: &Path, command: &str) -> Result<Self, String> {
        let words: Vec<&str> = command.split_whitespace().collect();
        let (program, options) = words.split_first().ok_or("the command is blank")?;
        if file.exists() && !file.is_file() {
            return Err(format!("{}: it is not a file", file.display()));
        }
        let text = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
        let file = std::path::absolute(file).map_err(|error| error.to_string())?;
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let output = |program: &str, arguments: &[&str]| {
            let mut command = Command::new(program);
            command.args(arguments).current_dir(folder.path());
            let output = run(&mut command, "")?;
            match output.success {
                true => Ok(output.stdout),
                false => Err(format!("{program}: {}", first_line(&output.stderr))),
            }
        };
        let version = output(program, &["--version"])?;
        let compile = |arguments: &[&str]| output(program, &[options, arguments].concat());
        let source = file.display().to_string();
        let headers = format!("-I{}", file.parent().unwrap_or(&file).display());
        compile(&[&headers, "-c", "-o", "source.o", &source])?;
        // Also links the functions of libgcc, for example double-precision arithmetic.
        compile(&["-nostdlib", "-r", "-o", "linked.o", "source.o", "-lgcc"])?;
        let objdump = output(program, &["-print-prog-name=objdump"])?;
        let listing = output(objdump.trim(), &["-t", "-d", "-r", "linked.o"])?;
        let name = file.file_name().unwrap_or_default();
        let functions = bound_functions(&listing)?.into_iter().map(|function| {
            let bound = function.bound.as_ref().ok();
            FunctionBounds {
                name: function.name,
                instructions: bound.map(|bound| bound.instructions),
                instructions_without_subnormals: bound.map(|bound| bound.without_subnormals),
                stack: bound.map(|bound| bound.stack),
                reason: function.bound.err(),
            }
        });
        Ok(Self {
            source: name.to_string_lossy().into_owned(),
            source_sha256: sha256(text),
            command: words.join(" "),
            compiler: first_line(&version).to_owned(),
            functions: functions.collect(),
        })
    }
}
