//! Unit vectors v/norm(v) of sliding velocities, as in vector Coulomb friction.
//!
//! At v = 0 the unit vector is set-valued: it is the disc of all vectors s with |s| <= 1 (J. J. Moreau). A [`Disc`]
//! is a vector v of functions of the rates whose components are divided by norm(v) in the equations. The components
//! of s replace v/norm(v) in the equations; the sides of switching surfaces replace signs in the same way.

use std::collections::{BTreeMap, HashMap};

use eomgen_model_spec::model::Function;

use crate::symbolic::arguments::Arguments;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Shape};
use crate::symbolic::substitute::substitute;

/// Vector v whose unit vector occurs in the equations.
pub(crate) struct Disc {
    /// Node of norm(v).
    norm: NodeId,
    /// Components of v.
    pub components: Vec<NodeId>,
}

/// Returns true if an expression in `roots` divides by a square root that depends on rates.
pub(crate) fn divides_by_speed(graph: &Graph, roots: &[NodeId]) -> bool {
    let moves = Dependence::RATE.join(Dependence::STATE);
    graph.reachable(roots).into_iter().any(|id| {
        let Operation::Product(factors) = graph.operation(id) else {
            return false;
        };
        factors.iter().any(|(factor, exponent)| {
            let is_root = matches!(graph.operation(*factor), Operation::Call(Function::Sqrt, _));
            is_root && *exponent < 0 && graph.dependence(*factor).has(moves)
        })
    })
}

/// Finds the discs in the expressions of `roots`.
pub(crate) fn find_discs(graph: &mut Graph, roots: &[NodeId]) -> Vec<Disc> {
    let mut found: Vec<Disc> = Vec::new();
    for id in graph.reachable(roots) {
        let Operation::Product(factors) = graph.operation(id).clone() else {
            continue;
        };
        for (norm, exponent) in factors {
            if exponent < 0 && found.iter().all(|disc| disc.norm != norm) {
                found.extend(recognise_disc(graph, norm));
            }
        }
    }
    found
}

/// Returns the disc of a norm: the square root of a sum of squares of velocities.
fn recognise_disc(graph: &mut Graph, norm: NodeId) -> Option<Disc> {
    let Operation::Call(Function::Sqrt, Arguments::One([sum])) = *graph.operation(norm) else {
        return None;
    };
    let mut terms = Vec::new();
    collect_terms(graph, 1.0, sum, &mut terms);
    let moves = Dependence::RATE.join(Dependence::STATE);
    let mut components = Vec::with_capacity(terms.len());
    for (factor, square) in terms {
        let Operation::Product(factors) = graph.operation(square).clone() else {
            return None;
        };
        let is_square = factor > 0.0 && factors.iter().all(|(_, exponent)| exponent % 2 == 0);
        if !is_square || graph.shape(square) != Shape::Scalar {
            return None;
        }
        let halves: Vec<(NodeId, i32)> = factors.iter().map(|(id, e)| (*id, e / 2)).collect();
        let root = graph.product(&halves);
        let component = graph.combine(&[(factor.sqrt(), root)]);
        if !graph.dependence(component).has(moves) {
            return None;
        }
        components.push(component);
    }
    Some(Disc { norm, components })
}

impl Disc {
    /// Replaces the unit vector by these components in the expressions of `roots` and adds the replacements to
    /// `known`. Returns false if an expression in `rates` divides something other than components of v by the norm.
    pub fn replace_unit_vector(
        &self,
        graph: &mut Graph,
        (rates, roots): (&[NodeId], &[NodeId]),
        unit: &[NodeId],
        known: &mut HashMap<NodeId, NodeId>,
    ) -> bool {
        // Operands precede their uses.
        for id in graph.reachable(roots) {
            let Operation::Product(factors) = graph.operation(id).clone() else {
                continue;
            };
            let Some((divisions, rest)) = self.split_divisions(graph, &factors) else {
                continue;
            };
            let mut replaced = Some(graph.product(&rest));
            for _ in 0..divisions {
                replaced = replaced.and_then(|node| self.divide_by_norm(graph, unit, node));
            }
            if let Some(node) = replaced {
                let node = substitute(graph, node, &|_, _| None, known);
                known.insert(id, node);
            }
        }
        let replaced: Vec<NodeId> = rates
            .iter()
            .map(|root| substitute(graph, *root, &|_, _| None, known))
            .collect();
        !graph.reachable(&replaced).into_iter().any(|id| {
            let Operation::Product(factors) = graph.operation(id) else {
                return false;
            };
            self.split_divisions(graph, factors).is_some()
        })
    }

