//! Impacts and contacts along a motion: closed contacts, jumps of rates at impacts, and contact
//! forces. `complementarity` solves for forces that push and do not pull.
//!
//! If a distance falls to zero, the impulses of all touching contacts satisfy Newton's law in
//! Moreau's form (B. Brogliato, *Nonsmooth Mechanics*, chapter 5): no impulse is negative, no rate
//! g' after the impact is below -e g' before it, and an impulse is nonzero only if these are
//! equal. A bouncing body has infinitely many impacts in a finite time, so a contact closes if the
//! next flight would be shorter than a fraction of the elapsed time. A closed contact opens if its
//! force falls to zero. `friction` adds Coulomb friction.

mod complementarity;
mod correction;
mod drift;
mod drift_correction;
mod friction;
mod impulses;
mod jump;
mod power;
mod redundant;
mod released;
mod sequence;
mod start;
mod tangents;

use std::collections::VecDeque;

use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, ImpactValues, Point, Stretch};
use eomgen_model_spec::interval::Interval;

use eomgen_sim::contact_friction::{ContactDecision, ContactMode};
use eomgen_sim::ode::{Surface, SurfaceKind, SurfaceMode, UNMOVED_SIZE_FRACTION};

use crate::motion::FrictionChoice;

pub(crate) use complementarity::{solve_complementarity, solve_rows};
use drift::Drift;
pub(crate) use drift::HeldDirection;
pub(crate) use friction::{
    build_contact_problem, collect_rates_and_slips, compute_free_accelerations,
};
pub(crate) use start::Start;
use tangents::{ContactForces, Tangent};

/// Largest distance that counts as zero, relative to its terms.
const ROUNDING: f64 = 1e-11;

/// Rounding error of a distance, relative to its terms and to their changes since t = 0.
const DISTANCE_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Number of consecutive impacts, each faster than the shortest flight, that count as an infinite sequence.
const MAX_CONSECUTIVE_IMPACTS: usize = 256;

/// Number of corrections of a state with closed contacts; each squares the residual.
const CORRECTIONS: usize = 2;

/// Contacts of a model along a motion.
pub(crate) struct Contacts {
    /// Names of the impacts.
    pub names: Vec<String>,
    /// Time at which the motion began, s.
    start: Option<f64>,
    /// Time at which each contact last touched at rest, or at which the motion began, s.
    open_since: Vec<f64>,
    /// Indices of the closed contacts.
    closed: Vec<usize>,
    /// Indices of the redundant contacts: open contacts that touch at rest because the closed ones determine their
    /// distances.
    redundant: Vec<usize>,
    /// Redundant contacts before the last correction of a state.
    uncorrected_redundant: Vec<usize>,
    /// Offset added to each distance, so that a distance that starts at zero is positive.
    offsets: Vec<f64>,
    /// Offsets before the last correction of a state.
    uncorrected_offsets: Vec<f64>,
    /// Drifts of each distance by rounding errors of rates that surfaces hold.
    drifts: Vec<Vec<Drift>>,
    /// Allowance added to the force of each closed contact, so that rounding of accelerations does not count as a pull.
    allowances: Vec<f64>,
    /// Impacts at the point of the last evaluation.
    at: Vec<ImpactValues>,
    /// Typical sizes of coordinates, used until they move.
    unmoved_sizes: Vec<f64>,
    /// Typical sizes of rates, used until they move.
    unmoved_rates: Vec<f64>,
    /// Largest magnitude of the terms of each distance so far.
    sizes: Vec<f64>,
    /// Times (s) and contacts of the last impacts.
    recent: VecDeque<(f64, Vec<usize>)>,
    /// False for an impact that ends an infinite sequence.
    has_restitution: bool,
    /// Work of contacts in the last impact, J.
    impact_work: f64,
    /// Impact at which the motion ended, and the reason.
    failure: Option<(usize, ContactFailure)>,
    /// Tangential motion of the contacts with friction.
    tangents: Vec<Tangent>,
    /// Times at which friction admits several motions.
    choices: Vec<FrictionChoice>,
    /// True if no contact forces were found between steps, so that the rates are undefined.
    has_no_forces: bool,
}

