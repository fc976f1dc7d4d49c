//! Derivation of the requested outputs as nodes: bias forces, inverse dynamics, rates of guards, products
//! with the Jacobian. `jacobian` derives Jacobians; `types` defines the results.

use super::adjoint::{self, pair_weights};
use super::hessian::gradient_derivative;
use super::jacobian::{
    JacobianRows, build_single_row_jacobian, collect_observable_rows, collect_rate_rows,
    differentiate_along_direction, differentiate_by_parameters, differentiate_by_time,
    differentiate_by_variables, stack_rows,
};
use super::matrix_derivatives::holds_moving_diagonal;
use super::output::Output;
use super::reactions::{StepObstacle, derive_reactions};
use super::regimes::find_switches;
use super::types::{Jacobian, Outputs, Products};
use crate::mechanics::equations::Equations;
use crate::mechanics::function_rates::derive_guard_rate;
use crate::mechanics::rows::RowNodes;
use crate::symbolic::association::count_shared_operations;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::factor::factor_if_cheaper;
use crate::symbolic::graph::{Argument, Graph, NodeId, Operation, Shape, Space, Variable};
use eomgen_model_spec::ids::{CoordinateId, FieldId};

/// Name of the column of derivatives along a direction: accelerations and first-order rates, then observables.
pub const TANGENTS: &str = "tangents";

/// Derives the requested outputs.
///
/// # Errors
/// [`OutputError::MovingDiagonal`], for products and Jacobians, and [`OutputError::Step`], for steps.
pub fn derive_outputs(
    equations: &mut Equations,
    outputs: &[Output],
) -> Result<Outputs<NodeId, RowNodes>, OutputError> {
    let mut result = Outputs {
        kinds: outputs.to_vec(),
        ..Outputs::default()
    };
    let has = |output| outputs.contains(&output);
    let has_jacobians_by = |suffix: &str| {
        outputs
            .iter()
            .any(|output| output.includes_jacobians_by(suffix))
    };
    let differentiated = ["state", "inputs", "parameters"]
        .into_iter()
        .any(has_jacobians_by)
        || has(Output::Products)
        || has(Output::TimeDerivatives)
        || has(Output::Tangents)
        || has(Output::TrajectoryGradients)
        || has(Output::Hessians);
    if differentiated {
        let mut roots = equations.rate_nodes();
        roots.extend(&equations.observables);
        roots.push(equations.power);
        if holds_moving_diagonal(&equations.graph, &roots) {
            return Err(OutputError::MovingDiagonal(MovingDiagonal::find(equations)));
        }
    }
    if has(Output::BiasForces) || has(Output::InverseDynamics) {
        let bias = derive_bias_forces(equations);
        result.inverse_dynamics =
            has(Output::InverseDynamics).then(|| derive_inverse_dynamics(equations, &bias));
        result.bias_forces = has(Output::BiasForces).then_some(bias);
    }
    result.guard_rates = has(Output::GuardRates).then(|| derive_guard_rates(equations));
    result.jacobians = derive_jacobians(equations, has_jacobians_by);
    if has(Output::Tangents) {
        result.jacobians.push(differentiate_along_direction(
            equations,
            &find_direction_component,
            TANGENTS,
        ));
    }
    if has(Output::TimeDerivatives) {
        let rows = collect_rate_rows(equations);
        result
            .jacobians
            .push(differentiate_by_time(equations, &rows, "rates_by_time"));
    }
    if has(Output::TrajectoryGradients) {
        result.jacobians.extend(derive_event_jacobians(equations));
    }
    if has(Output::Products) || has(Output::Hessians) || has(Output::TrajectoryGradients) {
        let products = derive_products(equations);
        if has(Output::Hessians) {
            let derivative = gradient_derivative(equations, &products.by_parameters);
            result.gradient_derivative = Some(derivative);
        }
        result.products = Some(products);
    }
    result.regimes = has(Output::Regimes).then(|| find_switches(equations));
    if has(Output::Step) {
        result.reactions = derive_reactions(equations).map_err(OutputError::Step)?;
    }
    Ok(result)
}

/// Output that cannot be derived, with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputError {
    /// A Jacobian cannot be derived.
    MovingDiagonal(MovingDiagonal),
    /// A step of fixed length cannot be derived.
    Step(StepObstacle),
}

impl OutputError {
    /// Returns the index in [`Equations::terms`] of the term that causes the error, if it is known.
    pub fn term(self) -> Option<usize> {
        match self {
            Self::MovingDiagonal(found) => found.term,
            Self::Step(_) => None,
        }
    }
}

impl std::fmt::Display for OutputError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::MovingDiagonal(found) => found.fmt(f),
            Self::Step(found) => found.fmt(f),
        }
    }
}

