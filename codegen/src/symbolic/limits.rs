//! Limits of derivatives at zeros of roots.
//!
//! The derivative of `norm(v)*v_x` contains v_x (v . dv)/norm(v), which is 0/0 at v = 0 although its limit is
//! 0. Let s be the argument of a root, without roots of its own. If |f| <= C |s|^o near s = 0, o is the order of f.
//! A product of positive order vanishes with s, so its reciprocals of the root are guarded: they are 0 if the root
//! is 0. If the order is 0, they are 0 if both the root and the [cofactor](super::cofactors) of the product are 0.
//! Otherwise the product is infinite or NaN at s = 0, where it has no limit.

use std::collections::HashMap;
use std::sync::Arc;

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::orders::{Bounds, Monomial};
use crate::symbolic::substitute::substitute;

/// Magnitude below which an exponent is rounding error.
pub(super) const EXPONENT_ROUNDING: f64 = 1e-9;

impl Graph {
    /// Returns `partial` times `inner` as a term of a derivative. The term is 0 on the flat side of a switch, and it
    /// equals its limit at zeros of roots.
    pub(crate) fn build_derivative_term(&mut self, partial: NodeId, inner: NodeId) -> NodeId {
        self.build_guarded_term(None, partial, inner)
    }

    /// Returns the derivative `partial` by an operand times `inner`, the derivative of the operand, like
    /// [`Graph::build_derivative_term`]. In addition, the term is 0 at [zeros of a smooth
    /// factor](super::vanishing_products).
    pub(crate) fn build_chain_rule_term(
        &mut self,
        operand: NodeId,
        partial: NodeId,
        inner: NodeId,
    ) -> NodeId {
        self.build_guarded_term(Some(operand), partial, inner)
    }

    fn build_guarded_term(
        &mut self,
        operand: Option<NodeId>,
        partial: NodeId,
        inner: NodeId,
    ) -> NodeId {
        let mut guards = Vec::new();
        let partial = self.remove_flat_guards(partial, &mut guards);
        let inner = self.remove_flat_guards(inner, &mut guards);
        let term = self.build_term_with_limits(operand, partial, inner);
        let guards = guards.into_iter().rev();
        guards.fold(term, |term, guard| self.guard_flat(guard, term))
    }

    fn build_term_with_limits(
        &mut self,
        operand: Option<NodeId>,
        partial: NodeId,
        inner: NodeId,
    ) -> NodeId {
        let mut term = self.multiply(partial, inner);
        if !self.has_reciprocal_root(term) {
            return term;
        }
        let arguments = self.find_reciprocal_arguments(term);
        for &argument in arguments.iter() {
            if self.order(argument, term) > 0.0 {
                term = guard(self, term, argument, None);
            }
        }
        let arguments = self.find_reciprocal_arguments(term);
        let cofactor = self
            .cofactor(&arguments, term)
            .or_else(|| self.find_vanishing_factor(operand?, partial));
        match cofactor {
            Some(cofactor) if self.as_constant(cofactor).is_none() => {
                let square = self.integer_power(cofactor, 2);
                let guarded = |term, argument: &NodeId| guard(self, term, *argument, Some(square));
                arguments.iter().fold(term, guarded)
            }
            _ => term,
        }
    }

    /// Returns base and exponent of the power that a guarded power equals if the base is not 0.
    pub(crate) fn guarded_power(&self, id: NodeId) -> Option<(NodeId, i32)> {
        self.read_guarded_power(self.operation(id))
    }

    fn read_guarded_power(&self, operation: &Operation) -> Option<(NodeId, i32)> {
        let &Operation::Select {
            a,
            b,
            then,
            otherwise,
            ..
        } = operation
        else {
            return None;
        };
        if !self.is_zero(b) {
            return None;
        }
        if !self.is_zero(otherwise) {
            return self.is_guard_of(otherwise, then);
        }
        let is_root = self.find_root_argument(a).is_some();
        match self.operation(then) {
            Operation::Product(factors) if is_root && **factors == [(a, -1)] => Some((a, -1)),
            Operation::Power(..) => {
                let (base, _) = self.read_negative_power(then)?;
                (base == a).then_some((then, 1))
            }
            _ => None,
        }
    }

