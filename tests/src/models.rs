//! Shipped specifications, their variants and random states. Nothing is checked here.

use eomgen_validate::oracle::Oracle;
use eomgen_validate::sampler::{Sample, Sampler};
use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::equations::{Equations, derive};
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::program::lowering::lower;
use eomgen_model_spec::model::Model;

/// The project's folder.
pub fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the package lies in the project")
}

/// The paths of all shipped specifications, in the order of their names.
pub fn shipped() -> Vec<PathBuf> {
    let folder = project().join("model-spec/models");
    let entries = std::fs::read_dir(folder).expect("the folder of the shipped specifications");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    assert!(!paths.is_empty(), "no shipped specification");
    paths
}

/// The path of a shipped specification.
pub fn path(name: &str) -> PathBuf {
    project()
        .join("model-spec/models")
        .join(format!("{name}.toml"))
}

/// A shipped specification, checked.
pub fn load(name: &str) -> Model {
    eomgen_model_spec::load(&path(name))
        .expect("a shipped specification loads")
        .model
}

/// A model derived with every field at one order.
pub struct Variant {
    /// The equations.
    pub equations: Equations,
    /// Their program, prepared with the model's parameters.
    pub evaluator: Evaluator,
}

/// Derives `model` with every field at `order`.
pub fn variant(model: &Model, order: usize) -> Variant {
    let parameters = model
        .parameter_values()
        .expect("the parameters have values");
    let orders = vec![order; model.fields.len()];
    let equations = derive(model, &orders).expect("the model can be derived");
    let evaluator = Evaluator::new(lower(model, &equations, &parameters));
    Variant {
        equations,
        evaluator,
    }
}

/// Random times, states and inputs of the sizes that the model's motion has, `count` in
/// every regime of its switching functions.
pub fn samples(model: &Model, order: usize, seed: u64, count: usize) -> Vec<Sample> {
    let parameters = model
        .parameter_values()
        .expect("the parameters have values");
    let oracle = Oracle::new(model, order, &parameters).expect("the oracle knows the model");
    let mut sampler = Sampler::new(&oracle, seed).expect("states can be drawn");
    let mut samples = Vec::new();
    for regime in sampler
        .regimes()
        .expect("the oracle knows the model")
        .visited
    {
        for _ in 0..count {
            let drawn = sampler
                .draw_in(&regime)
                .expect("the oracle knows the model");
            samples.push(drawn.expect("every regime can be reached").sample);
        }
    }
    samples
}