/// Reason why the motion ended at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ContactFailure {
    /// A step ended with a distance below zero.
    Penetrated,
    /// No impulses keep all touching bodies apart.
    NoImpulse,
    /// No forces satisfy the law of friction (Painlevé paradox).
    NoForces,
    /// No consistent modes of contacts and of dry friction were found.
    NoModes,
}

impl Contacts {
    /// Creates open contacts. `values` and `rates` are typical sizes of the coordinates and of their rates.
    pub fn new(names: Vec<String>, [values, rates]: [&[f64]; 2]) -> Self {
        let count = names.len();
        let unmoved = |sizes: &[f64]| -> Vec<f64> {
            let sizes = sizes.iter();
            sizes.map(|size| UNMOVED_SIZE_FRACTION * size).collect()
        };
        Self {
            names,
            unmoved_sizes: unmoved(values),
            unmoved_rates: unmoved(rates),
            sizes: vec![0.0; count],
            start: None,
            open_since: vec![0.0; count],
            closed: Vec::new(),
            redundant: Vec::new(),
            uncorrected_redundant: Vec::new(),
            offsets: vec![0.0; count],
            uncorrected_offsets: vec![0.0; count],
            drifts: vec![Vec::new(); count],
            allowances: vec![0.0; count],
            at: Vec::new(),
            recent: VecDeque::with_capacity(MAX_CONSECUTIVE_IMPACTS),
            has_restitution: true,
            impact_work: 0.0,
            failure: None,
            tangents: Vec::new(),
            choices: Vec::new(),
            has_no_forces: false,
        }
    }

    /// Adds friction to the contacts with the given indices.
    pub fn with_friction(mut self, places: impl Iterator<Item = usize>) -> Self {
        self.tangents = places.map(Tangent::new).collect();
        self
    }

    /// Returns the surface of each guard: the distances, then the slips of the contacts with friction.
    pub fn surfaces(&self) -> Vec<Surface> {
        let distances = self.names.iter().map(|name| Surface {
            formula: name.clone(),
            kind: SurfaceKind::Distance,
        });
        let slips = self.tangents.iter().map(|tangent| Surface {
            formula: format!("slip of {}", self.names[tangent.place]),
            kind: SurfaceKind::HeldSpeed,
        });
        distances.chain(slips).collect()
    }

    /// Returns the times at which friction admits several motions.
    pub fn choices(&self) -> &[FrictionChoice] {
        &self.choices
    }

    /// Records a decision at a time (s) if it admits several motions.
    fn note_choice(&mut self, t: f64, (places, decision): (&[usize], &ContactDecision)) {
        if decision.others > 0 {
            let names = places.iter().map(|place| self.names[*place].clone());
            self.choices.push(FrictionChoice {
                t,
                impacts: names.collect(),
                motions: decision.others + 1,
            });
        }
    }

    /// Returns the number of guards.
    pub fn guard_count(&self) -> usize {
        self.names.len() + self.tangents.len()
    }

    /// Returns the closed contacts.
    pub fn closed(&self) -> &[usize] {
        &self.closed
    }

    /// Sets the contacts that are closed at the start from the modes of all guards.
    pub fn assume_modes(&mut self, modes: &[SurfaceMode]) {
        let closed = |place: &usize| modes[*place] == SurfaceMode::Closed;
        self.closed = (0..self.names.len()).filter(closed).collect();
    }

