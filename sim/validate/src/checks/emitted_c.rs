//! Bit-for-bit comparison of the compiled emitted C with the variant that it was emitted from. The
//! check is skipped without a compiler and fails if the source does not compile.

use std::path::Path;
use std::process::Command;

use eomgen_codegen::program::Program;

use super::emitted::{compare, draw_samples};
use super::interface::{BITS, Calls, Precision, c_harness};
use super::linked_program::{EmittedFunction, format_samples, require_success};
use crate::certificate::{Check, SkipKind, Worst};
use crate::compiler::{self, execute, run, write};
use crate::oracle::{Oracle, OracleError};
use crate::variant::Variant;

const NAME: &str = "emitted_c";

/// Emitted C with the compiler to use.
#[derive(Clone, Debug)]
pub struct CSource {
    /// Prefix of the C names, and name of the header.
    pub name: String,
    /// Name of the file with the functions: `NAME.c`, or `NAME.h` if the packaging is a single header.
    pub file: String,
    /// Text of the file to compile.
    pub source: String,
    /// Text of `NAME.h`.
    pub header: String,
    /// Requested outputs, by their names in `--with`.
    pub outputs: Vec<String>,
    /// Compiler.
    pub compiler: CCompiler,
}

/// C compiler with its options.
#[derive(Clone, Debug)]
pub struct CCompiler {
    program: String,
    options: Vec<String>,
}

impl Default for CCompiler {
    /// Returns `cc`, or the value of the environment variable `CC`, with the documented options.
    fn default() -> Self {
        let program = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
        let options = ["-std=c99", "-O2", "-ffp-contract=off"];
        Self {
            program,
            options: options.map(str::to_owned).to_vec(),
        }
    }
}

impl CCompiler {
    /// Splits a command such as `gcc -O2`; `None` if it is blank.
    pub fn from_command(command: &str) -> Option<Self> {
        let mut words = command.split_whitespace().map(str::to_owned);
        Some(Self {
            program: words.next()?,
            options: words.collect(),
        })
    }

    /// Returns program and options.
    pub fn command(&self) -> String {
        let words = std::iter::once(&self.program).chain(&self.options);
        words.map(String::as_str).collect::<Vec<_>>().join(" ")
    }

    /// Returns true if the options choose the number type.
    fn sets_precision(&self) -> bool {
        self.options.iter().any(|option| option.contains("_REAL="))
    }

    /// Tests the compiler by compiling an almost empty file.
    pub(super) fn probe(&self, folder: &Path) -> Result<(), String> {
        let probe = folder.join("probe.c");
        write(&probe, "typedef int probe;\n")?;
        let output = self.compile(folder, &["-c", "-o", "probe.o", "probe.c"])?;
        require_success("the C compiler", output).map(drop)
    }

    pub(super) fn compile(
        &self,
        folder: &Path,
        arguments: &[&str],
    ) -> Result<compiler::Output, String> {
        let mut command = Command::new(&self.program);
        run(
            command
                .args(&self.options)
                .args(arguments)
                .current_dir(folder),
            "",
        )
    }
}

/// Functions that the check calls, in the order of the harness.
const FUNCTIONS: [EmittedFunction; 6] = [
    EmittedFunction::Rates,
    EmittedFunction::Observables,
    EmittedFunction::Energy,
    EmittedFunction::Power,
    EmittedFunction::Guards,
    EmittedFunction::MassMatrix,
];

/// Compiles each source and counts the numbers that are not bit-identical to `variant`. With `program`, the interface
/// is compared too.
pub fn check(
    oracle: &Oracle,
    (variant, program): (&mut dyn Variant, Option<&Program>),
    emitted: &[CSource],
) -> Result<Check, OracleError> {
    let samples = draw_samples(oracle)?;
    if samples.is_empty() {
        return Ok(not_run("no state in the model's domain was found"));
    }
    let mut worst: Option<Worst> = None;
    for source in emitted {
        let folder = match tempfile::tempdir() {
            Ok(folder) => folder,
            Err(error) => {
                return Ok(not_run(&format!(
                    "cannot create a temporary folder: {error}"
                )));
            }
        };
        if let Err(reason) = source.compiler.probe(folder.path()) {
            return Ok(not_run(&reason));
        }
        let found = run_harness(folder.path(), source, &format_samples(&samples));
        let compared = found.and_then(|lines| compare(variant, &FUNCTIONS, &samples, &lines));
        let interface = program
            .map(|program| check_interface(folder.path(), source, &Calls::new(program, &samples)));
        let compared = compared.and_then(|compared| Ok(compared.with(interface.transpose()?)));
        let compared = compared.unwrap_or_else(|message| {
            Worst::from_deviation(f64::INFINITY, format!("{}: {message}", source.file))
        });
        worst = Some(compared.with(worst));
    }
    Ok(match worst {
        Some(worst) => Check::from_deviation(NAME, worst, 0.0),
        None => not_run("no C was emitted"),
    })
}

/// Compares the interface in double and in single precision, unless the options of the compiler choose one.
fn check_interface(folder: &Path, emitted: &CSource, calls: &Calls<'_>) -> Result<Worst, String> {
    let CSource { name, compiler, .. } = emitted;
    write(&folder.join("interface.c"), &c_harness(calls, name))?;
    if compiler.sets_precision() {
        return Ok(Worst::from_deviation(0.0, String::new()));
    }
    let run = |number: &str, precision: Precision| {
        let real = format!("-D{name}_REAL={number}");
        let arguments = [
            "-I.",
            &real,
            "-o",
            "interface",
            "interface.c",
            "model.c",
            "-lm",
        ];
        require_success("the emitted source", compiler.compile(folder, &arguments)?)?;
        let output = execute(&folder.join("interface"), &calls.text())?;
        let found = require_success("the compiled model", output)?;
        Ok::<Worst, String>(calls.compare(&mut found.lines(), precision, (true, usize::MAX)))
    };
    let double = run("double", Precision::Double)?;
    Ok(double.with(Some(run("float", Precision::Single)?)))
}

fn not_run(reason: &str) -> Check {
    Check::with_skip(NAME.to_owned(), 0.0, SkipKind::NotRun, reason.to_owned())
}

fn run_harness(folder: &Path, emitted: &CSource, samples: &str) -> Result<String, String> {
    let CSource {
        name,
        source,
        header,
        compiler,
        ..
    } = emitted;
    write(&folder.join(format!("{name}.h")), header)?;
    write(&folder.join("model.c"), source)?;
    let harness = include_str!("harness/c99.c")
        .replace("/*BITS*/", BITS)
        .replace("NAME_", &format!("{name}_"))
        .replace("NAME.h", &format!("{name}.h"));
    write(&folder.join("harness.c"), &harness)?;
    // The evaluator computes in double precision.
    let double = format!("-D{name}_REAL=double");
    let first = match compiler.sets_precision() {
        true => vec!["-I."],
        false => vec!["-I.", &*double],
    };
    let compile = |arguments: &[&str]| compiler.compile(folder, &[&first, arguments].concat());
    let compiled = compile(&["-c", "-o", "model.o", "model.c"])?;
    require_success("the emitted source", compiled)?;
    let linked = compile(&["-o", "harness", "harness.c", "model.o", "-lm"])?;
    require_success("the harness", linked)?;
    let output = execute(&folder.join("harness"), samples)?;
    require_success("the compiled model", output)
}