    /// Returns how often a product is divided by norm(v), and its other factors; `None` if it is not divided by
    /// norm(v). In derivatives the reciprocal of the norm can be a selection that avoids the division at v = 0.
    fn split_divisions(
        &self,
        graph: &Graph,
        factors: &[(NodeId, i32)],
    ) -> Option<(i32, Vec<(NodeId, i32)>)> {
        let mut divisions = 0;
        let mut rest = Vec::with_capacity(factors.len());
        for &(factor, exponent) in factors {
            let (base, power) = graph.guarded_power(factor).unwrap_or((factor, 1));
            match base == self.norm && power * exponent < 0 {
                true => divisions -= power * exponent,
                false => rest.push((factor, exponent)),
            }
        }
        (divisions > 0).then_some((divisions, rest))
    }

    /// Returns a node divided by norm(v), if each of its terms has a component of v as a factor.
    fn divide_by_norm(&self, graph: &mut Graph, unit: &[NodeId], id: NodeId) -> Option<NodeId> {
        if let Operation::Sum(terms) = graph.operation(id).clone() {
            let mut divided = Vec::with_capacity(terms.len());
            for (factor, term) in terms {
                divided.push((factor.value(), self.divide_by_norm(graph, unit, term)?));
            }
            return Some(graph.combine(&divided));
        }
        let factors = powers(graph, id);
        for (component, unit) in self.components.iter().zip(unit) {
            let (scale, parts) = read_scaled_powers(graph, *component);
            let moves = Dependence::RATE.join(Dependence::STATE);
            let holds = |(part, power): (&NodeId, &i32)| {
                let own = factors.get(part).copied().unwrap_or(0);
                !graph.dependence(*part).has(moves) || own >= *power
            };
            if parts.iter().all(holds) {
                let mut rest = factors.clone();
                for (part, power) in &parts {
                    *rest.entry(*part).or_insert(0) -= power;
                }
                let mut product: Vec<(NodeId, i32)> = rest.into_iter().collect();
                product.push((*unit, 1));
                let product = graph.product(&product);
                return Some(graph.combine(&[(1.0 / scale, product)]));
            }
        }
        // A sum among the factors may have a component in each of its terms.
        for (part, power) in &factors {
            if *power < 1 || !matches!(graph.operation(*part), Operation::Sum(_)) {
                continue;
            }
            if let Some(divided) = self.divide_by_norm(graph, unit, *part) {
                let mut rest = factors.clone();
                rest.insert(*part, power - 1);
                let mut product: Vec<(NodeId, i32)> = rest.into_iter().collect();
                product.push((divided, 1));
                return Some(graph.product(&product));
            }
        }
        None
    }
}

/// Adds the terms of nested sums.
fn collect_terms(graph: &Graph, factor: f64, id: NodeId, terms: &mut Vec<(f64, NodeId)>) {
    match graph.operation(id) {
        Operation::Sum(inner) => {
            for (inner_factor, term) in inner {
                collect_terms(graph, factor * inner_factor.value(), *term, terms);
            }
        }
        _ => terms.push((factor, id)),
    }
}

/// Returns the powers of a product, or of the node itself.
fn powers(graph: &Graph, id: NodeId) -> BTreeMap<NodeId, i32> {
    match graph.operation(id) {
        Operation::Product(factors) => factors.iter().copied().collect(),
        _ => BTreeMap::from([(id, 1)]),
    }
}

/// Returns the numerical factor and the powers of a product.
fn read_scaled_powers(graph: &Graph, id: NodeId) -> (f64, BTreeMap<NodeId, i32>) {
    match graph.operation(id) {
        Operation::Sum(terms) if terms.len() == 1 => {
            (terms[0].0.value(), powers(graph, terms[0].1))
        }
        _ => (1.0, powers(graph, id)),
    }
}
