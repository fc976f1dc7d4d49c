//! Functions of the position along a field, and their integrals over its domain.
//!
//! An integrand is a sum of terms. Each term has a scalar, a power of s = (x - from)/(to - from), an optional weight
//! at quadrature nodes, and at most two field atoms (w, its rate, a mode shape, or a derivative of one by the
//! position). Terms without a weight have exact dimensionless integrals (`modes`); lengths and stiffnesses remain
//! parameters. A weight that depends only on parameters is integrated by `prepare`. Other integrands are evaluated at
//! the quadrature nodes in every call.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::Function;

use super::term::{Atom, IntegrandTerm};
use crate::mechanics::fields::domain::Domain;
use crate::mechanics::fields::moments::{build_shapes_at, integrate_term};
use crate::symbolic::arguments::Arguments;
use crate::symbolic::graph::{Graph, NodeId, Space};
use crate::symbolic::tables::TableKind;

/// Function of the position along a field.
#[derive(Clone, Debug)]
pub struct FieldFunction {
    terms: Vec<IntegrandTerm>,
}

/// Largest number of terms of an expanded integrand.
const MAX_TERMS: usize = 4096;

/// Highest power of s with a separate table of integrals.
const MAX_MOMENT: u32 = 32;

type Outcome<T> = Result<T, String>;

impl FieldFunction {
    /// Returns a function that is constant along the field.
    pub fn constant(scalar: NodeId) -> Self {
        Self {
            terms: vec![IntegrandTerm {
                scalar,
                power: 0,
                weight: None,
                atoms: Vec::new(),
            }],
        }
    }

    /// Returns the position x = from + length s.
    pub fn position(graph: &mut Graph, domain: &Domain) -> Self {
        let mut function = Self::constant(domain.length);
        function.terms[0].power = 1;
        if !graph.is_zero(domain.from) {
            function.terms.extend(Self::constant(domain.from).terms);
        }
        function
    }

    /// Returns a field atom, differentiated with respect to x.
    pub fn atom(graph: &mut Graph, domain: &Domain, atom: Atom) -> Self {
        let scale = graph.integer_power(domain.length, -i32::from(atom.derivative()));
        let mut function = Self::constant(scale);
        function.terms[0].atoms.push(atom);
        function
    }

    /// Multiplies the function by a number.
    pub fn scale(mut self, graph: &mut Graph, factor: f64) -> Self {
        for term in &mut self.terms {
            term.scalar = graph.scale(factor, term.scalar);
        }
        self
    }

    /// Returns a sum, difference, product, quotient or power.
    pub fn binary(
        &self,
        graph: &mut Graph,
        domain: &Domain,
        operator: BinaryOperator,
        other: &Self,
    ) -> Outcome<Self> {
        match operator {
            BinaryOperator::Add => self.add(graph, other.clone()),
            BinaryOperator::Subtract => {
                let negated = other.clone().scale(graph, -1.0);
                self.add(graph, negated)
            }
            BinaryOperator::Multiply => self.multiply(graph, domain, other),
            BinaryOperator::Divide => match other.as_scalar() {
                Some(scalar) => {
                    let reciprocal = graph.integer_power(scalar, -1);
                    self.multiply(graph, domain, &Self::constant(reciprocal))
                }
                None => {
                    let values = other.values(graph, domain)?;
                    let reciprocal = graph.integer_power(values, -1);
                    let weight = Self::weight(graph, reciprocal);
                    self.multiply(graph, domain, &weight)
                }
            },
            BinaryOperator::Power => self.power(graph, domain, other),
        }
    }

    /// Applies a function at every position.
    pub fn call(
        graph: &mut Graph,
        domain: &Domain,
        function: Function,
        arguments: &[Self],
    ) -> Outcome<Self> {
        let operands =
            |all| Arguments::from_operands(all).ok_or("a function takes one or two arguments");
        let scalars: Option<Vec<NodeId>> = arguments.iter().map(Self::as_scalar).collect();
        if let Some(scalars) = scalars {
            return Ok(Self::constant(graph.call(function, operands(scalars)?)));
        }
        let values = arguments
            .iter()
            .map(|a| a.values(graph, domain))
            .collect::<Outcome<Vec<NodeId>>>()?;
        let result = graph.call(function, operands(values)?);
        Ok(Self::weight(graph, result))
    }

    /// Returns the value of the function at a position that depends only on parameters.
    pub fn evaluate_at(
        &self,
        graph: &mut Graph,
        domain: &Domain,
        position: NodeId,
    ) -> Outcome<NodeId> {
        let s = domain.derive_relative_position(graph, position);
        let mut terms = Vec::new();
        for term in &self.terms {
            if term.weight.is_some() {
                return Err(
                    "at(...) accepts the field, its derivatives and polynomials of the position"
                        .into(),
                );
            }
            let mut factors = vec![(term.scalar, 1), (s, term.power as i32)];
            for atom in &term.atoms {
                let shapes = build_shapes_at(graph, domain, s, atom.derivative())?;
                let value = match atom.amplitudes(graph, domain.field) {
                    Some(amplitudes) => {
                        let product = graph.multiply(shapes, amplitudes);
                        graph.sum_over_space(Space::Modes(domain.field), product)
                    }
                    None => shapes,
                };
                factors.push((value, 1));
            }
            terms.push((1.0, graph.product(&factors)));
        }
        Ok(graph.combine(&terms))
    }

