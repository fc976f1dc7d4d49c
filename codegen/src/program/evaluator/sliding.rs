//! What the surfaces that may hold the motion are at a point.

use super::{Evaluator, Point, Stage};

/// A surface at a point, in SI; the quantities are those of
/// [`SlidingSurface`](crate::mechanics::outputs::SlidingSurface).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlidingAt {
    /// The rate of its function.
    pub rate: f64,
    /// By how much each of the sides changes that.
    pub by_sides: Vec<f64>,
    /// By how much its own side changes the rates of the state: a number for each degree of freedom,
    /// then for each state of first order.
    pub column: Vec<f64>,
}

impl Evaluator {
    /// All surfaces that may hold the motion, in the order of the program. Nothing is allocated where
    /// `out` was filled before.
    pub fn sliding(&mut self, point: Point<'_>, out: &mut Vec<SlidingAt>) {
        self.compute(Stage::Sliding, &point);
        let degrees = self.program.degrees_of_freedom();
        let states = self.program.states();
        out.resize_with(self.program.outputs.sliding.len(), SlidingAt::default);
        for (slot, surface) in out.iter_mut().zip(&self.program.outputs.sliding) {
            let number = |id| self.memory[self.places.offset(id)];
            slot.rate = number(surface.rate);
            slot.by_sides.resize(surface.by_sides.len(), 0.0);
            for (entry, id) in slot.by_sides.iter_mut().zip(&surface.by_sides) {
                *entry = number(*id);
            }
            slot.column.resize(states - degrees, 0.0);
            let (rates, first_order) = slot.column.split_at_mut(degrees);
            self.copy_rows(&surface.column.scalars, &surface.column.modal, rates);
            for (entry, id) in first_order.iter_mut().zip(&surface.first_order) {
                *entry = number(*id);
            }
        }
    }
}
