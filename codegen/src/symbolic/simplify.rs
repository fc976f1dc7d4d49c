//! Constructors of the graph's nodes. Each applies a few algebraic laws, stated in its documentation. No law
//! expands a product of sums, so shared parts remain shared. A law preserves values except for rounding.

use std::collections::BTreeMap;

use eomgen_model_spec::model::Function;

use crate::symbolic::arguments::Arguments;
use crate::symbolic::graph::{Bits, Graph, NodeId, Operation, Shape};

type Factors = Vec<(NodeId, i32)>;

impl Graph {
    /// Returns a constant.
    pub fn constant(&mut self, value: f64) -> NodeId {
        self.intern(Operation::Constant(Bits::new(value)))
    }

    /// Returns the constant 0.
    pub fn zero(&mut self) -> NodeId {
        self.read_small_number(0)
    }

    /// Returns the constant 1.
    pub fn one(&mut self) -> NodeId {
        self.read_small_number(1)
    }

    fn read_small_number(&mut self, number: u8) -> NodeId {
        if let Some(known) = self.zero_and_one[usize::from(number)] {
            return known;
        }
        let made = self.constant(f64::from(number));
        self.zero_and_one[usize::from(number)] = Some(made);
        made
    }

    /// Returns the value of a constant node; `None` for other nodes.
    pub fn as_constant(&self, id: NodeId) -> Option<f64> {
        match self.operation(id) {
            Operation::Constant(bits) => Some(bits.value()),
            _ => None,
        }
    }

    /// Returns true for the constant 0.
    pub fn is_zero(&self, id: NodeId) -> bool {
        self.as_constant(id) == Some(0.0)
    }

    /// Returns c a.
    pub fn scale(&mut self, factor: f64, a: NodeId) -> NodeId {
        self.combine(&[(factor, a)])
    }

    /// Returns -a.
    pub fn negate(&mut self, a: NodeId) -> NodeId {
        self.scale(-1.0, a)
    }