    /// Writes the guards, positive while the contacts keep their state: distances of open contacts,
    /// forces of closed ones, then the guards of friction. The first call starts the motion.
    pub fn write_guards(&mut self, own: &mut Evaluator, point: Point<'_>, out: &mut [f64]) {
        if self.start.is_none() {
            self.start_motion(own, point);
        }
        if self.closed.is_empty() {
            own.distances(point, out);
        } else {
            own.impacts(point, &mut self.at);
            for (slot, impact) in out.iter_mut().zip(&self.at) {
                *slot = impact.distance;
            }
        }
        for (place, slot) in out[..self.names.len()].iter_mut().enumerate() {
            *slot += self.offset(place, point.t);
        }
        let forces = self.compute_forces();
        for (place, force) in self.closed.iter().zip(&forces.normal) {
            out[*place] = force + self.allowances[*place];
        }
        for place in &self.redundant {
            out[*place] = 1.0;
        }
        self.write_friction_guards(&forces, &mut out[self.names.len()..]);
    }

    /// Writes the bounds of the guards; those of closed contacts are unknown.
    pub fn bound_guards(&self, own: &mut Evaluator, stretch: &Stretch<'_>, out: &mut [Enclosure]) {
        own.bound_distances(stretch, out);
        let Interval { low, high } = stretch.t.value();
        for (place, slot) in out[..self.names.len()].iter_mut().enumerate() {
            *slot = slot.add_enclosure(self.bound_offset(place, low, high));
        }
        for place in &self.closed {
            out[*place] = Enclosure::UNKNOWN;
        }
        for place in &self.redundant {
            out[*place] = Enclosure::constant(1.0);
        }
        let slips = &mut out[self.names.len()..];
        for (slot, tangent) in slips.iter_mut().zip(&self.tangents) {
            *slot = match self.closed.contains(&tangent.place) {
                true => Enclosure::UNKNOWN,
                false => Enclosure::constant(1.0),
            };
        }
    }

    /// Adds the accelerations due to the forces of closed contacts.
    pub fn add_to_rates(&mut self, own: &mut Evaluator, point: Point<'_>, rates: &mut [f64]) {
        if self.has_no_forces {
            return rates.fill(f64::NAN);
        }
        if self.closed.is_empty() {
            return;
        }
        own.impacts(point, &mut self.at);
        let forces = self.compute_forces();
        let degrees = own.program().degrees_of_freedom();
        self.add_forces(&self.closed, &forces, &mut rates[degrees..]);
    }

    /// Adds the rounding errors of the accelerations due to the forces of closed contacts.
    pub fn add_rate_roundings(&self, accelerations: &mut [f64]) {
        let forces = self.compute_forces();
        let normal = self.closed.iter().zip(&forces.normal);
        let normal = normal.map(|(place, force)| (&self.at[*place].column, force));
        let tangential = self.closed.iter().zip(&forces.tangential);
        let tangential = tangential.filter_map(|(place, force)| {
            let friction = self.friction_values(*place)?;
            Some((&friction.column, force))
        });
        for (column, force) in normal.chain(tangential) {
            for (slot, entry) in accelerations.iter_mut().zip(column) {
                *slot += f64::EPSILON * (entry * force).abs();
            }
        }
    }

    /// Returns cause and remedy if the motion stopped because bodies overlap at an impact.
    pub fn failure_message(&self) -> Option<String> {
        let (place, cause) = self.failure?;
        let name = &self.names[place];
        Some(match cause {
            ContactFailure::Penetrated => format!(
                "bodies overlap at the impact `{name}`: they are pressed into each other, or infinitely many impacts \
                 follow each other. Check constraints and prescribed motions at this contact, or use a stiff spring \
                 instead of the impact"
            ),
            ContactFailure::NoImpulse => format!(
                "no impulses separate the bodies at the impact `{name}`: other impacts, constraints or \
                 prescribed motions press them together. Replace one of these impacts or constraints by a stiff spring"
            ),
            ContactFailure::NoModes => format!(
                "no state of sticking or sliding was found that satisfies both the contact friction at the impact \
                 `{name}` and the dry friction written with sign. Write one of these friction laws as a smooth \
                 function, such as tanh(v/v_0) with a small speed v_0"
            ),
            ContactFailure::NoForces => format!(
                "no contact forces satisfy the law of friction at the impact `{name}`: friction presses the sliding \
                 bodies together faster than the contact can separate them (Painlevé's paradox). Lower the friction, \
                 or use a stiff spring and a friction force instead of the impact"
            ),
        })
    }