impl std::error::Error for OutputError {}

/// Sum over modes in which a function of the state weights the square of each mode shape. The Jacobian of such a sum
/// is not implemented.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovingDiagonal {
    /// Index of the term in [`Equations::terms`]; `None` if the sum is in no term.
    pub term: Option<usize>,
}

impl MovingDiagonal {
    fn find(equations: &Equations) -> Self {
        let holds = |term: &NodeId| holds_moving_diagonal(&equations.graph, &[*term]);
        Self {
            term: equations.terms.iter().position(holds),
        }
    }
}

impl std::fmt::Display for MovingDiagonal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(
            "there is no Jacobian, because a sum over modes multiplies the square of each mode shape by a function of the state",
        )
    }
}

fn derive_bias_forces(equations: &mut Equations) -> RowNodes {
    let graph = &mut equations.graph;
    let pairs = |terms: &[NodeId], forces: &[NodeId], graph: &mut Graph| -> Vec<NodeId> {
        let rows = terms.iter().zip(forces);
        rows.map(|(c, f)| graph.combine(&[(1.0, *c), (-1.0, *f)]))
            .collect()
    };
    let (terms, forces) = (&equations.velocity_terms, &equations.forces);
    RowNodes {
        scalars: pairs(&terms.scalars, &forces.scalars, graph),
        modal: pairs(&terms.modal, &forces.modal, graph),
    }
}

/// Returns the rows of M a + bias with the accelerations as an argument. Of three forms, the one with the fewest
/// operations is used: by the mass matrix, by a sweep, or by recursion along the tree of frames. The last two need no
/// mass matrix.
fn derive_inverse_dynamics(equations: &mut Equations, bias: &RowNodes) -> RowNodes {
    let mut best = derive_inverse_dynamics_by_mass(equations, bias);
    let scalars = [
        derive_inverse_dynamics_by_sweep(equations),
        derive_inverse_dynamics_by_recursion(equations),
    ];
    let graph = &equations.graph;
    for scalars in scalars.into_iter().flatten() {
        if count_shared_operations(graph, &scalars) < count_shared_operations(graph, &best.scalars)
        {
            best = RowNodes {
                scalars,
                modal: Vec::new(),
            };
        }
    }
    best
}

fn acceleration_argument(graph: &mut Graph, index: CoordinateId) -> NodeId {
    let variable = Variable::Coordinate(index);
    graph.intern(Operation::Argument(Argument::Accelerations, variable))
}

fn derive_inverse_dynamics_by_sweep(equations: &mut Equations) -> Option<Vec<NodeId>> {
    let momenta = equations.sweep.clone()?;
    let graph = &mut equations.graph;
    let rows = momenta.rates(graph, &acceleration_argument);
    let rows = factor_if_cheaper(graph, rows);
    let rows = rows.iter().zip(&equations.forces.scalars);
    Some(
        rows.map(|(row, force)| graph.combine(&[(1.0, *row), (-1.0, *force)]))
            .collect(),
    )
}

fn derive_inverse_dynamics_by_recursion(equations: &mut Equations) -> Option<Vec<NodeId>> {
    let bodies = equations.rigid_bodies.clone()?;
    let coordinates = equations.forces.scalars.len();
    let graph = &mut equations.graph;
    let rows = bodies.inverse_dynamics(graph, coordinates, &acceleration_argument)?;
    Some(factor_if_cheaper(graph, rows))
}

fn derive_inverse_dynamics_by_mass(equations: &mut Equations, bias: &RowNodes) -> RowNodes {
    let (graph, mass) = (&mut equations.graph, &equations.mass);
    let argument = |graph: &mut Graph, variable| {
        graph.intern(Operation::Argument(Argument::Accelerations, variable))
    };
    let scalars: Vec<NodeId> = CoordinateId::first(bias.scalars.len())
        .map(|index| argument(graph, Variable::Coordinate(index)))
        .collect();
    let modal: Vec<NodeId> = FieldId::first(bias.modal.len())
        .map(|field| argument(graph, Variable::ModeCoordinates(field)))
        .collect();
    let mut rows = bias.clone();
    for (row, slot) in rows.scalars.iter_mut().enumerate() {
        let mut terms = vec![(1.0, *slot)];
        for (entry, a) in mass.scalars[row].iter().zip(&scalars) {
            terms.push((1.0, graph.multiply(*entry, *a)));
        }
        for (field, entry) in FieldId::first(modal.len()).zip(&mass.coupling[row]) {
            let product = graph.multiply(*entry, modal[field]);
            terms.push((1.0, graph.sum_over_space(Space::Modes(field), product)));
        }
        *slot = graph.combine(&terms);
    }
    for (field, slot) in rows.modal.iter_mut().enumerate() {
        let mut terms = vec![(1.0, *slot)];
        for (coupling, a) in mass.coupling.iter().zip(&scalars) {
            terms.push((1.0, graph.multiply(coupling[field], *a)));
        }
        for (block, a) in mass.modal[field].iter().zip(&modal) {
            let parts = block.assembly().multiply_vector(graph, *a);
            terms.extend(parts.into_iter().map(|term| (1.0, term)));
        }
        *slot = graph.combine(&terms);
    }
    rows
}

