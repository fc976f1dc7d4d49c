//! Rows of Lagrange's equations by sweeps over the rate-dependent part of a kinetic energy, for models
//! without fields.
//!
//! The rate-dependent part of the kinetic energy is a graph of velocities. One backward sweep computes the
//! derivatives of the energy by all velocities, which include the momenta. From these follow the derivatives by the
//! coordinates. The rates of the momenta are computed by one forward tangent along the motion. If velocities are
//! defined recursively from frame to frame, this is the Newton-Euler recursion, with accelerations outward and forces
//! inward (Luh, Walker and Paul, 1980: J. Dyn. Sys. Meas. Control 102, 69-76).
//!
//! The mass matrix is the Hessian by the rates, propagated backward over the same graph (Gower and Mello, 2012:
//! Optim. Methods Softw. 27, 251-269). The intermediate Hessian entries between the velocities of a frame are the
//! inertia of all bodies that the frame carries: composite rigid bodies (Walker and Orin, 1982: J. Dyn. Sys. Meas.
//! Control 104, 205-211).

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use eomgen_model_spec::ids::CoordinateId;

use crate::mechanics::translate::along_motion;
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// Velocities (rate-dependent nodes) of a kinetic energy, with their derivatives by their operands.
pub(crate) struct Velocities {
    /// Units, the energy first; each unit precedes its operands.
    units: Vec<VelocityNode>,
    /// Contributions to the derivative of the energy by each rate.
    received: HashMap<NodeId, Vec<(f64, NodeId)>>,
}

/// Rate-dependent node, with the factors of the products in its sum as operands.
struct VelocityNode {
    node: NodeId,
    operands: Vec<NodeId>,
    /// Derivative of the node by each operand.
    partials: Vec<NodeId>,
    /// Derivative of the energy by the node.
    adjoint: NodeId,
}

/// Result of a backward sweep over the velocities.
#[derive(Clone, Debug)]
pub(crate) struct Momenta {
    /// dT/dq' of every coordinate.
    pub(crate) momenta: Vec<NodeId>,
    /// dT/dq of every coordinate.
    slopes: Vec<NodeId>,
}

impl Momenta {
    /// Returns d/dt(dT/dq') - dT/dq for these accelerations.
    pub(crate) fn rates(
        &self,
        graph: &mut Graph,
        acceleration: &dyn Fn(&mut Graph, CoordinateId) -> NodeId,
    ) -> Vec<NodeId> {
        let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
            Operation::Rate(index) => acceleration(graph, index),
            _ => along_motion(graph, leaf),
        };
        let mut direction = Direction::new(&tangent);
        let rows = self
            .momenta
            .iter()
            .zip(&self.slopes)
            .map(|(momentum, slope)| {
                let rate = direction.derivative(graph, *momentum);
                graph.combine(&[(1.0, rate), (-1.0, *slope)])
            });
        rows.collect()
    }
}

impl Velocities {
    /// Finds the velocities of a kinetic energy; `None` if the energy does not depend on rates.
    pub(crate) fn from_kinetic_energy(graph: &mut Graph, kinetic: NodeId) -> Option<Self> {
        if !is_velocity(graph, kinetic) {
            return None;
        }
        let mut velocities = Self {
            units: Vec::new(),
            received: HashMap::from([(kinetic, vec![(1.0, graph.one())])]),
        };
        let mut waiting = BTreeSet::from([kinetic]);
        // An operand is older than its uses.
        while let Some(node) = waiting.pop_last() {
            let operands = find_rate_dependent_operands(graph, node);
            if operands.is_empty() {
                continue;
            }
            waiting.extend(&operands);
            velocities.push(graph, node, operands);
        }
        Some(velocities)
    }

