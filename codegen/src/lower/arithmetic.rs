//! Sums and products as binary operations in a fixed order.

use super::values::Lowering;
use crate::graph::{Bits, Id, Operation, Shape};
use crate::program::{Op, ValueId};

impl Lowering<'_> {
    /// Prepared terms first, as one value; then the others, positive ones before
    /// negative ones so that no negation is needed.
    pub(super) fn sum(&mut self, terms: &[(Bits, Id)]) -> ValueId {
        let graph = self.graph;
        let (prepared, live): (Vec<_>, Vec<_>) = terms
            .iter()
            .map(|(factor, id)| (factor.value(), *id))
            .partition(|(_, id)| graph.dependence(*id).is_prepared());
        let mut parts: Vec<(bool, ValueId)> = Vec::new();
        if !live.is_empty() && prepared.len() > 1 {
            let whole: Vec<(bool, ValueId)> =
                prepared.iter().map(|(c, id)| self.term(*c, *id)).collect();
            parts.push((false, self.add_all(&whole)));
        } else {
            parts.extend(prepared.iter().map(|(c, id)| self.term(*c, *id)));
        }
        parts.extend(live.iter().map(|(c, id)| self.term(*c, *id)));
        self.add_all(&parts)
    }

    /// The sum of values, each with whether it is subtracted.
    fn add_all(&mut self, parts: &[(bool, ValueId)]) -> ValueId {
        let mut ordered: Vec<(bool, ValueId)> = parts.to_vec();
        ordered.sort_by_key(|(negative, _)| *negative);
        let mut iterator = ordered.into_iter();
        let Some((negative, first)) = iterator.next() else {
            return self.constant(0.0);
        };
        let mut total = if negative {
            let extent = self.values[first.0].extent;
            self.emit(Op::Negate(first), extent)
        } else {
            first
        };
        for (negative, value) in iterator {
            let op = if negative { Op::Subtract } else { Op::Add };
            total = self.binary(op, total, value);
        }
        total
    }

    /// |c| times a node, and whether c is negative.
    pub(super) fn term(&mut self, factor: f64, id: Id) -> (bool, ValueId) {
        let graph = self.graph;
        let (negative, magnitude) = (factor < 0.0, factor.abs());
        let factors = match graph.operation(id) {
            Operation::Product(factors) => factors.to_vec(),
            Operation::Constant(bits) => {
                return (negative, self.constant(magnitude * bits.value()));
            }
            _ => vec![(id, 1)],
        };
        let (prepared, live): (Vec<_>, Vec<_>) = factors
            .into_iter()
            .partition(|(id, _)| graph.dependence(*id).is_prepared());
        let coefficient = self.powers(magnitude, &prepared);
        let moving = (!live.is_empty())
            .then(|| self.powers(1.0, &live))
            .flatten();
        let value = match (coefficient, moving) {
            (Some(coefficient), Some(moving)) => self.binary(Op::Multiply, coefficient, moving),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => self.constant(1.0),
        };
        (negative, value)
    }

    /// A number times a product of powers, scalars before vectors; `None` for a bare 1.
    fn powers(&mut self, number: f64, factors: &[(Id, i32)]) -> Option<ValueId> {
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

    /// base^n by squaring.
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