    /// Returns a + b.
    pub fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.combine(&[(1.0, a), (1.0, b)])
    }

    /// Returns a - b.
    pub fn subtract(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.combine(&[(1.0, a), (-1.0, b)])
    }

    /// Returns a linear combination. Laws: numbers are folded, c (k a) = (c k) a, equal nodes are collected;
    /// an inner sum remains a node.
    pub fn combine(&mut self, terms: &[(f64, NodeId)]) -> NodeId {
        // No law applies to a single term that is not a product.
        if let [(1.0, only)] = *terms
            && !matches!(self.operation(only), Operation::Product(_))
        {
            return only;
        }
        let mut collected = BTreeMap::new();
        for &(factor, id) in terms {
            self.collect(&mut collected, factor, id, false);
        }
        self.sum_of(collected)
    }

    /// Returns a linear combination with inner sums expanded, because terms of different sums can cancel.
    pub fn combine_flat(&mut self, terms: &[(f64, NodeId)]) -> NodeId {
        let mut collected = BTreeMap::new();
        for &(factor, id) in terms {
            self.collect(&mut collected, factor, id, true);
        }
        self.sum_of(collected)
    }

    fn collect(&mut self, into: &mut BTreeMap<NodeId, f64>, factor: f64, id: NodeId, open: bool) {
        match self.operation(id) {
            Operation::Constant(bits) => {
                let value = bits.value();
                let one = self.one();
                *into.entry(one).or_insert(0.0) += factor * value;
            }
            Operation::Sum(terms) if open || terms.len() == 1 => {
                for (inner, term) in terms.clone() {
                    self.collect(into, factor * inner.value(), term, open);
                }
            }
            _ => *into.entry(id).or_insert(0.0) += factor,
        }
    }

    fn sum_of(&mut self, mut terms: BTreeMap<NodeId, f64>) -> NodeId {
        terms.retain(|_, factor| *factor != 0.0);
        self.merge_squared_sine_and_cosine(&mut terms);
        let terms: Vec<(Bits, NodeId)> = terms
            .into_iter()
            .map(|(id, factor)| (Bits::new(factor), id))
            .collect();
        match terms.as_slice() {
            [] => self.zero(),
            [(factor, id)] if factor.value() == 1.0 => *id,
            [(factor, id)] if self.as_constant(*id).is_some() => self.constant(factor.value()),
            _ => self.intern(Operation::Sum(terms.into_boxed_slice())),
        }
    }

    /// Law: c X sin(a)^2 + c X cos(a)^2 = c X.
    fn merge_squared_sine_and_cosine(&mut self, terms: &mut BTreeMap<NodeId, f64>) {
        let ids: Vec<NodeId> = terms.keys().copied().collect();
        for id in ids {
            let Some(&factor) = terms.get(&id) else {
                continue;
            };
            let Some((rest, partner)) = self.find_squared_cosine(id) else {
                continue;
            };
            if terms.get(&partner) == Some(&factor) {
                terms.remove(&id);
                terms.remove(&partner);
                self.collect(terms, factor, rest, false);
            }
        }
        terms.retain(|_, factor| *factor != 0.0);
    }

    /// Returns X and X cos(a)^2 for X sin(a)^2.
    fn find_squared_cosine(&mut self, id: NodeId) -> Option<(NodeId, NodeId)> {
        let Operation::Product(factors) = self.operation(id) else {
            return None;
        };
        let position = factors.iter().position(|(factor, exponent)| {
            *exponent == 2 && matches!(self.operation(*factor), Operation::Call(Function::Sin, _))
        })?;
        let mut others = factors.to_vec();
        let Operation::Call(_, argument) = *self.operation(others[position].0) else {
            return None;
        };
        others.remove(position);
        let rest = self.product(&others);
        let cosine = self.call(Function::Cos, argument);
        let partner = self.product(&[(rest, 1), (cosine, 2)]);
        Some((rest, partner))
    }

    /// Returns a b.
    pub fn multiply(&mut self, a: NodeId, b: NodeId) -> NodeId {
        // A product of 0 and an infinite constant is not 0.
        let holds_number = |id| match self.operation(id) {
            Operation::Constant(_) => true,
            Operation::Sum(terms) => terms.len() == 1,
            _ => false,
        };
        let vanishes = |zero, other| self.is_zero(zero) && !holds_number(other);
        if vanishes(a, b) || vanishes(b, a) {
            return self.zero();
        }
        self.product(&[(a, 1), (b, 1)])
    }

    /// Returns a / b.
    pub fn divide(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.product(&[(a, 1), (b, -1)])
    }

    /// Returns a^n.
    pub fn integer_power(&mut self, a: NodeId, exponent: i32) -> NodeId {
        self.product(&[(a, exponent)])
    }

    /// Returns a product of integer powers. Laws: numeric factors are moved in front of the product, inner products
    /// are merged, (a^m)^n = a^(m n), equal factors are collected, a^0 = 1. Inner products are not merged if an
    /// exponent would become too large.
    pub fn product(&mut self, factors: &[(NodeId, i32)]) -> NodeId {
        let (number, mut collected) = match self.collect_nested_factors(factors) {
            Some(opened) => opened,
            None => (1.0, collect_equal_factors(factors)),
        };
        collected.retain(|_, exponent| *exponent != 0);
        self.apply_piecewise_laws(&mut collected);
        if number == 0.0 {
            return self.zero();
        }
        let factors: Vec<(NodeId, i32)> = collected.into_iter().collect();
        let product = match factors.as_slice() {
            [] => return self.constant(number),
            [(id, 1)] => *id,
            _ => self.intern(Operation::Product(factors.into_boxed_slice())),
        };
        self.scale(number, product)
    }

    /// Returns the numeric factor and the powers of a product; `None` if an exponent is too large.
    fn collect_nested_factors(
        &self,
        factors: &[(NodeId, i32)],
    ) -> Option<(f64, BTreeMap<NodeId, i32>)> {
        let mut number = 1.0;
        let mut collected = BTreeMap::new();
        for &(id, exponent) in factors {
            self.collect_factor(&mut number, &mut collected, id, exponent)?;
        }
        Some((number, collected))
    }

    fn collect_factor(
        &self,
        number: &mut f64,
        into: &mut BTreeMap<NodeId, i32>,
        id: NodeId,
        exponent: i32,
    ) -> Option<()> {
        if exponent.abs() > MAX_EXPONENT {
            return None;
        }
        match self.operation(id) {
            Operation::Constant(bits) => *number *= compute_power(bits.value(), exponent),
            Operation::Sum(terms) if terms.len() == 1 => {
                let (factor, inner) = terms[0];
                *number *= compute_power(factor.value(), exponent);
                self.collect_factor(number, into, inner, exponent)?;
            }
            Operation::Product(factors) => {
                for &(inner, power) in factors {
                    self.collect_factor(number, into, inner, power.checked_mul(exponent)?)?;
                }
            }
            _ => {
                let total = into.entry(id).or_insert(0);
                *total += exponent;
                if total.abs() > MAX_EXPONENT {
                    return None;
                }
            }
        }
        Some(())
    }

    /// Laws: contact^n = contact for n > 0, and deadzone(p, b)^n contact(p, b) = deadzone(p, b)^n, because the force
    /// of Eq. (7) of the paper is zero without contact.
    fn apply_piecewise_laws(&mut self, factors: &mut BTreeMap<NodeId, i32>) {
        let contacts: Vec<(NodeId, Arguments<NodeId>)> = factors
            .keys()
            .filter_map(|id| match self.operation(*id) {
                Operation::Call(Function::Contact, arguments) => Some((*id, *arguments)),
                _ => None,
            })
            .collect();
        for (contact, arguments) in contacts {
            let exponent = factors.get(&contact).copied().unwrap_or(0);
            if exponent <= 0 {
                continue;
            }
            factors.insert(contact, 1);
            let deadzone = self.intern(Operation::Call(Function::Deadzone, arguments));
            if factors.get(&deadzone).is_some_and(|power| *power > 0) {
                factors.remove(&contact);
            }
        }
    }

    /// Returns base^exponent. Laws: an integer exponent gives a product, 1/2 a square root.
    pub fn power(&mut self, base: NodeId, exponent: NodeId) -> NodeId {
        match self.as_constant(exponent) {
            Some(value) if value == value.round() && value.abs() <= 64.0 => {
                self.integer_power(base, value as i32)
            }
            Some(value) if 2.0 * value == (2.0 * value).round() && value.abs() <= 32.0 => {
                let root = self.call(Function::Sqrt, &[base]);
                self.integer_power(root, (2.0 * value) as i32)
            }
            _ => self.intern(Operation::Power(base, exponent)),
        }
    }

    /// Returns a function of scalars or vectors. Laws: functions of constants with an exact result are evaluated;
    /// f(-a) = -f(a) for odd functions and f(-a) = f(a) for even functions; min(a, a) = max(a, a) = a.
    pub fn call(&mut self, function: Function, arguments: impl Into<Arguments<NodeId>>) -> NodeId {
        let arguments = arguments.into();
        if let (Function::Min | Function::Max, [a, b]) = (function, &arguments[..])
            && a == b
        {
            return *a;
        }
        if let Arguments::One([a]) = arguments {
            if let Some(value) = self
                .as_constant(a)
                .and_then(|x| find_exact_value(function, x))
            {
                return self.constant(value);
            }
            if let Some(positive) = self.remove_minus(a) {
                if function.is_even() {
                    return self.call(function, &[positive]);
                } else if function.is_odd() {
                    let value = self.call(function, &[positive]);
                    return self.negate(value);
                }
            }
        }
        self.intern(Operation::Call(function, arguments))
    }

    /// Returns a for a node -a; `None` for other nodes.
    fn remove_minus(&mut self, id: NodeId) -> Option<NodeId> {
        match self.operation(id).clone() {
            Operation::Sum(terms) if terms.iter().all(|(factor, _)| factor.value() < 0.0) => {
                Some(self.negate_all(&terms))
            }
            Operation::Constant(bits) if bits.value() < 0.0 => Some(self.constant(-bits.value())),
            _ => None,
        }
    }

    fn negate_all(&mut self, terms: &[(Bits, NodeId)]) -> NodeId {
        let negated: Vec<(f64, NodeId)> = terms.iter().map(|(f, id)| (-f.value(), *id)).collect();
        self.combine(&negated)
    }

    /// Returns `if a > b { then } else { otherwise }`. Law: a selection between equal branches is the branch.
    pub fn select(&mut self, a: NodeId, b: NodeId, then: NodeId, otherwise: NodeId) -> NodeId {
        self.select_between([a, b], then, otherwise, true)
    }

    /// Returns `if a > b { then } else { otherwise }` for results that agree near a = b.
    pub(crate) fn select_equivalent(
        &mut self,
        a: NodeId,
        b: NodeId,
        then: NodeId,
        otherwise: NodeId,
    ) -> NodeId {
        self.select_between([a, b], then, otherwise, false)
    }

    pub(crate) fn select_between(
        &mut self,
        [a, b]: [NodeId; 2],
        then: NodeId,
        otherwise: NodeId,
        is_switch: bool,
    ) -> NodeId {
        if then == otherwise {
            return then;
        }
        self.intern(Operation::Select {
            a,
            b,
            then,
            otherwise,
            is_switch,
        })
    }

    /// Splits the factors of a product into scalars and others.
    pub(crate) fn split_scalar_factors(&self, factors: &[(NodeId, i32)]) -> (Factors, Factors) {
        factors
            .iter()
            .partition(|(id, _)| self.shape(*id) == Shape::Scalar)
    }

    /// Returns the sum of a vector's elements. Laws: scalar factors are moved in front of the sum; an empty sum is 0.
    pub fn total(&mut self, vector: NodeId) -> NodeId {
        let Shape::Vector(space) = self.shape(vector) else {
            return vector;
        };
        if self.size(space) == 0 {
            return self.zero();
        }
        match self.operation(vector).clone() {
            Operation::Sum(terms) if terms.len() == 1 => {
                let inner = self.total(terms[0].1);
                self.scale(terms[0].0.value(), inner)
            }
            Operation::Product(factors) => {
                let (scalars, vectors) = self.split_scalar_factors(&factors);
                if scalars.is_empty() {
                    return self.intern(Operation::Total(vector));
                }
                let rest = self.product(&vectors);
                let total = self.total(rest);
                let scalar = self.product(&scalars);
                self.multiply(scalar, total)
            }
            _ => self.intern(Operation::Total(vector)),
        }
    }

    /// Returns the sum over `space`; a scalar is multiplied by the size.
    pub fn sum_over_space(
        &mut self,
        space: crate::symbolic::graph::Space,
        summand: NodeId,
    ) -> NodeId {
        match self.shape(summand) {
            Shape::Scalar => {
                let size = self.size(space) as f64;
                self.scale(size, summand)
            }
            _ => self.total(summand),
        }
    }

    /// Returns a matrix, or its transpose, times a vector or repeated scalar. Laws: scalar factors of the vector are
    /// moved in front; empty spaces and zero vectors give 0. If the weight of left^T diag(weight) right depends on
    /// the state, the three factors are applied one after the other. This takes fewer operations than forming the
    /// matrix, and it can be differentiated.
    pub fn apply(&mut self, matrix: NodeId, transposed: bool, vector: NodeId) -> NodeId {
        let Shape::Matrix(rows, columns) = self.shape(matrix) else {
            return self.zero();
        };
        if self.size(rows) == 0 || self.size(columns) == 0 || self.is_zero(vector) {
            return self.zero();
        }
        if let Operation::Gram {
            left,
            weight,
            right,
        } = *self.operation(matrix)
            && !self.dependence(weight).is_parameter_only()
        {
            let (left, right) = if transposed {
                (right, left)
            } else {
                (left, right)
            };
            let at_nodes = self.apply(right, false, vector);
            let weighted = self.multiply(weight, at_nodes);
            return self.apply(left, true, weighted);
        }
        match self.operation(vector).clone() {
            Operation::Sum(terms) if terms.len() == 1 => {
                let inner = self.apply(matrix, transposed, terms[0].1);
                self.scale(terms[0].0.value(), inner)
            }
            Operation::Product(factors) => {
                let (scalars, vectors) = self.split_scalar_factors(&factors);
                if scalars.is_empty() {
                    return self.intern_apply(matrix, transposed, vector);
                }
                let rest = self.product(&vectors);
                let applied = self.intern_apply(matrix, transposed, rest);
                let scalar = self.product(&scalars);
                self.multiply(scalar, applied)
            }
            _ => self.intern_apply(matrix, transposed, vector),
        }
    }

    /// Returns the solution of a system with a given Cholesky factor. Law: the solution is 0 if the right-hand side
    /// is 0.
    pub fn cholesky_solve(&mut self, factor: NodeId, vector: NodeId) -> NodeId {
        if self.is_zero(vector) {
            return vector;
        }
        self.intern(Operation::CholeskySolve(factor, vector))
    }

    fn intern_apply(&mut self, matrix: NodeId, transposed: bool, vector: NodeId) -> NodeId {
        self.intern(Operation::Apply {
            matrix,
            transposed,
            vector,
        })
    }
}

