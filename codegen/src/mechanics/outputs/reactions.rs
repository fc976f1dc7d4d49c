//! Sticking frictions and contacts for steps of fixed length: functions, columns and effects of their reactions. The
//! time-stepping method is in `program::evaluator::fixed_step`.

use super::types::Reactions;
use crate::mechanics::discs::find_discs;
use crate::mechanics::equations::Equations;
use crate::mechanics::function_rates::{Column, derive_along};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sliding::derive_friction_rates;
use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Property of a model for which there are no steps of fixed length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepObstacle {
    /// Energies jump at a surface.
    Corner,
    /// A friction acts against the direction of a velocity vector, v/norm(v).
    Direction,
    /// The rates are not linear in the sign of a friction.
    Nonlinear,
    /// A contact has friction and restitution.
    RestitutionWithFriction,
}

impl std::fmt::Display for StepObstacle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Corner => "a step of fixed length is not available for energies that jump",
            Self::Direction => {
                "a step of fixed length is not available for friction opposite to the direction of a velocity, v/norm(v)"
            }
            Self::Nonlinear => "a step of fixed length is not available for forces that are not linear in the sign of a friction",
            Self::RestitutionWithFriction => {
                "a step of fixed length is not available for contacts with both friction and restitution; remove the friction, \
                 or write the number 0 (not a parameter) as restitution"
            }
        })
    }
}

/// Derives the reactions; `None` for a model without contacts and without frictions that can stick.
pub(crate) fn derive_reactions(
    equations: &mut Equations,
) -> Result<Option<Reactions<NodeId, RowNodes>>, StepObstacle> {
    if !equations.corners.is_empty() {
        return Err(StepObstacle::Corner);
    }
    let rates = equations.rate_nodes();
    if !find_discs(&mut equations.graph, &rates).is_empty() {
        return Err(StepObstacle::Direction);
    }
    let held = derive_friction_rates(equations);
    let graph = &mut equations.graph;
    if held.columns.iter().any(|column| has_sides(graph, column)) {
        return Err(StepObstacle::Nonlinear);
    }
    let impacts = &equations.impacts;
    let bounces = |restitution: NodeId| !graph.is_zero(restitution);
    if (impacts.iter()).any(|impact| impact.friction.is_some() && bounces(impact.restitution)) {
        return Err(StepObstacle::RestitutionWithFriction);
    }
    let frictions: Vec<_> = (impacts.iter().enumerate())
        .filter_map(|(contact, impact)| Some((contact, impact.friction.as_ref()?)))
        .collect();
    let mut functions = held.functions;
    functions.extend(impacts.iter().map(|impact| impact.rate));
    functions.extend(frictions.iter().map(|(_, friction)| friction.slip));
    if functions.is_empty() {
        return Ok(None);
    }
    let at_rest = vec![graph.zero(); equations.state_rates.len()];
    let of_contact = |column: &RowNodes| (column.clone(), at_rest.clone());
    let mut columns = held.columns;
    columns.extend(impacts.iter().map(|impact| of_contact(&impact.column)));
    columns.extend((frictions.iter()).map(|(_, friction)| of_contact(&friction.column)));
    let mut effects = Vec::with_capacity(functions.len() * columns.len());
    for function in &functions {
        for column in &columns {
            effects.push(derive_along(graph, *function, column));
        }
    }
    Ok(Some(Reactions {
        accelerations: held.accelerations,
        first_order_rates: held.first_order_rates,
        distances: impacts.iter().map(|impact| impact.distance).collect(),
        restitutions: impacts.iter().map(|impact| impact.restitution).collect(),
        coefficients: (frictions.iter())
            .map(|(contact, friction)| (*contact, friction.coefficient))
            .collect(),
        functions,
        columns,
        effects,
    }))
}

fn has_sides(graph: &Graph, (rates, first_order): &Column) -> bool {
    let roots: Vec<NodeId> = rates
        .nodes()
        .into_iter()
        .chain(first_order.iter().copied())
        .collect();
    let parts = graph.reachable(&roots);
    parts
        .into_iter()
        .any(|part| matches!(graph.operation(part), Operation::Argument(..)))
}
