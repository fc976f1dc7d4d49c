//! What is derived on request, as nodes of the equations' graph: bias forces, inverse
//! dynamics, guards' rates, products with the Jacobian. Jacobians themselves are in
//! `jacobian`. The same structure, of values instead of nodes, is part of the program.

use crate::adjoint;
use crate::differentiate::Direction;
use crate::equations::{Equations, Rows};
use crate::graph::{Argument, Graph, Id, Operation, Space, Variable};
use crate::jacobian::{
    JacobianRows, by_parameters, by_variables, observable_rows, one_row, rate_rows,
};
use crate::matrix::StructuredMatrix;
use crate::matrix_derivatives::holds_moving_matrix;
use crate::regimes::{Switch, switches};
use crate::request::Request;
use crate::translate::along_motion;

/// What was requested, of nodes `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Requested<N, R> {
    /// What was asked for.
    pub requests: Vec<Request>,
    /// c - f
    pub bias_forces: Option<R>,
    /// M a + c - f, the accelerations a being an argument.
    pub inverse_dynamics: Option<R>,
    /// The rate of each guard along the motion.
    pub guard_rates: Option<Vec<N>>,
    /// Jacobians by state, inputs and parameters: of the rates, then of the observables.
    pub jacobians: Vec<Jacobian<N>>,
    /// Products with the Jacobian of the rates.
    pub products: Option<Products<N, R>>,
    /// What a regime decides in the accelerations.
    pub regimes: Option<Vec<Switch<N>>>,
}

impl<N, R> Default for Requested<N, R> {
    fn default() -> Self {
        Self {
            requests: Vec::new(),
            bias_forces: None,
            inverse_dynamics: None,
            guard_rates: None,
            jacobians: Vec::new(),
            products: None,
            regimes: None,
        }
    }
}

/// Products of the rates' Jacobian by state and inputs.
#[derive(Clone, Debug)]
pub struct Products<N, R> {
    /// The accelerations' rows of the product with a direction; those above are the rates'
    /// part of the direction.
    pub forward: R,
    /// For each variable, the product of the weights with its column, without what the
    /// rates' own rows add.
    pub reverse: Vec<(Variable, N)>,
    /// The product of the weights with the columns by parameters: a Jacobian of one row.
    pub by_parameters: Jacobian<N>,
}

/// A Jacobian by its structural nonzeros.
#[derive(Clone, Debug)]
pub struct Jacobian<N> {
    /// What it is: `rates_by_state` and so on.
    pub name: &'static str,
    /// How many rows.
    pub rows: usize,
    /// How many columns.
    pub columns: usize,
    /// Its blocks, by rows, then by columns; blocks of the same rows stand together.
    pub entries: Vec<Entry<N>>,
}

/// A block of structural nonzeros.
#[derive(Clone, Copy, Debug)]
pub struct Entry<N> {
    /// First row.
    pub row: usize,
    /// How many rows.
    pub rows: usize,
    /// First column.
    pub column: usize,
    /// How many columns.
    pub columns: usize,
    /// Whether only the diagonal is filled.
    pub diagonal: bool,
    /// A scalar, a vector over the rows or columns, or an assembled matrix.
    pub value: N,
}

impl<N> Entry<N> {
    /// How many nonzeros it has in each of its rows.
    pub fn width(&self) -> usize {
        if self.diagonal { 1 } else { self.columns }
    }
}

impl<N> Jacobian<N> {
    /// How many structural nonzeros there are.
    pub fn nonzeros(&self) -> usize {
        self.entries.iter().map(|e| e.rows * e.width()).sum()
    }

    /// Where the nonzeros of each entry begin, and how many there are in each of its rows
    /// with those of the other entries of these rows.
    pub fn places(&self) -> Vec<(usize, usize)> {
        let mut places = Vec::with_capacity(self.entries.len());
        let mut start = 0;
        for group in self.entries.chunk_by(|a, b| a.row == b.row) {
            let width: usize = group.iter().map(Entry::width).sum();
            let mut offset = 0;
            for entry in group {
                places.push((start + offset, width));
                offset += entry.width();
            }
            start += group[0].rows * width;
        }
        places
    }
}

