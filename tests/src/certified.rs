//! Certificates of models given as text, without compiling emitted code. Certificates of correct models must pass, and
//! certificates of wrong models must fail.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_validate::certificate::Certificate;
use eomgen_validate::certify::{self, Subject};
use eomgen_validate::derived::Derived;
use eomgen_validate::derived_outputs::DerivedOutputs;
use eomgen_validate::outputs::Outputs;
use eomgen_validate::variant::Variant;

use crate::models::variant;

/// Returns the model of a valid specification.
pub fn check_model(text: &str) -> Model {
    match eomgen_model_spec::check(Source::new("model.toml", text)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}\n{text}", found.render(false)),
    }
}

/// Certifies the derived equations of `subject`; the oracle uses `model`.
pub fn certify(model: &Model, subject: &Model) -> Certificate {
    certify_outputs(model, subject, &[])
}

/// Certifies the derived equations and the requested `outputs` of `subject`; the oracle uses `model`.
pub fn certify_outputs(model: &Model, subject: &Model, outputs: &[Output]) -> Certificate {
    let parameters = model.parameter_values().expect("values");
    let variants = |order: usize| {
        let evaluator = variant(subject, order).evaluator;
        Ok(Box::new(Derived::new(evaluator)) as Box<dyn Variant>)
    };
    let order = model.fields.first().map_or(0, |field| field.order);
    let orders: Vec<usize> = subject.fields.iter().map(|field| field.order).collect();
    let functions = || {
        let derived = eomgen_codegen::variant::Variant::derive_with(subject, &orders, outputs);
        let program = derived.map_err(|found| found.render(false))?.program;
        Ok(Box::new(DerivedOutputs::new(Evaluator::new(program))) as Box<dyn Outputs>)
    };
    certify::certify(&Subject {
        model,
        order,
        parameters: &parameters,
        variants: &variants,
        references: &[],
        not_applicable: &[],
        outputs: (!outputs.is_empty()).then_some(&functions),
        emitted: Err("judged elsewhere".to_owned()),
        program: None,
        c_sources: &[],
        casadi: None,
        unit: None,
        regimes: Err("judged elsewhere".to_owned()),
        exact: Err("judged elsewhere".to_owned()),
    })
}
