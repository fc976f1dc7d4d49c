//! Impacts at one instant. Contacts that are hit together receive simultaneous impulses. A contact that separates and
//! is hit again is hit in a later impact of the sequence. The distances of such impacts can fall below rounding long
//! before their speeds do. An infinite sequence stops the bodies (inelastic collapse; S. McNamara and W. R. Young,
//! Phys. Fluids A 4, 1992).

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::impulses::MAX_UNSOLVED_RATE_FRACTION;
use super::tangents::ContactForces;
use super::{ContactFailure, Contacts, DISTANCE_ROUNDING};

/// Number of impacts at one instant after which the bodies move on together. Speeds that shrink by 1 % in two impacts
/// are at rounding level after 6500 impacts.
const MAX_IMPACTS_AT_ONE_INSTANT: usize = 10_000;

impl Contacts {
    /// Changes the rates of a state by the impulses of contacts that touch and were hit `time_since_hit` s before, and of the
    /// contacts that these impulses close. Returns all contacts that touched, and the rounding error of the rate of
    /// each distance.
    pub(super) fn apply_impulses(
        &mut self,
        own: &mut Evaluator,
        (t, inputs): (f64, &[f64]),
        state: &mut [f64],
        mut touching: Vec<usize>,
        mut time_since_hit: f64,
    ) -> Result<(Vec<usize>, Vec<f64>), ContactFailure> {
        let degrees = own.program().degrees_of_freedom();
        let mut roundings = vec![0.0_f64; self.names.len()];
        own.impacts(Point { t, state, inputs }, &mut self.at);
        for count in 0..=MAX_IMPACTS_AT_ONE_INSTANT {
            self.has_restitution &= count < MAX_IMPACTS_AT_ONE_INSTANT;
            let (hit, impulses) = self.solve_hit_together(&touching, time_since_hit)?;
            self.impact_work += self.compute_work(&hit, &impulses);
            let (coordinates, rates) = state[..2 * degrees].split_at_mut(degrees);
            let pushes: Vec<f64> = (0..self.names.len())
                .map(|place| self.compute_push_size(place, &hit, &impulses))
                .collect();
            for (place, rounding) in roundings.iter_mut().enumerate() {
                let most = self.compute_rate_size(place, rates) + pushes[place];
                *rounding = rounding.max(DISTANCE_ROUNDING * most);
            }
            self.add_forces(&hit, &impulses, rates);
            self.add_forces(&hit, &impulses.scaled(time_since_hit), coordinates);
            own.impacts(Point { t, state, inputs }, &mut self.at);
            // Distances are located to rounding; these rounding errors must not accumulate.
            let mut below = touching.clone();
            below.retain(|place| self.at[*place].distance < 0.0);
            let corrections = self.solve_balance(&below, |impact| impact.distance);
            self.add_impulses(&below, &corrections, &mut state[..degrees]);
            own.impacts(Point { t, state, inputs }, &mut self.at);
            let touched = |place: &usize| {
                let distance = self.at[*place].distance + self.offsets[*place];
                !touching.contains(place) && distance < 0.0
            };
            let more: Vec<usize> = (0..self.names.len()).filter(touched).collect();
            let approaches = |place: &usize| {
                let unsolved = MAX_UNSOLVED_RATE_FRACTION * pushes[*place];
                self.at[*place].rate < -unsolved.max(roundings[*place])
            };
            // The rate of a closed contact is rounding; so is a rate that needs no impulse.
            let mut open = touching.iter().filter(|place| !self.rests(**place));
            let has_pushed = impulses.normal.iter().any(|impulse| *impulse > 0.0);
            if more.is_empty() && !(has_pushed && open.any(approaches)) {
                break;
            }
            touching.extend(more);
            time_since_hit = 0.0;
        }
        Ok((touching, roundings))
    }

    /// Returns the contacts that are hit together, and their impulses. A contact that separates is not included.
    ///
    /// # Errors
    /// No impulses keep the bodies apart.
    fn solve_hit_together(
        &self,
        touching: &[usize],
        time_since_hit: f64,
    ) -> Result<(Vec<usize>, ContactForces), ContactFailure> {
        let mut together = touching.to_vec();
        loop {
            let impulses = match self.has_friction() {
                true => self.solve_friction_impulses(&together, time_since_hit),
                false => self.solve_impulses(&together, time_since_hit),
            };
            let impulses = impulses.ok_or(ContactFailure::NoImpulse)?;
            let count = together.len();
            let mut normal = impulses.normal.iter();
            let all = together.clone();
            together.retain(|place| {
                let is_pushed = normal.next().is_some_and(|impulse| *impulse > 0.0);
                let push =
                    MAX_UNSOLVED_RATE_FRACTION * self.compute_push_size(*place, &all, &impulses);
                let leaves = self.has_restitution
                    && !self.rests(*place)
                    && self.compute_hit_rate(*place, time_since_hit) > push;
                !(is_pushed && leaves)
            });
            if together.len() == count {
                return Ok((together, impulses));
            }
        }
    }
}
