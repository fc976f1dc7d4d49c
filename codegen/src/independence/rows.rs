//! Constraint derivatives A, with M a + c = f + A^T lambda, and constraint residuals, computed by the program
//! of a model.
//!
//! Column k of A is divided by sqrt(M_kk), so that all entries of a row have one unit.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Constraint, Model, RESIDUAL};

use crate::mechanics::equations::Equations;
use crate::mechanics::outputs::{Jacobian, JacobianBlock, Outputs};
use crate::program::Program;
use crate::program::evaluator::{Evaluator, Point};
use crate::program::lowering::lower_with_outputs;
use crate::symbolic::graph::{NodeId, Space};

pub(crate) trait ConstraintGeometry {
    /// Returns the rows of A, each entry divided by the square root of its coordinate's inertia.
    fn rows(&mut self, point: Point<'_>) -> Vec<Vec<f64>>;
    /// Returns the diagonal of the mass matrix, with 1 for a coordinate without inertia.
    fn inertia(&mut self, point: Point<'_>) -> Vec<f64>;
    /// Returns the residuals of the constraints in SI units.
    fn residuals(&mut self, point: Point<'_>) -> Vec<f64>;
}

/// Evaluator of constraint derivatives and residuals.
pub struct ConstraintRows {
    evaluator: Evaluator,
    /// Indices of the residuals among the observables.
    residuals: Vec<usize>,
}

/// Returns the program whose Jacobian holds the constraint derivatives, or None for a model without
/// constraints. `parameters` are those of the specification, in SI units.
pub fn constraint_program(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
) -> Option<Program> {
    let rows = &equations.constraint_rows;
    let first = rows.first()?;
    let mut entries = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        let mut add = |column: usize, columns: usize, value: NodeId| {
            if !equations.graph.is_zero(value) && columns > 0 {
                entries.push(JacobianBlock {
                    row: place,
                    rows: 1,
                    column,
                    columns,
                    diagonal: false,
                    value,
                });
            }
        };
        for (column, value) in row.scalars.iter().enumerate() {
            add(column, 1, *value);
        }
        let mut column = row.scalars.len();
        for (field, value) in FieldId::first(row.modal.len()).zip(&row.modal) {
            let columns = equations.graph.size(Space::Modes(field));
            add(column, columns, *value);
            column += columns;
        }
    }
    let modes: usize = equations.graph.orders().iter().sum();
    let outputs = Outputs {
        jacobians: vec![Jacobian {
            name: "constraints",
            rows: rows.len(),
            columns: first.scalars.len() + modes,
            entries,
        }],
        ..Outputs::default()
    };
    Some(lower_with_outputs(model, equations, parameters, &outputs))
}

impl ConstraintRows {
    /// Builds the evaluator from the program of [`constraint_program`] with its default parameters.
    pub fn new(model: &Model, program: Program) -> Self {
        let place = |constraint: &Constraint| {
            let name = format!("{RESIDUAL}{}", constraint.name);
            let mut known = program.observables.iter();
            known.position(|observable| observable.name == name)
        };
        let residuals = model.constraints.iter().filter_map(place).collect();
        Self {
            evaluator: Evaluator::new(program),
            residuals,
        }
    }

    /// Sets the independent parameters, in SI units, for the evaluations that follow.
    pub fn prepare(&mut self, parameters: &[f64]) {
        self.evaluator.prepare(parameters);
    }

    /// Returns the number of coordinates and modes: the columns of A.
    pub fn degrees_of_freedom(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }

    /// Returns the rows of A, each entry divided by the square root of its coordinate's inertia.
    pub fn rows(&mut self, point: Point<'_>) -> Vec<Vec<f64>> {
        let degrees = self.degrees_of_freedom();
        let mut rows = vec![vec![0.0; degrees]; self.residuals.len()];
        let Some(jacobian) = self.evaluator.program().outputs.jacobians.first().cloned() else {
            return rows;
        };
        let mut nonzeros = vec![0.0; jacobian.nonzeros()];
        self.evaluator.jacobian(0, point, &mut nonzeros);
        let inertia = self.diagonal(point);
        for (entry, place) in jacobian.entries.iter().zip(jacobian.places()) {
            for column in 0..entry.columns {
                let degree = entry.column + column;
                rows[entry.row][degree] = nonzeros[place.start + column] / inertia[degree].sqrt();
            }
        }
        rows
    }

    fn diagonal(&mut self, point: Point<'_>) -> Vec<f64> {
        let degrees = self.degrees_of_freedom();
        let mut mass = vec![0.0; degrees * degrees];
        self.evaluator.mass_matrix(point, &mut mass);
        let diagonal = (0..degrees).map(|place| mass[place * degrees + place]);
        diagonal.map(positive_or_one).collect()
    }

    /// Returns the residuals of the constraints in SI units.
    pub fn residuals(&mut self, point: Point<'_>) -> Vec<f64> {
        let mut observables = vec![0.0; self.evaluator.program().observables.len()];
        self.evaluator.observables(point, &mut observables);
        let places = self.residuals.iter();
        places.map(|place| observables[*place]).collect()
    }
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

/// Returns `size`, or 1 if it is not positive.
pub(super) fn positive_or_one(size: f64) -> f64 {
    if size > 0.0 { size } else { 1.0 }
}
