//! What the impacts of a program are at a point.

use super::{Evaluator, Point, Stage};

/// An impact at a point, in SI; the quantities are those of
/// [`Impact`](crate::mechanics::impacts::Impact).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImpactAt {
    /// The distance.
    pub distance: f64,
    /// Its rate.
    pub rate: f64,
    /// Its second rate where no contact is closed.
    pub acceleration: f64,
    /// The part of the rate that comes back.
    pub restitution: f64,
    /// What an impulse of 1 adds to the rates, one number per degree of freedom.
    pub column: Vec<f64>,
    /// What impulses of 1 at each of the impacts add to the rate of the distance.
    pub delassus: Vec<f64>,
}

impl Evaluator {
    /// The distances of the impacts; `out` has as many numbers.
    pub fn distances(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Distances, &point);
        for (slot, impact) in out.iter_mut().zip(&self.program.impacts) {
            *slot = self.memory[self.places.offset(impact.distance)];
        }
    }

    /// All of the impacts, in the order of the specification. Nothing is allocated where `out` was
    /// filled before.
    pub fn impacts(&mut self, point: Point<'_>, out: &mut Vec<ImpactAt>) {
        self.compute(Stage::Impacts, &point);
        let degrees = self.program.degrees_of_freedom();
        out.resize_with(self.program.impacts.len(), ImpactAt::default);
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
