//! From the path of a specification to a compiled model, with messages for people.

use std::path::Path;

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_model_spec::Checked;
use eomgen_model_spec::model::Model;

use crate::error::{Error, Result, warn_of};

/// Reads and checks a specification; warnings go to stderr.
pub fn load(path: &Path) -> Result<Checked> {
    let checked = eomgen_model_spec::load(path).map_err(Error::Specification)?;
    if !checked.warnings.is_empty() {
        warn_of(&checked.warnings);
    }
    Ok(checked)
}

/// The orders of a model's fields. A text that is no order is refused with what would be.
pub fn orders(model: &Model, text: Option<&str>) -> Result<Vec<usize>> {
    let order = match text {
        None => None,
        Some(text) => Some(text.trim().parse::<usize>().map_err(|_| {
            Error::input(format!(
                "--order {text}: expected a whole number from 0 to {}",
                eomgen_model_spec::model::MAX_ORDER
            ))
        })?),
    };
    model
        .orders(order)
        .map_err(|error| Error::model(&model.source, error))
}

/// Derives a model at the given orders.
pub fn derive(model: Model, orders: &[usize]) -> Result<CompiledModel> {
    Ok(CompiledModel::derive(model, Orders::Each(orders))?)
}

/// Loads, checks and derives for readers: also what has no inertia somewhere.
pub fn load_to_read(path: &Path, order: Option<&str>) -> Result<CompiledModel> {
    let model = load(path)?.model;
    let orders = orders(&model, order)?;
    Ok(CompiledModel::derive_unjudged(
        model,
        Orders::Each(&orders),
    )?)
}
