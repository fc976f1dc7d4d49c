//! Certificates of variants: made, written, summarised.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::Packaging;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_paper::reference_equations::reference_equations;
use eomgen_validate::certificate::{Certificate, Check};
use eomgen_validate::of_model::certificate;

use crate::emission::source;
use crate::error::{Error, Result};

/// A certificate as it is written to a file.
pub fn document(certificate: &Certificate) -> Result<String> {
    let text = serde_json::to_string_pretty(certificate)
        .map_err(|error| Error::input(error.to_string()))?;
    Ok(text + "\n")
}

/// The certificate of a model at the given orders, which are one for all fields, as it is
/// emitted with `outputs`.
pub fn certify(model: &Model, orders: &[usize], outputs: &[Output]) -> Result<Certificate> {
    one_order(model, orders)?;
    let variant = Variant::derive_with(model, orders, outputs).map_err(Error::Specification)?;
    let emitted = source(&variant.program, Packaging::Crate)?;
    certify_source(model, orders, outputs, emitted)
}

/// The certificate of a source that was emitted so.
pub fn certify_source(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
    emitted: String,
) -> Result<Certificate> {
    let order = one_order(model, orders)?;
    let refused = |error| Error::model(&model.source, error);
    let values = model.parameter_values().map_err(refused)?;
    let reference_equations = reference_equations(model, order, &values);
    certificate(model, order, outputs, emitted, &reference_equations).map_err(refused)
}

/// The order of all fields.
fn one_order(model: &Model, orders: &[usize]) -> Result<usize> {
    let order = orders.first().copied().unwrap_or(0);
    if orders.iter().any(|other| *other != order) {
        return Err(Error::input(format!(
            "the fields of {} have the orders {orders:?}; a certificate is for one order: \
             give --order",
            model.name
        )));
    }
    Ok(order)
}

/// One line per check.
pub fn summary(certificate: &Certificate) -> String {
    let mut text = format!("{}, order {}\n", certificate.model, certificate.order);
    let width = certificate
        .checks
        .iter()
        .map(|check| check.name.len())
        .max()
        .unwrap_or(0);
    for check in &certificate.checks {
        text.push_str(&format!("  {:width$}  {}\n", check.name, verdict(check)));
    }
    text.push_str(if certificate.passed {
        "passed\n"
    } else {
        "FAILED\n"
    });
    text
}

fn verdict(check: &Check) -> String {
    let detail = if check.detail.is_empty() {
        String::new()
    } else {
        format!("  ({})", check.detail)
    };
    if check.skipped {
        return format!("skipped{detail}");
    }
    let value = check
        .value
        .map_or("not finite".to_owned(), |value| format!("{value:.1e}"));
    let word = if check.passed { "passed" } else { "FAILED" };
    format!("{word}   {value} of {:.0e}{detail}", check.tolerance)
}
