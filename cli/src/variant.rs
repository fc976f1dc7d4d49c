//! From the path of a specification to a derived variant, with messages for people.

use std::io::IsTerminal;
use std::path::Path;

use codegen::mechanics::equations::Equations;
use codegen::program::Program;
use codegen::program::evaluator::Evaluator;
use codegen::variant::Variant as Derived;
use model_spec::Checked;
use model_spec::model::Model;

use crate::problem::{Outcome, Problem, warn};

/// A model derived at one order.
pub struct Variant {
    /// The checked model.
    pub model: Model,
    /// Its equations.
    pub equations: Equations,
    /// Its program.
    pub program: Program,
}

/// Reads and checks a specification; warnings go to stderr.
pub fn load(path: &Path) -> Outcome<Checked> {
    let checked = model_spec::load(path).map_err(Problem::Specification)?;
    if !checked.warnings.is_empty() {
        warn(&checked.warnings.render(std::io::stderr().is_terminal()));
    }
    Ok(checked)
}

/// The orders of a model's fields. A text that is no order is refused with what would be.
pub fn orders(model: &Model, text: Option<&str>) -> Outcome<Vec<usize>> {
    let order = match text {
        None => None,
        Some(text) => Some(text.trim().parse::<usize>().map_err(|_| {
            Problem::input(format!(
                "--order {text}: expected a whole number from 0 to {}",
                model_spec::model::MAX_ORDER
            ))
        })?),
    };
    model
        .orders(order)
        .map_err(|error| Problem::model(&model.source, error))
}

/// Derives a model at the given orders.
pub fn derive_variant(model: Model, orders: &[usize]) -> Outcome<Variant> {
    let derived = Derived::derive(&model, orders).map_err(Problem::Specification)?;
    Ok(Variant::of(model, derived))
}

/// Derives a model at the given orders, also one without inertia at its own parameters and
/// initial state: for readers, and for who judges other parameters.
pub fn derive_unjudged(model: Model, orders: &[usize]) -> Outcome<Variant> {
    let derived = Derived::derive_to_read(&model, orders, &[]).map_err(Problem::Specification)?;
    Ok(Variant::of(model, derived))
}

impl Variant {
    fn of(model: Model, derived: Derived) -> Self {
        Self {
            model,
            equations: derived.equations,
            program: derived.program,
        }
    }

    /// Loads, checks and derives for readers: also what has no inertia somewhere.
    pub fn load_to_read(path: &Path, order: Option<&str>) -> Outcome<Self> {
        let model = load(path)?.model;
        let orders = orders(&model, order)?;
        derive_unjudged(model, &orders)
    }

    /// An evaluator of the program, at the specification's parameters.
    pub fn evaluator(&self) -> Evaluator {
        Evaluator::new(self.program.clone())
    }
}
