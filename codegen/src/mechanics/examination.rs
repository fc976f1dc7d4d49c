//! What can be refused of a model, without its equations of motion: every expression is translated, and
//! every coordinate has inertia. The work grows as the specification does, where equations may grow with
//! its square and more.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::ids::StateId;
use eomgen_model_spec::model::Model;

use crate::mechanics::equations::{derived_parameters, total_of};
use crate::mechanics::forces::translated;
use crate::mechanics::inertia::check_energy;
use crate::mechanics::translate::{DeriveError, Derived, Translator};
use crate::symbolic::graph::NodeId;

/// The work that an examination took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examination {
    /// Number of nodes of the graph.
    pub nodes: usize,
    /// Number of entries of Hessians that were updated.
    pub updates: usize,
}

/// Examines a model; None if its equations have to be derived for that: fields, constraints, impacts
/// and named coefficients are refused for what they do in them.
///
/// # Errors
/// What cannot be derived, and coordinates without inertia at the initial state.
pub fn examine(model: &Model) -> Result<Option<Examination>, Diagnostic> {
    let is_plain = model.fields.is_empty()
        && model.constraints.is_empty()
        && model.impacts.is_empty()
        && model.coefficients.is_empty();
    if !is_plain {
        return Ok(None);
    }
    let mut translator = Translator::new(model, &[]);
    let kinetic = translate_all(&mut translator).map_err(DeriveError::diagnostic)?;
    let sweep = check_energy(model, &translator.graph, kinetic)?;
    Ok(sweep.map(|sweep| Examination {
        nodes: translator.graph.len(),
        updates: sweep.updates,
    }))
}

/// Translates all expressions; the kinetic energy.
fn translate_all(translator: &mut Translator) -> Derived<NodeId> {
    let model = translator.model;
    let mut terms = Vec::new();
    derived_parameters(translator)?;
    let kinetic = total_of(translator, &model.kinetic, "T", &mut terms)?;
    total_of(translator, &model.potential, "V", &mut terms)?;
    total_of(translator, &model.dissipation, "R", &mut terms)?;
    for force in &model.forces {
        translated(translator, force)?;
    }
    for state in StateId::first(model.states.len()) {
        translator.state_rate(state)?;
    }
    for observable in &model.observables {
        translator.node(&observable.value)?;
    }
    Ok(kinetic)
}
