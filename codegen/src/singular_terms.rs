//! Terms of a model without a derivative at a point, such as `v/norm(v)` at rest. Each term is differentiated
//! along all variables at once, energies twice, because their first derivatives are forces.

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;

use crate::mechanics::equations::{Equations, derive};
use crate::mechanics::outputs::{Jacobian, JacobianBlock, Outputs};
use crate::program::evaluator::{Evaluator, Point};
use crate::program::lowering::lower_with_outputs;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Dependence, Graph, NodeId};

/// Returns the places of terms with a non-finite derivative at a point; `parameters` are the values of all
/// parameters in SI units.
///
/// # Errors
/// Expressions that cannot be derived.
pub fn without_derivative(
    model: &Model,
    orders: &[usize],
    parameters: &[f64],
    point: Point<'_>,
) -> Result<Vec<Span>, Diagnostics> {
    let found = |diagnostic| Diagnostics::one(model.source.clone(), diagnostic);
    let mut equations = derive(model, orders).map_err(|error| found(error.diagnostic()))?;
    let terms = terms(model, &equations);
    let mut entries = Vec::with_capacity(terms.len());
    for (row, term) in terms.iter().enumerate() {
        let mut value = term.node;
        for _ in 0..term.derivatives {
            value = along_everything(&mut equations.graph, value);
        }
        entries.push(JacobianBlock {
            row,
            rows: 1,
            column: 0,
            columns: 1,
            diagonal: false,
            value,
        });
    }
    let outputs = Outputs {
        jacobians: vec![Jacobian {
            name: "terms",
            rows: terms.len(),
            columns: 1,
            entries,
        }],
        ..Outputs::default()
    };
    let program = lower_with_outputs(model, &equations, parameters, &outputs);
    let mut values = vec![0.0; terms.len()];
    Evaluator::new(program).jacobian(0, point, &mut values);
    let singular = terms.iter().zip(values);
    let singular = singular.filter(|(_, value)| !value.is_finite());
    Ok(singular.map(|(term, _)| term.span).collect())
}

struct Term {
    node: NodeId,
    span: Span,
    /// Number of derivatives of the term in a Jacobian.
    derivatives: usize,
}

fn terms(model: &Model, equations: &Equations) -> Vec<Term> {
    let energies = model.kinetic.iter().chain(&model.potential);
    let energies = energies.chain(&model.dissipation);
    let energies = energies.map(|term| (term.value.span, 2));
    let forces = model.forces.iter().map(|force| (force.value.span, 1));
    let declared = energies.chain(forces).zip(&equations.terms);
    let rates = model.states.iter().map(|state| (state.rate.span, 1));
    let observables = model.observables.iter();
    let observables = observables.map(|observable| (observable.value.span, 1));
    declared
        .chain(rates.zip(&equations.state_rates))
        .chain(observables.zip(&equations.observables))
        .map(|((span, derivatives), node)| Term {
            node: *node,
            span,
            derivatives,
        })
        .collect()
}

/// Differentiates with a tangent of 1 for every variable.
fn along_everything(graph: &mut Graph, node: NodeId) -> NodeId {
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