/// Derives what is requested.
///
/// # Errors
/// If the modal mass matrix is dense and moves with the state: products and Jacobians are not
/// derived then.
pub fn requested(
    equations: &mut Equations,
    requests: &[Request],
) -> Result<Requested<Id, Rows>, MovingMatrix> {
    let mut result = Requested {
        requests: requests.to_vec(),
        ..Requested::default()
    };
    let has = |request| requests.contains(&request);
    let differentiated =
        has(Request::Jacobians) || has(Request::Products) || has(Request::Linearisation);
    if differentiated {
        let mut roots = equations.accelerations.rows.nodes();
        roots.extend(&equations.observables);
        roots.push(equations.power);
        if holds_moving_matrix(&equations.graph, &roots) {
            return Err(MovingMatrix);
        }
    }
    if has(Request::BiasForces) || has(Request::InverseDynamics) {
        let bias = bias_forces(equations);
        result.inverse_dynamics =
            has(Request::InverseDynamics).then(|| inverse_dynamics(equations, &bias));
        result.bias_forces = has(Request::BiasForces).then_some(bias);
    }
    result.guard_rates = has(Request::GuardRates).then(|| guard_rates(equations));
    if has(Request::Jacobians) || has(Request::Linearisation) {
        result.jacobians = jacobians(equations);
    }
    result.products = has(Request::Products).then(|| products(equations));
    result.regimes = has(Request::Regimes).then(|| switches(equations));
    Ok(result)
}

/// Why Jacobians could not be derived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovingMatrix;

impl std::fmt::Display for MovingMatrix {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("no Jacobian: the modal mass matrix is dense and moves with the state")
    }
}

impl std::error::Error for MovingMatrix {}

fn bias_forces(equations: &mut Equations) -> Rows {
    let graph = &mut equations.graph;
    let pairs = |terms: &[Id], forces: &[Id], graph: &mut Graph| -> Vec<Id> {
        let rows = terms.iter().zip(forces);
        rows.map(|(c, f)| graph.combine(&[(1.0, *c), (-1.0, *f)]))
            .collect()
    };
    let (terms, forces) = (&equations.velocity_terms, &equations.forces);
    Rows {
        scalars: pairs(&terms.scalars, &forces.scalars, graph),
        modal: pairs(&terms.modal, &forces.modal, graph),
    }
}

/// The rows of M a + bias, with a from the argument.
fn inverse_dynamics(equations: &mut Equations, bias: &Rows) -> Rows {
    let (graph, mass) = (&mut equations.graph, &equations.mass);
    let argument = |graph: &mut Graph, variable| {
        graph.intern(Operation::Argument(Argument::Accelerations, variable))
    };
    let scalars: Vec<Id> = (0..bias.scalars.len())
        .map(|index| argument(graph, Variable::Coordinate(index)))
        .collect();
    let modal: Vec<Id> = (0..bias.modal.len())
        .map(|field| argument(graph, Variable::ModeCoordinates(field)))
        .collect();
    let mut rows = bias.clone();
    for (row, slot) in rows.scalars.iter_mut().enumerate() {
        let mut terms = vec![(1.0, *slot)];
        for (entry, a) in mass.scalars[row].iter().zip(&scalars) {
            terms.push((1.0, graph.multiply(*entry, *a)));
        }
        for (field, entry) in mass.coupling[row].iter().enumerate() {
            let product = graph.multiply(*entry, modal[field]);
            terms.push((1.0, graph.total_over(Space::Modes(field), product)));
        }
        *slot = graph.combine(&terms);
    }
    for (field, slot) in rows.modal.iter_mut().enumerate() {
        let mut terms = vec![(1.0, *slot)];
        for (coupling, a) in mass.coupling.iter().zip(&scalars) {
            terms.push((1.0, graph.multiply(coupling[field], *a)));
        }
        for (block, a) in mass.modal[field].iter().zip(&modal) {
            terms.extend(times(graph, block, *a).into_iter().map(|term| (1.0, term)));
        }
        *slot = graph.combine(&terms);
    }
    rows
}

/// The parts of matrix times vector.
fn times(graph: &mut Graph, matrix: &StructuredMatrix, vector: Id) -> Vec<Id> {
    let mut parts = Vec::new();
    if let Some(diagonal) = matrix.diagonal {
        parts.push(graph.multiply(diagonal, vector));
    }
    for &(u, v) in &matrix.outer {
        let product = graph.multiply(v, vector);
        let total = graph.total_over(matrix.columns, product);
        parts.push(graph.multiply(u, total));
    }
    for part in &matrix.matrices {
        let scaled = graph.multiply(part.column, vector);
        let product = graph.apply(part.matrix, part.transposed, scaled);
        parts.push(graph.multiply(part.row, product));
    }
    parts
}

