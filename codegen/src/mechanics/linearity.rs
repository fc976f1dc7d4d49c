//! Structural test of linearity between switching surfaces. A model that passes can be solved exactly from switch to
//! switch.
//!
//! For given sides of the switching surfaces, a linear model has a constant mass matrix, and forces of first degree
//! in coordinates, rates, inputs and sinusoids of time. The test is sufficient, not necessary: it does not use
//! trigonometric identities.

use std::collections::HashMap;

use eomgen_model_spec::model::Function;

use crate::mechanics::equations::Equations;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Shape};

/// Linearity of a model between its switching surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linearity {
    /// Linear everywhere.
    Linear,
    /// Linear between switching surfaces whose switching functions are linear.
    PiecewiseLinear,
    /// Model with constraints; its linearity is not tested.
    Constrained,
    /// Model with impacts, at which rates jump.
    Impacts,
    /// Model whose motion has corners, at which rates jump; the first such surface.
    Corners(NodeId),
    /// Nonlinear model; the first nonlinear node.
    Nonlinear(NodeId),
}

/// Returns the linearity of the equations.
pub fn linearity(equations: &Equations) -> Linearity {
    let graph = &equations.graph;
    if !equations.multipliers.is_empty() {
        return Linearity::Constrained;
    }
    if !equations.impacts.is_empty() {
        return Linearity::Impacts;
    }
    let mut corners = equations.corners.iter();
    if let Some(corner) = corners.find(|corner| corner.moves_rates) {
        return Linearity::Corners(equations.guards[corner.guard].value);
    }
    let mut degrees = Degrees {
        graph,
        known: HashMap::new(),
    };
    let mass = &equations.mass;
    let blocks = equations.modal_blocks.iter().map(|block| block.matrix);
    let masses = mass
        .scalars
        .iter()
        .chain(&mass.coupling)
        .flatten()
        .copied()
        .chain(blocks);
    for entry in masses {
        if !graph.dependence(entry).is_parameter_only() {
            return Linearity::Nonlinear(entry);
        }
    }
    let rows = [equations.velocity_terms.nodes(), equations.forces.nodes()].concat();
    let surfaces = equations.guards.iter().map(|guard| guard.value);
    let state_rates = equations.state_rates.iter().copied();
    for node in rows.into_iter().chain(state_rates).chain(surfaces) {
        match degrees.find_degree(node) {
            Ok(0 | 1) => {}
            Ok(_) => return Linearity::Nonlinear(node),
            Err(culprit) => return Linearity::Nonlinear(culprit),
        }
    }
    if equations.guards.is_empty() {
        Linearity::Linear
    } else {
        Linearity::PiecewiseLinear
    }
}

struct Degrees<'g> {
    graph: &'g Graph,
    known: HashMap<NodeId, Result<u32, NodeId>>,
}

impl Degrees<'_> {
    /// Returns the degree of a node in the motion for given sides. Errors: the first nonlinear node.
    fn find_degree(&mut self, id: NodeId) -> Result<u32, NodeId> {
        if self.graph.dependence(id).is_parameter_only() {
            return Ok(0);
        }
        if let Some(&known) = self.known.get(&id) {
            return known;
        }
        let degree = self.compute(id);
        self.known.insert(id, degree);
        degree
    }

    fn compute(&mut self, id: NodeId) -> Result<u32, NodeId> {
        let graph = self.graph;
        match graph.operation(id) {
            Operation::Coordinate(_)
            | Operation::Rate(_)
            | Operation::ModeCoordinates(_)
            | Operation::ModeRates(_)
            | Operation::State(_)
            | Operation::Input(_) => Ok(1),
            Operation::Sum(terms) => self.find_highest_degree(terms.iter().map(|(_, term)| *term)),
            Operation::Product(factors) => {
                let mut total = 0;
                for &(factor, exponent) in factors {
                    let degree = self.find_degree(factor)?;
                    let power = u32::try_from(exponent).ok().filter(|_| degree < 2);
                    match (degree, power) {
                        (0, _) => {}
                        (_, Some(power)) => total += degree * power,
                        (_, None) => return Err(id),
                    }
                }
                if total > 1 { Err(id) } else { Ok(total) }
            }
            Operation::Call(function, arguments) => self.call(id, *function, arguments),
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                ..
            } => {
                self.find_highest_degree([*a, *b])?;
                self.find_highest_degree([*then, *otherwise])
            }
            Operation::Total(a) | Operation::CholeskySolve(_, a) => self.find_degree(*a),
            Operation::Apply { vector, .. } => self.find_degree(*vector),
            _ => Err(id),
        }
    }

    fn call(
        &mut self,
        id: NodeId,
        function: Function,
        arguments: &[NodeId],
    ) -> Result<u32, NodeId> {
        let scalar = self.graph.shape(id) == Shape::Scalar;
        match (function, arguments) {
            (Function::Sin | Function::Cos, &[a]) if self.is_phase(a) => Ok(1),
            (Function::Contact | Function::Sign | Function::Above, _) if scalar => {
                self.find_highest_degree(arguments.iter().copied())?;
                Ok(0)
            }
            (Function::Deadzone | Function::Abs | Function::Min | Function::Max, _) if scalar => {
                self.find_highest_degree(arguments.iter().copied())
            }
            _ => Err(id),
        }
    }

    fn find_highest_degree(
        &mut self,
        parts: impl IntoIterator<Item = NodeId>,
    ) -> Result<u32, NodeId> {
        parts
            .into_iter()
            .try_fold(0, |highest, part| Ok(self.find_degree(part)?.max(highest)))
    }

    /// Returns true for a phase omega t + phi.
    fn is_phase(&self, id: NodeId) -> bool {
        let moving = Dependence::COORDINATE
            .join(Dependence::RATE)
            .join(Dependence::STATE)
            .join(Dependence::INPUT);
        if self.graph.dependence(id).has(moving) {
            return false;
        }
        match self.graph.operation(id) {
            Operation::Time => true,
            Operation::Sum(terms) => terms.iter().all(|(_, term)| {
                self.graph.dependence(*term).is_parameter_only() || self.is_phase(*term)
            }),
            Operation::Product(factors) => {
                let timed: Vec<&(NodeId, i32)> = factors
                    .iter()
                    .filter(|(factor, _)| !self.graph.dependence(*factor).is_parameter_only())
                    .collect();
                matches!(timed.as_slice(), [(factor, 1)] if self.is_phase(*factor))
            }
            _ => false,
        }
    }
}
