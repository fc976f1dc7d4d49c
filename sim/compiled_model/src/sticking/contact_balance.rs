//! Surfaces that hold the motion while contacts are closed. The contact forces keep the distances from accelerating, so
//! they follow from the sides: a = a_0 + W lambda = 0 with Delassus' matrix W. With these forces the rates of the
//! switching functions are linear in the sides.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::sided_model::{SidedModel, TimeAndState};
use crate::contacts::{delassus, solve_complementarity, solve_rows};

/// Rest of the effect of a surface's force on its own function, with closed contacts, that is rounding.
const MAX_STOPPED_FRACTION: f64 = 1e-8;

impl SidedModel {
    /// Sets the closed contacts.
    pub(super) fn set_closed_contacts(&mut self, closed: &[usize]) {
        self.closed_contacts.clear();
        self.closed_contacts.extend(closed);
    }

    pub(super) fn closed_contacts(&self) -> &[usize] {
        &self.closed_contacts
    }

    /// Closes the contacts without friction that touch, do not move and push at a state, which has rounding of these sizes
    /// in its coordinates and rates.
    pub(super) fn close_resting_contacts(
        &mut self,
        (t, state): TimeAndState<'_>,
        [distance_rounding, rate_rounding]: [f64; 2],
    ) {
        self.closed_contacts.clear();
        let impacts = &self.evaluator.program().impacts;
        if impacts.is_empty() || impacts.iter().any(|impact| impact.friction.is_some()) {
            return;
        }
        let inputs = &self.inputs;
        self.evaluator
            .impacts(Point { t, state, inputs }, &mut self.impacts);
        let rests = |place: &usize| {
            let impact = &self.impacts[*place];
            impact.distance <= distance_rounding && impact.rate.abs() <= rate_rounding
        };
        let resting: Vec<usize> = (0..self.impacts.len()).filter(rests).collect();
        let delassus = delassus(&self.impacts, &resting);
        let accelerations = resting
            .iter()
            .map(|place| self.impacts[*place].acceleration);
        let forces = solve_complementarity(&delassus, &accelerations.collect::<Vec<f64>>());
        let pushing = resting.iter().zip(forces).filter(|(_, force)| *force > 0.0);
        self.closed_contacts
            .extend(pushing.map(|(place, _)| *place));
    }

    /// Returns the evaluator and its inputs: those of the model and the sides.
    pub(super) fn evaluator_with_sides(&mut self) -> (&mut Evaluator, &[f64]) {
        (&mut self.evaluator, &self.inputs)
    }

    /// Returns true if closed contacts prevent the motion that the force of a surface resists.
    pub(super) fn is_stopped_by_contacts(&self, surface: usize) -> bool {
        let own = self.own_effects.get(surface).copied().unwrap_or(0.0);
        !self.closed_contacts.is_empty()
            && self.at[surface].by_sides[surface].abs() <= MAX_STOPPED_FRACTION * own
    }

    /// Adds the effects of the contact forces to those of the surfaces, as last evaluated. The switching functions are
    /// linear in the rates.
    pub(super) fn add_contact_forces(&mut self, (t, state): TimeAndState<'_>) {
        let diagonal = self.at.iter().enumerate();
        self.own_effects = diagonal
            .map(|(row, surface)| surface.by_sides[row].abs())
            .collect();
        if self.closed_contacts.is_empty() {
            return;
        }
        let point = Point {
            t,
            state,
            inputs: &self.inputs,
        };
        self.evaluator.impacts(point, &mut self.impacts);
        let closed = self.closed_contacts.clone();
        let delassus = delassus(&self.impacts, &closed);
        let rows: Vec<usize> = (0..closed.len()).collect();
        let accelerations: Vec<f64> = (closed.iter())
            .map(|place| self.impacts[*place].acceleration)
            .collect();
        let columns: Vec<Vec<f64>> = (closed.iter())
            .map(|place| self.impacts[*place].column.clone())
            .collect();
        let forces = solve_rows(&delassus, &accelerations, &rows);
        let degrees = self.degrees_of_freedom();
        let mut moved = state.to_vec();
        moved[degrees..2 * degrees].fill(0.0);
        let still = self.distance_rates_and_functions(t, &moved, &closed);
        let by_forces: Vec<Vec<f64>> = (columns.iter())
            .map(|column| {
                moved[degrees..2 * degrees].copy_from_slice(column);
                let pushed = self.distance_rates_and_functions(t, &moved, &closed);
                pushed.1.iter().zip(&still.1).map(|(a, b)| a - b).collect()
            })
            .collect();
        let count = self.at.len();
        let forces_by_sides: Vec<Vec<f64>> = (0..count)
            .map(|side| {
                moved[degrees..2 * degrees].copy_from_slice(&self.at[side].column[..degrees]);
                let pushed = self.distance_rates_and_functions(t, &moved, &closed);
                let changes: Vec<f64> = pushed.0.iter().zip(&still.0).map(|(a, b)| a - b).collect();
                solve_rows(&delassus, &changes, &rows)
            })
            .collect();
        for (row, surface) in self.at.iter_mut().enumerate() {
            let rate = |forces: &[f64]| -> f64 {
                let terms = forces.iter().zip(&by_forces);
                terms.map(|(force, effects)| force * effects[row]).sum()
            };
            surface.rate += rate(&forces);
            for (slot, forces) in surface.by_sides.iter_mut().zip(&forces_by_sides) {
                *slot += rate(forces);
            }
            for (force, column) in forces_by_sides[row].iter().zip(&columns) {
                for (slot, entry) in surface.column.iter_mut().zip(column) {
                    *slot += force * entry;
                }
            }
        }
    }

    /// Returns the rates of the distances of `closed` contacts, and the switching functions of the surfaces.
    fn distance_rates_and_functions(
        &mut self,
        t: f64,
        state: &[f64],
        closed: &[usize],
    ) -> (Vec<f64>, Vec<f64>) {
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.impacts(point, &mut self.impacts);
        self.evaluator.guards(point, &mut self.guards);
        let rates = closed.iter().map(|place| self.impacts[*place].rate);
        let sliding = &self.evaluator.program().outputs.sliding;
        let functions = sliding.iter().map(|surface| self.guards[surface.guard]);
        (rates.collect(), functions.collect())
    }
}
