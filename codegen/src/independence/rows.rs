//! Constraint derivatives A, with M a + c = f + A^T lambda, and constraint residuals, computed by the program
//! of a model.
//!
//! Column k of A is divided by sqrt(M_kk), so that all entries of a row have one unit.

use crate::program::Program;
use crate::program::evaluator::{Evaluator, Point};

/// Evaluator of constraint derivatives and residuals.
pub struct ConstraintRows {
    evaluator: Evaluator,
    /// Indices of the residuals among the observables.
    residuals: Vec<usize>,
}

impl ConstraintRows {
    /// Builds the evaluator from a program whose Jacobian holds the constraint derivatives, with its default
    /// parameters; `residuals` are the indices of the residuals among its observables.
    pub fn new(program: Program, residuals: Vec<usize>) -> Self {
        Self {
            evaluator: Evaluator::new(program),
            residuals,
        }
    }

    /// Sets the independent parameters, in SI units, for the evaluations that follow.
    pub fn prepare(&mut self, parameters: &[f64]) {
        self.evaluator.prepare(parameters);
    }

    /// Returns the number of coordinates and modes, which is the number of columns of A.
    pub fn degrees_of_freedom(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }

    /// Returns the rows of A, each entry divided by the square root of its coordinate's inertia.
    pub fn rows(&mut self, point: Point<'_>) -> Vec<Vec<f64>> {
        let inertia = self.diagonal(point);
        let mut rows = self.derivatives(point);
        for row in &mut rows {
            for (entry, inertia) in row.iter_mut().zip(&inertia) {
                *entry /= inertia.sqrt();
            }
        }
        rows
    }

    /// Returns the rows of A in SI units.
    pub fn derivatives(&mut self, point: Point<'_>) -> Vec<Vec<f64>> {
        let degrees = self.degrees_of_freedom();
        let mut rows = vec![vec![0.0; degrees]; self.residuals.len()];
        let Some(jacobian) = self.evaluator.program().outputs.jacobians.first().cloned() else {
            return rows;
        };
        let mut nonzeros = vec![0.0; jacobian.nonzeros()];
        self.evaluator.jacobian(0, point, &mut nonzeros);
        for (entry, position) in jacobian.entries.iter().zip(jacobian.places()) {
            for column in 0..entry.columns {
                rows[entry.row][entry.column + column] = nonzeros[position.start + column];
            }
        }
        rows
    }

    /// Returns the sum over j of |A_kj| s_j for each row k, with the magnitudes s_j of the coordinates, in SI units.
    pub fn compute_weighted_lengths(&mut self, point: Point<'_>, sizes: &[f64]) -> Vec<f64> {
        let weighted = |row: Vec<f64>| {
            let entries = row.iter().zip(sizes);
            entries.map(|(entry, size)| entry.abs() * size).sum()
        };
        self.derivatives(point).into_iter().map(weighted).collect()
    }

    /// Returns the mass matrix row by row, in SI units.
    pub fn mass_matrix(&mut self, point: Point<'_>) -> Vec<f64> {
        let degrees = self.degrees_of_freedom();
        let mut mass = vec![0.0; degrees * degrees];
        self.evaluator.mass_matrix(point, &mut mass);
        mass
    }

    /// Returns the diagonal of the mass matrix, with 1 for a coordinate without inertia.
    pub(super) fn diagonal(&mut self, point: Point<'_>) -> Vec<f64> {
        let degrees = self.degrees_of_freedom();
        let mass = self.mass_matrix(point);
        let diagonal = (0..degrees).map(|index| mass[index * degrees + index]);
        diagonal.map(replace_nonpositive_by_one).collect()
    }

    /// Returns the residuals of the constraints in SI units.
    pub fn residuals(&mut self, point: Point<'_>) -> Vec<f64> {
        let mut observables = vec![0.0; self.evaluator.program().observables.len()];
        self.evaluator.observables(point, &mut observables);
        let places = self.residuals.iter();
        places.map(|index| observables[*index]).collect()
    }
}

/// Returns `size`, or 1 if it is not positive.
pub(super) fn replace_nonpositive_by_one(size: f64) -> f64 {
    if size > 0.0 { size } else { 1.0 }
}
