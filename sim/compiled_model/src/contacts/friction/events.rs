//! Mode changes of closed contacts with friction.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::contact_friction::{ContactDecision, ContactMode};

use super::super::tangents::{ContactForces, Tangent};
use super::super::{ContactFailure, Contacts, solve_rows};

/// Rounding error of a force, relative to the forces of its contact.
const FORCE_ROUNDING: f64 = 1e-12;

/// A tangential force whose effect on its own slip is below this fraction has no independent effect. The effect
/// includes the reactions of other contacts.
const MAX_INDEPENDENT_FRACTION: f64 = 1e-8;

/// Rounding error of the acceleration of a slip, relative to its terms.
const ACCELERATION_ROUNDING: f64 = 1e-11;

/// While other contacts stick, a slip below this multiple of its rounding error counts as zero.
const NEAR_ROUNDINGS: f64 = 1e3;

impl Contacts {
    /// Changes the modes of the closed contacts if one of their guards at `point` is negative. Contacts that no longer
    /// push open, sliding ends at zero slip, and sticking ends at the limit of friction. The rounding errors at
    /// `located` set the tolerance within which contacts open.
    ///
    /// # Errors
    /// No forces satisfy the law of friction.
    pub(in super::super) fn change_friction_modes(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        located: Point<'_>,
    ) -> Result<(), (usize, ContactFailure)> {
        let places = self.list_resting();
        let forces = self.compute_friction_forces();
        let has_left = self.free_left_slips(&forces);
        let mut modes: Vec<ContactMode> =
            self.closed.iter().map(|place| self.mode(*place)).collect();
        let mut excluded = Vec::new();
        for (index, place) in self.closed.iter().enumerate() {
            let is_pulling = forces.normal[index] + self.allowances[*place] < 0.0;
            let tangent = self.tangent(*place);
            let has_ended =
                tangent.is_some_and(|own| self.compute_friction_guard(own, index, &forces) < 0.0);
            if is_pulling || has_ended {
                excluded.push((index, modes[index]));
            }
        }
        // The forces may have grown beyond all bounds before the guards became NaN.
        let is_finite = forces.normal.iter().all(|force| force.is_finite());
        if excluded.is_empty() && is_finite && !has_left {
            return Ok(());
        }
        modes.resize(places.len(), ContactMode::Open);
        let roundings = self.compute_slip_roundings(own, point);
        let slipping = self.list_slip_directions(&roundings, &excluded);
        let accelerations = self.compute_free_accelerations(&places);
        let problem = self.problem(&places, slipping, &accelerations);
        let decided = problem.decide(Some(&modes), &excluded);
        let decided = decided.or_else(|| problem.decide(Some(&modes), &[]));
        let decision = decided.ok_or((places[0], ContactFailure::NoForces))?;
        self.note_choice(point.t, (&places, &decision));
        self.enter_modes(own, (&places, &decision), &roundings, (point, located));
        Ok(())
    }

    /// Keeps the modes of closed contacts at a point if forces in these modes satisfy the law of friction. Otherwise
    /// changes the modes, because other forces may have changed.
    ///
    /// # Errors
    /// No forces satisfy the law of friction.
    pub(in super::super) fn revise_friction_modes(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
    ) -> Result<(), (usize, ContactFailure)> {
        let roundings = self.compute_slip_roundings(own, point);
        let places = self.closed.clone();
        let modes: Vec<ContactMode> = places.iter().map(|place| self.mode(*place)).collect();
        let slipping = self.list_slip_directions(&roundings, &[]);
        let problem = self.problem(&places, slipping, &self.compute_free_accelerations(&places));
        let decided = problem.decide(Some(&modes), &[]);
        let decision = decided.ok_or((places[0], ContactFailure::NoForces))?;
        if decision.modes != modes {
            self.note_choice(point.t, (&places, &decision));
            self.enter_modes(own, (&places, &decision), &roundings, (point, point));
            return Ok(());
        }
        let bears = |contacts: &Self| -> Vec<bool> {
            contacts.tangents.iter().map(|own| own.bears).collect()
        };
        let (before, forces) = (bears(self), self.compute_friction_forces());
        self.mark_bearing(&roundings);
        let changed = before.iter().zip(bears(self)).map(|(a, b)| *a != b);
        let changed: Vec<bool> = changed.collect();
        for (index, place) in places.iter().enumerate() {
            if self.tangent_index(*place).is_some_and(|own| changed[own]) {
                self.reset_offsets(*place, index, &forces, &roundings);
            }
        }
        Ok(())
    }

