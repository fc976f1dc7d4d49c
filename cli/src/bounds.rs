//! Bounds of rounding errors for the ranges on the command line.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::variant::Variant;
use eomgen_compiled_model::{CompiledModel, Instance, Orders, split_assignments};
use eomgen_model_spec::model::Model;
use eomgen_validate::rounding::{Bounds, VariableRanges};

use crate::arguments::Validate;
use crate::error::{Error, Result};
use crate::operating_point::point;
use crate::settings::{as_borrowed, settings};

/// Bounds the rounding errors of a model as emitted with `outputs`.
pub fn bounds(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
    options: &Validate,
) -> Result<Bounds> {
    let variant = Variant::derive_with_trace(model, orders, outputs);
    let program = variant.map_err(Error::Specification)?.program;
    let of_model = |error| Error::model(&model.source, error);
    let mut ranges = VariableRanges::from_model(model, &program).map_err(of_model)?;
    if !options.state.is_empty() || !options.range.is_empty() {
        let compiled = CompiledModel::derive(model.clone(), Orders::PerField(orders))?;
        let run = compiled.with_declared_parameters()?;
        if !options.state.is_empty() {
            let at = point(&run, &options.state)?;
            ranges.set_point(at.t, &at.state, &at.inputs);
        }
        for text in &options.range {
            let (name, [low, high]) = read_range(&run, text)?;
            for name in expand_field_modes(&compiled, &name) {
                let set = ranges.set(&name, low, high);
                set.map_err(|message| Error::input(format!("--range {text}: {message}")))?;
            }
        }
    }
    Ok(ranges.bounds(&program))
}

/// Reads `NAME=LOW:HIGH` or `NAME=VALUE`. Returns the name and both ends in SI.
fn read_range(run: &Instance<'_>, text: &str) -> Result<(String, [f64; 2])> {
    let (name, value) = text.split_once('=').ok_or_else(|| {
        Error::input(format!(
            "--range {text}: expected NAME=LOW:HIGH, such as `theta_dot=-10:10`"
        ))
    })?;
    let name = name.trim();
    let (low, high) = value.split_once(':').unwrap_or((value, value));
    let read = |end: &str| read_end(run, name, end);
    Ok((name.to_owned(), [read(low)?, read(high)?]))
}

/// Reads one end of the range of a variable or of all modes of a field.
fn read_end(run: &Instance<'_>, name: &str, end: &str) -> Result<f64> {
    let model = run.model().model();
    let mut parameters = model.parameters.iter();
    if let Some(place) = parameters.position(|known| known.name == name) {
        let settings = settings(model, &[format!("{name}={end}")])?;
        let changed = model.with_parameters(&as_borrowed(&settings));
        let values = changed.and_then(|changed| changed.parameter_values());
        return Ok(values.map_err(|error| Error::model(&model.source, error))?[place]);
    }
    let first = expand_field_modes(run.model(), name).into_iter().next();
    let name = first.unwrap_or_else(|| name.to_owned());
    let given = split_assignments("--range", &[format!("{name}={end}")])?;
    let value = run.read_quantities(&given)?.pop();
    Ok(value.map_or(f64::NAN, |(_, value)| value))
}

/// Returns the names of all modes (or of their rates) if `name` is the name of a field (or of its rate); otherwise
/// returns `name`.
fn expand_field_modes(compiled: &CompiledModel, name: &str) -> Vec<String> {
    let (field, ending) = match name.strip_suffix("_dot") {
        Some(field) => (field, "_dot"),
        None => (name, ""),
    };
    let fields = compiled.program().fields.iter();
    let mut known = fields.filter(|known| known.coordinates == field);
    match known.next() {
        Some(known) => (1..=known.order)
            .map(|mode| format!("{field}_{mode}{ending}"))
            .collect(),
        None => vec![name.to_owned()],
    }
}