    /// Closes the contacts at rest that push. The impacts are evaluated at `point`. The rounding errors at `located`
    /// set the tolerance within which contacts open.
    fn close(
        &mut self,
        own: &mut Evaluator,
        touching: &[usize],
        (point, located): (Point<'_>, Point<'_>),
    ) {
        let accelerations: Vec<f64> = touching.iter().map(|i| self.at[*i].acceleration).collect();
        let forces = solve_complementarity(&self.compute_delassus(touching), &accelerations);
        let pushing = touching
            .iter()
            .zip(forces)
            .filter(|(_, force)| *force > 0.0);
        self.closed = pushing.map(|(place, _)| *place).collect();
        for place in &self.closed {
            self.allowances[*place] = 0.0;
        }
        self.note_redundant(own, point, touching);
        // The contacts separate without speed: at first rounding of the state moves them more.
        self.offset_by_rounding(touching, (located.t, located.state));
    }

    /// Offsets the distances of touching contacts so that they start above zero.
    fn offset_distances(&mut self, touching: &[usize]) {
        for place in touching {
            let distance = self.at[*place].distance;
            self.offsets[*place] = f64::MIN_POSITIVE.max(-2.0 * distance);
        }
    }

    /// Offsets the distances of touching contacts so that they start above zero by the rounding error of a state.
    fn offset_by_rounding(&mut self, touching: &[usize], at: (f64, &[f64])) {
        self.offset_distances(touching);
        for place in touching {
            self.offsets[*place] =
                self.offsets[*place].max(self.compute_distance_rounding(*place, at));
        }
    }

    /// Offsets the distances of open contacts that touch after an impact. They stay positive if a projection moves the
    /// state by rounding.
    pub fn offset_for_projection(&mut self, at: (f64, &[f64])) {
        for place in 0..self.names.len() {
            let rounding = self.compute_distance_rounding(place, at);
            let touches =
                (0.0..rounding).contains(&(self.at[place].distance + self.offsets[place]));
            if touches && !self.closed.contains(&place) {
                self.offsets[place] += rounding;
            }
        }
    }

    /// Returns the magnitude of the terms of a distance at the given coordinates.
    fn compute_distance_size(&self, place: usize, coordinates: &[f64]) -> f64 {
        let sizes = coordinates.iter().zip(&self.unmoved_sizes);
        let sizes = sizes.map(|(coordinate, unmoved)| coordinate.abs().max(*unmoved));
        let row = self.at[place].row.iter();
        row.zip(sizes).map(|(entry, size)| entry.abs() * size).sum()
    }

    /// Returns the magnitude of the terms of the rate of a distance.
    fn compute_rate_size(&self, place: usize, rates: &[f64]) -> f64 {
        let terms = self.at[place].row.iter().zip(rates);
        terms.map(|(entry, rate)| (entry * rate).abs()).sum()
    }

    /// Returns the rounding error of a distance due to rounding of state and time.
    fn compute_distance_rounding(&self, place: usize, (t, state): (f64, &[f64])) -> f64 {
        let degrees = self.at[place].row.len();
        let rates = &state[degrees..2 * degrees];
        self.compute_position_rounding(place, state)
            + DISTANCE_ROUNDING * t.abs() * self.compute_rate_size(place, rates)
    }

    /// Returns the rounding error of a distance due to rounding of the coordinates.
    fn compute_position_rounding(&self, place: usize, state: &[f64]) -> f64 {
        let degrees = self.at[place].row.len();
        f64::MIN_POSITIVE + DISTANCE_ROUNDING * self.compute_distance_size(place, &state[..degrees])
    }

