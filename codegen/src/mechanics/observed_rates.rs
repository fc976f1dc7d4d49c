//! Observables and their time derivatives along the motion, with the derived accelerations.

use eomgen_model_spec::model::Observable;

use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::{DeriveError, Derived, Translator};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// Returns the node of an observable; if the observable is the time derivative of an expression, derives it.
pub(crate) fn derive_observable(
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
                "`{name}` contains a rate: its second derivative needs the time derivative of an acceleration"
            ),
            "use its first derivative, or an observable without rates",
        );
    }
    for _ in 0..rate.times {
        if can_jump(&translator.graph, node) {
            return refused(
                format!(
                    "the time derivative of `{name}` is not defined at jumps of `{name}` or of its rate"
                ),
                "use an observable without sign, above and contact; for a second derivative also without abs, min, max and deadzone",
            );
        }
        if translator.holds_input_without_rate(node) {
            return refused(
                format!(
                    "the time derivative of `{name}` needs the rate of an input, which is unknown"
                ),
                "add `rates = 2` to the entry of the input to provide its rates",
            );
        }
        node = translator.derive_rate_along_motion(node, accelerations)?;
    }
    Ok(node)
}

/// Returns true if a node can jump during the motion.
fn can_jump(graph: &Graph, node: NodeId) -> bool {
    let is_jump = |id: &NodeId| {
        if graph.dependence(*id).is_parameter_only() {
            return false;
        }
        match graph.operation(*id) {
            Operation::Call(function, _) => function.is_step(),
            Operation::Select { is_switch, .. } => *is_switch,
            _ => false,
        }
    };
    graph.reachable(&[node]).iter().any(is_jump)
}