    /// Propagates the derivative of the energy from a node to its operands.
    fn push(&mut self, graph: &mut Graph, node: NodeId, operands: Vec<NodeId>) {
        let received = self.received.remove(&node).unwrap_or_default();
        let adjoint = graph.combine(&received);
        let mut partials = Vec::with_capacity(operands.len());
        for &operand in &operands {
            let partial = differentiate_partially(graph, node, &operands, operand);
            let part = graph.multiply(partial, adjoint);
            self.received.entry(operand).or_default().push((1.0, part));
            partials.push(partial);
        }
        self.units.push(VelocityNode {
            node,
            operands,
            partials,
            adjoint,
        });
    }

    /// Returns the momenta and the derivatives of the energy with respect to the coordinates.
    pub(crate) fn momenta(&self, graph: &mut Graph, coordinates: usize) -> Momenta {
        let mut slopes: Vec<Vec<(f64, NodeId)>> = vec![Vec::new(); coordinates];
        for unit in &self.units {
            for (index, slope) in unit.derive_slopes(graph, coordinates) {
                slopes[index].push((1.0, graph.multiply(slope, unit.adjoint)));
            }
        }
        let momenta = CoordinateId::first(coordinates)
            .map(|index| {
                let rate = graph.intern(Operation::Rate(index));
                let received = self.received.get(&rate).map_or(&[][..], Vec::as_slice);
                graph.combine_flat(received)
            })
            .collect();
        let slopes = slopes.iter().map(|terms| graph.combine_flat(terms));
        Momenta {
            momenta,
            slopes: slopes.collect(),
        }
    }

    /// Returns the Hessian of the energy by the rates; `None` if it depends on rates.
    pub(crate) fn mass_matrix(
        &self,
        graph: &mut Graph,
        coordinates: usize,
    ) -> Option<Vec<Vec<NodeId>>> {
        let mut inertia = Inertia::default();
        for unit in &self.units {
            inertia.push(graph, unit);
            unit.add_curvature(graph, &mut inertia)?;
        }
        let rates: Vec<NodeId> = CoordinateId::first(coordinates)
            .map(|index| graph.intern(Operation::Rate(index)))
            .collect();
        let mut matrix = Vec::with_capacity(coordinates);
        for a in &rates {
            let row: Vec<NodeId> = rates
                .iter()
                .map(|b| inertia.between(graph, *a, *b))
                .collect();
            if row.iter().any(|entry| is_velocity(graph, *entry)) {
                return None;
            }
            matrix.push(row);
        }
        Some(matrix)
    }
}

impl VelocityNode {
    /// Returns the derivatives of the node with respect to coordinates, with constant operands.
    fn derive_slopes(&self, graph: &mut Graph, coordinates: usize) -> Vec<(usize, NodeId)> {
        let moving = self.find_leaves(graph, self.node);
        let mut found = Vec::new();
        for (place, index) in CoordinateId::first(coordinates).enumerate() {
            let variable = graph.intern(Operation::Coordinate(index));
            if moving.contains(&variable) {
                found.push((
                    place,
                    differentiate_partially(graph, self.node, &self.operands, variable),
                ));
            }
        }
        found
    }

    /// Returns the leaves of a node; the unit's operands count as leaves.
    fn find_leaves(&self, graph: &Graph, node: NodeId) -> BTreeSet<NodeId> {
        let mut found = BTreeSet::new();
        let mut seen = HashSet::new();
        let mut waiting = vec![node];
        while let Some(node) = waiting.pop() {
            if !seen.insert(node) {
                continue;
            }
            let operands = match self.operands.binary_search(&node) {
                Ok(_) => Vec::new(),
                Err(_) => graph.operands(graph.operation(node)),
            };
            if operands.is_empty() {
                found.insert(node);
            }
            waiting.extend(operands);
        }
        found
    }