/// Returns the rates of the guards along the motion, with constant inputs.
fn derive_guard_rates(equations: &mut Equations) -> Vec<NodeId> {
    let values: Vec<NodeId> = equations.guards.iter().map(|guard| guard.value).collect();
    let mut rate = |value: &NodeId| derive_guard_rate(equations, *value);
    values.iter().map(&mut rate).collect()
}

fn derive_products(equations: &mut Equations) -> Products<NodeId, RowNodes> {
    let rows = equations.accelerations.rows.clone();
    let graph = &mut equations.graph;
    let mut direction = Direction::new(&find_direction_component);
    let forward = RowNodes {
        scalars: differentiate_nodes(graph, &mut direction, &rows.scalars),
        modal: differentiate_nodes(graph, &mut direction, &rows.modal),
    };
    let first_order = differentiate_nodes(graph, &mut direction, &equations.state_rates);
    let weighted = pair_weights(equations);
    let gradient = adjoint::gradient(&mut equations.graph, &weighted);
    let mut reverse: Vec<(Variable, NodeId)> = gradient
        .into_iter()
        .filter_map(|(leaf, node)| Some((find_variable(&equations.graph, leaf)?, node)))
        .collect();
    reverse.sort_by_key(|(_, node)| *node);
    Products {
        forward,
        forward_first_order: first_order,
        reverse,
        by_parameters: derive_weighted_by_parameters(equations, &weighted),
    }
}

/// Returns the gradient of the weighted rates by the independent parameters. It is derived by reverse accumulation,
/// or parameter by parameter if matrices depend on parameters.
fn derive_weighted_by_parameters(
    equations: &mut Equations,
    weighted: &[(NodeId, NodeId)],
) -> Jacobian<NodeId> {
    const NAME: &str = "weighted_rates_by_parameters";
    let graph = &mut equations.graph;
    match adjoint::derive_gradient_by_parameters(graph, weighted, &equations.derived_parameters) {
        Some(gradient) => build_single_row_jacobian(graph, NAME, &gradient),
        None => {
            let sum = JacobianRows::from_scalars(&[sum_weighted_nodes(graph, weighted)]);
            differentiate_by_parameters(equations, &sum, NAME)
        }
    }
}

fn sum_weighted_nodes(graph: &mut Graph, weighted: &[(NodeId, NodeId)]) -> NodeId {
    let mut terms = Vec::new();
    for &(weight, row) in weighted {
        let product = graph.multiply(weight, row);
        let term = match graph.shape(weight) {
            Shape::Vector(space) => graph.sum_over_space(space, product),
            _ => product,
        };
        terms.push((1.0, term));
    }
    graph.combine(&terms)
}

fn differentiate_nodes(
    graph: &mut Graph,
    direction: &mut Direction<'_>,
    nodes: &[NodeId],
) -> Vec<NodeId> {
    nodes
        .iter()
        .map(|node| direction.derivative(graph, *node))
        .collect()
}

/// Returns the component of the direction for a leaf; it is 0 for time and parameters.
fn find_direction_component(graph: &mut Graph, leaf: NodeId) -> NodeId {
    match find_variable(graph, leaf) {
        Some(variable) => graph.intern(Operation::Argument(Argument::Direction, variable)),
        None => graph.zero(),
    }
}

fn find_variable(graph: &Graph, leaf: NodeId) -> Option<Variable> {
    Some(match *graph.operation(leaf) {
        Operation::Coordinate(index) => Variable::Coordinate(index),
        Operation::ModeCoordinates(field) => Variable::ModeCoordinates(field),
        Operation::Rate(index) => Variable::Rate(index),
        Operation::ModeRates(field) => Variable::ModeRates(field),
        Operation::State(index) => Variable::State(index),
        Operation::Input(index) => Variable::Input(index),
        _ => return None,
    })
}