    /// Notes the magnitudes of the terms of the distances at a state.
    fn note_sizes(&mut self, state: &[f64]) {
        for place in 0..self.sizes.len() {
            let degrees = self.at[place].row.len();
            let size = self.compute_distance_size(place, &state[..degrees]);
            self.sizes[place] = self.sizes[place].max(size);
        }
    }

    /// Returns the magnitudes of the rates of a state, at least the typical sizes of rates that have not moved.
    fn compute_rate_magnitudes(&self, own: &Evaluator, state: &[f64]) -> Vec<f64> {
        let degrees = own.program().degrees_of_freedom();
        let rates = state[degrees..2 * degrees].iter().zip(&self.unmoved_rates);
        rates
            .map(|(rate, unmoved)| rate.abs().max(*unmoved))
            .collect()
    }

    /// Closes the contacts that touch at rest at the start, or that are assumed to be closed, if they push.
    fn start_motion(&mut self, own: &mut Evaluator, point: Point<'_>) {
        self.start = Some(point.t);
        self.open_since.fill(point.t);
        own.impacts(point, &mut self.at);
        self.note_sizes(point.state);
        let small = self.compute_rate_roundings(own, point.state);
        let touches = |place: &usize| self.at[*place].distance <= ROUNDING * self.sizes[*place];
        let touching: Vec<usize> = (0..self.at.len())
            .filter(|place| touches(place) || self.closed.contains(place))
            .collect();
        let is_still = |place: &usize| self.at[*place].rate.abs() <= small[*place];
        let still = touching.iter().copied();
        let still: Vec<usize> = still
            .filter(|place| is_still(place) || self.closed.contains(place))
            .collect();
        self.offset_distances(&touching);
        self.close_still(own, point, (&still, &small));
    }

    /// Records that the motion ends if there are no contact forces.
    fn note_forces(&mut self, found: Result<(), (usize, ContactFailure)>) {
        if let Err(cause) = found {
            self.failure = Some(cause);
            self.has_no_forces = true;
        }
    }

    /// Updates the modes of closed contacts at a point between steps, where inputs may jump.
    pub fn update_modes(&mut self, own: &mut Evaluator, point: Point<'_>) {
        let updated = self.change_modes(own, point, point);
        self.note_forces(updated);
    }

    /// Keeps or changes the modes of contact friction at a point at which other forces have changed.
    pub fn revise_modes(&mut self, own: &mut Evaluator, point: Point<'_>) {
        if self.has_friction() && !self.closed.is_empty() {
            let revised = self.revise_friction_modes(own, point);
            self.note_forces(revised);
        }
    }

    /// Ends the motion because the modes of contacts contradict those of dry friction.
    pub fn stop_at_contradiction(&mut self) {
        let first = self.closed.first().copied().unwrap_or(0);
        self.note_forces(Err((first, ContactFailure::NoModes)));
    }

    /// Opens closed contacts that no longer push, and changes the modes of friction. The rounding errors at `located`
    /// set the tolerance within which contacts open.
    ///
    /// # Errors
    /// No forces satisfy the law of friction.
    fn change_modes(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        located: Point<'_>,
    ) -> Result<(), (usize, ContactFailure)> {
        if self.closed.is_empty() {
            return Ok(());
        }
        self.note_closed_until(point.t);
        own.impacts(point, &mut self.at);
        if self.has_friction() {
            return self.change_friction_modes(own, point, located);
        }
        let pulls = |(place, force): (&usize, &f64)| force + self.allowances[*place] < 0.0;
        if self
            .closed
            .iter()
            .zip(&self.compute_forces().normal)
            .any(pulls)
        {
            let resting = self.list_resting();
            self.close(own, &resting, (point, located));
        }
        Ok(())
    }

    /// Records that the contacts at rest touch until the time `t` (s).
    fn note_closed_until(&mut self, t: f64) {
        for place in self.list_resting() {
            self.open_since[place] = t;
        }
    }

