//! Extraction of common factors of sums. Inner sums that are used once are expanded first, because their terms can be
//! equal to other terms.

use std::collections::{BTreeMap, HashMap};

use eomgen_model_spec::model::Function;

use crate::symbolic::association::{MAX_FACTORS, count_shared_operations};
use crate::symbolic::graph::{Graph, NodeId, Operation, Shape};
use crate::symbolic::substitute::substitute;

type Terms = Vec<(f64, NodeId)>;

/// Extracts common factors of sums if this saves operations.
pub(crate) fn factor_if_cheaper(graph: &mut Graph, roots: Vec<NodeId>) -> Vec<NodeId> {
    let other = factor_common(graph, &roots);
    if count_shared_operations(graph, &other) < count_shared_operations(graph, &roots) {
        other
    } else {
        roots
    }
}

/// Extracts common factors in all sums that the roots depend on.
fn factor_common(graph: &mut Graph, roots: &[NodeId]) -> Vec<NodeId> {
    let mut uses = graph.uses(roots);
    for root in roots {
        *uses.entry(*root).or_insert(0) += 2;
    }
    let mut known: HashMap<NodeId, NodeId> = HashMap::new();
    let mut opened: HashMap<NodeId, Terms> = HashMap::new();
    for id in graph.reachable(roots) {
        if graph.dependence(id).is_parameter_only() {
            known.insert(id, id);
            continue;
        }
        let result = match graph.operation(id).clone() {
            Operation::Sum(terms) if graph.shape(id) == Shape::Scalar => {
                let mut all = Terms::new();
                for (factor, term) in terms {
                    match opened.get(&term) {
                        Some(inner) => {
                            all.extend(inner.iter().map(|(c, term)| (factor.value() * c, *term)));
                        }
                        None => all.push((factor.value(), known[&term])),
                    }
                }
                if uses.get(&id) == Some(&1) {
                    opened.insert(id, all.clone());
                }
                sum(graph, &all)
            }
            _ => substitute(graph, id, &|_, _| None, &mut known),
        };
        known.insert(id, result);
    }
    roots.iter().map(|root| known[root]).collect()
}

/// Builds a sum of terms. Terms that differ only in factors of parameters and numbers are collected: a x + b x = (a +
/// b) x.
pub(crate) fn collect_terms(graph: &mut Graph, terms: &[(f64, NodeId)]) -> NodeId {
    let mut by_live: BTreeMap<NodeId, Terms> = BTreeMap::new();
    for &(c, term) in terms {
        let (prepared, live) = match graph.operation(term).clone() {
            Operation::Product(factors) => {
                let prepared = |(id, _): &(NodeId, i32)| graph.dependence(*id).is_parameter_only();
                let (prepared, live): (Vec<_>, Vec<_>) = factors.iter().partition(|f| prepared(f));
                (graph.product(&prepared), graph.product(&live))
            }
            _ if graph.dependence(term).is_parameter_only() => (term, graph.one()),
            _ => (graph.one(), term),
        };
        by_live.entry(live).or_default().push((c, prepared));
    }
    let terms: Terms = by_live
        .into_iter()
        .map(|(live, prepared)| match prepared.as_slice() {
            [(c, prepared)] => (*c, graph.multiply(*prepared, live)),
            several => {
                let factor = graph.combine(several);
                (1.0, graph.multiply(factor, live))
            }
        })
        .collect();
    graph.combine(&terms)
}

/// Builds a sum of terms and extracts the most frequent factor first.
fn sum(graph: &mut Graph, terms: &[(f64, NodeId)]) -> NodeId {
    let combined = graph.combine(terms);
    let Operation::Sum(terms) = graph.operation(combined).clone() else {
        return combined;
    };
    let terms: Terms = terms.iter().map(|(c, term)| (c.value(), *term)).collect();
    let combined = collect_terms(graph, &terms);
    let mut terms: Terms = match graph.operation(combined) {
        Operation::Sum(terms) => terms.iter().map(|(c, term)| (c.value(), *term)).collect(),
        _ => return combined,
    };
    while let Some(factor) = find_most_common_factor(graph, &terms) {
        let mut rests = Terms::new();
        let mut others = Terms::new();
        for (c, term) in terms {
            if find_live_factors(graph, term).contains(&factor) {
                rests.push((c, graph.divide(term, factor)));
            } else {
                others.push((c, term));
            }
        }
        let inner = sum(graph, &rests);
        let product = graph.multiply(factor, inner);
        others.push((1.0, product));
        terms = others;
    }
    graph.combine(&terms)
}

/// Returns the most frequent factor of at least two terms. Among equally frequent factors, sines and cosines are
/// preferred, because then both rows of a rotation contain the same sums.
fn find_most_common_factor(graph: &Graph, terms: &[(f64, NodeId)]) -> Option<NodeId> {
    let mut counts: BTreeMap<NodeId, usize> = BTreeMap::new();
    for (_, term) in terms {
        for factor in find_live_factors(graph, *term) {
            *counts.entry(factor).or_insert(0) += 1;
        }
    }
    let turns = |id| {
        matches!(
            graph.operation(id),
            Operation::Call(Function::Sin | Function::Cos, _)
        )
    };
    counts
        .into_iter()
        .filter(|(_, count)| *count > 1)
        .max_by_key(|(id, count)| (*count, turns(*id), std::cmp::Reverse(*id)))
        .map(|(id, _)| id)
}

/// Returns the scalar, state-dependent factors of a term with positive exponents; empty for a product with too many
/// factors.
fn find_live_factors(graph: &Graph, term: NodeId) -> Vec<NodeId> {
    let live =
        |id: NodeId| graph.shape(id) == Shape::Scalar && !graph.dependence(id).is_parameter_only();
    match graph.operation(term) {
        Operation::Product(factors) if factors.len() > MAX_FACTORS => Vec::new(),
        Operation::Product(factors) => factors
            .iter()
            .filter(|(id, exponent)| *exponent > 0 && live(*id))
            .map(|(id, _)| *id)
            .collect(),
        _ if live(term) => vec![term],
        _ => Vec::new(),
    }
}
