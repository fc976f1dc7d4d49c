//! Checks of a model that need no equations of motion: expressions that cannot be translated, coordinates
//! without inertia, and constraints that contradict each other or that no state satisfies.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::model::Model;

use crate::independence::bounds::check_signs;
use crate::independence::find_redundancy;
use crate::independence::nodes::NodeGeometry;
use crate::mechanics::inertia::check_energy;
use crate::mechanics::redundancy::Redundancy;
use crate::mechanics::translate::DeriveError;
use crate::mechanics::unsolved::Unsolved;
use crate::symbolic::graph::NodeId;

/// Result of an examination, with the numbers of processed nodes and entries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Examination {
    /// Number of graph nodes.
    pub nodes: usize,
    /// Number of updated entries in the Hessian of the kinetic energy.
    pub updates: usize,
    /// Constraints that depend on each other.
    pub redundancy: Redundancy,
}

/// Checks a model. Returns `None` if the model has fields, or if its kinetic energy contains functions of velocities;
/// such a model can only be checked by its derived equations.
///
/// # Errors
/// Expressions that cannot be derived, constraints that contradict each other or that no state satisfies, and
/// coordinates without inertia at the initial state.
pub fn examine(model: &Model) -> Result<Option<Examination>, Diagnostic> {
    if !model.fields.is_empty() {
        return Ok(None);
    }
    let unsolved = Unsolved::translate(model).map_err(DeriveError::diagnostic)?;
    let inertia = check_energy(model, &unsolved.graph, unsolved.kinetic);
    if matches!(inertia, Ok(None)) {
        return Ok(None);
    }
    let redundancy = check_constraints(model, &unsolved)?;
    Ok(inertia?.map(|sweep| Examination {
        nodes: unsolved.graph.len(),
        updates: sweep.updates,
        redundancy,
    }))
}

fn check_constraints(model: &Model, unsolved: &Unsolved) -> Result<Redundancy, Diagnostic> {
    if model.constraints.is_empty() {
        return Ok(Redundancy::default());
    }
    let values = model.parameter_values();
    let values = values.map_err(|error| error.diagnostic())?;
    let residuals: Vec<NodeId> = unsolved.residuals().collect();
    check_signs(model, &unsolved.graph, &residuals, &values)?;
    let mut geometry = NodeGeometry::new(unsolved, model.coordinates.len(), values);
    find_redundancy(model, &[], &mut geometry)
}
