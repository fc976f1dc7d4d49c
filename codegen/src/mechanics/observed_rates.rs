//! Observables and their time derivatives along the motion. Rates of coordinates change with the
//! accelerations that were solved for.

use eomgen_model_spec::model::{Function, Observable};

use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::{DeriveError, Derived, Translator};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// The node of an observable, or of the time derivative that it is.
pub(crate) fn observed(
    translator: &mut Translator,
    observable: &Observable,
    accelerations: &RowNodes,
) -> Derived<NodeId> {
    let mut node = translator.node(&observable.value)?;
    let Some(rate) = observable.rate_of else {
        return Ok(node);
    };
    let name = &translator.model.observables[rate.observable].name;
    let refused = |message: String, help: &str| {
        Err(DeriveError {
            span: observable.span,
            message,
            help: Some(help.to_owned()),
        })
    };
    if rate.times > 1 && translator.graph.dependence(node).has(Dependence::RATE) {
        return refused(
            format!(
                "`{name}` holds a rate, so that its second derivative needs the rate of an acceleration"
            ),
            "measure its first derivative, or an observable of positions",
        );
    }
    for _ in 0..rate.times {
        if jumps(&translator.graph, node) {
            return refused(
                format!(
                    "the time derivative of `{name}` is not defined where it jumps, or where its rate does"
                ),
                "measure an observable without sign, above, contact, and of a second derivative without abs, min, max and deadzone",
            );
        }
        if translator.holds_input_without_rate(node) {
            return refused(
                format!(
                    "the time derivative of `{name}` needs the rate of an input, which is not known"
                ),
                "`rates = 2` in the input's entry says that its rates are given as well",
            );
        }
        node = translator.rate_along_motion(node, accelerations)?;
    }
    Ok(node)
}

/// Returns true if a node may jump as the motion goes on.
fn jumps(graph: &Graph, node: NodeId) -> bool {
    let is_jump = |id: &NodeId| {
        if graph.dependence(*id).is_parameter_only() {
            return false;
        }
        match graph.operation(*id) {
            Operation::Call(function, _) => {
                matches!(
                    function,
                    Function::Sign | Function::Above | Function::Contact
                )
            }
            Operation::Select { .. } => true,
            _ => false,
        }
    };
    graph.reachable(&[node]).iter().any(is_jump)
}
