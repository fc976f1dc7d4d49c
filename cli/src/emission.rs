//! Emitted files of the targets of `generate`: the options of the command line for `eomgen_targets`.

use eomgen_codegen::c::{self, Real};
use eomgen_codegen::program::{Output, Program};
use eomgen_codegen::rust::{self, Packaging};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_targets::emit;
use eomgen_validate::certify::{CCompiler, CSource};

use crate::arguments::{Extra, Target};
use crate::count::count;
use crate::error::{Error, Result, warn};

pub fn source(program: &Program, packaging: Packaging) -> Result<String> {
    Ok(rust::emit(program, packaging)?)
}

/// Emits a program as C with this number type, with the default compiler for its certificate.
pub fn c_source(program: &Program, outputs: &[Output], real: Real) -> Result<CSource> {
    let c::Files { source, header } = c::emit_with(program, real)?;
    let names = outputs.iter().map(|output| output.name().to_owned());
    Ok(CSource {
        name: program.name.clone(),
        source,
        header,
        outputs: names.collect(),
        compiler: CCompiler::default(),
    })
}

/// Returns names and contents of the emitted files. The file with the equations is first.
pub fn files(model: &Model, variant: &Variant, target: Target) -> Result<Vec<(String, Vec<u8>)>> {
    let files = emit(model, variant, target.into(), &warn)?.into_iter();
    Ok(files.map(|file| (file.name, file.contents)).collect())
}

/// Returns the outputs to derive for the requested target.
///
/// # Errors
/// An option that the target does not support.
pub fn outputs(target: Target, with: &[Extra], certify: bool) -> Result<Vec<Output>> {
    let has_certificate = matches!(target, Target::Rust | Target::C99);
    if certify && !has_certificate {
        return Err(Error::input(
            "--certify needs --target rust or --target c99: a certificate covers the emitted Rust or C",
        ));
    }
    if with.contains(&Extra::Bench) && target != Target::Rust {
        return Err(Error::input(
            "--with bench needs --target rust: the benchmark is a crate",
        ));
    }
    Ok(eomgen_targets::outputs(
        target.into(),
        &Extra::outputs(with),
    )?)
}

/// Returns the size of the first file, in words.
pub fn size(target: Target, contents: &[u8]) -> String {
    match target {
        Target::Fmu2 | Target::Fmu3 => format!("{} bytes", contents.len()),
        _ => count(contents.iter().filter(|b| **b == b'\n').count(), "line"),
    }
}