    /// Returns base and exponent of `power` if `guarded` is its guarded form.
    fn is_guard_of(&self, guarded: NodeId, power: NodeId) -> Option<(NodeId, i32)> {
        match *self.operation(guarded) {
            Operation::Select {
                then, otherwise, ..
            } if then == power && self.is_zero(otherwise) => self.guarded_power(guarded),
            _ => None,
        }
    }

    /// Returns true if an operation contains a reciprocal of a root that can be infinite.
    pub(crate) fn holds_reciprocal_root(&self, operation: &Operation) -> bool {
        let held = |ids: &[NodeId]| ids.iter().any(|id| self.has_reciprocal_root(*id));
        let is_reciprocal = match operation {
            Operation::Product(factors) => factors
                .iter()
                .any(|factor| self.find_reciprocal_argument(*factor).is_some()),
            Operation::Power(_, exponent) => {
                let exponent = self.as_constant(*exponent);
                exponent.is_some_and(|value| value < 0.0)
            }
            _ => false,
        };
        match operation {
            Operation::Select { a, otherwise, .. }
                if self.is_zero(*otherwise) && self.read_guarded_power(operation).is_some() =>
            {
                held(&[*a])
            }
            _ => is_reciprocal || held(&self.operands(operation)),
        }
    }

    /// Returns base s and exponent p of a node c |s|^p with a constant c; nested roots and powers are resolved.
    pub(super) fn read_base_power(&self, id: NodeId) -> (NodeId, f64) {
        let (inner, exponent) = match self.operation(id) {
            Operation::Call(Function::Sqrt, a) => (a[0], 0.5),
            Operation::Call(Function::Abs, a) => (a[0], 1.0),
            Operation::Power(base, exponent) => match self.as_constant(*exponent) {
                Some(exponent) if exponent > 0.0 => (*base, exponent),
                _ => return (id, 1.0),
            },
            Operation::Sum(terms) if terms.len() == 1 => (terms[0].1, 1.0),
            Operation::Product(factors) => {
                let mut moving = factors
                    .iter()
                    .filter(|(factor, _)| !self.dependence(*factor).is_parameter_only());
                match (moving.next(), moving.next()) {
                    (Some(&(factor, exponent)), None) if exponent > 0 => {
                        (factor, f64::from(exponent))
                    }
                    _ => return (id, 1.0),
                }
            }
            _ => return (id, 1.0),
        };
        let (base, power) = self.read_base_power(inner);
        (base, power * exponent)
    }

    fn find_root_argument(&self, id: NodeId) -> Option<NodeId> {
        match self.operation(id) {
            Operation::Call(Function::Sqrt, arguments) => arguments.first().copied(),
            _ => None,
        }
    }

    /// Returns base and exponent of a power with a negative constant exponent.
    pub(super) fn read_negative_power(&self, id: NodeId) -> Option<(NodeId, f64)> {
        let Operation::Power(base, exponent) = *self.operation(id) else {
            return None;
        };
        let exponent = self.as_constant(exponent)?;
        (exponent < 0.0).then_some((base, exponent))
    }

    /// Returns base s and exponent p of a factor s^-p, the reciprocal of a root or of a real power.
    pub(super) fn reciprocal(&self, (factor, exponent): (NodeId, i32)) -> Option<(NodeId, f64)> {
        let (inner, power) = match exponent < 0 {
            true => (
                self.find_root_argument(factor).map(|_| factor)?,
                -f64::from(exponent),
            ),
            false => {
                let (base, power) = self.read_negative_power(factor)?;
                (base, -power * f64::from(exponent))
            }
        };
        let (base, own) = self.read_base_power(inner);
        Some((base, own * power))
    }

    fn find_reciprocal_argument(&self, factor: (NodeId, i32)) -> Option<NodeId> {
        self.reciprocal(factor).map(|(base, _)| base)
    }

    /// Returns the arguments of all roots with unguarded reciprocals in a node.
    fn find_reciprocal_arguments(&mut self, id: NodeId) -> Arc<Vec<NodeId>> {
        if let Some(known) = self.orders_at_zeros.arguments.get(&id) {
            return known.clone();
        }
        let operation = self.operation(id).clone();
        let mut found = Vec::new();
        if let Operation::Product(factors) = &operation {
            let arguments = factors
                .iter()
                .filter_map(|factor| self.find_reciprocal_argument(*factor));
            found.extend(arguments);
        }
        found.extend(self.find_reciprocal_argument((id, 1)));
        for operand in self.operands(&operation) {
            if self.has_reciprocal_root(operand) {
                found.extend(self.find_reciprocal_arguments(operand).iter());
            }
        }
        found.sort_unstable();
        found.dedup();
        let found = Arc::new(found);
        self.orders_at_zeros.arguments.insert(id, found.clone());
        found
    }

