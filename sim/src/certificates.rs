//! The certificate of a model at one order: its derivation and its emitted source go
//! before the checks of [`crate::validate`], with whatever was written by hand for it.

use codegen::equations::derive;
use codegen::evaluator::Evaluator;
use codegen::lower::lower;
use model_spec::model::Model;
use model_spec::variant::ModelError;

use crate::by_hand::references;
use crate::derived::Derived;
use crate::validate::certificate::Certificate;
use crate::validate::certify::{Emitted, EmittedFunction, Subject, certify};
use crate::validate::variant::Variant;

/// The certificate of `model` with every field at `order`; `emitted` is the source of
/// that variant as a crate of its own.
///
/// # Errors
/// If the parameters have no finite values.
pub fn certificate(
    model: &Model,
    order: usize,
    emitted: String,
) -> Result<Certificate, ModelError> {
    let parameters = model.parameter_values()?;
    let variants = |order: usize| variant(model, order, &parameters);
    let emitted = Emitted {
        source: emitted,
        input_fields: model
            .inputs
            .iter()
            .map(|input| input.name.clone())
            .collect(),
        functions: vec![
            EmittedFunction::Rates,
            EmittedFunction::Observables,
            EmittedFunction::Energy,
            EmittedFunction::Power,
            EmittedFunction::Guards,
            EmittedFunction::MassMatrix,
        ],
    };
    let references = references(model, order, &parameters);
    Ok(certify(&Subject {
        model,
        order,
        parameters: &parameters,
        variants: &variants,
        references: &references,
        emitted: Ok(emitted),
    }))
}

/// The variant of a model with every field at `order`, at parameter values in SI.
fn variant(model: &Model, order: usize, parameters: &[f64]) -> Result<Box<dyn Variant>, String> {
    let orders = vec![order; model.fields.len()];
    let equations = derive(model, &orders).map_err(|error| error.to_string())?;
    let evaluator = Evaluator::new(lower(model, &equations, parameters));
    Ok(Box::new(Derived::new(evaluator)))
}
