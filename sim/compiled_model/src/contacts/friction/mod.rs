//! Contact friction: modes of closed contacts, their forces and their guards.
//!
//! A closed contact with friction sticks or slides in a direction. The mode is constant between events, so that
//! the rates are smooth: a contact that slides has the tangential force -mu N in its direction even in trial
//! states beyond zero slip. `events` changes the modes, `jumps` computes impulses, `resting` closes
//! contacts.

mod events;
mod jumps;
mod problem;
mod resting;

use eomgen_codegen::program::evaluator::{Evaluator, FrictionValues, Point};
use eomgen_sim::contact_friction::{ContactMode, ContactProblem};

use super::Contacts;
use super::tangents::{ContactForces, Tangent};
pub(crate) use problem::{
    build_contact_problem, collect_rates_and_slips, compute_free_accelerations,
    compute_full_delassus,
};

/// Relative change of a rate, for a difference quotient of the slip.
const RELATIVE_CHANGE: f64 = 1e-6;

/// Relative acceleration of a slip beyond which other contacts no longer keep it at zero.
const MAX_BEARING_ACCELERATION: f64 = 1e-10;

/// Rounding error of a slip, relative to the largest sum of its terms so far.
const SLIP_ROUNDING: f64 = 1024.0 * f64::EPSILON;

impl Contacts {
    /// Returns true if a contact has friction.
    pub fn has_friction(&self) -> bool {
        !self.tangents.is_empty()
    }

    /// Returns the index of a contact among those with friction.
    pub(super) fn tangent_index(&self, place: usize) -> Option<usize> {
        self.tangents
            .iter()
            .position(|tangent| tangent.place == place)
    }

    fn tangent(&self, place: usize) -> Option<&Tangent> {
        self.tangents.iter().find(|tangent| tangent.place == place)
    }

    /// Returns the closed contacts with their modes.
    pub fn closed_modes(&self) -> Vec<(usize, ContactMode)> {
        let closed = self.closed.iter();
        closed.map(|place| (*place, self.mode(*place))).collect()
    }

    /// Returns the mode of a closed contact.
    fn mode(&self, place: usize) -> ContactMode {
        let tangent = self.tangent(place);
        tangent.map_or(ContactMode::Slides(0.0), |tangent| tangent.mode)
    }

    /// Returns the friction values of a contact at the last point; `None` without friction.
    pub(super) fn friction_values(&self, place: usize) -> Option<&FrictionValues> {
        self.at[place].friction.as_ref()
    }

    pub(super) fn slip(&self, place: usize) -> f64 {
        self.friction_values(place)
            .map_or(0.0, |friction| friction.slip)
    }

    /// Returns the complementarity problem of some contacts with the slip directions `direction`; see
    /// [`contact_problem`].
    fn problem(
        &self,
        places: &[usize],
        direction: impl Fn(usize) -> Option<f64>,
        rates: &[f64],
    ) -> ContactProblem {
        build_contact_problem(&self.at, places, direction, rates)
    }

    fn compute_full_delassus(&self, places: &[usize]) -> Vec<f64> {
        compute_full_delassus(&self.at, places)
    }

    /// Returns the accelerations of distances and slips without contact forces.
    fn compute_free_accelerations(&self, places: &[usize]) -> Vec<f64> {
        compute_free_accelerations(&self.at, places)
    }

    /// Returns the forces of the closed contacts in their modes.
    pub(super) fn compute_friction_forces(&self) -> ContactForces {
        let modes: Vec<ContactMode> = self.closed.iter().map(|place| self.mode(*place)).collect();
        let rates = self.compute_free_accelerations(&self.closed);
        let problem = self.problem(&self.closed, |_| None, &rates);
        ContactForces::from_directions(problem.forces(&modes))
    }

    /// Returns the impulses that stop the closed contacts and the slips of contacts that stick.
    pub(super) fn compute_stopping_impulses(&self) -> ContactForces {
        let sticks = |place: &usize| self.mode(*place) == ContactMode::Sticks;
        let modes = self.closed.iter().map(|place| match sticks(place) {
            true => ContactMode::Sticks,
            false => ContactMode::Slides(0.0),
        });
        self.solve_stopping_impulses(&self.closed, &modes.collect::<Vec<ContactMode>>())
    }

    /// Returns the impulses that stop the closed contacts, with friction at contacts that slide; `None` if a contact
    /// stops sliding. A contact that closes after an impact has a smaller friction impulse, because part of its normal
    /// impulse is removed.
    pub(super) fn compute_closing_impulses(&self) -> Option<ContactForces> {
        let modes: Vec<ContactMode> = self.closed.iter().map(|place| self.mode(*place)).collect();
        let impulses = self.solve_stopping_impulses(&self.closed, &modes);
        let changes = self.compute_rate_changes(&self.closed, &impulses);
        let changes = changes[self.closed.len()..].iter();
        let mut sliding = self.closed.iter().zip(&modes).zip(changes);
        let slides_on = sliding.all(|((place, mode), change)| match mode {
            ContactMode::Slides(side) if *side != 0.0 => side * (self.slip(*place) + change) > 0.0,
            _ => true,
        });
        slides_on.then_some(impulses)
    }

