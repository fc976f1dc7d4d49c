//! Numerical mass matrix at one point: the Hessian of the kinetic energy by the rates, from one backward
//! sweep over the velocities of the energy (Gower and Mello, 2012: Optim. Methods Softw. 27, 251-269).
//!
//! A rate is eliminated as soon as no unprocessed velocity contains it; this keeps the factorisation sparse. Along a
//! chain of bodies the elimination is the recursion of articulated-body inertias (Featherstone, 1983: Int. J.
//! Robotics Research 2, 13-30), along a chain of masses a band elimination. The work is proportional to the size of
//! the expression.

use std::collections::BTreeMap;

use super::lack::{ROUNDING_PER_ROW, SparseRows};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// Result of a sweep over the velocities.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sweep {
    /// True if the mass matrix is positive definite.
    pub is_definite: bool,
    /// Number of updated Hessian entries.
    pub updates: usize,
}

/// Rate-dependent nodes of a kinetic energy ("velocities"), operands first, with the value of each node.
pub(crate) struct Velocities<'g> {
    graph: &'g Graph,
    nodes: Vec<NodeId>,
    values: &'g [f64],
}

struct LocalDerivatives {
    slopes: Vec<(NodeId, f64)>,
    curvatures: Vec<(NodeId, NodeId, f64)>,
}

impl<'g> Velocities<'g> {
    /// Selects the velocities among `reachable`, the nodes of the energy; `values` is indexed by node.
    pub(crate) fn new(graph: &'g Graph, reachable: &[NodeId], values: &'g [f64]) -> Self {
        let moves = |node: &NodeId| graph.dependence(*node).has(Dependence::RATE);
        Self {
            graph,
            nodes: reachable.iter().copied().filter(moves).collect(),
            values,
        }
    }

    /// Eliminates the rates; `None` if a function other than a sum or product has a velocity as its argument.
    pub(super) fn eliminate(&self, coordinates: usize) -> Option<Sweep> {
        let mut composite = Hessian::default();
        let mut articulated = Hessian::default();
        let mut found = Sweep::default();
        let threshold = ROUNDING_PER_ROW * coordinates as f64;
        let mut eliminated = 0;
        let mut is_definite = true;
        self.sweep(&mut |step| match step {
            SweepStep::Velocity(node, local, adjoint) => {
                composite.push(node, local, adjoint);
                articulated.push(node, local, adjoint);
            }
            SweepStep::Complete(rate) => {
                let own = composite.take(rate).remove(&rate).unwrap_or(0.0);
                let pivot = articulated.eliminate(rate);
                is_definite &= own > 0.0 && pivot > threshold * own && own.is_finite();
                eliminated += 1;
            }
        })?;
        found.is_definite = is_definite && eliminated == coordinates;
        found.updates = composite.updates + articulated.updates;
        Some(found)
    }

    /// Computes the diagonal of the mass matrix; an entry is 0 if its rate is the argument of a function other than a
    /// sum or product.
    pub(crate) fn diagonal(&self, coordinates: usize) -> Vec<f64> {
        let mut hessian = Hessian::default();
        let mut diagonal = vec![0.0; coordinates];
        self.sweep(&mut |step| match step {
            SweepStep::Velocity(node, local, adjoint) => hessian.push(node, local, adjoint),
            SweepStep::Complete(rate) => {
                let own = hessian.take(rate).remove(&rate);
                if let (Operation::Rate(index), Some(own)) = (self.graph.operation(rate), own) {
                    diagonal[index.index()] = own;
                }
            }
        });
        diagonal
    }

    /// Computes the mass matrix without structural zeros; `None` if a function other than a sum or product has a
    /// velocity as its argument.
    pub(super) fn mass_matrix(&self, coordinates: usize) -> Option<SparseRows> {
        let mut hessian = Hessian::default();
        self.sweep(&mut |step| {
            if let SweepStep::Velocity(node, local, adjoint) = step {
                hessian.push(node, local, adjoint);
            }
        })?;
        let place = |node: &NodeId| match self.graph.operation(*node) {
            Operation::Rate(index) => Some(index.index()),
            _ => None,
        };
        let mut rows: SparseRows = vec![BTreeMap::new(); coordinates];
        for (node, row) in &hessian.rows {
            let Some(own) = place(node) else { continue };
            let entries = row
                .iter()
                .filter_map(|(other, value)| Some((place(other)?, *value)));
            rows[own] = entries.collect();
        }
        Some(rows)
    }

