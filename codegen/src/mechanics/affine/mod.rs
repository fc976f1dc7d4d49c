//! Equations of a piecewise-linear model, y' = A y + B u + S sin + C cos + c. All coefficients depend only on
//! parameters and sides. Therefore one program computes the matrices of every regime for all parameter values.
//!
//! Every piecewise function becomes a polynomial in *sides*. Each switching surface has one side: 1 if its switching
//! function is positive, else 0. For example, deadzone(p, b) is s(p - b) (p - b) + (1 - s(p + b)) (p + b). With the
//! sides as parameters, the equations are linear in the motion. A side between 0 and 1 describes a state that is held
//! on the surface, for example during sticking: the rates are a convex combination of the rates on both sides.

mod rows;

use std::collections::HashMap;

use eomgen_model_spec::ids::{FieldId, ParameterId};
use eomgen_model_spec::model::Function;

use crate::mechanics::equations::Equations;
use crate::mechanics::forces::can_be_constant;
use crate::mechanics::linearity::{Linearity, linearity};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sides::Sides;
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape, Space};
use crate::symbolic::substitute::substitute;

pub(crate) use rows::AffineRow;

/// Equations of a model that is linear between its switching surfaces.
pub struct AffineEquations {
    pub(crate) graph: Graph,
    pub(crate) parameter_names: Vec<String>,
    /// Expression of each derived parameter. The sides follow as further parameters; they have no expressions.
    pub(crate) derived_parameters: Vec<Option<NodeId>>,
    pub(crate) scalars: Vec<AffineRow>,
    /// One row for each field, with the coefficients of all modes.
    pub(crate) modal: Vec<AffineRow>,
    pub(crate) first_order: Vec<AffineRow>,
    pub(crate) guards: Vec<AffineRow>,
    pub(crate) guard_functions: Vec<Function>,
    /// For each guard, the first guard whose surface is parallel, because both differ only by parameters.
    pub(crate) guard_groups: Vec<usize>,
    /// For each guard, true if it can be constant throughout a regime, because it depends on the sides of other
    /// surfaces or only on inputs.
    pub(crate) guards_rest: Vec<bool>,
    /// Half-widths of dead zones, which must not be negative.
    pub(crate) half_widths: Vec<NodeId>,
    pub(crate) phases: Vec<PhaseNodes>,
    pub(crate) pivots: Vec<NodeId>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct PhaseNodes {
    pub rate: NodeId,
    pub offset: NodeId,
}

/// Derives the coefficients of a piecewise-linear model.
///
/// # Errors
/// The first node that is not linear between switching surfaces.
pub fn derive_affine(mut equations: Equations) -> Result<AffineEquations, NodeId> {
    match linearity(&equations) {
        Linearity::Linear | Linearity::PiecewiseLinear => {}
        Linearity::Constrained => return Err(equations.multipliers[0]),
        Linearity::Impacts => return Err(equations.impacts[0].distance),
        Linearity::Corners(node) | Linearity::Nonlinear(node) => return Err(node),
    }
    let not_scalar = |guard: &&crate::mechanics::guard::Guard| {
        equations.graph.shape(guard.value) != Shape::Scalar
    };
    if let Some(guard) = equations.guards.iter().find(not_scalar) {
        return Err(guard.value);
    }
    let first_side = equations.parameter_names.len();
    let mut roots = equations.rate_nodes();
    roots.extend(equations.guards.iter().map(|guard| guard.value));
    let given = (&mut equations.graph, &equations.guards[..]);
    let mut with_sides = Sides::replace_all(given, &roots, &|guard| {
        Some(Operation::Parameter(ParameterId::new(first_side + guard)))
    });
    let graph = &mut equations.graph;
    let known = &mut with_sides.known;
    let mut replaced = |graph: &mut Graph, id: NodeId| substitute(graph, id, &|_, _| None, known);
    let accelerations = RowNodes {
        scalars: map_nodes(graph, &equations.accelerations.rows.scalars, &mut replaced),
        modal: map_nodes(graph, &equations.accelerations.rows.modal, &mut replaced),
    };
    let state_rates = map_nodes(graph, &equations.state_rates, &mut replaced);
    let surfaces: Vec<NodeId> = equations.guards.iter().map(|guard| guard.value).collect();
    let guards = map_nodes(graph, &surfaces, &mut replaced);
    let moving = [accelerations.nodes(), state_rates.clone(), guards.clone()].concat();
    let sinusoids = rows::Sinusoids::find(graph, &moving);
    let inputs = input_count(graph, &moving);
    let mut reader = rows::Reader::new(
        graph,
        (&accelerations, state_rates.len()),
        &sinusoids,
        inputs,
    );
    let scalars = read_rows(&mut reader, graph, &accelerations.scalars);
    let modal = FieldId::first(accelerations.modal.len()).zip(&accelerations.modal);
    let modal: Vec<AffineRow> = modal
        .map(|(field, id)| reader.row(graph, *id, Some(Space::Modes(field))))
        .collect();
    let first_order = read_rows(&mut reader, graph, &state_rates);
    let guard_rows = read_rows(&mut reader, graph, &guards);
    let rows = [&scalars, &modal, &first_order, &guard_rows]
        .into_iter()
        .flatten();
    let unsettled = |id: &NodeId| !graph.dependence(*id).is_parameter_only();
    if let Some(node) = rows.flat_map(AffineRow::nodes).find(unsettled) {
        return Err(node);
    }
    let time = graph.intern(Operation::Time);
    let phases = sinusoids
        .phases
        .iter()
        .map(|&phase| PhaseNodes {
            rate: derive_by_scalar(graph, phase, time),
            offset: evaluate_at_time_zero(graph, phase, time),
        })
        .collect();
    let guard_groups = group_parallel_surfaces(graph, &surfaces);
    let guards_rest = surfaces
        .iter()
        .map(|id| can_be_constant(graph, *id))
        .collect();
    let mut derived_parameters = equations.derived_parameters;
    derived_parameters.extend(guards.iter().map(|_| None));
    let mut parameter_names = equations.parameter_names;
    parameter_names.extend((0..guards.len()).map(|guard| format!("side_{guard}")));
    Ok(AffineEquations {
        graph: equations.graph,
        parameter_names,
        derived_parameters,
        scalars,
        modal,
        first_order,
        guards: guard_rows,
        guard_functions: equations.guards.iter().map(|g| g.function).collect(),
        guard_groups,
        guards_rest,
        half_widths: with_sides.half_widths,
        phases,
        pivots: equations.accelerations.pivots,
    })
}

fn map_nodes(
    graph: &mut Graph,
    nodes: &[NodeId],
    replaced: &mut dyn FnMut(&mut Graph, NodeId) -> NodeId,
) -> Vec<NodeId> {
    nodes.iter().map(|id| replaced(graph, *id)).collect()
}

fn read_rows(reader: &mut rows::Reader<'_>, graph: &mut Graph, nodes: &[NodeId]) -> Vec<AffineRow> {
    nodes
        .iter()
        .map(|id| reader.row(graph, *id, None))
        .collect()
}

fn evaluate_at_time_zero(graph: &mut Graph, phase: NodeId, time: NodeId) -> NodeId {
    let zero = |graph: &mut Graph, node: NodeId| (node == time).then(|| graph.zero());
    substitute(graph, phase, &zero, &mut HashMap::new())
}

/// Returns, for each surface, the index of the first parallel surface (possibly its own index).
fn group_parallel_surfaces(graph: &mut Graph, surfaces: &[NodeId]) -> Vec<usize> {
    let mut firsts = Vec::with_capacity(surfaces.len());
    for (index, &surface) in surfaces.iter().enumerate() {
        let first = (0..index).find(|&other| {
            let difference = graph.combine_flat(&[(1.0, surface), (-1.0, surfaces[other])]);
            graph.dependence(difference).is_parameter_only()
        });
        firsts.push(first.unwrap_or(index));
    }
    firsts
}

/// Returns the number of inputs up to the last input that `nodes` use.
fn input_count(graph: &Graph, nodes: &[NodeId]) -> usize {
    let inputs = graph
        .reachable(nodes)
        .into_iter()
        .filter_map(|id| match graph.operation(id) {
            Operation::Input(index) => Some(index.index() + 1),
            _ => None,
        });
    inputs.max().unwrap_or(0)
}
