//! Corners of a motion: the motion crosses a surface g(q, t) = 0 at which the Lagrangian L = T - V jumps. The sides
//! of such surfaces become inputs of the equations.
//!
//! The coordinates are continuous at a corner. The Weierstrass-Erdmann corner conditions determine the rates after it
//! (G. Erdmann, Ueber unstetige Loesungen in der Variationsrechnung, J. reine angew. Math. 82, 1877):
//!
//! ```text
//! p+ - p- = lambda dg/dq + A^T mu,    H+ - H- = -lambda dg/dt - mu a_t,    A q'+ + a_t = 0
//! ```
//!
//! with the momenta p = dL/dq', the Hamiltonian H = p q' - L and the constraints A q' + a_t = 0. The simulator
//! solves them for lambda and mu.

use std::collections::HashMap;

use eomgen_model_spec::ids::InputId;
use eomgen_model_spec::model::Model;

use crate::mechanics::equations::Equations;
use crate::mechanics::function_rates::derive_guard_rate;
use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::outputs::{Corners, RateRow};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sides::Sides;
use crate::mechanics::translate::along_motion;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Shape};
use crate::symbolic::substitute::substitute;

/// Returns true if momenta or the rates of constraints can jump, at a surface or because an input jumps.
pub fn has_jumping_momenta(equations: &Equations) -> bool {
    let graph = &equations.graph;
    let depends = |node: &NodeId| graph.dependence(*node).has(Dependence::INPUT);
    let mut energies = std::iter::once(&equations.kinetic).chain(&equations.residuals);
    let mut mass = equations.mass.scalars.iter().flatten();
    let is_quadratic = !mass.any(|entry| graph.dependence(*entry).has(Dependence::RATE));
    !equations.corners.is_empty() || is_quadratic && energies.any(depends)
}

/// Adds the sides of the corner surfaces as inputs after the inputs of the model, in the order of
/// [`Equations::corners`]. Mass matrix and energies then depend on these sides. Returns the quantities that determine
/// the rates after a corner.
pub(crate) fn add_corner_sides(
    model: &Model,
    orders: &[usize],
    equations: &mut Equations,
) -> Corners<NodeId, RowNodes> {
    let variables = Variables::new(model, orders);
    let corners = equations.corners.clone();
    let places = guard_places(equations);
    let surfaces = corners.iter().map(|corner| {
        let value = equations.guards[corner.guard].value;
        let rate = derive_guard_rate(equations, value);
        let graph = &mut equations.graph;
        RateRow {
            place: places[corner.guard],
            rate,
            row: variables.gradient(graph, value, GradientBy::Coordinates),
        }
    });
    let surfaces = surfaces.collect();
    let graph = &mut equations.graph;
    let rates: Vec<NodeId> = (equations.residuals.iter())
        .map(
            |residual| match graph.dependence(*residual).has(Dependence::RATE) {
                true => *residual,
                false => along_motion(graph, *residual),
            },
        )
        .collect();
    let roots = [equations.kinetic, equations.potential];
    let first = equations.inputs;
    let given = (&mut *graph, &equations.guards[..]);
    let mut known = Sides::replace_jumps(given, &roots, &|guard| {
        let side = corners.iter().position(|corner| corner.guard == guard)?;
        Some(Operation::Input(InputId::new(first + side)))
    })
    .known;
    let mut replaced = |graph: &mut Graph, node: NodeId| replace(graph, node, &mut known);
    let kinetic = replaced(graph, equations.kinetic);
    let potential = replaced(graph, equations.potential);
    let constraints = rates.iter().enumerate().map(|(place, rate)| RateRow {
        place,
        rate: *rate,
        row: variables.gradient(graph, *rate, GradientBy::Rates),
    });
    let constraints = constraints.collect();
    let momenta = variables.gradient(graph, kinetic, GradientBy::Rates);
    let product = variables.multiply_by_rates(graph, &momenta);
    equations.mass = variables.mass_matrix(graph, &momenta);
    equations.modal_blocks = equations.mass.assemble_blocks(graph);
    Corners {
        hamiltonian: graph.combine(&[(1.0, product), (-1.0, kinetic), (1.0, potential)]),
        energy: graph.add(kinetic, potential),
        momenta,
        surfaces,
        constraints,
    }
}

fn replace(graph: &mut Graph, node: NodeId, known: &mut HashMap<NodeId, NodeId>) -> NodeId {
    substitute(graph, node, &|_, _| None, known)
}

/// Returns, for each guard, the index of its first element among all guard values.
fn guard_places(equations: &Equations) -> Vec<usize> {
    let graph = &equations.graph;
    let mut next = 0;
    let mut places = Vec::with_capacity(equations.guards.len());
    for guard in &equations.guards {
        places.push(next);
        next += match graph.shape(guard.value) {
            Shape::Vector(space) => graph.size(space),
            _ => 1,
        };
    }
    places
}
