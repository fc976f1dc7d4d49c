//! Derivatives of products at zeros of a smooth factor.
//!
//! Let A be continuous at a point, and let B be zero there with |B| <= C |dx|, as for a Lipschitz function. Then A B
//! has the derivative A dB at this point, because A B = A(0) B + o(|dx|). The other term of the product rule, B dA,
//! is 0 even if dA is infinite. For example, `sqrt(norm([v_x, v_y]))*v_z` has the derivative 0 at rest. Therefore the
//! reciprocals of roots in B dA are set to 0 where the roots and B are 0. Elsewhere they remain infinite.

use eomgen_model_spec::model::Function;

use crate::symbolic::graph::{Graph, NodeId, Operation};

impl Graph {
    /// Returns a factor of `partial`, the derivative of a node with respect to its `operand`. Where this factor is
    /// zero, `partial` times the derivative of `operand` is zero. Returns `None` if no such factor is known.
    pub(super) fn find_vanishing_factor(
        &mut self,
        operand: NodeId,
        partial: NodeId,
    ) -> Option<NodeId> {
        if self.has_reciprocal_root(operand)
            || self.has_reciprocal_root(partial)
            || !self.is_continuous(operand)
        {
            return None;
        }
        let factors = match self.operation(partial) {
            Operation::Sum(terms) if terms.len() == 1 => self.factors(terms[0].1),
            _ => self.factors(partial),
        };
        let mut smooth = Vec::new();
        for (factor, exponent) in factors {
            if self.dependence(factor).is_parameter_only() {
                continue;
            }
            if exponent < 0 || !self.is_continuous(factor) {
                return None;
            }
            if self.is_lipschitz(factor) {
                smooth.push((factor, exponent));
            }
        }
        (!smooth.is_empty()).then(|| self.product(&smooth))
    }

    fn factors(&self, id: NodeId) -> Vec<(NodeId, i32)> {
        match self.operation(id) {
            Operation::Product(factors) => factors.to_vec(),
            _ => vec![(id, 1)],
        }
    }

    /// Returns true if a continuous node is Lipschitz near each of its finite values.
    fn is_lipschitz(&mut self, id: NodeId) -> bool {
        if let Some(&known) = self.orders_at_zeros.lipschitz.get(&id) {
            return known;
        }
        let operation = self.operation(id).clone();
        let is_lipschitz = match &operation {
            Operation::Call(Function::Sqrt, arguments) => self.is_norm(arguments[0]),
            Operation::Call(Function::Asin | Function::Acos | Function::Ln, _) => false,
            Operation::Power(base, exponent) => {
                self.as_constant(*exponent)
                    .is_some_and(|value| value >= 1.0)
                    && self.is_lipschitz(*base)
            }
            _ => {
                let operands = self.operands(&operation);
                operands
                    .into_iter()
                    .all(|operand| self.is_lipschitz(operand))
            }
        };
        let is_lipschitz = is_lipschitz && self.is_continuous(id);
        self.orders_at_zeros.lipschitz.insert(id, is_lipschitz);
        is_lipschitz
    }

    /// Returns true for a sum of squares of Lipschitz nodes with factors of one sign.
    fn is_norm(&mut self, square: NodeId) -> bool {
        if let Operation::Sum(terms) = self.operation(square).clone() {
            return terms
                .iter()
                .all(|(factor, term)| factor.value() > 0.0 && self.is_norm(*term));
        }
        self.factors(square).into_iter().all(|(factor, exponent)| {
            let is_square = exponent > 0 && exponent % 2 == 0;
            self.dependence(factor).is_parameter_only()
                || is_square && self.is_lipschitz(factor)
                || exponent == 1 && factor != square && self.is_norm(factor)
        })
    }
}
