//! Emitted files of the targets of `generate`, the outputs to derive for them, and unsupported combinations.

use eomgen_codegen::c;
use eomgen_codegen::program::{Output, Program};
use eomgen_codegen::rust::{self, EmitError, Packaging};
use eomgen_codegen::variant::Variant;
use eomgen_codegen::wasm;
use eomgen_model_spec::model::Model;
use eomgen_validate::certify::{CCompiler, CSource};

use crate::arguments::{Extra, Target};
use crate::count::count;
use crate::error::{Error, Result};
use crate::fmu::{self, Version};

pub fn source(program: &Program, packaging: Packaging) -> Result<String> {
    rust::emit(program, packaging).map_err(input_error)
}

/// Emits a program as C, with the default compiler for its certificate.
pub fn c_source(program: &Program, outputs: &[Output]) -> Result<CSource> {
    let c::Files { source, header } = c::emit(program).map_err(input_error)?;
    let names = outputs.iter().map(|output| output.name().to_owned());
    Ok(CSource {
        name: program.name.clone(),
        source,
        header,
        outputs: names.collect(),
        compiler: CCompiler::default(),
    })
}

/// Emits a program as a WebAssembly module.
pub fn module(program: &Program) -> Result<Vec<u8>> {
    wasm::emit(program).map_err(input_error)
}

/// Returns names and contents of the emitted files. The file with the equations is first.
pub fn files(model: &Model, variant: &Variant, target: Target) -> Result<Vec<(String, Vec<u8>)>> {
    let program = &variant.program;
    let name = &program.name;
    let text = |name: String, text: String| (name, text.into_bytes());
    match target {
        Target::Rust => {
            let source = source(program, Packaging::Crate)?;
            Ok(vec![text("lib.rs".to_owned(), source)])
        }
        Target::C99 => {
            let c::Files { source, header } = c::emit(program).map_err(input_error)?;
            Ok(vec![
                text(format!("{name}.c"), source),
                text(format!("{name}.h"), header),
            ])
        }
        Target::Casadi => {
            let source = c::emit_casadi(program).map_err(input_error)?;
            Ok(vec![text(format!("{name}_casadi.c"), source)])
        }
        Target::Fmu2 | Target::Fmu3 => {
            without_impacts(model, "a functional mock-up unit")?;
            without_corners(program, "a functional mock-up unit")?;
            let version = match target {
                Target::Fmu2 => Version::Two,
                _ => Version::Three,
            };
            Ok(vec![fmu::file(model, variant, version)?])
        }
    }
}

/// Rejects a model with impacts for targets without jumps of rates.
pub fn without_impacts(model: &Model, what: &str) -> Result<()> {
    model.impacts.first().map_or(Ok(()), |impact| {
        Err(Error::input(format!(
            "the model has impacts (`{}`), which {what} does not support: bodies would pass through each \
             other; use `eomgen simulate`",
            impact.name
        )))
    })
}

/// Rejects a program whose energies jump at a surface for targets without jumps of rates.
pub fn without_corners(program: &Program, what: &str) -> Result<()> {
    let mut guards = program.guards.iter();
    guards.find(|guard| guard.is_corner).map_or(Ok(()), |guard| {
        Err(Error::input(format!(
            "the energies of the model jump where `{}` is zero, and the rates with them, which {what} does not \
             support: use `eomgen simulate`",
            guard.formula
        )))
    })
}

/// Returns the outputs to derive for the requested target.
///
/// # Errors
/// An option that the target does not support.
pub fn outputs(target: Target, with: &[Extra], certify: bool) -> Result<Vec<Output>> {
    let hessians = Extra::Output(Output::Hessians);
    let has = |extra: Extra| with.contains(&extra);
    let reason = match target {
        Target::Rust | Target::C99 if has(hessians) => "--with hessians needs --target casadi",
        Target::Rust => return Ok(Extra::outputs(with)),
        Target::Casadi | Target::Fmu2 | Target::Fmu3 if certify => {
            "--certify needs --target rust or --target c99: a certificate covers the emitted Rust or C"
        }
        _ if has(Extra::Bench) => "--with bench needs --target rust: the benchmark is a crate",
        _ if has(Extra::Output(Output::Lanes)) => {
            "--with lanes needs --target rust: its functions are generic over the number type, \
             which C does not support"
        }
        Target::C99 => return Ok(Extra::outputs(with)),
        Target::Casadi if with.iter().all(|extra| *extra == hessians) => {
            let mut outputs = c::CASADI_OUTPUTS.to_vec();
            outputs.extend(Extra::outputs(with));
            return Ok(outputs);
        }
        Target::Fmu2 | Target::Fmu3 if with.is_empty() => return Ok(fmu::OUTPUTS.to_vec()),
        Target::Fmu2 | Target::Fmu3 => {
            "--with is not available for a functional mock-up unit: the standard defines its functions"
        }
        Target::Casadi => {
            "--target casadi accepts --with hessians only: its functions are rates and \
             jac_rates"
        }
    };
    Err(Error::input(reason))
}

/// Returns the size of the first file, in words.
pub fn size(target: Target, contents: &[u8]) -> String {
    match target {
        Target::Fmu2 | Target::Fmu3 => format!("{} bytes", contents.len()),
        _ => count(contents.iter().filter(|b| **b == b'\n').count(), "line"),
    }
}

fn input_error(error: EmitError) -> Error {
    Error::input(error.to_string())
}
