//! Loads, checks and derives a specification.

use std::path::Path;

use eomgen_codegen::variant::examine;
use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;

use crate::error::{Error, Result, print_diagnostics, warn};
use crate::input_file::register_input;

/// Reads and checks a specification.
///
/// # Errors
/// A dataset file, or the messages about an invalid specification.
pub fn read(path: &Path) -> Result<Checked> {
    eomgen_model_spec::load(path).map_err(|found| match is_dataset(&found) {
        true => Error::input(format!(
            "{} is a dataset file: give it to `compare` or `discover` after the specification",
            path.display()
        )),
        false => Error::Specification(found),
    })
}

/// Returns true if the text of an invalid specification has the tables of a dataset file.
fn is_dataset(found: &Diagnostics) -> bool {
    let text = &found.source().text;
    let has = |table: &str| text.lines().any(|line| line.trim_end().starts_with(table));
    has("[records]") && has("[channels.") && !has("[model]")
}

/// Reads and checks a specification and prints its warnings.
pub fn load(path: &Path) -> Result<Checked> {
    let checked = read(path)?;
    let source = &checked.model.source;
    source
        .files()
        .into_iter()
        .map(Path::new)
        .for_each(register_input);
    let tables = checked
        .model
        .fields
        .iter()
        .filter_map(|field| field.basis.table());
    for table in tables {
        let folder = source.folder.as_deref().unwrap_or(Path::new(""));
        register_input(&folder.join(&table.file));
    }
    if !checked.warnings.is_empty() {
        print_diagnostics(&checked.warnings);
    }
    Ok(checked)
}

/// Parses the text of `--order`.
pub fn order(text: Option<&str>) -> Result<Option<usize>> {
    let parse = |text: &str| {
        text.trim().parse::<usize>().map_err(|_| {
            Error::input(format!(
                "--order {text}: expected a whole number from 0 to {}",
                eomgen_model_spec::model::MAX_ORDER
            ))
        })
    };
    text.map(parse).transpose()
}

/// Returns the orders of a model's fields, from the text of `--order`.
pub fn orders(model: &Model, text: Option<&str>) -> Result<Vec<usize>> {
    model
        .orders(order(text)?)
        .map_err(|error| Error::model(&model.source, error))
}

pub fn derive(model: Model, orders: &[usize]) -> Result<CompiledModel> {
    let compiled = CompiledModel::derive(model, Orders::PerField(orders))?;
    note_redundancy(&compiled.redundancy_notes());
    Ok(compiled)
}

/// Prints notes about dependent constraints.
pub fn note_redundancy(notes: &[String]) {
    for note in notes {
        warn(&format!("note: {note}"));
    }
}

/// Checks the constraints of a model for dependence and prints notes about dependent ones.
pub fn note_dependent_constraints(model: &Model, orders: &[usize]) -> Result {
    if !model.constraints.is_empty() {
        let redundancy = examine(model, orders).map_err(Error::Specification)?;
        note_redundancy(&redundancy.describe(model));
    }
    Ok(())
}

/// Loads and derives a model to print its equations; coordinates without inertia are accepted.
pub fn load_to_read(path: &Path, order: Option<&str>) -> Result<CompiledModel> {
    let model = load(path)?.model;
    let orders = orders(&model, order)?;
    let orders = Orders::PerField(&orders);
    let compiled = CompiledModel::derive_without_inertia_check(model, orders)?;
    note_redundancy(&compiled.redundancy_notes());
    Ok(compiled)
}
