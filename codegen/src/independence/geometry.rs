//! Constraint derivatives, inertias and residuals at a state, computed by a program or from graph nodes.

use crate::independence::rows::ConstraintRows;
use crate::program::evaluator::Point;

pub(crate) trait ConstraintGeometry {
    /// Returns the rows of A, each entry divided by the square root of its coordinate's inertia.
    fn rows(&mut self, point: Point<'_>) -> Vec<Vec<f64>>;
    /// Returns the diagonal of the mass matrix, with 1 for a coordinate without inertia.
    fn inertia(&mut self, point: Point<'_>) -> Vec<f64>;
    /// Returns the residuals of the constraints in SI units.
    fn residuals(&mut self, point: Point<'_>) -> Vec<f64>;
}

impl ConstraintGeometry for ConstraintRows {
    fn rows(&mut self, point: Point<'_>) -> Vec<Vec<f64>> {
        self.rows(point)
    }

    fn inertia(&mut self, point: Point<'_>) -> Vec<f64> {
        self.diagonal(point)
    }

    fn residuals(&mut self, point: Point<'_>) -> Vec<f64> {
        self.residuals(point)
    }
}
