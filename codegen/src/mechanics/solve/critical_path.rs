//! What waits for an elementary function, moved to the end of an acceleration: in
//! c (a + k sin(x)) with prepared c and k the result waits for three operations after the
//! sine, in c a + (c k) sin(x) for two, and the rest is done by then. No operation is added.
//! Neither is one
//! by opening c (a + k b) to c a + (c k) b.

use std::collections::HashMap;

use crate::mechanics::rows::Rows;
use crate::symbolic::graph::{Graph, Id, Operation, Shape};

/// The rows with the late terms of each coordinate's pulled out of its products.
pub(super) fn late_terms_last(graph: &mut Graph, rows: &Rows) -> Rows {
    let uses = graph.uses(&rows.nodes());
    let scalars = rows
        .scalars
        .iter()
        .map(|&row| {
            if uses.get(&row).is_some_and(|uses| *uses > 0) || graph.waits(row) == 0 {
                return row;
            }
            let one = graph.one();
            let mut parts = Vec::new();
            pull_out(graph, &uses, (1.0, one), row, &mut parts);
            let waits = graph.waits(row);
            let terms = terms_by_scale(graph, &uses, waits, parts);
            graph.combine(&terms)
        })
        .collect();
    Rows {
        scalars,
        modal: rows.modal.clone(),
    }
}

/// factor scale node, the scale being prepared.
struct Part {
    factor: f64,
    scale: Id,
    node: Id,
}

/// Opens the sums of a product with the scale, down to what waits no less than all of it.
fn pull_out(
    graph: &mut Graph,
    uses: &HashMap<Id, usize>,
    (factor, scale): (f64, Id),
    node: Id,
    parts: &mut Vec<Part>,
) {
    let waits = graph.waits(node);
    let shared = uses.get(&node).is_some_and(|uses| *uses > 1);
    match graph.operation(node).clone() {
        Operation::Sum(terms) if waits > 0 && !shared => {
            for (c, term) in &terms {
                pull_out(graph, uses, (factor * c.value(), scale), *term, parts);
            }
        }
        Operation::Product(factors) if waits > 0 && !shared => {
            let (prepared, moving): (Vec<_>, Vec<_>) = factors
                .iter()
                .partition(|(id, _)| graph.dependence(*id).is_prepared());
            match moving.as_slice() {
                [(sum, 1)] if graph.shape(*sum) == Shape::Scalar => {
                    let prepared = graph.product(&prepared);
                    let scale = graph.multiply(scale, prepared);
                    pull_out(graph, uses, (factor, scale), *sum, parts);
                }
                _ => parts.push(Part {
                    factor,
                    scale,
                    node,
                }),
            }
        }
        _ => parts.push(Part {
            factor,
            scale,
            node,
        }),
    }
}

/// The parts as terms of a sum: late ones and those that take their scale for nothing each by
/// itself, the others collected by their scale.
fn terms_by_scale(
    graph: &mut Graph,
    uses: &HashMap<Id, usize>,
    waits: u32,
    parts: Vec<Part>,
) -> Vec<(f64, Id)> {
    let mut terms = Vec::new();
    let mut early: Vec<(Id, Vec<(f64, Id)>)> = Vec::new();
    for part in parts {
        if graph.waits(part.node) == waits {
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
        let (free, bound): (Vec<_>, Vec<_>) = opened(graph, uses, collected)
            .into_iter()
            .partition(|(_, node)| takes_a_scale(graph, uses, *node));
        for (factor, node) in free {
            terms.push((factor, graph.multiply(scale, node)));
        }
        if !bound.is_empty() {
            terms.push(scaled_sum(graph, scale, &bound));
        }
    }
    terms
}

/// The terms, sums that nothing else needs replaced by theirs if all of these take a scale.
fn opened(graph: &Graph, uses: &HashMap<Id, usize>, terms: Vec<(f64, Id)>) -> Vec<(f64, Id)> {
    let mut all = Vec::new();
    for (factor, node) in terms {
        let shared = uses.get(&node).is_some_and(|uses| *uses > 1);
        match graph.operation(node) {
            Operation::Sum(inner)
                if !shared && inner.iter().all(|(_, id)| takes_a_scale(graph, uses, *id)) =>
            {
                all.extend(inner.iter().map(|(c, id)| (factor * c.value(), *id)));
            }
            _ => all.push((factor, node)),
        }
    }
    all
}

/// Whether a term can be scaled for nothing: it is prepared, or has a prepared factor and is not
/// needed as it is. So scaled it may be what another row has.
fn takes_a_scale(graph: &Graph, uses: &HashMap<Id, usize>, node: Id) -> bool {
    let prepared = |id: Id| graph.dependence(id).is_prepared();
    let shared = uses.get(&node).is_some_and(|uses| *uses > 1);
    let has_a_factor = match graph.operation(node) {
        Operation::Product(factors) => factors.iter().any(|(factor, _)| prepared(*factor)),
        _ => false,
    };
    prepared(node) || (has_a_factor && !shared)
}

/// The scaled sum of terms as one term, with the sign in front if all of them are negative.
fn scaled_sum(graph: &mut Graph, scale: Id, terms: &[(f64, Id)]) -> (f64, Id) {
    let negative = terms.iter().all(|(c, _)| *c < 0.0);
    let sign = if negative { -1.0 } else { 1.0 };
    let terms: Vec<(f64, Id)> = terms.iter().map(|(c, id)| (sign * c, *id)).collect();
    let sum = graph.combine(&terms);
    (sign, graph.multiply(scale, sum))
}
