//! Python module `NAME_acados.py`: the functions for CasADi as a model for acados.

use eomgen_codegen::program::Program;

use crate::error::{EmissionError, Result};
use crate::file::EmittedFile;
use eomgen_model_spec::argument::Argument;

/// Template of the module. `@key@` is replaced by a text of the program.
const TEMPLATE: &str = include_str!("model.py");

/// Returns the Python module of a program that has the [outputs](eomgen_codegen::c::CASADI_OUTPUTS) for CasADi.
///
/// # Errors
/// The rates depend on time: the dynamics of acados have states, inputs and parameters only.
pub(crate) fn emit_file(program: &Program) -> Result<EmittedFile> {
    let mut jacobians = program.outputs.jacobians.iter();
    if jacobians.any(|known| known.name == "rates_by_time" && known.nonzeros() > 0) {
        return Err(EmissionError::Request(format!(
            "{}: the rates of `{}` depend on time, and the dynamics of acados do not; replace t by an \
             input, or by a state with the rate 1",
            Argument::Target.with_text("acados"),
            program.name
        )));
    }
    let text = |(place, part): (usize, &str)| match (place % 2, part) {
        (0, part) => part.to_owned(),
        (_, "name") => program.name.clone(),
        (_, "model") => program.specification.clone(),
        (_, "specification") => program.spec_hash.clone(),
        (_, "generator") => env!("CARGO_PKG_VERSION").to_owned(),
        (_, "states") => format_list(program.state_names().iter().map(|name| &**name)),
        (_, "inputs") => format_list(program.inputs.iter().map(|input| &*input.name)),
        (_, key) => {
            debug_assert_eq!(key, "parameters");
            let parameters = program.parameters.iter();
            format_list(parameters.map(|parameter| &*parameter.quantity.name))
        }
    };
    let filled = TEMPLATE.split('@').enumerate().map(text).collect();
    let name = format!("{}_acados.py", program.name);
    Ok(EmittedFile::text(name, filled))
}

/// Returns a Python list of names.
fn format_list<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let quoted: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    format!("[{}]", quoted.join(", "))
}
