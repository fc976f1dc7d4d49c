//! Terms of a model that are not differentiable at a point, such as `v/norm(v)` at rest. Each term is differentiated
//! along all variables at once. Energies are differentiated twice, because their first derivatives are forces.

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;

use crate::mechanics::equations::{Equations, derive};
use crate::mechanics::outputs::{Jacobian, JacobianBlock, Outputs};
use crate::program::evaluator::{Evaluator, Point};
use crate::program::lowering::lower_with_outputs;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Variable};

/// A term without a finite value or derivative at a point.
pub struct SingularTerm {
    /// Position of the expression in the text.
    pub span: Span,
    /// Kind and name, such as "force `drag`".
    pub name: String,
    /// False if the value of the term is infinite or NaN.
    pub has_value: bool,
    /// Variables with an infinite or NaN derivative of the term.
    pub by: Vec<Variable>,
    /// All variables that the term depends on.
    pub of: Vec<Variable>,
}

/// Returns the terms whose values or derivatives at a point are not finite; `parameters` are the values of all
/// parameters in SI units.
///
/// # Errors
/// Expressions that cannot be derived.
pub fn find_singular_terms(
    model: &Model,
    orders: &[usize],
    parameters: &[f64],
    point: Point<'_>,
) -> Result<Vec<SingularTerm>, Diagnostics> {
    let found = |diagnostic| Diagnostics::from_one(model.source.clone(), diagnostic);
    let mut equations = derive(model, orders).map_err(|error| found(error.diagnostic()))?;
    let mut terms = collect_terms(model, &equations);
    let mut nodes = Vec::with_capacity(2 * terms.len());
    for term in &terms {
        let mut value = term.node;
        for _ in 0..term.derivatives {
            value = differentiate_along_all(&mut equations.graph, value);
        }
        nodes.extend([term.node, value]);
    }
    let values = evaluate(model, &equations, parameters, point, &nodes);
    let mut values = values.chunks(2);
    terms.retain(|_| {
        values
            .next()
            .is_some_and(|pair| pair.iter().any(|value| !value.is_finite()))
    });
    let mut singular = Vec::with_capacity(terms.len());
    for term in terms {
        let of = find_variables(&equations.graph, term.node);
        let mut nodes = vec![term.node];
        for variable in &of {
            let mut value = differentiate_along(&mut equations.graph, *variable, term.node);
            for _ in 1..term.derivatives {
                value = differentiate_along_all(&mut equations.graph, value);
            }
            nodes.push(value);
        }
        let values = evaluate(model, &equations, parameters, point, &nodes);
        let derivatives = of.iter().zip(&values[1..]);
        let by = derivatives.filter(|(_, value)| !value.is_finite());
        let by = by.map(|(variable, _)| *variable).collect();
        singular.push(SingularTerm {
            span: term.span,
            name: term.name,
            has_value: values[0].is_finite(),
            by,
            of,
        });
    }
    Ok(singular)
}

/// Returns the values of scalar nodes at a point.
fn evaluate(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
    point: Point<'_>,
    nodes: &[NodeId],
) -> Vec<f64> {
    let entry = |(row, value): (usize, &NodeId)| JacobianBlock {
        row,
        rows: 1,
        column: 0,
        columns: 1,
        diagonal: false,
        value: *value,
    };
    let outputs = Outputs {
        jacobians: vec![Jacobian {
            name: "terms",
            rows: nodes.len(),
            columns: 1,
            entries: nodes.iter().enumerate().map(entry).collect(),
        }],
        ..Outputs::default()
    };
    let program = lower_with_outputs(model, equations, parameters, &outputs);
    let mut values = vec![0.0; nodes.len()];
    Evaluator::new(program).jacobian(0, point, &mut values);
    values
}

struct Term {
    node: NodeId,
    span: Span,
    name: String,
    /// Number of differentiations up to the Jacobian: 2 for energies, else 1.
    derivatives: usize,
}

fn collect_terms(model: &Model, equations: &Equations) -> Vec<Term> {
    let energies = [
        ("kinetic energy", &model.kinetic),
        ("potential energy", &model.potential),
        ("dissipation", &model.dissipation),
    ];
    let energies = energies.into_iter().flat_map(|(kind, terms)| {
        let named = move |name: &String| format!("{kind} `{name}`");
        let terms = terms.iter();
        terms.map(move |term| (term.value.span, named(&term.name), 2))
    });
    let forces = model.forces.iter();
    let forces = forces.map(|force| (force.value.span, format!("force `{}`", force.name), 1));
    let declared = energies.chain(forces).zip(&equations.terms);
    let rates = model.states.iter();
    let rates = rates.map(|state| (state.rate.span, format!("rate of `{}`", state.name), 1));
    let observables = model.observables.iter();
    let observables = observables.map(|observable| {
        let name = format!("observable `{}`", observable.name);
        (observable.value.span, name, 1)
    });
    declared
        .chain(rates.zip(&equations.state_rates))
        .chain(observables.zip(&equations.observables))
        .map(|((span, name, derivatives), node)| Term {
            node: *node,
            span,
            name,
            derivatives,
        })
        .collect()
}

/// Returns the variables that a node depends on, without parameters and time.
fn find_variables(graph: &Graph, node: NodeId) -> Vec<Variable> {
    let reachable = graph.reachable(&[node]).into_iter();
    reachable
        .filter_map(|id| match *graph.operation(id) {
            Operation::Coordinate(index) => Some(Variable::Coordinate(index)),
            Operation::ModeCoordinates(field) => Some(Variable::ModeCoordinates(field)),
            Operation::Rate(index) => Some(Variable::Rate(index)),
            Operation::ModeRates(field) => Some(Variable::ModeRates(field)),
            Operation::State(index) => Some(Variable::State(index)),
            Operation::Input(index) => Some(Variable::Input(index)),
            _ => None,
        })
        .collect()
}

/// Returns the derivative of a node by one variable; for a field, the sum of the derivatives by all its modes.
fn differentiate_along(graph: &mut Graph, variable: Variable, node: NodeId) -> NodeId {
    let variable = graph.variable(variable);
    let tangent = |graph: &mut Graph, leaf: NodeId| match leaf == variable {
        true => graph.one(),
        false => graph.zero(),
    };
    Direction::new(&tangent).derivative(graph, node)
}

/// Returns the sum of the derivatives of a node by all variables.
fn differentiate_along_all(graph: &mut Graph, node: NodeId) -> NodeId {
    let tangent = |graph: &mut Graph, leaf: NodeId| {
        let variables = [
            Dependence::COORDINATE,
            Dependence::RATE,
            Dependence::STATE,
            Dependence::INPUT,
        ];
        let moves = variables
            .into_iter()
            .any(|kind| graph.dependence(leaf).has(kind));
        if moves { graph.one() } else { graph.zero() }
    };
    Direction::new(&tangent).derivative(graph, node)
}
