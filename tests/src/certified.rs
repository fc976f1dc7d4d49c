//! Certificates of models given as text, without compiling what would be emitted: whether a
//! right model passes and a wrong one fails.

use model_spec::model::Model;
use model_spec::source::Source;
use sim::derived::Derived;
use sim::validate::certificate::Certificate;
use sim::validate::certify::{Subject, certify};
use sim::validate::variant::Variant;

use crate::models::variant;

/// The model of a text, which must be sound.
pub fn checked(text: &str) -> Model {
    match model_spec::check(Source::new("model.toml", text)) {
        Ok(checked) => checked.model,
        Err(found) => panic!("{}\n{text}", found.render(false)),
    }
}

/// The certificate of `model` if its equations were those of `subject`.
pub fn certificate(model: &Model, subject: &Model) -> Certificate {
    let parameters = model.parameter_values().expect("values");
    let variants = |order: usize| {
        let evaluator = variant(subject, order).evaluator;
        Ok(Box::new(Derived::new(evaluator)) as Box<dyn Variant>)
    };
    let order = model.fields.first().map_or(0, |field| field.order);
    certify(&Subject {
        model,
        order,
        parameters: &parameters,
        variants: &variants,
        references: &[],
        emitted: Err("judged elsewhere".to_owned()),
    })
}