    /// Returns the known directions of slip; `None` for contacts that do not slip.
    fn list_slip_directions(
        &self,
        roundings: &[f64],
        ended: &[(usize, ContactMode)],
    ) -> impl Fn(usize) -> Option<f64> + use<> {
        let ended: Vec<usize> = ended.iter().map(|(index, _)| self.closed[*index]).collect();
        let known = self
            .tangents
            .iter()
            .zip(roundings)
            .map(|(tangent, rounding)| {
                let slip = self.slip(tangent.place);
                let is_at_rest = match tangent.mode {
                    _ if tangent.bears => true,
                    ContactMode::Slides(_) if self.closed.contains(&tangent.place) => {
                        let within = rounding.max(tangent.slip_offset);
                        slip.abs() <= within || ended.contains(&tangent.place)
                    }
                    ContactMode::Sticks if self.closed.contains(&tangent.place) => true,
                    _ => slip.abs() <= *rounding,
                };
                (tangent.place, (!is_at_rest).then(|| slip.signum()))
            });
        let known: Vec<(usize, Option<f64>)> = known.collect();
        move |place| {
            let found = known.iter().find(|(own, _)| *own == place);
            found.and_then(|(_, direction)| *direction)
        }
    }

    /// Determines the modes of contacts at rest in their normal directions, including the directions of zero slips.
    ///
    /// # Errors
    /// No forces satisfy the law of friction.
    pub(in super::super) fn decide_resting(
        &self,
        places: &[usize],
        (smallest, roundings): (&[f64], &[f64]),
    ) -> Result<ContactDecision, (usize, ContactFailure)> {
        let is_zero = |place: usize, slip: f64| {
            let index = self.tangent_index(place);
            index.is_none_or(|index| slip.abs() <= roundings[index].max(smallest[place]))
        };
        let modes: Vec<ContactMode> = places
            .iter()
            .map(|place| match is_zero(*place, self.slip(*place)) {
                true => ContactMode::Sticks,
                false => ContactMode::Slides(0.0),
            })
            .collect();
        // Flights too short to resolve leave small rates, which would make a rocking body slip.
        let stopped = self.compute_stopped_slips(places, &modes);
        let slips: Vec<(usize, f64)> = places.iter().copied().zip(stopped).collect();
        let direction = |place: usize| {
            let slip = slips.iter().find(|(own, _)| *own == place)?.1;
            (!is_zero(place, slip)).then(|| slip.signum())
        };
        let accelerations = self.compute_free_accelerations(places);
        let problem = self.problem(places, direction, &accelerations);
        let decided = problem.decide(None, &[]);
        decided.ok_or((
            places.first().copied().unwrap_or(0),
            ContactFailure::NoForces,
        ))
    }

    /// Enters the modes decided at `point`. Contacts that do not push open.
    pub(in super::super) fn enter_modes(
        &mut self,
        own: &mut Evaluator,
        (places, decision): (&[usize], &ContactDecision),
        roundings: &[f64],
        (point, located): (Point<'_>, Point<'_>),
    ) {
        self.closed.clear();
        let mut opened = Vec::new();
        for (place, mode) in places.iter().zip(&decision.modes) {
            match mode {
                ContactMode::Open => opened.push(*place),
                _ => self.closed.push(*place),
            }
            if let Some(index) = self.tangent_index(*place) {
                self.tangents[index].mode = *mode;
            }
        }
        for place in &self.closed {
            self.allowances[*place] = 0.0;
        }
        self.note_redundant(own, point, places);
        self.offset_by_rounding(&opened, (located.t, located.state));
        let forces = self.compute_friction_forces();
        self.mark_bearing(roundings);
        for index in 0..self.closed.len() {
            let place = self.closed[index];
            self.allowances[place] = self.allowances[place].max(-2.0 * forces.normal[index]);
            self.reset_offsets(place, index, &forces, roundings);
        }
    }

