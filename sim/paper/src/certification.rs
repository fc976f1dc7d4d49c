//! Certificates with hand-written reference equations.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_compiled_model::Error;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::variant::ModelError;
use eomgen_validate::certificate::Certificate;
use eomgen_validate::model_certificate::certificate;

use crate::reference_equations::reference_equations;

/// Certifies a model as emitted with `outputs`. `orders` must be equal for all fields.
///
/// # Errors
/// Models that cannot be derived or emitted, and orders that differ.
pub fn certify(model: &Model, orders: &[usize], outputs: &[Output]) -> Result<Certificate, Error> {
    one_order(model, orders)?;
    let variant = Variant::derive_with(model, orders, outputs)?;
    let emitted = emit(&variant.program, Packaging::Crate);
    let emitted = emitted.map_err(|error| Error::Request(error.to_string()))?;
    certify_source(model, orders, outputs, emitted)
}

/// Certifies an emitted source.
///
/// # Errors
/// As [`certify`].
pub fn certify_source(
    model: &Model,
    orders: &[usize],
    outputs: &[Output],
    emitted: String,
) -> Result<Certificate, Error> {
    let order = one_order(model, orders)?;
    let refused =
        |error: ModelError| Diagnostics::from_one(model.source.clone(), error.diagnostic());
    let values = model.parameter_values().map_err(refused)?;
    let reference_equations = reference_equations(model, order, &values);
    let certificate = certificate(model, order, outputs, emitted, &reference_equations);
    Ok(certificate.map_err(refused)?)
}

fn one_order(model: &Model, orders: &[usize]) -> Result<usize, Error> {
    let order = orders.first().copied().unwrap_or(0);
    if orders.iter().any(|other| *other != order) {
        return Err(Error::Request(format!(
            "the fields of {} have the orders {orders:?}; a certificate is for one order: \
             give --order",
            model.name
        )));
    }
    Ok(order)
}