    /// Writes the modes of closed contacts and of friction.
    pub fn write_modes(&self, modes: &mut [SurfaceMode]) {
        for place in &self.closed {
            modes[*place] = SurfaceMode::Closed;
        }
        let slips = &mut modes[self.names.len()..];
        for (slot, tangent) in slips.iter_mut().zip(&self.tangents) {
            *slot = match tangent.mode {
                _ if !self.closed.contains(&tangent.place) => SurfaceMode::Open,
                ContactMode::Open => SurfaceMode::Open,
                ContactMode::Sticks => SurfaceMode::Held,
                ContactMode::Slides(_) if tangent.bears => SurfaceMode::Held,
                ContactMode::Slides(side) => SurfaceMode::from_side(side),
            };
        }
    }

    /// Returns the forces of the closed contacts for which their distances do not accelerate.
    fn compute_forces(&self) -> ContactForces {
        match self.has_friction() {
            true => self.compute_friction_forces(),
            false => ContactForces {
                normal: self.solve_balance(&self.closed, |impact| impact.acceleration),
                tangential: Vec::new(),
            },
        }
    }

    /// Returns the impulses that stop the closed contacts.
    fn solve_normal_stopping_impulses(&self) -> ContactForces {
        match self.has_friction() {
            true => self.compute_stopping_impulses(),
            false => ContactForces {
                normal: self.solve_balance(&self.closed, |impact| impact.rate),
                tangential: Vec::new(),
            },
        }
    }

    /// Adds the effects of normal and tangential impulses at `places` to the rates.
    fn add_forces(&self, places: &[usize], impulses: &ContactForces, rates: &mut [f64]) {
        self.add_impulses(places, &impulses.normal, rates);
        for (place, impulse) in places.iter().zip(&impulses.tangential) {
            let column = self.at[*place].friction.iter().flat_map(|one| &one.column);
            for (rate, entry) in rates.iter_mut().zip(column) {
                *rate += entry * impulse;
            }
        }
    }

    /// Returns the impulses at `places` that reduce a quantity of these contacts to zero.
    fn solve_balance(&self, places: &[usize], quantity: impl Fn(&ImpactValues) -> f64) -> Vec<f64> {
        let quantities: Vec<f64> = places
            .iter()
            .map(|place| quantity(&self.at[*place]))
            .collect();
        let rows: Vec<usize> = (0..places.len()).collect();
        solve_rows(&self.compute_delassus(places), &quantities, &rows)
    }

    /// Adds the effects of impulses at `places` to the rates.
    fn add_impulses(&self, places: &[usize], impulses: &[f64], rates: &mut [f64]) {
        for (place, impulse) in places.iter().zip(impulses) {
            for (rate, entry) in rates.iter_mut().zip(&self.at[*place].column) {
                *rate += entry * impulse;
            }
        }
    }

    /// Returns the magnitude of the terms with which impulses at other contacts change the rate of a distance.
    fn compute_push_size(&self, place: usize, others: &[usize], impulses: &ContactForces) -> f64 {
        let pushes = others.iter().zip(&impulses.normal);
        let pushes = pushes.map(|(other, impulse)| (&self.at[*other].column, impulse));
        let along = others.iter().zip(&impulses.tangential);
        let along = along.filter_map(|(other, impulse)| {
            let friction = self.at[*other].friction.as_ref()?;
            Some((&friction.column, impulse))
        });
        let all = pushes.chain(along);
        all.map(|(column, impulse)| impulse.abs() * self.compute_rate_size(place, column))
            .sum()
    }

    /// Returns the Delassus matrix of some contacts.
    fn compute_delassus(&self, places: &[usize]) -> Vec<Vec<f64>> {
        let row = |place: &usize| {
            let entries = &self.at[*place].delassus;
            places.iter().map(|other| entries[*other]).collect()
        };
        places.iter().map(row).collect()
    }
}