    /// Returns the order of a node in `argument`; the order is negative if the node is not proven to be bounded.
    pub(super) fn order(&mut self, argument: NodeId, id: NodeId) -> f64 {
        if let Some(&known) = self.orders_at_zeros.orders.get(&(argument, id)) {
            return known;
        }
        let order = match self.bounds(argument) {
            Some(bounds) => self.order_by(argument, &bounds, id),
            None => f64::NEG_INFINITY,
        };
        self.orders_at_zeros.orders.insert((argument, id), order);
        order
    }

    fn order_by(&mut self, argument: NodeId, bounds: &Bounds, id: NodeId) -> f64 {
        let (base, power) = self.read_base_power(id);
        if base == argument {
            return power;
        }
        if let Some(guard) = self.flat_guard(id) {
            return self.order(argument, guard.inner);
        }
        if let Some((factor, exponent)) = self.guarded_power(id) {
            let exponent = f64::from(exponent);
            return exponent * self.factor_order(argument, factor, exponent);
        }
        match self.operation(id).clone() {
            Operation::Product(factors) => {
                self.find_product_order(argument, bounds, &as_real(&factors), None)
            }
            Operation::Sum(terms) => {
                let orders = terms.iter().map(|(_, term)| self.order(argument, *term));
                let least = orders.fold(f64::INFINITY, f64::min);
                least.max(self.find_product_order(argument, bounds, &[(id, 1.0)], Some(id)))
            }
            Operation::Call(Function::Sqrt, a) => 0.5 * self.order(argument, a[0]),
            Operation::Call(function, a) if vanishes_with_argument(function) => {
                self.order(argument, a[0])
            }
            Operation::Call(Function::Max | Function::Min, a) => {
                self.order(argument, a[0]).min(self.order(argument, a[1]))
            }
            Operation::Select {
                then, otherwise, ..
            } => self
                .order(argument, then)
                .min(self.order(argument, otherwise)),
            Operation::Power(base, exponent) => match self.as_constant(exponent) {
                Some(exponent) if exponent > 0.0 || self.read_base_power(base).0 == argument => {
                    exponent * self.order(argument, base)
                }
                Some(_) if self.order(argument, base) != 0.0 => f64::NEG_INFINITY,
                _ => self.find_bounded_order(argument, &[base, exponent]),
            },
            Operation::Total(vector)
            | Operation::Apply { vector, .. }
            | Operation::CholeskySolve(_, vector) => {
                let of_node = self.find_product_order(argument, bounds, &[(id, 1.0)], Some(id));
                of_node.max(self.order(argument, vector))
            }
            operation => {
                let operands = self.operands(&operation);
                let bounded = self.find_bounded_order(argument, &operands);
                bounded.max(self.find_product_order(argument, bounds, &[(id, 1.0)], Some(id)))
            }
        }
    }

    /// Returns the order 0 if all operands are bounded, else negative infinity.
    fn find_bounded_order(&mut self, argument: NodeId, operands: &[NodeId]) -> f64 {
        let unbounded = operands.iter().any(|operand| {
            self.has_reciprocal_root(*operand) && self.order(argument, *operand) < 0.0
        });
        if unbounded { f64::NEG_INFINITY } else { 0.0 }
    }

    /// Returns the order of a product: the sum of the orders of the monomials and of the other factors in it.
    fn find_product_order(
        &mut self,
        argument: NodeId,
        bounds: &Bounds,
        factors: &[(NodeId, f64)],
        own: Option<NodeId>,
    ) -> f64 {
        let mut left = HashMap::new();
        for &(factor, exponent) in factors {
            self.split_absolute(factor, exponent, &mut left);
        }
        let mut order = 0.0;
        for (monomial, each) in bounds.iter() {
            let times = count_divisions(monomial, &left);
            take(monomial, times, &mut left);
            order += times * each;
        }
        for (factor, exponent) in sorted(left) {
            // A node that contains no monomial has no known order and counts as order 0.
            if own == Some(factor) {
                continue;
            }
            order += exponent * self.factor_order(argument, factor, exponent);
        }
        order
    }

