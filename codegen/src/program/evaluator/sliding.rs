//! Quantities of the surfaces along which the motion can slide, at a point.

use super::{Evaluator, Point, Stage};

/// Quantities of a surface at a point, in SI units; see
/// [`SlidingSurface`](crate::mechanics::outputs::SlidingSurface).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlidingValues {
    /// Rate of the switching function.
    pub rate: f64,
    /// Derivative of the rate of the switching function by each side.
    pub by_sides: Vec<f64>,
    /// Derivatives of the accelerations, then of the rates of first-order states, by the side of this surface.
    pub column: Vec<f64>,
}

impl Evaluator {
    /// Computes the quantities of all surfaces along which the motion can slide, in the order of the program. A call
    /// with an `out` of a previous call allocates no memory.
    pub fn sliding(&mut self, point: Point<'_>, out: &mut Vec<SlidingValues>) {
        self.compute(Stage::Sliding, &point);
        let degrees = self.program.degrees_of_freedom();
        let states = self.program.states();
        out.resize_with(self.program.outputs.sliding.len(), SlidingValues::default);
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
