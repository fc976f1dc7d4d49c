//! Rejection of constraints that no state satisfies, by interval bounds of their expressions.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::interval::Interval;
use eomgen_model_spec::model::{Constraint, Model};

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Rejects constraints whose expression has the same sign at all states, times and inputs. `residuals` are the
/// expressions; `parameters` are the values of all parameters in SI units.
///
/// # Errors
/// The first such constraint, with the bound of its expression.
pub(crate) fn check_signs(
    model: &Model,
    graph: &Graph,
    residuals: &[NodeId],
    parameters: &[f64],
) -> Result<(), Diagnostic> {
    let bounds = bounds(graph, &graph.reachable(residuals), parameters);
    for (constraint, residual) in model.constraints.iter().zip(residuals) {
        let Interval { low, high } = bounds[residual.0 as usize];
        if low > 0.0 {
            return Err(describe_never_zero(constraint, "least", low));
        }
        if high < 0.0 {
            return Err(describe_never_zero(constraint, "most", high));
        }
    }
    Ok(())
}

fn describe_never_zero(constraint: &Constraint, end: &str, bound: f64) -> Diagnostic {
    let (name, unit) = (&constraint.name, &constraint.unit);
    Diagnostic::error(format!("the constraint `{name}` is never zero"))
        .with_span(
            constraint.zero.span,
            format!("is at {end} {bound:.3e} {unit} at every state"),
        )
        .with_help("correct its expression, for example a sign, so that it can be zero")
}

/// Returns the bounds of `nodes` (operands first), indexed by node.
fn bounds(graph: &Graph, nodes: &[NodeId], parameters: &[f64]) -> Vec<Interval> {
    let size = nodes.last().map_or(0, |last| last.0 as usize + 1);
    let mut known = vec![Interval::ALL; size];
    for &node in nodes {
        known[node.0 as usize] = bound(graph.operation(node), parameters, &known);
    }
    known
}

fn bound(operation: &Operation, parameters: &[f64], known: &[Interval]) -> Interval {
    let of = |node: &NodeId| known[node.0 as usize];
    let exactly = |value: f64| Interval::from_ends(value, value);
    match operation {
        Operation::Constant(value) => exactly(value.value()),
        Operation::Parameter(index) => {
            let value = parameters.get(index.index());
            value.map_or(Interval::ALL, |value| exactly(*value))
        }
        Operation::Sum(terms) => {
            let terms = terms.iter();
            let scaled = terms.map(|(factor, term)| exactly(factor.value()).multiply(of(term)));
            scaled.fold(exactly(0.0), Interval::add_interval)
        }
        Operation::Product(factors) => {
            let factors = factors.iter();
            let powers = factors.map(|(factor, power)| of(factor).raise(f64::from(*power)));
            powers.fold(exactly(1.0), Interval::multiply)
        }
        Operation::Call(function, arguments) => {
            let arguments: Vec<Interval> = arguments.iter().map(of).collect();
            Interval::apply_function(*function, &arguments)
        }
        Operation::Select {
            then, otherwise, ..
        } => of(then).hull(of(otherwise)),
        _ => Interval::ALL,
    }
}
