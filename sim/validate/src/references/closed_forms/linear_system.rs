//! Solution of M(q) q'' = f for the accelerations, with a bound of the rounding error.

use nalgebra::{DMatrix, DVector};

use super::NotApplicable;
use crate::references::evaluation::{Evaluation, Row};

/// Equations M(q) q'' = f(q, q') of all coordinates.
pub struct LinearSystem {
    mass: DMatrix<f64>,
    force: Vec<Row>,
}

impl LinearSystem {
    /// Creates an empty system of `coordinates` rows.
    pub fn new(coordinates: usize) -> Self {
        Self {
            mass: DMatrix::zeros(coordinates, coordinates),
            force: vec![Row::new(); coordinates],
        }
    }

    /// Adds `value` to the mass matrix at `(row, column)` and at `(column, row)`.
    pub fn mass(&mut self, row: usize, column: usize, value: f64) {
        self.mass[(row, column)] += value;
        if row != column {
            self.mass[(column, row)] += value;
        }
    }

    /// Adds a term to the force of `row`.
    pub fn force(&mut self, row: usize, term: f64) {
        if let Some(force) = self.force.get_mut(row) {
            force.add(term);
        }
    }

    /// Solves for the accelerations q''. The scale of row i is entry i of |M^-1| (largest term of f + |M| |q''|), the
    /// componentwise bound of the rounding error of a linear solve (Higham, "Accuracy and Stability of Numerical
    /// Algorithms", chapter 7).
    pub fn solve(self) -> Result<Evaluation, NotApplicable> {
        let force = DVector::from_iterator(self.force.len(), self.force.iter().map(Row::sum));
        let inverse = self.mass.clone().try_inverse().ok_or(NotApplicable::Mass)?;
        let accelerations = self
            .mass
            .clone()
            .lu()
            .solve(&force)
            .ok_or(NotApplicable::Mass)?;
        let largest = self.force.iter().map(Row::largest);
        let terms = DVector::from_iterator(self.force.len(), largest)
            + self.mass.abs() * accelerations.abs();
        let scales = inverse.abs() * terms;
        Ok(Evaluation {
            accelerations: accelerations.iter().copied().collect(),
            scales: scales.iter().copied().collect(),
        })
    }
}
