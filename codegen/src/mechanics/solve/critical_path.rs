//! Shortening of the critical path of an acceleration. An elementary function has the latency of about a dozen
//! additions, so terms with such a function are added last. For example, c and k depend only on parameters. Then
//! three operations follow the sine in c (a + k sin(x)), but two in c a + (c k) sin(x), because the rest is computed
//! earlier. The number of operations stays the same.

use std::collections::HashMap;

use crate::mechanics::rows::RowNodes;
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};

/// Pulls the terms on the critical path out of the products in the acceleration of each coordinate.
pub(super) fn shorten_critical_path(graph: &mut Graph, rows: &RowNodes) -> RowNodes {
    let uses = graph.uses(&rows.nodes());
    let scalars = rows
        .scalars
        .iter()
        .map(|&row| {
            if uses.get(&row).is_some_and(|uses| *uses > 0) || graph.critical_path(row) == 0 {
                return row;
            }
            let one = graph.one();
            let mut parts = Vec::new();
            pull_out(graph, &uses, (1.0, one), row, &mut parts);
            let critical_path = graph.critical_path(row);
            let terms = collect_terms_by_scale(graph, &uses, critical_path, parts);
            graph.combine(&terms)
        })
        .collect();
    RowNodes {
        scalars,
        modal: rows.modal.clone(),
    }
}

/// Term factor * scale * node, with a scale of parameters.
struct ScaledTerm {
    factor: f64,
    scale: NodeId,
    node: NodeId,
}

/// Expands scale * node along the critical path into terms and adds these to `parts`.
fn pull_out(
    graph: &mut Graph,
    uses: &HashMap<NodeId, usize>,
    (factor, scale): (f64, NodeId),
    node: NodeId,
    parts: &mut Vec<ScaledTerm>,
) {
    let critical_path = graph.critical_path(node);
    let shared = uses.get(&node).is_some_and(|uses| *uses > 1);
    match graph.operation(node).clone() {
        Operation::Sum(terms) if critical_path > 0 && !shared => {
            for (c, term) in &terms {
                pull_out(graph, uses, (factor * c.value(), scale), *term, parts);
            }
        }
        Operation::Product(factors) if critical_path > 0 && !shared => {
            let (parameter_only, moving): (Vec<_>, Vec<_>) = factors
                .iter()
                .partition(|(id, _)| graph.dependence(*id).is_parameter_only());
            match moving.as_slice() {
                [(sum, 1)] if graph.shape(*sum) == Shape::Scalar => {
                    let parameter_only = graph.product(&parameter_only);
                    let scale = graph.multiply(scale, parameter_only);
                    pull_out(graph, uses, (factor, scale), *sum, parts);
                }
                _ => parts.push(ScaledTerm {
                    factor,
                    scale,
                    node,
                }),
            }
        }
        _ => parts.push(ScaledTerm {
            factor,
            scale,
            node,
        }),
    }
}

/// Returns the parts as terms of a sum. Terms on the critical path and terms that absorb their scale stay
/// separate; the others are collected by their scale.
fn collect_terms_by_scale(
    graph: &mut Graph,
    uses: &HashMap<NodeId, usize>,
    critical_path: u32,
    parts: Vec<ScaledTerm>,
) -> Vec<(f64, NodeId)> {
    let mut terms = Vec::new();
    let mut early: Vec<(NodeId, Vec<(f64, NodeId)>)> = Vec::new();
    for part in parts {
        if graph.critical_path(part.node) == critical_path {
            terms.push((part.factor, graph.multiply(part.scale, part.node)));
            continue;
        }
        let term = (part.factor, part.node);
        match early.iter_mut().find(|(scale, _)| *scale == part.scale) {
            Some((_, collected)) => collected.push(term),
            None => early.push((part.scale, vec![term])),
        }
    }
    for (scale, collected) in early {
        let (free, bound): (Vec<_>, Vec<_>) = expand_sums(graph, uses, collected)
            .into_iter()
            .partition(|(_, node)| absorbs_scale(graph, uses, *node));
        for (factor, node) in free {
            terms.push((factor, graph.multiply(scale, node)));
        }
        if !bound.is_empty() {
            terms.push(build_scaled_sum(graph, scale, &bound));
        }
    }
    terms
}

/// Expands sums with one use if all their terms absorb a scale.
fn expand_sums(
    graph: &Graph,
    uses: &HashMap<NodeId, usize>,
    terms: Vec<(f64, NodeId)>,
) -> Vec<(f64, NodeId)> {
    let mut all = Vec::new();
    for (factor, node) in terms {
        let shared = uses.get(&node).is_some_and(|uses| *uses > 1);
        match graph.operation(node) {
            Operation::Sum(inner)
                if !shared && inner.iter().all(|(_, id)| absorbs_scale(graph, uses, *id)) =>
            {
                all.extend(inner.iter().map(|(c, id)| (factor * c.value(), *id)));
            }
            _ => all.push((factor, node)),
        }
    }
    all
}

/// Returns true if a term can be multiplied by the scale without an additional operation: it depends only on
/// parameters, or it has a factor of parameters and no other use.
fn absorbs_scale(graph: &Graph, uses: &HashMap<NodeId, usize>, node: NodeId) -> bool {
    let parameter_only = |id: NodeId| graph.dependence(id).is_parameter_only();
    let shared = uses.get(&node).is_some_and(|uses| *uses > 1);
    let has_a_factor = match graph.operation(node) {
        Operation::Product(factors) => factors.iter().any(|(factor, _)| parameter_only(*factor)),
        _ => false,
    };
    parameter_only(node) || (has_a_factor && !shared)
}

/// Returns the scaled sum of terms as one term; if all terms are negative, its factor is -1.
fn build_scaled_sum(graph: &mut Graph, scale: NodeId, terms: &[(f64, NodeId)]) -> (f64, NodeId) {
    let negative = terms.iter().all(|(c, _)| *c < 0.0);
    let sign = if negative { -1.0 } else { 1.0 };
    let terms: Vec<(f64, NodeId)> = terms.iter().map(|(c, id)| (sign * c, *id)).collect();
    let sum = graph.combine(&terms);
    (sign, graph.multiply(scale, sum))
}