    /// Visits the velocities from the energy to the rates, and each rate after the last velocity that
    /// contains it.
    fn sweep(&self, see: &mut dyn FnMut(SweepStep<'_>)) -> Option<()> {
        let mut uses = vec![0_usize; self.values.len()];
        let mut adjoints = vec![0.0; self.values.len()];
        for node in &self.nodes {
            for operand in self.operands(*node) {
                uses[operand.0 as usize] += 1;
            }
        }
        if let Some(energy) = self.nodes.last() {
            adjoints[energy.0 as usize] = 1.0;
        }
        for &node in self.nodes.iter().rev() {
            if let Operation::Rate(_) = self.graph.operation(node) {
                continue;
            }
            let local = self.differentiate_locally(node)?;
            let adjoint = adjoints[node.0 as usize];
            see(SweepStep::Velocity(node, &local, adjoint));
            for (operand, slope) in local.slopes {
                let place = operand.0 as usize;
                adjoints[place] += slope * adjoint;
                uses[place] -= 1;
                if uses[place] == 0 && matches!(self.graph.operation(operand), Operation::Rate(_)) {
                    see(SweepStep::Complete(operand));
                }
            }
        }
        Some(())
    }

    fn is_moving(&self, node: NodeId) -> bool {
        self.graph.dependence(node).has(Dependence::RATE)
    }

    fn operands(&self, node: NodeId) -> Vec<NodeId> {
        let mut operands = self.graph.operands(self.graph.operation(node));
        operands.retain(|operand| self.is_moving(*operand));
        operands
    }

    fn differentiate_locally(&self, node: NodeId) -> Option<LocalDerivatives> {
        match self.graph.operation(node) {
            Operation::Sum(terms) => {
                let moving = terms.iter().filter(|(_, term)| self.is_moving(*term));
                Some(LocalDerivatives {
                    slopes: moving.map(|(c, term)| (*term, c.value())).collect(),
                    curvatures: Vec::new(),
                })
            }
            Operation::Product(factors) => Some(self.differentiate_product_locally(factors)),
            _ => None,
        }
    }

    /// Returns the derivatives of a product of powers with respect to its moving factors.
    fn differentiate_product_locally(&self, factors: &[(NodeId, i32)]) -> LocalDerivatives {
        let product = |lowered: &[usize]| -> f64 {
            let mut value = 1.0;
            for (place, &(factor, power)) in factors.iter().enumerate() {
                let times = lowered.iter().filter(|other| **other == place).count() as i32;
                let known = self.values[factor.0 as usize];
                let falling: i32 = (0..times).map(|step| power - step).product();
                value *= f64::from(falling) * known.powi(power - times);
            }
            value
        };
        let mut local = LocalDerivatives {
            slopes: Vec::new(),
            curvatures: Vec::new(),
        };
        for (i, &(a, power)) in factors.iter().enumerate() {
            if !self.is_moving(a) {
                continue;
            }
            local.slopes.push((a, product(&[i])));
            if power != 1 {
                local.curvatures.push((a, a, product(&[i, i])));
            }
            for (j, &(b, _)) in factors.iter().enumerate().take(i) {
                if self.is_moving(b) {
                    local.curvatures.push((a, b, product(&[i, j])));
                }
            }
        }
        local
    }
}

enum SweepStep<'s> {
    /// Velocity, its derivatives with respect to its operands, and the derivative of the energy with respect to the
    /// velocity.
    Velocity(NodeId, &'s LocalDerivatives, f64),
    /// Rate that no unprocessed velocity contains.
    Complete(NodeId),
}

/// Second derivatives of the energy between unprocessed nodes; each is stored in both directions.
#[derive(Default)]
struct Hessian {
    rows: BTreeMap<NodeId, BTreeMap<NodeId, f64>>,
    updates: usize,
}

impl Hessian {
    fn add(&mut self, a: NodeId, b: NodeId, value: f64) {
        self.updates += 1;
        *self.rows.entry(a).or_default().entry(b).or_default() += value;
        if a != b {
            *self.rows.entry(b).or_default().entry(a).or_default() += value;
        }
    }

    fn take(&mut self, node: NodeId) -> BTreeMap<NodeId, f64> {
        let row = self.rows.remove(&node).unwrap_or_default();
        for other in row.keys() {
            if let Some(others) = self.rows.get_mut(other) {
                others.remove(&node);
            }
        }
        row
    }

    /// Eliminates a velocity: adds its Hessian entries to those of its operands.
    fn push(&mut self, node: NodeId, local: &LocalDerivatives, adjoint: f64) {
        for (other, value) in self.take(node) {
            if other == node {
                for (place, &(a, by_a)) in local.slopes.iter().enumerate() {
                    for &(b, by_b) in &local.slopes[..=place] {
                        self.add(a, b, by_a * by_b * value);
                    }
                }
                continue;
            }
            for &(a, by_a) in &local.slopes {
                let factor = if a == other { 2.0 } else { 1.0 };
                self.add(a, other, factor * by_a * value);
            }
        }
        for &(a, b, curvature) in &local.curvatures {
            self.add(a, b, curvature * adjoint);
        }
    }

    /// Eliminates a rate and returns its pivot.
    fn eliminate(&mut self, rate: NodeId) -> f64 {
        let mut row = self.take(rate);
        let pivot = row.remove(&rate).unwrap_or(0.0);
        let entries: Vec<(NodeId, f64)> = row.into_iter().collect();
        for (place, &(a, with_a)) in entries.iter().enumerate() {
            for &(b, with_b) in &entries[..=place] {
                self.add(a, b, -with_a * with_b / pivot);
            }
        }
        pivot
    }
}
