//! Work of contacts on T + V. A force F at a distance g(q, t) has the power F (g' - w). At the rate g' = w the force
//! does no work; w is `g_t` if the kinetic energy is a quadratic form of the rates. Its impulse P does the work -P w,
//! without the loss by restitution. Friction along the slip has the same form, with the loss by friction.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::ode::ROUNDING_FACTOR;

use super::Contacts;
use super::tangents::ContactForces;

impl Contacts {
    /// Returns the power (W) of the forces of the closed contacts.
    pub fn power(&mut self, own: &mut Evaluator, point: Point<'_>) -> f64 {
        let terms = self.list_power_terms(own, point);
        terms
            .map(|(force, [rate, workless])| force * (rate - workless))
            .sum()
    }

    /// Returns the rounding error (W) of the power of the closed contacts. A contact that moves at its workless rate
    /// has the rounding errors of both rates.
    pub fn power_rounding(&mut self, own: &mut Evaluator, point: Point<'_>) -> f64 {
        let terms = self.list_power_terms(own, point);
        let roundings = terms.map(|(force, rates)| {
            ROUNDING_FACTOR * f64::EPSILON * (force * rates[0].abs().max(rates[1].abs())).abs()
        });
        roundings.sum()
    }

    /// Returns each force of the closed contacts, with the rate of its distance or slip and its workless rate.
    fn list_power_terms(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
    ) -> impl Iterator<Item = (f64, [f64; 2])> {
        let forces = match self.closed.is_empty() {
            true => ContactForces::default(),
            false => {
                own.impacts(point, &mut self.at);
                self.compute_forces()
            }
        };
        let places = self.closed.iter();
        let rates = places.map(|place| {
            let contact = &self.at[*place];
            let along = contact.friction.as_ref();
            let along = along.map_or([0.0; 2], |one| [one.slip, one.workless_slip]);
            ([contact.rate, contact.workless_rate], along)
        });
        // Without friction there are no tangential forces.
        let tangential = forces.tangential.into_iter().chain(std::iter::repeat(0.0));
        let both = forces.normal.into_iter().zip(tangential);
        let terms = both.zip(rates);
        terms.flat_map(|((normal, along), (rates, slips))| [(normal, rates), (along, slips)])
    }

    /// Returns the work (J) of the contacts in the last impact.
    pub fn impact_work(&self) -> f64 {
        self.impact_work
    }

    /// Returns the work (J) of impulses at some contacts at the last point, without losses.
    pub(super) fn compute_work(&self, places: &[usize], impulses: &ContactForces) -> f64 {
        let normal = places.iter().zip(&impulses.normal);
        let normal = normal.map(|(place, impulse)| -impulse * self.at[*place].workless_rate);
        let slips = places.iter().zip(&impulses.tangential);
        let slips = slips.map(|(place, impulse)| -impulse * self.compute_workless_slip(*place));
        normal.chain(slips).sum()
    }

    fn compute_workless_slip(&self, place: usize) -> f64 {
        let friction = self.at[place].friction.as_ref();
        friction.map_or(0.0, |one| one.workless_slip)
    }
}
