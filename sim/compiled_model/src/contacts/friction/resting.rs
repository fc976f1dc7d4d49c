//! Contacts with friction that close at the start or after an impact.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::contact_friction::ContactMode;

use super::super::impulses::FlightLimits;
use super::super::tangents::ContactForces;
use super::super::{ContactFailure, Contacts, DISTANCE_ROUNDING};

impl Contacts {
    /// Closes the contacts at rest that push at the start. Slips up to the rate `small` of each contact are zero.
    ///
    /// # Errors
    /// No forces satisfy the law of friction.
    pub(in super::super) fn start_resting(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        (still, small): (&[usize], &[f64]),
    ) -> Result<(), (usize, ContactFailure)> {
        if still.is_empty() {
            return Ok(());
        }
        let roundings = self.compute_slip_roundings(own, point);
        let decision = self.decide_resting(still, (small, &roundings))?;
        self.note_choice(point.t, (still, &decision));
        self.enter_modes(own, (still, &decision), &roundings, (point, point));
        Ok(())
    }

    /// After an impact, closes the touching contacts that would not separate, and the contacts whose bodies move on
    /// together.
    ///
    /// # Errors
    /// No forces satisfy the law of friction.
    pub(in super::super) fn close_resting_with_friction(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        touching: &[usize],
        flight: &FlightLimits,
    ) -> Result<(), (usize, ContactFailure)> {
        let mut roundings = self.compute_slip_roundings(own, point);
        for (rounding, change) in roundings.iter_mut().zip(&flight.slip_changes) {
            *rounding = rounding.max(*change);
        }
        self.closed.clear();
        self.redundant.clear();
        let mut resting: Vec<usize> = Vec::new();
        let mut decision = None;
        let mut even = flight.acceleration_roundings.clone();
        let mut accelerations =
            self.compute_resting_accelerations(touching, (&[], &Default::default()));
        loop {
            let is_next = |(place, acceleration): &(&usize, &f64)| {
                let rate = self.at[**place].rate;
                !resting.contains(*place)
                    && flight.is_rest(**place, (rate, **acceleration), even[**place])
            };
            let Some((next, _)) = touching.iter().zip(&accelerations).find(is_next) else {
                break;
            };
            resting.push(*next);
            let decided = self.decide_resting(&resting, (&flight.rate_roundings, &roundings))?;
            let forces = ContactForces::from_directions(decided.impulses.clone());
            for (place, even) in even.iter_mut().enumerate() {
                *even = flight.acceleration_roundings[place]
                    + DISTANCE_ROUNDING * self.compute_push_size(place, &resting, &forces);
            }
            accelerations = self.compute_resting_accelerations(touching, (&resting, &forces));
            decision = Some(decided);
        }
        self.offset_distances(touching);
        let Some(mut decision) = decision else {
            return Ok(());
        };
        let forces = ContactForces::from_directions(decision.impulses.clone());
        self.note_choice(point.t, (&resting, &decision));
        // Contacts whose bodies move on together without a force stay closed.
        let decided = resting.iter().zip(&decision.modes);
        let pushing = decided.filter(|(_, mode)| **mode != ContactMode::Open);
        let pushing: Vec<usize> = pushing.map(|(place, _)| *place).collect();
        for (place, mode) in resting.iter().zip(&mut decision.modes) {
            let among = touching.iter().zip(&accelerations);
            let is_even = among
                .filter(|(own, _)| *own == place)
                .any(|(_, a)| *a <= even[*place]);
            let is_free = !self.is_blocked_by(&pushing, *place);
            if *mode == ContactMode::Open && is_even && is_free {
                let small = flight.rate_roundings[*place];
                *mode = self.find_force_free_mode(*place, (&resting, &forces), (&roundings, small));
            }
        }
        self.enter_modes(own, (&resting, &decision), &roundings, (point, point));
        for place in self.closed.clone() {
            let least = even[place] / self.at[place].delassus[place];
            self.allowances[place] = self.allowances[place].max(least);
            let tangents = self.tangents.iter_mut().filter(|own| own.place == place);
            for tangent in tangents {
                tangent.force_allowance = tangent.force_allowance.max(least);
            }
        }
        Ok(())
    }

    /// Returns the mode of a closed contact without a normal force. Its friction is zero, so the contact sticks only if
    /// its slip and the acceleration of its slip are zero. Slips up to their rounding errors or the rate `small` count
    /// as zero.
    fn find_force_free_mode(
        &self,
        place: usize,
        (resting, forces): (&[usize], &ContactForces),
        (roundings, small): (&[f64], f64),
    ) -> ContactMode {
        let Some(index) = self.tangent_index(place) else {
            return ContactMode::Slides(0.0);
        };
        let slip = self.slip(place);
        if slip.abs() > roundings[index].max(small) {
            return ContactMode::Slides(slip.signum());
        }
        let Some(friction) = self.friction_values(place) else {
            return ContactMode::Sticks;
        };
        let own = &friction.delassus;
        let (pushes, sizes) = self.compute_pushed_acceleration(own, (resting, forces));
        let acceleration = friction.acceleration + pushes;
        let size = friction.acceleration.abs() + sizes;
        match acceleration.abs() > DISTANCE_ROUNDING * size {
            true => ContactMode::Slides(acceleration.signum()),
            false => ContactMode::Sticks,
        }
    }

    /// Returns the accelerations of the distances of contacts due to the forces of other contacts.
    fn compute_resting_accelerations(
        &self,
        touching: &[usize],
        (resting, forces): (&[usize], &ContactForces),
    ) -> Vec<f64> {
        let acceleration = |place: &usize| {
            let impact = &self.at[*place];
            impact.acceleration
                + self
                    .compute_pushed_acceleration(&impact.delassus, (resting, forces))
                    .0
        };
        touching.iter().map(acceleration).collect()
    }

    /// Returns the acceleration due to `forces` in the direction with the given row of the Delassus matrix, and the sum
    /// of the magnitudes of its terms.
    fn compute_pushed_acceleration(
        &self,
        row: &[f64],
        (resting, forces): (&[usize], &ContactForces),
    ) -> (f64, f64) {
        let normal = resting.iter().zip(&forces.normal);
        let normal = normal.map(|(other, force)| row[*other] * force);
        let along = resting.iter().zip(&forces.tangential);
        let along = along.filter_map(|(other, force)| {
            let column = self.names.len() + self.tangent_index(*other)?;
            Some(row[column] * force)
        });
        let terms = normal.chain(along);
        terms.fold((0.0, 0.0), |(sum, size), term| {
            (sum + term, size + term.abs())
        })
    }
}