    /// Returns the order of a factor. The order of a reciprocal is known only for powers of the argument and for
    /// factors of order 0.
    fn factor_order(&mut self, argument: NodeId, factor: NodeId, exponent: f64) -> f64 {
        let (base, power) = self.read_base_power(factor);
        if base == argument {
            return power;
        }
        match self.order(argument, factor) {
            order if exponent > 0.0 || order == 0.0 => order,
            _ => f64::INFINITY,
        }
    }

    /// Adds the factors of a power; the absolute value of a product has the factors of the product.
    pub(super) fn split_absolute(
        &self,
        factor: NodeId,
        exponent: f64,
        into: &mut HashMap<NodeId, f64>,
    ) {
        match self.operation(factor) {
            Operation::Call(Function::Abs, a) => self.split_absolute(a[0], exponent, into),
            Operation::Call(Function::Sign, _) if exponent > 0.0 => {}
            Operation::Call(Function::Sqrt, a) if exponent > 0.0 => {
                self.split_absolute(a[0], 0.5 * exponent, into);
            }
            Operation::Power(base, power) if exponent > 0.0 => match self.as_constant(*power) {
                Some(power) if power > 0.0 => self.split_absolute(*base, power * exponent, into),
                _ => *into.entry(factor).or_insert(0.0) += exponent,
            },
            Operation::Product(factors) => {
                for &(inner, power) in factors {
                    self.split_absolute(inner, f64::from(power) * exponent, into);
                }
            }
            Operation::Sum(terms) if terms.len() == 1 => {
                self.split_absolute(terms[0].1, exponent, into);
            }
            _ => *into.entry(factor).or_insert(0.0) += exponent,
        }
    }

    /// Returns the monomials that are zero wherever a sum of terms with the same sign is zero. Returns `None` if the
    /// terms can have different signs, or if a term of parameters keeps the sum from being zero.
    pub(super) fn bounds(&mut self, argument: NodeId) -> Option<Bounds> {
        if let Some(known) = self.orders_at_zeros.bounds.get(&argument) {
            return known.clone();
        }
        let mut monomials = Vec::new();
        let bounds = self
            .add_bounds(argument, true, &mut monomials)
            .then(|| Arc::new(monomials));
        self.orders_at_zeros.bounds.insert(argument, bounds.clone());
        bounds
    }

    fn add_bounds(&mut self, id: NodeId, is_sole: bool, into: &mut Vec<(Monomial, f64)>) -> bool {
        if self.dependence(id).is_parameter_only() {
            return false;
        }
        if let Operation::Sum(terms) = self.operation(id).clone() {
            let is_sole = is_sole && terms.len() == 1;
            return terms.iter().all(|(factor, term)| {
                (is_sole || factor.value() > 0.0) && self.add_bounds(*term, is_sole, into)
            });
        }
        let mut factors = HashMap::new();
        self.split_absolute(id, 1.0, &mut factors);
        factors.retain(|factor, exponent| {
            *exponent > 0.0 && !self.dependence(*factor).is_parameter_only()
        });
        let factors = sorted(factors);
        if let [(factor, 1.0)] = factors[..]
            && factor != id
        {
            return self.add_bounds(factor, is_sole, into);
        }
        let is_square = factors.iter().all(|(_, exponent)| exponent % 2.0 == 0.0);
        if factors.is_empty() || !(is_sole || is_square || self.is_never_negative(id)) {
            return false;
        }
        if let [(factor, exponent)] = factors[..]
            && matches!(self.operation(factor), Operation::Sum(_))
            && let Some(inner) = self.bounds(factor)
        {
            let of_inner = inner.iter();
            into.extend(of_inner.map(|(monomial, order)| (monomial.clone(), order / exponent)));
        }
        into.push((factors, 1.0));
        true
    }

    fn is_never_negative(&self, id: NodeId) -> bool {
        match self.operation(id) {
            Operation::Product(factors) => factors.iter().all(|(factor, exponent)| {
                exponent % 2 == 0
                    || self.dependence(*factor).is_parameter_only()
                    || self.is_never_negative(*factor)
            }),
            Operation::Call(Function::Max, a) => a
                .iter()
                .any(|a| self.as_constant(*a).is_some_and(|value| value >= 0.0)),
            Operation::Call(function, _) => {
                matches!(
                    function,
                    Function::Abs | Function::Sqrt | Function::Exp | Function::Cosh
                )
            }
            _ => false,
        }
    }
}

