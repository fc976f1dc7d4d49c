//! Impacts of a program at a point.

use super::{Evaluator, Point, Stage};

/// Impact at a point in SI units; see [`Impact`](crate::mechanics::impacts::Impact).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactValues {
    /// Distance.
    pub distance: f64,
    /// Rate of the distance.
    pub rate: f64,
    /// Second rate of the distance if no contact is closed.
    pub acceleration: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Change of the rates by a unit impulse, one number for each degree of freedom.
    pub column: Vec<f64>,
    /// Change of the distance's rate by a unit impulse at each of the impacts.
    pub delassus: Vec<f64>,
}

impl Evaluator {
    /// Writes the distances of the impacts to `out`.
    pub fn distances(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Distances, &point);
        for (slot, impact) in out.iter_mut().zip(&self.program.impacts) {
            *slot = self.memory[self.places.offset(impact.distance)];
        }
    }

    /// Computes all impacts in the order of the specification. A call with an `out` of a previous call
    /// allocates no memory.
    pub fn impacts(&mut self, point: Point<'_>, out: &mut Vec<ImpactValues>) {
        self.compute(Stage::Impacts, &point);
        let degrees = self.program.degrees_of_freedom();
        out.resize_with(self.program.impacts.len(), ImpactValues::default);
        for (slot, impact) in out.iter_mut().zip(&self.program.impacts) {
            let number = |id| self.memory[self.places.offset(id)];
            slot.distance = number(impact.distance);
            slot.rate = number(impact.rate);
            slot.acceleration = number(impact.acceleration);
            slot.restitution = number(impact.restitution);
            slot.delassus.resize(impact.delassus.len(), 0.0);
            for (entry, id) in slot.delassus.iter_mut().zip(&impact.delassus) {
                *entry = number(*id);
            }
            slot.column.resize(degrees, 0.0);
            self.copy_rows(
                &impact.column.scalars,
                &impact.column.modal,
                &mut slot.column,
            );
        }
    }
}
