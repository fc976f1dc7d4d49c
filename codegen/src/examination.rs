//! What can be refused of a model, without its equations of motion: every expression is translated, every
//! coordinate has inertia, and constraints can hold and do not depend on each other.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::model::Model;

use crate::independence::bounds::check_signs;
use crate::independence::check_independence;
use crate::independence::nodes::NodeGeometry;
use crate::mechanics::inertia::check_energy;
use crate::mechanics::translate::DeriveError;
use crate::mechanics::unsolved::Unsolved;
use crate::symbolic::graph::NodeId;

/// The work that an examination took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Examination {
    /// Number of nodes of the graph.
    pub nodes: usize,
    /// Number of entries of Hessians that were updated.
    pub updates: usize,
}

/// Examines a model; None if its equations have to be derived for that: those of fields, and of kinetic
/// energies that take functions of velocities.
///
/// # Errors
/// What cannot be derived, constraints that never hold or depend on each other, and coordinates without
/// inertia at the initial state.
pub fn examine(model: &Model) -> Result<Option<Examination>, Diagnostic> {
    if !model.fields.is_empty() {
        return Ok(None);
    }
    let unsolved = Unsolved::translate(model).map_err(DeriveError::diagnostic)?;
    let inertia = check_energy(model, &unsolved.graph, unsolved.kinetic);
    if matches!(inertia, Ok(None)) {
        return Ok(None);
    }
    check_constraints(model, &unsolved)?;
    Ok(inertia?.map(|sweep| Examination {
        nodes: unsolved.graph.len(),
        updates: sweep.updates,
    }))
}

fn check_constraints(model: &Model, unsolved: &Unsolved) -> Result<(), Diagnostic> {
    if model.constraints.is_empty() {
        return Ok(());
    }
    let values = model.parameter_values();
    let values = values.map_err(|error| error.diagnostic())?;
    let residuals: Vec<NodeId> = unsolved.residuals().collect();
    check_signs(model, &unsolved.graph, &residuals, &values)?;
    let mut geometry = NodeGeometry::new(unsolved, model.coordinates.len(), values);
    check_independence(model, &[], &mut geometry)
}