/// Returns true if |function(x)| <= C |x| near 0.
pub(super) fn vanishes_with_argument(function: Function) -> bool {
    function.is_odd() && !function.has_jump()
        || matches!(function, Function::Abs | Function::Deadzone)
}

/// Returns the node with guards on all reciprocals of roots of `argument`. If `condition` is given, the guards act
/// only where it is 0.
fn guard(graph: &mut Graph, id: NodeId, argument: NodeId, condition: Option<NodeId>) -> NodeId {
    let replacement =
        |graph: &mut Graph, node: NodeId| is_guarded(graph, node, argument, condition);
    substitute(graph, id, &replacement, &mut HashMap::new())
}

fn is_guarded(
    graph: &mut Graph,
    id: NodeId,
    argument: NodeId,
    condition: Option<NodeId>,
) -> Option<NodeId> {
    if !graph.has_reciprocal_root(id) {
        return Some(id);
    }
    if let Some((base, exponent)) = graph.guarded_power(id) {
        let power = graph.integer_power(base, exponent);
        return match is_guarded(graph, power, argument, condition) {
            Some(anew) if anew != power => Some(anew),
            _ => Some(id),
        };
    }
    if let Some((base, _)) = graph.read_negative_power(id)
        && graph.read_base_power(base).0 == argument
    {
        return Some(build_guarded_reciprocal(graph, base, id, condition));
    }
    let Operation::Product(factors) = graph.operation(id).clone() else {
        return None;
    };
    if !factors
        .iter()
        .any(|factor| graph.find_reciprocal_argument(*factor) == Some(argument))
    {
        return None;
    }
    let mut rebuilt = Vec::with_capacity(factors.len());
    for &(factor, exponent) in &factors {
        let is_reciprocal = graph.find_reciprocal_argument((factor, exponent)) == Some(argument);
        rebuilt.push(match exponent < 0 && is_reciprocal {
            true => {
                let reciprocal = graph.integer_power(factor, -1);
                let reciprocal = build_guarded_reciprocal(graph, factor, reciprocal, condition);
                (reciprocal, -exponent)
            }
            false => (guard(graph, factor, argument, condition), exponent),
        });
    }
    Some(graph.product(&rebuilt))
}

/// Returns a node that is 0 if the root and the condition are 0, else the reciprocal of the root.
fn build_guarded_reciprocal(
    graph: &mut Graph,
    root: NodeId,
    reciprocal: NodeId,
    condition: Option<NodeId>,
) -> NodeId {
    let zero = graph.zero();
    let at_zero = graph.select(root, zero, reciprocal, zero);
    match condition {
        Some(condition) => graph.select(condition, zero, reciprocal, at_zero),
        None => at_zero,
    }
}

/// Returns the largest exponent with which a power of the monomial divides a product.
pub(super) fn count_divisions(monomial: &Monomial, product: &HashMap<NodeId, f64>) -> f64 {
    let held = |(node, exponent): &(NodeId, f64)| product.get(node).map_or(0.0, |n| n / exponent);
    let times = monomial.iter().map(held);
    times.fold(f64::INFINITY, f64::min).max(0.0)
}

/// Divides a product by a power of a monomial.
pub(super) fn take(monomial: &Monomial, times: f64, product: &mut HashMap<NodeId, f64>) {
    for (node, exponent) in monomial {
        product.entry(*node).and_modify(|n| *n -= times * exponent);
    }
}

/// Returns the factors with nonzero exponents in the order of their nodes.
pub(super) fn sorted(factors: HashMap<NodeId, f64>) -> Monomial {
    let mut factors: Monomial = factors
        .into_iter()
        .filter(|(_, exponent)| exponent.abs() > EXPONENT_ROUNDING)
        .collect();
    factors.sort_unstable_by_key(|(node, _)| *node);
    factors
}

fn as_real(factors: &[(NodeId, i32)]) -> Monomial {
    let real = |&(factor, exponent): &(NodeId, i32)| (factor, f64::from(exponent));
    factors.iter().map(real).collect()
}
