//! Emitted files of the targets, the outputs to derive for them, and unsupported combinations.

use eomgen_codegen::c;
use eomgen_codegen::mechanics::outputs::UnknownOutput;
use eomgen_codegen::program::Output;
use eomgen_codegen::rust::{self, Packaging};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::argument::Argument;
use eomgen_model_spec::model::Model;

use crate::acados;
use crate::error::{EmissionError, Result};
use crate::file::EmittedFile;
use crate::fmu::{self, Version};
use crate::target::Target;

/// Returns the emitted files of a variant that has the [`outputs`] of the target. The file with the equations is
/// first. `warn` receives warnings.
///
/// # Errors
/// The target does not support the model, or its language does not allow a name.
pub fn emit(
    model: &Model,
    variant: &Variant,
    target: Target,
    warn: &dyn Fn(&str),
) -> Result<Vec<EmittedFile>> {
    let program = &variant.program;
    let name = &program.name;
    if target.has_casadi_functions() && !model.controllers.is_empty() {
        let controllers: Vec<String> = (model.controllers.iter())
            .map(|controller| format!("`{}`", controller.name))
            .collect();
        let controllers = controllers.join(", ");
        warn(&format!(
            "note: the functions for CasADi do not sample the controllers of the model ({controllers}): they are those of the machine without them"
        ));
    }
    match target {
        Target::Rust => {
            let source = rust::emit(program, Packaging::Crate).map_err(EmissionError::request)?;
            Ok(vec![EmittedFile::text("lib.rs".to_owned(), source)])
        }
        Target::C99 => {
            let c::Files { source, header } = c::emit(program).map_err(EmissionError::request)?;
            Ok(vec![
                EmittedFile::text(format!("{name}.c"), source),
                EmittedFile::text(format!("{name}.h"), header),
            ])
        }
        Target::Cuda => {
            let source = c::emit_cuda(program).map_err(EmissionError::request)?;
            Ok(vec![EmittedFile::text(format!("{name}.cuh"), source)])
        }
        Target::Casadi | Target::Acados => {
            let source = c::emit_casadi(program).map_err(EmissionError::request)?;
            let mut files = vec![EmittedFile::text(format!("{name}_casadi.c"), source)];
            if target == Target::Acados {
                files.push(acados::emit_file(program)?);
            }
            Ok(files)
        }
        Target::Fmu2 => unit(model, variant, Version::Two),
        Target::Fmu3 => unit(model, variant, Version::Three),
    }
}

fn unit(model: &Model, variant: &Variant, version: Version) -> Result<Vec<EmittedFile>> {
    let orders = variant.equations.graph.orders();
    Ok(vec![fmu::emit_file(model, orders, version)?])
}

/// Returns the additional output with this name.
///
/// # Errors
/// The name is unknown; the message lists the known names.
pub fn parse_output(name: &str) -> Result<Output, String> {
    if name == "hessians" {
        return Ok(Output::Hessians);
    }
    name.parse()
        .map_err(|error: UnknownOutput| format!("{error}, hessians"))
}

/// Returns the outputs to derive for a target and additional outputs `with`.
///
/// # Errors
/// The target does not support an output.
pub fn outputs(target: Target, with: &[Output]) -> Result<Vec<Output>> {
    let (extras, target_argument) = (Argument::Extras, Argument::Target);
    let hessians = extras.with_text("hessians");
    let has = |output: Output| with.contains(&output);
    let reason = match target {
        Target::Rust | Target::C99 | Target::Cuda if has(Output::Hessians) => {
            format!("{hessians} needs {target_argument} casadi or acados")
        }
        Target::Rust => return Ok(with.to_vec()),
        _ if has(Output::Lanes) => {
            format!(
                "{} needs {}: its functions are generic over the number type, which C does not support",
                Argument::Extras.with_text("lanes"),
                Argument::Target.with_text("rust")
            )
        }
        Target::C99 | Target::Cuda => return Ok(with.to_vec()),
        Target::Casadi | Target::Acados
            if with.iter().all(|output| *output == Output::Hessians) =>
        {
            return Ok([&c::CASADI_OUTPUTS[..], with].concat());
        }
        Target::Fmu2 | Target::Fmu3 if with.is_empty() => return Ok(Vec::new()),
        Target::Fmu2 | Target::Fmu3 => {
            format!(
                "{extras} is not available for a functional mock-up unit: the standard defines its functions"
            )
        }
        Target::Casadi | Target::Acados => {
            format!(
                "{target_argument} casadi and acados accept {hessians} only: their functions are rates and jac_rates"
            )
        }
    };
    Err(EmissionError::Request(reason))
}