    /// Adds the second derivatives of the node, multiplied by its adjoint; returns `None` if they depend on rates.
    fn add_curvature(&self, graph: &mut Graph, inertia: &mut Inertia) -> Option<()> {
        for (place, &first) in self.operands.iter().enumerate() {
            let slope = self.partials[place];
            if !is_velocity(graph, slope) {
                continue;
            }
            // The slope has nonzero derivatives only by operands that it contains.
            let within = self.find_leaves(graph, slope);
            let (earlier, held) = (&self.operands[..=place], &self.operands);
            let held: Vec<NodeId> = held
                .iter()
                .copied()
                .filter(|o| within.contains(o))
                .collect();
            for &second in earlier.iter().filter(|second| within.contains(second)) {
                let curvature = differentiate_partially(graph, slope, &held, second);
                let value = graph.multiply(curvature, self.adjoint);
                if is_velocity(graph, value) {
                    return None;
                }
                inertia.add(graph, first, second, value);
            }
        }
        Some(())
    }
}

/// Hessian between unprocessed velocities; each entry is stored in both directions.
#[derive(Default)]
struct Inertia {
    terms: HashMap<NodeId, BTreeMap<NodeId, Vec<(f64, NodeId)>>>,
}

impl Inertia {
    fn add(&mut self, graph: &Graph, a: NodeId, b: NodeId, value: NodeId) {
        if graph.is_zero(value) {
            return;
        }
        for (from, to) in [(a, b), (b, a)] {
            let entry = self.terms.entry(from).or_default().entry(to).or_default();
            entry.push((1.0, value));
            if a == b {
                return;
            }
        }
    }

    fn between(&self, graph: &mut Graph, a: NodeId, b: NodeId) -> NodeId {
        match self.terms.get(&a).and_then(|row| row.get(&b)) {
            Some(terms) => graph.combine_flat(terms),
            None => graph.zero(),
        }
    }

    /// Eliminates a velocity: adds its Hessian entries to those of its operands.
    fn push(&mut self, graph: &mut Graph, unit: &VelocityNode) {
        let Some(row) = self.terms.remove(&unit.node) else {
            return;
        };
        let parts: Vec<(NodeId, NodeId)> = unit
            .operands
            .iter()
            .copied()
            .zip(unit.partials.iter().copied())
            .collect();
        for (other, terms) in row {
            let value = graph.combine(&terms);
            if other == unit.node {
                for (place, &(a, by_a)) in parts.iter().enumerate() {
                    for &(b, by_b) in &parts[..=place] {
                        let product = graph.product(&[(by_a, 1), (by_b, 1), (value, 1)]);
                        self.add(graph, a, b, product);
                    }
                }
                continue;
            }
            if let Some(others) = self.terms.get_mut(&other) {
                others.remove(&unit.node);
            }
            for &(a, by_a) in &parts {
                let factor = if a == other { 2.0 } else { 1.0 };
                let product = graph.multiply(by_a, value);
                let product = graph.scale(factor, product);
                self.add(graph, a, other, product);
            }
        }
    }
}

fn is_velocity(graph: &Graph, node: NodeId) -> bool {
    graph.dependence(node).has(Dependence::RATE)
}

/// Returns the rate-dependent operands of a node; a product in a sum is replaced by its factors.
fn find_rate_dependent_operands(graph: &Graph, node: NodeId) -> Vec<NodeId> {
    let mut parts = BTreeSet::new();
    for operand in graph.operands(graph.operation(node)) {
        match (graph.operation(node), graph.operation(operand)) {
            (Operation::Sum(_), Operation::Product(factors)) => {
                parts.extend(factors.iter().map(|(factor, _)| *factor));
            }
            _ => {
                parts.insert(operand);
            }
        }
    }
    parts
        .into_iter()
        .filter(|part| is_velocity(graph, *part))
        .collect()
}

/// Returns the derivative of a node by one operand or by a coordinate, with the other operands `held` constant.
fn differentiate_partially(graph: &mut Graph, node: NodeId, held: &[NodeId], by: NodeId) -> NodeId {
    let (zero, one) = (graph.zero(), graph.one());
    let mut direction = Direction::default();
    // Operands without a seed have derivative 0.
    let moving = held.iter().filter(|part| graph.may_depend_on(**part, by));
    for part in moving {
        direction.seed(*part, zero);
    }
    direction.seed(by, one);
    direction.derivative(graph, node)
}
