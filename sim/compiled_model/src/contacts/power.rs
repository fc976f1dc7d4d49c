//! Work of contacts on T + V. A force F at a distance g(q, t) has the power F (g' - w), where w is the rate at which it
//! does no work: `g_t` for a kinetic energy that is a quadratic form of the rates. Its impulse does the work -P w, without
//! the loss by restitution. Friction along the slip acts alike, with the loss by friction.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::Contacts;
use super::tangents::ContactForces;

impl Contacts {
    /// Returns the power (W) of the forces of the closed contacts.
    pub fn power(&mut self, own: &mut Evaluator, point: Point<'_>) -> f64 {
        if self.closed.is_empty() {
            return 0.0;
        }
        own.impacts(point, &mut self.at);
        let forces = self.forces();
        let normal = self.closed.iter().zip(&forces.normal);
        let normal = normal.map(|(place, force)| {
            let contact = &self.at[*place];
            force * (contact.rate - contact.workless_rate)
        });
        let along = self.closed.iter().zip(&forces.tangential);
        let along = along.map(|(place, force)| {
            let friction = self.at[*place].friction.as_ref();
            force * friction.map_or(0.0, |one| one.slip - one.workless_slip)
        });
        normal.chain(along).sum()
    }

    /// Returns the work (J) of the contacts in the last impact.
    pub fn impact_work(&self) -> f64 {
        self.impact_work
    }

    /// Returns the work (J) of impulses at these contacts at the last point, without the losses.
    pub(super) fn work_of(&self, places: &[usize], impulses: &ContactForces) -> f64 {
        let normal = places.iter().zip(&impulses.normal);
        let normal = normal.map(|(place, impulse)| -impulse * self.at[*place].workless_rate);
        let slips = places.iter().zip(&impulses.tangential);
        let slips = slips.map(|(place, impulse)| -impulse * self.workless_slip(*place));
        normal.chain(slips).sum()
    }

    fn workless_slip(&self, place: usize) -> f64 {
        let friction = self.at[place].friction.as_ref();
        friction.map_or(0.0, |one| one.workless_slip)
    }
}
