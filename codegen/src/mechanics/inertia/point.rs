//! Values of scalar nodes at one point.

use eomgen_model_spec::function::call;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Parameters, state and inputs, in SI units.
pub(crate) struct Point<'p> {
    pub(crate) parameters: &'p [f64],
    /// Coordinates, their rates, then the first-order states.
    pub(crate) state: &'p [f64],
    pub(crate) inputs: &'p [f64],
    pub(crate) coordinates: usize,
}

impl Point<'_> {
    /// Computes the values of `nodes` (operands first), indexed by node; `None` if a node belongs to a field.
    pub(crate) fn values(&self, graph: &Graph, nodes: &[NodeId]) -> Option<Vec<f64>> {
        let size = nodes.last().map_or(0, |last| last.0 as usize + 1);
        let mut values = vec![f64::NAN; size];
        for &node in nodes {
            let value = self.value(graph.operation(node), &values)?;
            values[node.0 as usize] = value;
        }
        Some(values)
    }

    fn value(&self, operation: &Operation, known: &[f64]) -> Option<f64> {
        let of = |node: &NodeId| known[node.0 as usize];
        let given = |list: &[f64], place: usize| list.get(place).copied();
        Some(match operation {
            Operation::Constant(value) => value.value(),
            Operation::Parameter(index) => given(self.parameters, index.index())?,
            Operation::Coordinate(index) => given(self.state, index.index())?,
            Operation::Rate(index) => given(self.state, self.coordinates + index.index())?,
            Operation::State(index) => given(self.state, 2 * self.coordinates + index.index())?,
            Operation::Input(index) => given(self.inputs, index.index())?,
            Operation::Time => 0.0,
            Operation::Sum(terms) => terms.iter().map(|(c, term)| c.value() * of(term)).sum(),
            Operation::Product(factors) => {
                let powers = factors.iter().map(|(node, power)| of(node).powi(*power));
                powers.product()
            }
            Operation::Call(function, arguments) => {
                let mut arguments = arguments.iter();
                let first = arguments.next().map_or(f64::NAN, of);
                call(*function, first, arguments.next().map_or(f64::NAN, of))
            }
            Operation::Power(base, exponent) => of(base).powf(of(exponent)),
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                ..
            } => match of(a) > of(b) {
                true => of(then),
                false => of(otherwise),
            },
            _ => return None,
        })
    }
}
