//! Emitted files for the targets of `generate`: converts command-line options to calls of `eomgen_targets`.

use eomgen_codegen::c::{self, CASADI_OUTPUTS, Real};
use eomgen_codegen::program::{Output, Program};
use eomgen_codegen::rust;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::sha256;
use eomgen_targets::archive::unpack;
use eomgen_targets::emit;
use eomgen_validate::certify::{CCompiler, CSource, CasadiSource, UnitSource};
use eomgen_validate::instructions::InstructionBounds;
use eomgen_validate::model_certificate::Sources;

use crate::arguments::{Extra, Packaging, Target};
use crate::count::count;
use crate::error::{Error, Result, warn};

/// Emits a program as Rust in this packaging.
pub fn source(program: &Program, packaging: rust::Packaging) -> Result<String> {
    Ok(rust::emit(program, packaging)?)
}

/// Returns names and contents of the emitted files in this packaging, or in the default one. The file with the
/// equations is first.
///
/// # Errors
/// A packaging that the target does not support.
pub fn files(
    model: &Model,
    variant: &Variant,
    (target, packaging): (Target, Option<Packaging>),
) -> Result<Vec<(String, Vec<u8>)>> {
    let program = &variant.program;
    match (target, packaging) {
        (_, None) | (Target::Rust, Some(Packaging::Crate)) => {
            let files = emit(model, variant, target.into(), &warn)?.into_iter();
            Ok(files.map(|file| (file.name, file.contents)).collect())
        }
        (Target::Rust, Some(Packaging::Module)) => {
            let text = source(program, rust::Packaging::Module)?;
            Ok(vec![("mod.rs".to_owned(), text.into_bytes())])
        }
        (Target::C99, Some(Packaging::HeaderOnly)) => {
            let text = c::emit_header_only(program, Real::Double)?;
            Ok(vec![(format!("{}.h", program.name), text.into_bytes())])
        }
        (_, Some(Packaging::HeaderOnly)) => {
            Err(Error::input("--packaging header-only needs --target c99"))
        }
        (_, Some(Packaging::Crate | Packaging::Module)) => Err(Error::input(
            "--packaging crate and --packaging module need --target rust",
        )),
    }
}

/// Returns the source to certify from the emitted files of [`files`], with the default compiler for C.
pub fn sources(
    name: &str,
    target: Target,
    files: &[(String, Vec<u8>)],
    outputs: &[Output],
) -> Result<Sources> {
    let text = |place: usize| {
        let file = files.get(place);
        file.map(|(_, contents)| String::from_utf8_lossy(contents).into_owned())
    };
    let mut sources = Sources::default();
    match (target, text(0), text(1)) {
        (Target::C99, Some(source), Some(header)) => {
            let compiler = CCompiler::default();
            sources.c = vec![c_source(name, (source, header), outputs, compiler)];
        }
        (Target::C99, Some(header), None) => {
            let compiler = CCompiler::default();
            sources.c = vec![header_only_source(name, header, outputs, compiler)];
        }
        (Target::Casadi | Target::Acados, Some(source), _) => {
            let compiler = CCompiler::default();
            sources.casadi = Some(casadi_source(name, source, outputs, compiler));
        }
        (Target::Fmu2 | Target::Fmu3, ..) => {
            if let Some((_, contents)) = files.first() {
                sources.unit = Some(unit_source(name, contents, CCompiler::default())?);
            }
        }
        (_, source, _) => sources.rust = source,
    }
    Ok(sources)
}

/// Returns a functional mock-up unit with the compiler of the program that loads it.
///
/// # Errors
/// A file that is not a ZIP archive.
pub fn unit_source(name: &str, contents: &[u8], compiler: CCompiler) -> Result<UnitSource> {
    Ok(UnitSource {
        name: name.to_owned(),
        sha256: sha256(contents),
        files: unpack(contents)?,
        compiler,
    })
}

/// Returns emitted C (source file and header) with the compiler to use in its checks.
pub fn c_source(
    name: &str,
    (source, header): (String, String),
    outputs: &[Output],
    compiler: CCompiler,
) -> CSource {
    let names = outputs.iter().map(|output| output.name().to_owned());
    CSource {
        name: name.to_owned(),
        file: format!("{name}.c"),
        source,
        header,
        outputs: names.collect(),
        compiler,
    }
}

/// Returns header-only C with the compiler to use in its checks. The source is a file that includes the header and
/// compiles the functions.
pub fn header_only_source(
    name: &str,
    header: String,
    outputs: &[Output],
    compiler: CCompiler,
) -> CSource {
    let source = format!("#define {name}_IMPLEMENTATION\n{header}");
    CSource {
        file: format!("{name}.h"),
        ..c_source(name, (source, header), outputs, compiler)
    }
}

/// Bounds the instructions and the stack of the functions of emitted C for a cross compiler.
pub fn instructions(source: &CSource, command: &str) -> Result<InstructionBounds, String> {
    InstructionBounds::of_source(&source.name, (&source.source, &source.header), command)
}

/// Returns emitted functions for CasADi with all outputs and the compiler to use in their checks.
pub fn casadi_source(
    name: &str,
    source: String,
    outputs: &[Output],
    compiler: CCompiler,
) -> CasadiSource {
    let is_requested = |output: &&Output| !CASADI_OUTPUTS.contains(output);
    CasadiSource {
        name: name.to_owned(),
        source,
        with: outputs.iter().filter(is_requested).copied().collect(),
        compiler,
    }
}

/// Returns the outputs to derive for the requested target.
///
/// # Errors
/// An option that the target does not support.
pub fn outputs(target: Target, with: &[Extra], certify: bool) -> Result<Vec<Output>> {
    if certify && target == Target::Cuda {
        return Err(Error::input(
            "--certify needs another target than cuda: CUDA C++ has no certificate",
        ));
    }
    if with.contains(&Extra::Bench) && target != Target::Rust {
        return Err(Error::input(
            "--with bench needs --target rust: the benchmark is a crate",
        ));
    }
    Ok(eomgen_targets::outputs(
        target.into(),
        &Extra::select_outputs(with),
    )?)
}

/// Returns the size of the first file, in words.
pub fn size(target: Target, contents: &[u8]) -> String {
    match target {
        Target::Fmu2 | Target::Fmu3 => format!("{} bytes", contents.len()),
        _ => count(contents.iter().filter(|b| **b == b'\n').count(), "line"),
    }
}