/// Derives the Jacobians by the requested variables, first those of the rates, then those of the observables.
fn derive_jacobians(
    equations: &mut Equations,
    is_requested_by: impl Fn(&str) -> bool,
) -> Vec<Jacobian<NodeId>> {
    let [by_state, by_inputs, by_all_parameters] =
        ["state", "inputs", "parameters"].map(is_requested_by);
    if !(by_state || by_inputs || by_all_parameters) {
        return Vec::new();
    }
    let (rates, observables) = (
        collect_rate_rows(equations),
        collect_observable_rows(equations),
    );
    let mut found = Vec::new();
    for (rows, names) in [
        (
            &rates,
            ["rates_by_state", "rates_by_inputs", "rates_by_parameters"],
        ),
        (&observables, OBSERVABLES_BY),
    ] {
        if by_state {
            found.push(differentiate_by_variables(equations, rows, names[0], false));
        }
        if by_inputs {
            found.push(differentiate_by_variables(equations, rows, names[1], true));
        }
        if by_all_parameters {
            found.push(differentiate_by_parameters(equations, rows, names[2]));
        }
    }
    found
}

const OBSERVABLES_BY: [&str; 3] = [
    "observables_by_state",
    "observables_by_inputs",
    "observables_by_parameters",
];

/// Derives Jacobians of observables and of the quantities at events. These are scalar guards and their rates,
/// distances of impacts, residuals of constraints and their rates, and the jumps of the rates by impacts without
/// friction.
fn derive_event_jacobians(equations: &mut Equations) -> Vec<Jacobian<NodeId>> {
    let guards = equations.guards.iter().map(|guard| guard.value);
    let guards: Vec<NodeId> = guards
        .filter(|value| equations.graph.shape(*value) == Shape::Scalar)
        .collect();
    let rates: Vec<NodeId> = guards
        .iter()
        .map(|value| derive_guard_rate(equations, *value))
        .collect();
    let distances = equations.impacts.iter().map(|impact| impact.distance);
    let distances: Vec<NodeId> = distances.collect();
    let residuals = equations.residuals.clone();
    let residual_rates: Vec<NodeId> = residuals
        .iter()
        .map(|value| derive_guard_rate(equations, *value))
        .collect();
    let observables = collect_observable_rows(equations);
    let mut found = Vec::new();
    for (rows, [by_state, by_inputs, by_all_parameters]) in [
        (observables, OBSERVABLES_BY),
        (
            JacobianRows::from_scalars(&guards),
            [
                "guards_by_state",
                "guards_by_inputs",
                "guards_by_parameters",
            ],
        ),
        (
            JacobianRows::from_scalars(&rates),
            [
                "guard_rates_by_state",
                "guard_rates_by_inputs",
                "guard_rates_by_parameters",
            ],
        ),
        (
            JacobianRows::from_scalars(&distances),
            [
                "distances_by_state",
                "distances_by_inputs",
                "distances_by_parameters",
            ],
        ),
        (
            JacobianRows::from_scalars(&residuals),
            [
                "residuals_by_state",
                "residuals_by_inputs",
                "residuals_by_parameters",
            ],
        ),
        (
            JacobianRows::from_scalars(&residual_rates),
            [
                "residual_rates_by_state",
                "residual_rates_by_inputs",
                "residual_rates_by_parameters",
            ],
        ),
    ] {
        found.push(differentiate_by_variables(
            equations, &rows, by_state, false,
        ));
        found.push(differentiate_by_variables(
            equations, &rows, by_inputs, true,
        ));
        found.push(differentiate_by_parameters(
            equations,
            &rows,
            by_all_parameters,
        ));
    }
    let jumps: Vec<RowNodes> = (0..equations.impacts.len())
        .map(|impact| derive_impact_jump(equations, impact))
        .collect();
    let rows = stack_rows(equations, &jumps);
    found.push(differentiate_by_variables(
        equations,
        &rows,
        "jumps_by_state",
        false,
    ));
    found.push(differentiate_by_variables(
        equations,
        &rows,
        "jumps_by_inputs",
        true,
    ));
    found.push(differentiate_by_parameters(
        equations,
        &rows,
        "jumps_by_parameters",
    ));
    found.push(differentiate_by_time(equations, &rows, "jumps_by_time"));
    found
}

/// Returns the jump of the rates by an impact without friction, according to Newton's law of restitution.
fn derive_impact_jump(equations: &mut Equations, place: usize) -> RowNodes {
    let impact = &equations.impacts[place];
    let graph = &mut equations.graph;
    let one = graph.one();
    let factor = graph.combine(&[(-1.0, one), (-1.0, impact.restitution)]);
    let change = graph.multiply(factor, impact.rate);
    let impulse = graph.divide(change, impact.delassus[place]);
    let mut scale = |nodes: &[NodeId]| -> Vec<NodeId> {
        nodes
            .iter()
            .map(|node| graph.multiply(impulse, *node))
            .collect()
    };
    RowNodes {
        scalars: scale(&impact.column.scalars),
        modal: scale(&impact.column.modal),
    }
}
