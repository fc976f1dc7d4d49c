//! Shipped specifications, their variants and random states.

use eomgen_validate::oracle::Oracle;
use eomgen_validate::sampler::{Sample, Sampler};
use std::path::{Path, PathBuf};

use eomgen_codegen::mechanics::equations::Equations;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::program::lowering::lower;
use eomgen_codegen::variant::derive_equations;
use eomgen_model_spec::model::Model;

/// Returns the project's folder.
pub fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the package is in the project")
}

/// Returns the paths of all shipped specifications, sorted by name.
pub fn shipped_specifications() -> Vec<PathBuf> {
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

/// Returns the path of a shipped specification.
pub fn path(name: &str) -> PathBuf {
    project()
        .join("model-spec/models")
        .join(format!("{name}.toml"))
}

/// Loads a shipped specification.
pub fn load(name: &str) -> Model {
    eomgen_model_spec::load(&path(name))
        .expect("a shipped specification loads")
        .model
}

/// Variant of a model with all fields at one order.
pub struct Variant {
    /// Equations of motion.
    pub equations: Equations,
    /// Evaluator, prepared with the model's parameters.
    pub evaluator: Evaluator,
}

/// Derives `model` with every field at `order`.
pub fn variant(model: &Model, order: usize) -> Variant {
    let parameters = model
        .parameter_values()
        .expect("the parameters have values");
    let orders = vec![order; model.fields.len()];
    let equations = derive_equations(model, &orders).expect("the model can be derived");
    let evaluator = Evaluator::new(lower(model, &equations, &parameters));
    Variant {
        equations,
        evaluator,
    }
}

/// Returns random times, states and inputs with magnitudes typical of the motion; `count` in every regime.
pub fn samples(model: &Model, order: usize, seed: u64, count: usize) -> Vec<Sample> {
    let parameters = model
        .parameter_values()
        .expect("the parameters have values");
    let oracle = Oracle::new(model, order, &parameters).expect("the oracle supports the model");
    let mut sampler = Sampler::new(&oracle, seed).expect("states can be drawn");
    let mut samples = Vec::new();
    for regime in sampler
        .visit_regimes()
        .expect("the oracle supports the model")
        .visited
    {
        for _ in 0..count {
            let drawn = sampler
                .draw_in(&regime)
                .expect("the oracle supports the model");
            samples.push(drawn.expect("every regime can be reached").sample);
        }
    }
    samples
}
