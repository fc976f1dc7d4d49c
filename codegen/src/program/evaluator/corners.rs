//! Momenta and energy at a corner of the motion, at a point.

use super::{Evaluator, Point, Stage};
use crate::program::{Corners, RateRow, RowValues, ValueId};

/// Quantities of corners at a point, in SI units; see [`Corners`]. A row has one number for each degree of freedom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CornerValues {
    /// Momenta.
    pub momenta: Vec<f64>,
    /// Hamiltonian.
    pub hamiltonian: f64,
    /// Energy.
    pub energy: f64,
    /// Rate of each surface, and its derivatives with respect to the rates of the coordinates.
    pub surfaces: Vec<(f64, Vec<f64>)>,
    /// Rate of each constraint, and its derivatives with respect to the rates of the coordinates.
    pub constraints: Vec<(f64, Vec<f64>)>,
}

impl Evaluator {
    /// Computes the quantities at corners; `None` for a program without them.
    pub fn corners(&mut self, point: Point<'_>) -> Option<CornerValues> {
        self.compute(Stage::Corners, &point);
        let corners: &Corners<ValueId, RowValues> = self.program.outputs.corners.as_ref()?;
        let number = |id: ValueId| self.memory[self.places.offset(id)];
        let row = |values: &RowValues| {
            let mut out = vec![0.0; self.program.degrees_of_freedom()];
            self.copy_rows(&values.scalars, &values.modal, &mut out);
            out
        };
        let rows = |rows: &[RateRow<ValueId, RowValues>]| {
            let pairs = rows
                .iter()
                .map(|known| (number(known.rate), row(&known.row)));
            pairs.collect()
        };
        Some(CornerValues {
            momenta: row(&corners.momenta),
            hamiltonian: number(corners.hamiltonian),
            energy: number(corners.energy),
            surfaces: rows(&corners.surfaces),
            constraints: rows(&corners.constraints),
        })
    }
}