/// Largest exponent of collected equal factors.
const MAX_EXPONENT: i32 = 4096;

/// Collects equal factors without merging inner products.
fn collect_equal_factors(factors: &[(NodeId, i32)]) -> BTreeMap<NodeId, i32> {
    let mut collected = BTreeMap::new();
    for &(id, exponent) in factors {
        *collected.entry(id).or_insert(0) += exponent;
    }
    collected
}

/// Computes value^exponent by repeated multiplication, because `powi` may round differently on other machines.
fn compute_power(value: f64, exponent: i32) -> f64 {
    let magnitude = (0..exponent.unsigned_abs()).fold(1.0, |product, _| product * value);
    if exponent < 0 {
        1.0 / magnitude
    } else {
        magnitude
    }
}

fn find_exact_value(function: Function, x: f64) -> Option<f64> {
    match function {
        _ if x == 0.0 && function.is_odd() => Some(0.0),
        Function::Cos | Function::Cosh | Function::Exp if x == 0.0 => Some(1.0),
        Function::Ln if x == 1.0 => Some(0.0),
        Function::Sqrt if x >= 0.0 => Some(x.sqrt()),
        Function::Abs => Some(x.abs()),
        Function::Sign => Some(x.signum()),
        Function::Above if x > 0.0 => Some(1.0),
        Function::Above if x <= 0.0 => Some(0.0),
        _ => None,
    }
}
