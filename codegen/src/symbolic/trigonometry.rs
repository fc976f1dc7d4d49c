//! Addition theorems for sums of products of sines and cosines, such as cos a cos b + sin a sin b = cos(a - b). They
//! need an expansion; therefore the constructors of nodes do not apply them. The caller compares the operations of
//! both forms.

use std::collections::BTreeMap;

use eomgen_model_spec::model::Function;

use crate::symbolic::expand::{expand_once, is_expanded};
use crate::symbolic::factor::collect_terms;
use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Largest number of levels that are expanded.
const MAX_LEVELS: usize = 12;

/// Expands a node and applies the addition theorems to its terms. Returns `None` if the complete expansion is too
/// long.
pub(crate) fn with_sums_of_angles(graph: &mut Graph, node: NodeId) -> Option<NodeId> {
    let mut expanded = node;
    let mut levels = 0;
    while !is_expanded(graph, expanded) {
        levels += 1;
        if levels > MAX_LEVELS {
            return None;
        }
        expanded = expand_once(graph, expanded)?;
    }
    let mut terms: BTreeMap<NodeId, f64> = match graph.operation(expanded) {
        Operation::Sum(terms) => terms.iter().map(|(c, term)| (*term, c.value())).collect(),
        _ => return Some(node),
    };
    while let Some((first, second, merged)) = find_merging_pair(graph, &terms) {
        terms.remove(&first);
        terms.remove(&second);
        let mut all: Vec<(f64, NodeId)> = terms.iter().map(|(term, c)| (*c, *term)).collect();
        all.push(merged);
        let sum = graph.combine_flat(&all);
        terms = match graph.operation(sum) {
            Operation::Sum(terms) => terms.iter().map(|(c, term)| (*term, c.value())).collect(),
            _ => return Some(sum),
        };
    }
    let terms: Vec<(f64, NodeId)> = terms.iter().map(|(term, c)| (*c, *term)).collect();
    Some(collect_terms(graph, &terms))
}

/// Returns two terms that an addition theorem combines, with the result.
fn find_merging_pair(
    graph: &mut Graph,
    terms: &BTreeMap<NodeId, f64>,
) -> Option<(NodeId, NodeId, (f64, NodeId))> {
    for (&term, &factor) in terms {
        let Operation::Product(factors) = graph.operation(term).clone() else {
            continue;
        };
        let turns: Vec<(NodeId, Function, NodeId)> = factors
            .iter()
            .filter(|(_, exponent)| *exponent > 0)
            .filter_map(|(id, _)| match graph.operation(*id) {
                Operation::Call(function @ (Function::Sin | Function::Cos), arguments) => {
                    Some((*id, *function, arguments[0]))
                }
                _ => None,
            })
            .collect();
        for (index, &first) in turns.iter().enumerate() {
            for &second in &turns[index + 1..] {
                if first.2 == second.2 {
                    continue;
                }
                let rest = graph.product(&[(term, 1), (first.0, -1), (second.0, -1)]);
                let partners = [find_partner(graph, first), find_partner(graph, second)];
                let partner = graph.product(&[(rest, 1), (partners[0], 1), (partners[1], 1)]);
                let Some(&other) = terms.get(&partner) else {
                    continue;
                };
                if other.abs() != factor.abs() {
                    continue;
                }
                let (sign, angle) = merge_pair(graph, (factor, other), first, second);
                let value = graph.multiply(rest, angle);
                return Some((term, partner, (sign, value)));
            }
        }
    }
    None
}

/// Returns the cosine for a sine, and the sine for a cosine.
fn find_partner(graph: &mut Graph, (_, function, angle): (NodeId, Function, NodeId)) -> NodeId {
    let other = match function {
        Function::Sin => Function::Cos,
        _ => Function::Sin,
    };
    graph.call(other, &[angle])
}

/// Returns factor * first * second + other * (partner of first) * (partner of second) as one term.
fn merge_pair(
    graph: &mut Graph,
    (factor, other): (f64, f64),
    (_, first, a): (NodeId, Function, NodeId),
    (_, second, b): (NodeId, Function, NodeId),
) -> (f64, NodeId) {
    let same = factor == other;
    // sin a sin b + cos a cos b = cos(a - b), and cos a cos b - sin a sin b = cos(a + b). sin a cos b + cos a sin b =
    // sin(a + b), and sin a cos b - cos a sin b = sin(a - b).
    let alike = first == second;
    let sum = alike != same;
    let angle = graph.combine_flat(&[(1.0, a), (if sum { 1.0 } else { -1.0 }, b)]);
    let function = if alike { Function::Cos } else { Function::Sin };
    let sign = match (alike, first) {
        (true, Function::Sin) => other,
        (true, _) => factor,
        (false, Function::Sin) => factor,
        (false, _) => other,
    };
    (sign, graph.call(function, &[angle]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eomgen_model_spec::ids::CoordinateId;

    fn coordinates(graph: &mut Graph, count: usize) -> Vec<NodeId> {
        let places = CoordinateId::first(count);
        places
            .map(|index| graph.intern(Operation::Coordinate(index)))
            .collect()
    }

    #[test]
    fn addition_theorem_applies_inside_a_product() {
        let mut graph = Graph::new(&[], &[]);
        let [a, b, x] = coordinates(&mut graph, 3)[..] else {
            panic!("three coordinates");
        };
        let [of_cosines, of_sines] = [Function::Cos, Function::Sin].map(|function| {
            let turns = [a, b].map(|angle| graph.call(function, &[angle]));
            graph.multiply(turns[0], turns[1])
        });
        let sum = graph.add(of_cosines, of_sines);
        let node = graph.multiply(x, sum);
        let difference = graph.subtract(a, b);
        let cosine = graph.call(Function::Cos, &[difference]);
        let expected = graph.multiply(x, cosine);
        assert_eq!(with_sums_of_angles(&mut graph, node), Some(expected));
    }

    #[test]
    fn product_of_long_sums_is_not_partially_expanded() {
        let mut graph = Graph::new(&[], &[]);
        let all = coordinates(&mut graph, 21);
        let factors: Vec<(NodeId, i32)> = all
            .chunks(7)
            .map(|own| {
                let terms: Vec<(f64, NodeId)> = own.iter().map(|x| (1.0, *x)).collect();
                (graph.combine(&terms), 1)
            })
            .collect();
        let node = graph.product(&factors);
        assert_eq!(with_sums_of_angles(&mut graph, node), None);
    }
}
