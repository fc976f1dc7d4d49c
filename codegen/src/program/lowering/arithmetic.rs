//! Sums and products as binary operations in a fixed order.

use eomgen_model_spec::model::Function;

use super::values::Lowering;
use crate::program::{Extent, Op, ValueId};
use crate::symbolic::association::Factor;
use crate::symbolic::graph::{Bits, NodeId, Operation, Shape};

impl Lowering<'_> {
    /// Adds the prepared terms first. The other terms follow in the order of their critical paths; therefore the
    /// addition does not wait for the slowest terms. Positive terms precede negative terms, which saves a negation.
    pub(super) fn sum(&mut self, terms: &[(Bits, NodeId)]) -> ValueId {
        let graph = self.graph;
        let (parameter_only, mut live): (Vec<_>, Vec<_>) = terms
            .iter()
            .map(|(factor, id)| (factor.value(), *id))
            .partition(|(_, id)| graph.dependence(*id).is_parameter_only());
        live.sort_by_key(|(_, id)| graph.critical_path(*id));
        let mut parts: Vec<(bool, ValueId)> = parameter_only
            .iter()
            .map(|(c, id)| self.term(*c, *id))
            .collect();
        if !live.is_empty() && parts.len() > 1 {
            parts = vec![(false, self.add_all(&parts))];
        }
        for equals in
            live.chunk_by(|(_, a), (_, b)| graph.critical_path(*a) == graph.critical_path(*b))
        {
            if graph.critical_path(equals[0].1) > 0 {
                parts = self.join_terms(parts);
            }
            parts.extend(equals.iter().map(|(c, id)| self.term(*c, *id)));
        }
        self.add_all(&parts)
    }

    /// Adds the parts to one part; the flag of the result is true if all parts are subtracted.
    fn join_terms(&mut self, parts: Vec<(bool, ValueId)>) -> Vec<(bool, ValueId)> {
        if parts.len() < 2 {
            return parts;
        }
        if parts.iter().any(|(negative, _)| !negative) {
            return vec![(false, self.add_all(&parts))];
        }
        let magnitudes: Vec<(bool, ValueId)> =
            parts.into_iter().map(|(_, value)| (false, value)).collect();
        vec![(true, self.add_all(&magnitudes))]
    }

    /// Adds the values; the flag of a part is true if it is subtracted.
    fn add_all(&mut self, parts: &[(bool, ValueId)]) -> ValueId {
        let mut ordered: Vec<(bool, ValueId)> = parts.to_vec();
        ordered.sort_by_key(|(negative, _)| *negative);
        let mut iterator = ordered.into_iter();
        let Some((negative, first)) = iterator.next() else {
            return self.constant(0.0);
        };
        let mut total = if negative { self.negate(first) } else { first };
        for (negative, value) in iterator {
            let op = if negative { Op::Subtract } else { Op::Add };
            total = self.binary(op, total, value);
        }
        total
    }

    /// Returns -a; if a has a prepared factor, the sign is applied to the factor.
    fn negate(&mut self, value: ValueId) -> ValueId {
        let extent = self.values[value.0].extent;
        if let Op::Multiply(factor, moving) = self.values[value.0].op
            && self.values[factor.0].parameter_only
            && !self.values[moving.0].parameter_only
        {
            let extent = self.values[factor.0].extent;
            let factor = self.emit(Op::Negate(factor), extent);
            return self.binary(Op::Multiply, factor, moving);
        }
        self.emit(Op::Negate(value), extent)
    }

    /// Returns |c| times a node, and true if c is negative.
    pub(super) fn term(&mut self, factor: f64, id: NodeId) -> (bool, ValueId) {
        let graph = self.graph;
        let (negative, magnitude) = (factor < 0.0, factor.abs());
        if let Some(factors) = self.association.factors(magnitude, id) {
            let factors = factors.to_vec();
            return (negative, self.multiply_in_order(&factors));
        }
        let factors = match graph.operation(id) {
            Operation::Product(factors) => factors.to_vec(),
            Operation::Constant(bits) => {
                return (negative, self.constant(magnitude * bits.value()));
            }
            _ => vec![(id, 1)],
        };
        let (parameter_only, live): (Vec<_>, Vec<_>) = factors
            .into_iter()
            .partition(|(id, _)| graph.dependence(*id).is_parameter_only());
        if let Some(total) = self.scale_total(magnitude, &parameter_only, &live) {
            return (negative, total);
        }
        let coefficient = self.powers(magnitude, &parameter_only);
        let moving = (!live.is_empty())
            .then(|| self.select_by_contact(&live))
            .flatten();
        let value = match (coefficient, moving) {
            (Some(coefficient), Some(moving)) => self.binary(Op::Multiply, coefficient, moving),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => self.constant(1.0),
        };
        (negative, value)
    }

    /// Multiplies the factors in their order, with a prepared factor last.
    fn multiply_in_order(&mut self, factors: &[Factor]) -> ValueId {
        let mut product: Option<ValueId> = None;
        let (prepared, live): (Vec<Factor>, Vec<Factor>) = factors
            .iter()
            .partition(|factor| matches!(factor, Factor::Coefficient(_)));
        for factor in live {
            let value = self.factor(factor);
            product = Some(match product {
                Some(product) => self.binary(Op::Multiply, product, value),
                None => value,
            });
        }
        match (prepared.first(), product) {
            (Some(prepared), Some(product)) => {
                let coefficient = self.factor(*prepared);
                self.binary(Op::Multiply, coefficient, product)
            }
            (Some(only), None) => self.factor(*only),
            (None, Some(product)) => product,
            (None, None) => self.constant(1.0),
        }
    }

    fn factor(&mut self, factor: Factor) -> ValueId {
        match factor {
            Factor::Node(id) => self.value(id),
            Factor::Pair(index) => {
                let (a, b) = self.association.pair(index);
                self.multiply_in_order(&[a, b])
            }
            Factor::Coefficient(index) => {
                let prepared = self.association.coefficient(index).clone();
                let value = self.powers(prepared.number, &prepared.powers);
                value.unwrap_or_else(|| self.constant(1.0))
            }
        }
    }

    /// Moves a prepared factor of a sum over modes into the sum, if no other value uses the sum without this factor.
    /// Vector factors stay outside the sum.
    fn scale_total(
        &mut self,
        number: f64,
        parameter_only: &[(NodeId, i32)],
        live: &[(NodeId, i32)],
    ) -> Option<ValueId> {
        let graph = self.graph;
        let &[(total, 1)] = live else {
            return None;
        };
        let Operation::Total(summand) = graph.operation(total) else {
            return None;
        };
        let Operation::Product(factors) = graph.operation(*summand) else {
            return None;
        };
        let scalars = |(id, _): &(NodeId, i32)| graph.shape(*id) == Shape::Scalar;
        if !parameter_only.iter().all(scalars) {
            return None;
        }
        let once = self.uses.get(&total) == Some(&1);
        let (constant, moving): (Vec<_>, Vec<_>) = factors
            .iter()
            .partition(|(id, _)| graph.dependence(*id).is_parameter_only());
        if !once || constant.is_empty() || (parameter_only.is_empty() && number == 1.0) {
            return None;
        }
        let coefficient = self.powers(number, &[parameter_only, constant.as_slice()].concat())?;
        let moving = self.select_by_contact(&moving)?;
        let summand = self.binary(Op::Multiply, coefficient, moving);
        Some(self.emit(Op::Total(summand), Extent::Scalar))
    }

    /// Multiplies powers if one factor is `contact`. The result is a selection between the product of the other
    /// factors and 0, which needs no multiplication.
    fn select_by_contact(&mut self, factors: &[(NodeId, i32)]) -> Option<ValueId> {
        let graph = self.graph;
        let contact = |(id, _): &(NodeId, i32)| {
            matches!(graph.operation(*id), Operation::Call(Function::Contact, _))
        };
        let Some(index) = factors.iter().position(contact) else {
            return self.powers(1.0, factors);
        };
        if factors.len() == 1 || factors[index].1 < 0 {
            return self.powers(1.0, factors);
        }
        let mut others = factors.to_vec();
        others.remove(index);
        let then = self.select_by_contact(&others)?;
        let a = self.value(factors[index].0);
        let b = self.constant(0.0);
        let otherwise = b;
        let extent = self.join(a, then);
        let op = Op::Select {
            a,
            b,
            then,
            otherwise,
        };
        Some(self.emit(op, extent))
    }

    /// Multiplies a number and powers, scalars before vectors; returns `None` if the product is the constant 1.
    fn powers(&mut self, number: f64, factors: &[(NodeId, i32)]) -> Option<ValueId> {
        let graph = self.graph;
        let mut ordered = factors.to_vec();
        ordered.sort_by_key(|(id, _)| graph.shape(*id) != Shape::Scalar);
        let mut above: Option<ValueId> = (number != 1.0).then(|| self.constant(number));
        let mut below: Option<ValueId> = None;
        for (id, exponent) in ordered {
            let base = self.value(id);
            let power = self.integer_power(base, exponent.unsigned_abs());
            let side = if exponent > 0 { &mut above } else { &mut below };
            *side = Some(match *side {
                Some(product) => self.binary(Op::Multiply, product, power),
                None => power,
            });
        }
        match (above, below) {
            (above, None) => above,
            (Some(above), Some(below)) => Some(self.binary(Op::Divide, above, below)),
            (None, Some(below)) => {
                let one = self.constant(1.0);
                Some(self.binary(Op::Divide, one, below))
            }
        }
    }

    fn integer_power(&mut self, base: ValueId, exponent: u32) -> ValueId {
        let mut result: Option<ValueId> = None;
        let (mut square, mut rest) = (base, exponent);
        while rest > 0 {
            if rest & 1 == 1 {
                result = Some(match result {
                    Some(product) => self.binary(Op::Multiply, product, square),
                    None => square,
                });
            }
            rest >>= 1;
            if rest > 0 {
                square = self.binary(Op::Multiply, square, square);
            }
        }
        result.unwrap_or_else(|| self.constant(1.0))
    }
}
