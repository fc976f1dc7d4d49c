//! Derivatives and residuals of the constraints of a model without fields, computed from graph nodes. No
//! equations of motion are needed.

use crate::independence::geometry::ConstraintGeometry;
use crate::independence::rows::replace_nonpositive_by_one;
use crate::mechanics::inertia::point::Point as NodePoint;
use crate::mechanics::inertia::sweep::Velocities;
use crate::mechanics::unsolved::Unsolved;
use crate::program::evaluator::Point;
use crate::symbolic::graph::NodeId;

pub(crate) struct NodeGeometry<'u> {
    model: &'u Unsolved,
    parameters: Vec<f64>,
    coordinates: usize,
    /// Nodes of the derivatives and residuals, operands first.
    constraints: Vec<NodeId>,
    /// Nodes of the kinetic energy, operands first.
    energy: Vec<NodeId>,
}

impl<'u> NodeGeometry<'u> {
    /// Prepares the evaluation; `coordinates` is the number of coordinates, and `parameters` are in SI units.
    pub(crate) fn new(model: &'u Unsolved, coordinates: usize, parameters: Vec<f64>) -> Self {
        let all = model.constraints.iter();
        let roots: Vec<NodeId> = all
            .flat_map(|one| one.derivatives.iter().map(|entry| entry.1))
            .chain(model.residuals())
            .collect();
        Self {
            constraints: model.graph.reachable(&roots),
            energy: model.graph.reachable(&[model.kinetic]),
            model,
            parameters,
            coordinates,
        }
    }

    /// Returns the values of `nodes`, indexed by node; all are NaN if one cannot be computed.
    fn values(&self, nodes: &[NodeId], point: Point<'_>) -> Vec<f64> {
        let at = NodePoint {
            parameters: &self.parameters,
            state: point.state,
            inputs: point.inputs,
            coordinates: self.coordinates,
        };
        let values = at.values(&self.model.graph, nodes);
        values.unwrap_or_else(|| vec![f64::NAN; self.model.graph.len()])
    }
}

impl ConstraintGeometry for NodeGeometry<'_> {
    fn rows(&mut self, point: Point<'_>) -> Vec<Vec<f64>> {
        let inertia = self.inertia(point);
        let values = self.values(&self.constraints, point);
        let row = |derivatives: &[(usize, NodeId)]| {
            let mut row = vec![0.0; self.coordinates];
            for &(index, node) in derivatives {
                row[index] = values[node.0 as usize] / inertia[index].sqrt();
            }
            row
        };
        let all = self.model.constraints.iter();
        all.map(|one| row(&one.derivatives)).collect()
    }

    fn inertia(&mut self, point: Point<'_>) -> Vec<f64> {
        let values = self.values(&self.energy, point);
        let velocities = Velocities::new(&self.model.graph, &self.energy, &values);
        let diagonal = velocities.diagonal(self.coordinates).into_iter();
        diagonal.map(replace_nonpositive_by_one).collect()
    }

    fn residuals(&mut self, point: Point<'_>) -> Vec<f64> {
        let values = self.values(&self.constraints, point);
        let residuals = self.model.residuals();
        residuals.map(|node| values[node.0 as usize]).collect()
    }
}
