//! Cofactors of bounded terms. They show where a term of a derivative is zero at zeros of the square roots in it.
//!
//! The derivative of `norm([v_x, v_y])*v_z` by v_x is v_x v_z/norm. It is bounded by |v_z|; v_z is its cofactor.
//! Where norm and v_z are both 0, the limit is 0. A cofactor c of a term f is a continuous node with |f| <= C |c|
//! near zeros of the roots in f. Each factor of a product cancels at most one root; the product of the remaining
//! factors is the cofactor.

use std::collections::HashMap;
use std::sync::Arc;

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::limits::{
    EXPONENT_ROUNDING, count_divisions, sorted, take, vanishes_with_argument,
};

impl Graph {
    /// Returns the cofactor of a node near zeros of the arguments of its roots, or 1 if no cofactor is known. Returns
    /// `None` if the node is not proven to be bounded.
    pub(super) fn cofactor(&mut self, arguments: &Arc<Vec<NodeId>>, id: NodeId) -> Option<NodeId> {
        if !self.has_reciprocal_root(id) {
            return Some(self.factor_that_vanishes(arguments, id));
        }
        let key = (arguments.clone(), id);
        if let Some(&known) = self.orders_at_zeros.cofactors.get(&key) {
            return known;
        }
        let found = self.find_cofactor(arguments, id);
        self.orders_at_zeros.cofactors.insert(key, found);
        found
    }

    fn find_cofactor(&mut self, arguments: &Arc<Vec<NodeId>>, id: NodeId) -> Option<NodeId> {
        if let Some(guard) = self.flat_guard(id) {
            return self.cofactor(arguments, guard.inner);
        }
        match self.operation(id).clone() {
            Operation::Product(factors) => self.find_product_cofactor(arguments, &factors),
            Operation::Sum(terms) => {
                let terms: Vec<NodeId> = terms.iter().map(|(_, term)| *term).collect();
                self.find_sum_cofactor(arguments, &terms)
            }
            Operation::Call(Function::Max | Function::Min, operands) => {
                self.find_sum_cofactor(arguments, &operands)
            }
            Operation::Call(function, operands)
                if function == Function::Sqrt || vanishes_with_argument(function) =>
            {
                self.cofactor(arguments, operands[0])
            }
            Operation::Power(base, exponent) => match self.as_constant(exponent) {
                Some(exponent) if exponent > 0.0 => self.cofactor(arguments, base),
                _ => None,
            },
            _ => None,
        }
    }

    /// Returns the cofactor of a sum: the sum of the squares of the cofactors of its terms.
    fn find_sum_cofactor(
        &mut self,
        arguments: &Arc<Vec<NodeId>>,
        terms: &[NodeId],
    ) -> Option<NodeId> {
        let mut squares = Vec::with_capacity(terms.len());
        for term in terms {
            let cofactor = self.cofactor(arguments, *term)?;
            squares.push((1.0, self.integer_power(cofactor, 2)));
        }
        if squares
            .iter()
            .any(|(_, square)| self.as_constant(*square).is_some())
        {
            return Some(self.one());
        }
        Some(self.combine(&squares))
    }

    fn find_product_cofactor(
        &mut self,
        arguments: &Arc<Vec<NodeId>>,
        factors: &[(NodeId, i32)],
    ) -> Option<NodeId> {
        let (mut roots, mut left) = (HashMap::new(), HashMap::new());
        for &factor in factors {
            self.split_reciprocals(arguments, factor, &mut roots, &mut left)?;
        }
        for (argument, power) in sorted(roots) {
            self.cancel(argument, power, &mut left)?;
        }
        let mut cofactor = self.one();
        for (factor, exponent) in sorted(left) {
            if exponent > 0.0 {
                let factor = self.factor_that_vanishes(arguments, factor);
                cofactor = self.multiply(cofactor, factor);
            }
        }
        Some(cofactor)
    }

    /// Adds a factor of a product to the list of reciprocal roots or to the list of other factors.
    fn split_reciprocals(
        &mut self,
        arguments: &Arc<Vec<NodeId>>,
        (factor, exponent): (NodeId, i32),
        roots: &mut HashMap<NodeId, f64>,
        left: &mut HashMap<NodeId, f64>,
    ) -> Option<()> {
        if let Some((base, power)) = self.guarded_power(factor) {
            return self.split_reciprocals(arguments, (base, power * exponent), roots, left);
        }
        if let Some((argument, power)) = self.reciprocal((factor, exponent)) {
            *roots.entry(argument).or_insert(0.0) += power;
            return Some(());
        }
        match self.operation(factor).clone() {
            Operation::Product(factors) => {
                for &(inner, power) in &factors {
                    self.split_reciprocals(arguments, (inner, power * exponent), roots, left)?;
                }
            }
            _ if !self.has_reciprocal_root(factor) => {
                self.split_absolute(factor, f64::from(exponent), left);
            }
            _ if exponent > 0 => {
                let cofactor = self.cofactor(arguments, factor)?;
                self.split_absolute(cofactor, 1.0, left);
            }
            _ => return None,
        }
        Some(())
    }

    /// Removes from `factors` a product that cancels the reciprocal of a power of `argument`.
    fn cancel(
        &mut self,
        argument: NodeId,
        mut power: f64,
        left: &mut HashMap<NodeId, f64>,
    ) -> Option<()> {
        let bounds = self.bounds(argument)?;
        for (monomial, order) in bounds.iter() {
            let times = count_divisions(monomial, left).min(power / order);
            take(monomial, times, left);
            power -= times * order;
        }
        for (factor, exponent) in sorted(left.clone()) {
            let order = self.order(argument, factor);
            if exponent > 0.0 && order > 0.0 && power > EXPONENT_ROUNDING {
                let times = exponent.min(power / order);
                left.insert(factor, exponent - times);
                power -= times * order;
            }
        }
        (power <= EXPONENT_ROUNDING).then_some(())
    }

    /// Returns the node if it is continuous and can be 0 at zeros of the arguments, else 1.
    fn factor_that_vanishes(&mut self, arguments: &Arc<Vec<NodeId>>, id: NodeId) -> NodeId {
        let may_vanish = match self.operation(id).clone() {
            _ if self.dependence(id).is_parameter_only() => false,
            Operation::Sum(terms) => {
                let (constant, moving): (Vec<NodeId>, Vec<NodeId>) = terms
                    .iter()
                    .map(|(_, term)| *term)
                    .partition(|term| self.dependence(*term).is_parameter_only());
                constant.is_empty()
                    || !moving
                        .into_iter()
                        .all(|term| arguments.iter().any(|s| self.order(*s, term) > 0.0))
            }
            _ => true,
        };
        match may_vanish && self.is_continuous(id) {
            true => id,
            false => self.one(),
        }
    }

    /// Returns true if a node is a continuous function of continuous operands.
    pub(super) fn is_continuous(&mut self, id: NodeId) -> bool {
        if let Some(&known) = self.orders_at_zeros.continuous.get(&id) {
            return known;
        }
        let operation = self.operation(id).clone();
        let operands = self.operands(&operation);
        let is_continuous = match operation {
            Operation::Sum(_) | Operation::Product(_) | Operation::Power(..) => true,
            Operation::Call(function, _) => !function.has_jump(),
            _ => operands.is_empty(),
        };
        let is_continuous = is_continuous
            && operands
                .into_iter()
                .all(|operand| self.is_continuous(operand));
        self.orders_at_zeros.continuous.insert(id, is_continuous);
        is_continuous
    }
}
