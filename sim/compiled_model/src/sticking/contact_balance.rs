//! Surfaces that hold the motion while contacts are closed. In given modes of the contacts, their forces depend on the
//! sides: they keep the distances, and the slips of contacts that stick, from accelerating. With these forces the rates
//! of the switching functions are linear in the sides.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::contact_friction::ContactMode;

use super::sided_model::{SidedModel, TimeAndState};
use crate::contacts::{build_contact_problem, collect_rates_and_slips, compute_free_accelerations};

/// With closed contacts, a surface force whose effect on its own function falls below this fraction has no effect. A
/// rate of the function below it is rounding too.
const MAX_STOPPED_FRACTION: f64 = 1e-8;

/// The sum of two opposed effects counts as zero below this fraction of one of them.
const MAX_BALANCED_FRACTION: f64 = 1e-12;

impl SidedModel {
    /// Sets the closed contacts with their modes.
    pub(super) fn set_closed_contacts(&mut self, closed: &[(usize, ContactMode)]) {
        self.closed_contacts.clear();
        self.closed_contacts.extend(closed);
    }

    pub(super) fn closed_contacts(&self) -> &[(usize, ContactMode)] {
        &self.closed_contacts
    }

    /// Closes the contacts that touch, do not move and push at a state. The distances and
    /// rates of the state have the given rounding errors.
    pub(super) fn close_resting_contacts(
        &mut self,
        (t, state): TimeAndState<'_>,
        [distance_rounding, rate_rounding]: [f64; 2],
    ) {
        self.closed_contacts.clear();
        if self.evaluator.program().impacts.is_empty() {
            return;
        }
        let inputs = &self.inputs;
        self.evaluator
            .impacts(Point { t, state, inputs }, &mut self.impacts);
        let impacts = &self.impacts;
        let rests = |place: &usize| {
            let impact = &impacts[*place];
            impact.distance <= distance_rounding && impact.rate.abs() <= rate_rounding
        };
        let direction = |place: usize| {
            let slip = impacts[place].friction.as_ref().map(|one| one.slip);
            let slip = slip.filter(|slip| slip.abs() > rate_rounding);
            slip.map(f64::signum)
        };
        let resting: Vec<usize> = (0..impacts.len()).filter(rests).collect();
        let accelerations = compute_free_accelerations(impacts, &resting);
        let problem = build_contact_problem(impacts, &resting, direction, &accelerations);
        let modes = problem.decide(None, &[]).map(|decision| decision.modes);
        let closed = resting.into_iter().zip(modes.unwrap_or_default());
        self.closed_contacts
            .extend(closed.filter(|(_, mode)| *mode != ContactMode::Open));
    }

    /// Returns the evaluator and its inputs: the inputs of the model, followed by the sides.
    pub(super) fn evaluator_with_sides(&mut self) -> (&mut Evaluator, &[f64]) {
        (&mut self.evaluator, &self.inputs)
    }

    /// Returns true if closed contacts prevent the motion that the force of a surface resists.
    pub(super) fn is_stopped_by_contacts(&self, surface: usize) -> bool {
        let own = self.own_effects.get(surface).copied().unwrap_or(0.0);
        !self.closed_contacts.is_empty()
            && self.at[surface].by_sides[surface].abs() <= MAX_STOPPED_FRACTION * own
    }

    /// Returns the side, -1 or 1, to which closed contacts move the motion across the surface; `None` if they stop it.
    /// The contacts prevent the motion that the force of the surface resists.
    pub(super) fn side_of_contact_motion(&self, surface: usize) -> Option<f64> {
        let own = self.own_effects.get(surface).copied().unwrap_or(0.0);
        let rate = self.at[surface].rate;
        (rate.abs() > MAX_STOPPED_FRACTION * own).then(|| rate.signum())
    }

    /// Adds the effects of the contact forces to the last evaluated effects of the surfaces. The switching functions
    /// are linear in the rates.
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
        let (closed, modes): (Vec<usize>, Vec<ContactMode>) =
            self.closed_contacts.iter().copied().unzip();
        let accelerations = compute_free_accelerations(&self.impacts, &closed);
        let degrees = self.degrees_of_freedom();
        let normal = closed.iter().map(|place| &self.impacts[*place].column);
        let normal = normal.map(|column| Some(column.clone()));
        let tangential = closed.iter().map(|place| {
            let friction = self.impacts[*place].friction.as_ref();
            friction.map(|friction| friction.column.clone())
        });
        let columns: Vec<Option<Vec<f64>>> = normal.chain(tangential).collect();
        let impacts = self.impacts.clone();
        let forces_at = |rates: &[f64]| {
            let problem = build_contact_problem(&impacts, &closed, |_| None, rates);
            problem.impulses(&modes)
        };
        let forces = forces_at(&accelerations);
        let mut moved = state.to_vec();
        moved[degrees..2 * degrees].fill(0.0);
        let still = self.contact_rates_and_functions(t, &moved, &closed);
        let mut by_forces = Vec::with_capacity(columns.len());
        for column in columns.iter() {
            let Some(column) = column else {
                by_forces.push(vec![0.0; still.1.len()]);
                continue;
            };
            moved[degrees..2 * degrees].copy_from_slice(column);
            let pushed = self.contact_rates_and_functions(t, &moved, &closed);
            by_forces.push(subtract(&pushed.1, &still.1));
        }
        let mut forces_by_sides = Vec::with_capacity(self.at.len());
        for side in 0..self.at.len() {
            moved[degrees..2 * degrees].copy_from_slice(&self.at[side].column[..degrees]);
            let pushed = self.contact_rates_and_functions(t, &moved, &closed);
            forces_by_sides.push(forces_at(&subtract(&pushed.0, &still.0)));
        }
        for (row, surface) in self.at.iter_mut().enumerate() {
            let rate = |forces: &[f64]| -> f64 {
                let terms = forces.iter().zip(&by_forces);
                terms.map(|(force, effects)| force * effects[row]).sum()
            };
            surface.rate = add_opposed(surface.rate, rate(&forces));
            for (slot, forces) in surface.by_sides.iter_mut().zip(&forces_by_sides) {
                *slot = add_opposed(*slot, rate(forces));
            }
            for (force, column) in forces_by_sides[row].iter().zip(&columns) {
                for (slot, entry) in surface.column.iter_mut().zip(column.iter().flatten()) {
                    *slot += force * entry;
                }
            }
        }
    }

    /// Returns the rates of the distances and the slips of `closed` contacts, and the switching functions of the surfaces.
    fn contact_rates_and_functions(
        &mut self,
        t: f64,
        state: &[f64],
        closed: &[usize],
    ) -> (Vec<f64>, Vec<f64>) {
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.impacts(point, &mut self.impacts);
        self.evaluator.guards(point, &mut self.guards);
        let sliding = &self.evaluator.program().outputs.sliding;
        let functions = sliding.iter().map(|surface| self.guards[surface.guard]);
        (
            collect_rates_and_slips(&self.impacts, closed),
            functions.collect(),
        )
    }
}

/// Returns the sum of the effects of a surface and of the contact forces, 0 if they cancel up to rounding.
fn add_opposed(own: f64, by_contacts: f64) -> f64 {
    let sum = own + by_contacts;
    match sum.abs() <= MAX_BALANCED_FRACTION * own.abs() {
        true => 0.0,
        false => sum,
    }
}

fn subtract(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
