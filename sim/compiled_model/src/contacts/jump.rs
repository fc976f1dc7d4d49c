//! Contacts at a jump of the rates that no contact causes, for example a jump of an energy or an input.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DVector;

use super::{Contacts, ROUNDING};
use crate::corners::TouchingContact;

impl Contacts {
    /// Returns the contacts at which bodies touch at rest.
    pub fn find_touching_contacts(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
    ) -> Vec<TouchingContact> {
        let resting = self.list_resting();
        if resting.is_empty() {
            return Vec::new();
        }
        own.impacts(point, &mut self.at);
        let degrees = own.program().degrees_of_freedom();
        let rates = DVector::from_column_slice(&point.state[degrees..2 * degrees]);
        let touching = resting.iter().map(|place| {
            let row = DVector::from_column_slice(&self.at[*place].row);
            let drift = self.at[*place].rate - row.dot(&rates);
            TouchingContact { drift, row }
        });
        touching.collect()
    }

    /// Determines the modes of contacts at rest after a jump. Contacts that the jump separates open; the others take
    /// the directions of their new slips.
    pub fn decide_after_jump(&mut self, own: &mut Evaluator, point: Point<'_>) {
        let touching = self.list_resting();
        if touching.is_empty() {
            return;
        }
        self.note_closed_until(point.t);
        own.impacts(point, &mut self.at);
        let small = self.compute_rate_roundings(own, point.state);
        let is_still = |place: &usize| self.at[*place].rate.abs() <= small[*place];
        let still: Vec<usize> = touching.iter().copied().filter(is_still).collect();
        self.closed.clear();
        self.redundant.clear();
        self.offset_by_rounding(&touching, (point.t, point.state));
        self.close_still(own, point, (&still, &small));
    }

    /// Returns the largest rate of each distance that counts as zero.
    pub(super) fn compute_rate_roundings(&self, own: &Evaluator, state: &[f64]) -> Vec<f64> {
        let rates = self.compute_rate_magnitudes(own, state);
        let sizes = (0..self.at.len()).map(|place| self.compute_rate_size(place, &rates));
        sizes.map(|size| ROUNDING * size).collect()
    }

    /// Closes the contacts at rest that push. Slips up to the rate `small` of each contact are zero.
    pub(super) fn close_still(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        (still, small): (&[usize], &[f64]),
    ) {
        match self.has_friction() {
            false => self.close(own, still, (point, point)),
            true => {
                let started = self.start_resting(own, point, (still, small));
                self.note_forces(started);
            }
        }
    }
}