    /// Returns the integral over the domain.
    pub fn integral(&self, graph: &mut Graph, domain: &Domain) -> Outcome<NodeId> {
        let mut terms = Vec::new();
        for term in &self.terms {
            let value = integrate_term(graph, domain, term);
            let product = graph.product(&[(term.scalar, 1), (domain.length, 1), (value, 1)]);
            terms.push((1.0, product));
        }
        Ok(graph.combine(&terms))
    }

    fn weight(graph: &mut Graph, values: NodeId) -> Self {
        let mut function = Self::constant(graph.one());
        function.terms[0].weight = Some(values);
        function
    }

    /// Returns the scalar if the function is constant along the field.
    fn as_scalar(&self) -> Option<NodeId> {
        match self.terms.as_slice() {
            [term] if term.power == 0 && term.weight.is_none() && term.atoms.is_empty() => {
                Some(term.scalar)
            }
            _ => None,
        }
    }

    fn add(&self, graph: &mut Graph, other: Self) -> Outcome<Self> {
        let mut terms = self.terms.clone();
        terms.extend(other.terms);
        check_term_count(collect_like_terms(graph, terms))
    }

    fn multiply(&self, graph: &mut Graph, domain: &Domain, other: &Self) -> Outcome<Self> {
        let atoms = |function: &Self| {
            function
                .terms
                .iter()
                .map(|t| t.atoms.len())
                .max()
                .unwrap_or(0)
        };
        if atoms(self) + atoms(other) > 2 {
            let values = [self.values(graph, domain)?, other.values(graph, domain)?];
            let product = graph.multiply(values[0], values[1]);
            return Ok(Self::weight(graph, product));
        }
        if self.terms.len() * other.terms.len() > MAX_TERMS {
            return Err(describe_too_many_terms());
        }
        let mut terms = Vec::new();
        for a in &self.terms {
            for b in &other.terms {
                let weight = match (a.weight, b.weight) {
                    (Some(a), Some(b)) => Some(graph.multiply(a, b)),
                    (a, b) => a.or(b),
                };
                let mut atoms = [a.atoms.clone(), b.atoms.clone()].concat();
                atoms.sort();
                let (power, weight) = reduce_power(graph, domain, a.power + b.power, weight);
                terms.push(IntegrandTerm {
                    scalar: graph.multiply(a.scalar, b.scalar),
                    power,
                    weight,
                    atoms,
                });
            }
        }
        check_term_count(collect_like_terms(graph, terms))
    }

    fn power(&self, graph: &mut Graph, domain: &Domain, exponent: &Self) -> Outcome<Self> {
        let number = exponent.as_scalar().and_then(|e| graph.as_constant(e));
        if let (Some(base), Some(exponent)) = (self.as_scalar(), exponent.as_scalar()) {
            return Ok(Self::constant(graph.power(base, exponent)));
        }
        match number {
            Some(n) if n == n.round() && (0.0..=8.0).contains(&n) => {
                let mut result = Self::constant(graph.one());
                for _ in 0..n as u32 {
                    result = result.multiply(graph, domain, self)?;
                }
                Ok(result)
            }
            _ => {
                let base = self.values(graph, domain)?;
                let exponent = exponent.values(graph, domain)?;
                let result = graph.power(base, exponent);
                Ok(Self::weight(graph, result))
            }
        }
    }

    /// Returns the values at the quadrature nodes: a vector over the nodes, or a scalar if they are equal.
    fn values(&self, graph: &mut Graph, domain: &Domain) -> Outcome<NodeId> {
        let s = domain.table(graph, TableKind::NodePosition);
        let mut terms = Vec::new();
        for term in &self.terms {
            let mut factors = vec![(term.scalar, 1), (s, term.power as i32)];
            factors.extend(term.weight.map(|weight| (weight, 1)));
            for atom in &term.atoms {
                let matrix = domain.table(graph, TableKind::ShapeAtNodes(atom.derivative()));
                let Some(amplitudes) = atom.amplitudes(graph, domain.field) else {
                    return Err("phi[i] must be a factor of the integrand, at most twice".into());
                };
                factors.push((graph.apply(matrix, false, amplitudes), 1));
            }
            terms.push((1.0, graph.product(&factors)));
        }
        Ok(graph.combine(&terms))
    }
}

/// Multiplies the weight by a power of s that has no table of integrals.
fn reduce_power(
    graph: &mut Graph,
    domain: &Domain,
    power: u32,
    weight: Option<NodeId>,
) -> (u32, Option<NodeId>) {
    if power <= MAX_MOMENT {
        return (power, weight);
    }
    let s = domain.table(graph, TableKind::NodePosition);
    let mut factors = vec![(s, power as i32)];
    factors.extend(weight.map(|weight| (weight, 1)));
    (0, Some(graph.product(&factors)))
}

fn collect_like_terms(graph: &mut Graph, terms: Vec<IntegrandTerm>) -> Vec<IntegrandTerm> {
    let mut collected: Vec<IntegrandTerm> = Vec::new();
    for term in terms {
        let alike = collected.iter().position(|other| {
            other.power == term.power && other.weight == term.weight && other.atoms == term.atoms
        });
        match alike {
            Some(index) => {
                collected[index].scalar = graph.add(collected[index].scalar, term.scalar);
            }
            None => collected.push(term),
        }
    }
    collected
}

fn check_term_count(terms: Vec<IntegrandTerm>) -> Outcome<FieldFunction> {
    if terms.len() > MAX_TERMS {
        return Err(describe_too_many_terms());
    }
    Ok(FieldFunction { terms })
}

fn describe_too_many_terms() -> String {
    format!("this integrand has more than {MAX_TERMS} terms when expanded")
}