/// The rates of the guards along the motion, the inputs held.
fn guard_rates(equations: &mut Equations) -> Vec<Id> {
    let rows = equations.accelerations.rows.clone();
    let tangent = move |graph: &mut Graph, leaf: Id| match *graph.operation(leaf) {
        Operation::Rate(index) => rows.scalars[index],
        Operation::ModeRates(field) => rows.modal[field],
        _ => along_motion(graph, leaf),
    };
    let mut direction = Direction::new(&tangent);
    let graph = &mut equations.graph;
    let guards = equations.guards.iter();
    guards
        .map(|guard| direction.derivative(graph, guard.value))
        .collect()
}

fn products(equations: &mut Equations) -> Products<Id, Rows> {
    let rows = equations.accelerations.rows.clone();
    let tangent = |graph: &mut Graph, leaf: Id| match variable_of(graph, leaf) {
        Some(variable) => graph.intern(Operation::Argument(Argument::Direction, variable)),
        None => graph.zero(),
    };
    let graph = &mut equations.graph;
    let mut direction = Direction::new(&tangent);
    let forward = Rows {
        scalars: derivatives(graph, &mut direction, &rows.scalars),
        modal: derivatives(graph, &mut direction, &rows.modal),
    };
    let mut weighted = Vec::new();
    for (index, row) in rows.scalars.iter().enumerate() {
        weighted.push((weight(graph, Variable::Rate(index)), *row));
    }
    for (field, row) in rows.modal.iter().enumerate() {
        weighted.push((weight(graph, Variable::ModeRates(field)), *row));
    }
    let gradient = adjoint::gradient(graph, &weighted);
    let mut reverse: Vec<(Variable, Id)> = gradient
        .into_iter()
        .filter_map(|(leaf, node)| Some((variable_of(graph, leaf)?, node)))
        .collect();
    reverse.sort_by_key(|(_, node)| *node);
    Products {
        forward,
        reverse,
        by_parameters: weighted_by_parameters(equations, &rows, &weighted),
    }
}

/// The gradient of the weighted rates by the independent parameters: backward where it can be,
/// one parameter after the other where matrices hold them.
fn weighted_by_parameters(
    equations: &mut Equations,
    rows: &Rows,
    weighted: &[(Id, Id)],
) -> Jacobian<Id> {
    const NAME: &str = "weighted_rates_by_parameters";
    let graph = &mut equations.graph;
    match adjoint::gradient_by_parameters(graph, weighted, &equations.derived_parameters) {
        Some(gradient) => one_row(graph, NAME, &gradient),
        None => {
            let sum = JacobianRows::single(weighted_sum(graph, rows));
            by_parameters(equations, &sum, NAME)
        }
    }
}

/// The sum of weights times accelerations, the rows of the rates that hold parameters.
fn weighted_sum(graph: &mut Graph, rows: &Rows) -> Id {
    let mut terms = Vec::new();
    for (index, row) in rows.scalars.iter().enumerate() {
        let weight = weight(graph, Variable::Rate(index));
        terms.push((1.0, graph.multiply(weight, *row)));
    }
    for (field, row) in rows.modal.iter().enumerate() {
        let weight = weight(graph, Variable::ModeRates(field));
        let product = graph.multiply(weight, *row);
        terms.push((1.0, graph.total_over(Space::Modes(field), product)));
    }
    graph.combine(&terms)
}

fn derivatives(graph: &mut Graph, direction: &mut Direction<'_>, nodes: &[Id]) -> Vec<Id> {
    nodes
        .iter()
        .map(|node| direction.derivative(graph, *node))
        .collect()
}

fn weight(graph: &mut Graph, variable: Variable) -> Id {
    graph.intern(Operation::Argument(Argument::Weights, variable))
}

fn variable_of(graph: &Graph, leaf: Id) -> Option<Variable> {
    Some(match *graph.operation(leaf) {
        Operation::Coordinate(index) => Variable::Coordinate(index),
        Operation::ModeCoordinates(field) => Variable::ModeCoordinates(field),
        Operation::Rate(index) => Variable::Rate(index),
        Operation::ModeRates(field) => Variable::ModeRates(field),
        Operation::Input(index) => Variable::Input(index),
        _ => return None,
    })
}

fn jacobians(equations: &mut Equations) -> Vec<Jacobian<Id>> {
    let (rates, observables) = (rate_rows(equations), observable_rows(equations));
    vec![
        by_variables(equations, &rates, "rates_by_state", false),
        by_variables(equations, &rates, "rates_by_inputs", true),
        by_parameters(equations, &rates, "rates_by_parameters"),
        by_variables(equations, &observables, "observables_by_state", false),
        by_variables(equations, &observables, "observables_by_inputs", true),
        by_parameters(equations, &observables, "observables_by_parameters"),
    ]
}