    fn solve_stopping_impulses(&self, places: &[usize], modes: &[ContactMode]) -> ContactForces {
        let rates = collect_rates_and_slips(&self.at, places);
        let problem = self.problem(places, |_| None, &rates);
        ContactForces::from_directions(problem.impulses(modes))
    }

    /// Returns the slips after impulses that stop the contacts and the slips of contacts that stick.
    fn compute_stopped_slips(&self, places: &[usize], modes: &[ContactMode]) -> Vec<f64> {
        let impulses = self.solve_stopping_impulses(places, modes);
        let changes = self.compute_rate_changes(places, &impulses);
        let changes = places.iter().zip(&changes[places.len()..]);
        changes
            .map(|(place, change)| self.slip(*place) + change)
            .collect()
    }

    /// Writes the friction guards: the slip in its direction while a contact slides, the margin mu N - |T| while it
    /// sticks. If other contacts keep the slip at zero, the guard is negative when they no longer do.
    pub(super) fn write_friction_guards(&self, forces: &ContactForces, out: &mut [f64]) {
        for (slot, tangent) in out.iter_mut().zip(&self.tangents) {
            let closed = self.closed.iter().position(|place| *place == tangent.place);
            *slot = match closed {
                Some(index) => self.compute_friction_guard(tangent, index, forces),
                None => 1.0,
            };
        }
    }

    /// Returns the friction guard of a closed contact; `index` counts the closed contacts.
    fn compute_friction_guard(
        &self,
        tangent: &Tangent,
        index: usize,
        forces: &ContactForces,
    ) -> f64 {
        let Some(friction) = self.friction_values(tangent.place) else {
            return 1.0;
        };
        match tangent.mode {
            _ if tangent.bears => {
                let (acceleration, size) = self.compute_slip_acceleration(index, forces);
                MAX_BEARING_ACCELERATION * size - acceleration.abs() + f64::MIN_POSITIVE
            }
            ContactMode::Slides(side) => side * friction.slip + tangent.slip_offset,
            ContactMode::Sticks => {
                let bound = friction.coefficient * forces.normal[index];
                bound - forces.tangential[index].abs() + tangent.force_allowance
            }
            ContactMode::Open => 1.0,
        }
    }

    /// Returns the acceleration of the slip of a closed contact, and the magnitude of its terms. `index` counts the
    /// closed contacts.
    pub(super) fn compute_slip_acceleration(
        &self,
        index: usize,
        forces: &ContactForces,
    ) -> (f64, f64) {
        let count = self.closed.len();
        let delassus = self.compute_full_delassus(&self.closed);
        let row = delassus.chunks_exact(2 * count).nth(count + index);
        let forces = forces.normal.iter().chain(&forces.tangential);
        let terms = row.into_iter().flatten().zip(forces);
        let free = self.compute_free_accelerations(&self.closed)[count + index];
        terms.fold((free, free.abs()), |(sum, size), (entry, force)| {
            (sum + entry * force, size + (entry * force).abs())
        })
    }

    /// Notes the magnitudes of the slips at the last point.
    pub(super) fn note_slip_sizes(&mut self) {
        for tangent in &mut self.tangents {
            let slip = self.at[tangent.place].friction.as_ref().map(|one| one.slip);
            tangent.slip_size = tangent.slip_size.max(slip.unwrap_or(0.0).abs());
        }
    }

    /// Returns the rounding error of each slip due to rounding of the rates. At rest the rounding comes from earlier,
    /// larger rates, or from the typical sizes of rates that have not moved.
    pub(super) fn compute_slip_roundings(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
    ) -> Vec<f64> {
        let degrees = own.program().degrees_of_freedom();
        own.impacts(point, &mut self.at);
        let slips = |contacts: &Self| -> Vec<f64> {
            let tangents = contacts.tangents.iter();
            tangents
                .map(|tangent| contacts.slip(tangent.place))
                .collect()
        };
        let here = slips(self);
        let mut sums = vec![0.0; here.len()];
        let mut moved = point.state.to_vec();
        for entry in degrees..2 * degrees {
            let unmoved = self.unmoved_rates.get(entry - degrees);
            let size = moved[entry].abs().max(unmoved.copied().unwrap_or(0.0));
            if size == 0.0 {
                continue;
            }
            moved[entry] += RELATIVE_CHANGE * size;
            let beside = Point {
                state: &moved,
                ..point
            };
            own.impacts(beside, &mut self.at);
            for (sum, (a, b)) in sums.iter_mut().zip(slips(self).iter().zip(&here)) {
                *sum += (a - b).abs() / RELATIVE_CHANGE;
            }
            moved[entry] = point.state[entry];
        }
        own.impacts(point, &mut self.at);
        let rounding = |(tangent, sum): (&mut Tangent, f64)| {
            tangent.slip_size = tangent.slip_size.max(sum);
            f64::MIN_POSITIVE + SLIP_ROUNDING * tangent.slip_size
        };
        self.tangents.iter_mut().zip(sums).map(rounding).collect()
    }
}
