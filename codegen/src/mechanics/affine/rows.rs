//! Coefficients of an expression of first degree in the motion: its derivatives, and its value with zero state,
//! inputs and sinusoids.

use std::collections::HashMap;

use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, StateId};
use eomgen_model_spec::model::Function;

use crate::mechanics::rows::RowNodes;
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::graph::{Graph, NodeId, Operation, Space};
use crate::symbolic::modal_derivative::ModalDerivative;
use crate::symbolic::substitute::substitute;

/// Coefficients of an expression. The coefficients of a scalar are scalars, or vectors over the modes of a field. The
/// coefficients of a vector over modes are vectors, or matrices over the modes of both fields.
#[derive(Clone, Debug)]
pub(crate) struct AffineRow {
    pub coordinates: Vec<NodeId>,
    pub mode_coordinates: Vec<NodeId>,
    pub rates: Vec<NodeId>,
    pub mode_rates: Vec<NodeId>,
    pub states: Vec<NodeId>,
    pub inputs: Vec<NodeId>,
    pub sines: Vec<NodeId>,
    pub cosines: Vec<NodeId>,
    pub constant: NodeId,
}

impl AffineRow {
    /// Returns all coefficients.
    pub fn nodes(&self) -> impl Iterator<Item = NodeId> + '_ {
        let blocks = [
            &self.coordinates,
            &self.mode_coordinates,
            &self.rates,
            &self.mode_rates,
            &self.states,
            &self.inputs,
            &self.sines,
            &self.cosines,
        ];
        let all = blocks.into_iter().flatten().copied();
        all.chain(std::iter::once(self.constant))
    }
}

pub(super) struct Sinusoids {
    /// Distinct phases.
    pub phases: Vec<NodeId>,
    /// Sine and cosine of each phase.
    calls: Vec<[NodeId; 2]>,
}

impl Sinusoids {
    /// Finds the sinusoids in `nodes`.
    pub fn find(graph: &mut Graph, nodes: &[NodeId]) -> Self {
        let mut phases = Vec::new();
        for id in graph.reachable(nodes) {
            if graph.dependence(id).is_parameter_only() {
                continue;
            }
            if let Operation::Call(Function::Sin | Function::Cos, arguments) = graph.operation(id)
                && !phases.contains(&arguments[0])
            {
                phases.push(arguments[0]);
            }
        }
        let calls = phases
            .iter()
            .map(|&phase| {
                let functions = [Function::Sin, Function::Cos];
                functions.map(|function| graph.intern(Operation::Call(function, (&[phase]).into())))
            })
            .collect();
        Self { phases, calls }
    }
}

pub(super) struct Reader<'a> {
    sinusoids: &'a Sinusoids,
    coordinates: Vec<NodeId>,
    rates: Vec<NodeId>,
    states: Vec<NodeId>,
    inputs: Vec<NodeId>,
    modes: Vec<ModalDerivative>,
    mode_rates: Vec<ModalDerivative>,
    at_rest: HashMap<NodeId, NodeId>,
}

impl<'a> Reader<'a> {
    /// Prepares the variables of a model whose accelerations have these rows; `states` is the number of first-order
    /// states.
    pub fn new(
        graph: &mut Graph,
        (rows, states): (&RowNodes, usize),
        sinusoids: &'a Sinusoids,
        inputs: usize,
    ) -> Self {
        let scalars = CoordinateId::first(rows.scalars.len());
        let fields = FieldId::first(rows.modal.len());
        let mut modal = |operation: fn(FieldId) -> Operation| -> Vec<ModalDerivative> {
            fields
                .clone()
                .filter_map(|field| {
                    let variable = graph.intern(operation(field));
                    ModalDerivative::new(graph, variable)
                })
                .collect()
        };
        let (modes, mode_rates) = (
            modal(Operation::ModeCoordinates),
            modal(Operation::ModeRates),
        );
        let mut leaves = |operations: Vec<Operation>| {
            operations
                .into_iter()
                .map(|leaf| graph.intern(leaf))
                .collect()
        };
        Self {
            sinusoids,
            coordinates: leaves(scalars.clone().map(Operation::Coordinate).collect()),
            rates: leaves(scalars.map(Operation::Rate).collect()),
            states: leaves(StateId::first(states).map(Operation::State).collect()),
            inputs: leaves(InputId::first(inputs).map(Operation::Input).collect()),
            modes,
            mode_rates,
            at_rest: HashMap::new(),
        }
    }

    /// Returns the coefficients of the node `id`; if `elements` is given, those of each element of a vector over this
    /// space.
    pub fn row(&mut self, graph: &mut Graph, id: NodeId, elements: Option<Space>) -> AffineRow {
        let by = |graph: &mut Graph, variables: &[NodeId]| -> Vec<NodeId> {
            variables
                .iter()
                .map(|variable| derive_by_scalar(graph, id, *variable))
                .collect()
        };
        let (coordinates, rates) = (by(graph, &self.coordinates), by(graph, &self.rates));
        let (states, inputs) = (by(graph, &self.states), by(graph, &self.inputs));
        let by_calls = |graph: &mut Graph, index: usize| -> Vec<NodeId> {
            let calls = self.sinusoids.calls.iter();
            calls
                .map(|pair| derive_by_scalar(graph, id, pair[index]))
                .collect()
        };
        AffineRow {
            coordinates,
            rates,
            states,
            inputs,
            sines: by_calls(graph, 0),
            cosines: by_calls(graph, 1),
            mode_coordinates: read_modes(graph, id, elements, &mut self.modes),
            mode_rates: read_modes(graph, id, elements, &mut self.mode_rates),
            constant: self.constant(graph, id),
        }
    }

    /// Returns the value of a node with zero state, inputs and sinusoids.
    fn constant(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        let sinusoids = self.sinusoids;
        let replacement = |graph: &mut Graph, node: NodeId| {
            let moves = match graph.operation(node) {
                Operation::Coordinate(_)
                | Operation::Rate(_)
                | Operation::ModeCoordinates(_)
                | Operation::ModeRates(_)
                | Operation::State(_)
                | Operation::Input(_) => true,
                _ => sinusoids.calls.iter().flatten().any(|call| *call == node),
            };
            moves.then(|| graph.zero())
        };
        substitute(graph, id, &replacement, &mut self.at_rest)
    }
}

/// Differentiates with respect to the modes of each field. The derivative of a scalar is a vector, that of a vector
/// over modes a matrix.
fn read_modes(
    graph: &mut Graph,
    id: NodeId,
    elements: Option<Space>,
    fields: &mut [ModalDerivative],
) -> Vec<NodeId> {
    fields
        .iter_mut()
        .map(|field| match elements {
            Some(space) => {
                let jacobian = field.derive_element_jacobian(graph, id, space);
                jacobian.assemble(graph)
            }
            None => field.gradient(graph, id),
        })
        .collect()
}