    /// Releases the slips of contacts that other contacts no longer keep at zero. Returns true if there are any.
    fn free_left_slips(&mut self, forces: &ContactForces) -> bool {
        let has_left = |tangent: &Tangent| {
            let closed = self.closed.iter().position(|place| *place == tangent.place);
            let guard = closed.map(|index| self.compute_friction_guard(tangent, index, forces));
            tangent.bears && guard.is_some_and(|guard| guard < 0.0)
        };
        let left: Vec<bool> = self.tangents.iter().map(has_left).collect();
        for (tangent, has_left) in self.tangents.iter_mut().zip(&left) {
            tangent.bears &= !has_left;
        }
        left.contains(&true)
    }

    /// Marks contacts at the limit of friction whose slip other contacts keep at zero: a box on two edges, or the floor
    /// under a body at a wall. Their slip depends on the directions in which the other contacts do not move.
    fn mark_bearing(&mut self, roundings: &[f64]) {
        for tangent in &mut self.tangents {
            tangent.bears = false;
        }
        let count = self.closed.len();
        let sticks = |index: &usize| self.mode(self.closed[*index]) == ContactMode::Sticks;
        let sticking = (0..count).filter(sticks).map(|index| count + index);
        let kept: Vec<usize> = (0..count).chain(sticking).collect();
        let delassus = self.compute_full_delassus(&self.closed);
        let forces = self.compute_friction_forces();
        let rows: Vec<Vec<f64>> = delassus
            .chunks_exact((2 * count).max(1))
            .map(<[f64]>::to_vec)
            .collect();
        for index in 0..count {
            let Some(tangent) = self.tangent_index(self.closed[index]) else {
                continue;
            };
            let slides = matches!(self.tangents[tangent].mode, ContactMode::Slides(_));
            let slip = self.slip(self.closed[index]);
            if !slides || slip.abs() > NEAR_ROUNDINGS * roundings[tangent] {
                continue;
            }
            let (acceleration, size) = self.compute_slip_acceleration(index, &forces);
            if acceleration.abs() > ACCELERATION_ROUNDING * size {
                continue;
            }
            let row = &rows[count + index];
            let column: Vec<f64> = rows.iter().map(|row| row[count + index]).collect();
            let balanced = solve_rows(&rows, &column, &kept);
            let terms = kept.iter().zip(&balanced);
            let through: f64 = terms.map(|(direction, part)| row[*direction] * part).sum();
            let own = row[count + index];
            self.tangents[tangent].bears = own + through <= MAX_INDEPENDENT_FRACTION * own;
        }
    }

    /// Sets the offsets of a closed contact so that its friction guard starts above zero.
    pub(in super::super) fn reset_offsets(
        &mut self,
        place: usize,
        index: usize,
        forces: &ContactForces,
        roundings: &[f64],
    ) {
        let Some(tangent) = self.tangent_index(place) else {
            return;
        };
        let slip = self.slip(place);
        let mu = self
            .friction_values(place)
            .map_or(0.0, |one| one.coefficient);
        let size = mu * forces.normal[index].abs() + forces.tangential[index].abs();
        let margin = mu * forces.normal[index] - forces.tangential[index].abs();
        let own = &mut self.tangents[tangent];
        own.slip_offset = match own.mode {
            ContactMode::Slides(side) => roundings[tangent].max(-2.0 * side * slip),
            _ => 0.0,
        };
        own.force_allowance = (FORCE_ROUNDING * size).max(-2.0 * margin);
    }
}
