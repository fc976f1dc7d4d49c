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
mod friction;
mod impulses;
mod power;
mod start;
mod tangents;

use std::collections::VecDeque;

use eomgen_codegen::independence::vectors::max_magnitude;
use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, ImpactValues, Point, Stretch};

use eomgen_sim::contact_friction::ContactMode;
use eomgen_sim::ode::{Surface, SurfaceKind, SurfaceMode};

pub(crate) use complementarity::{solve_complementarity, solve_rows};
pub(crate) use start::Start;
use tangents::{ContactForces, Tangent};

/// A distance this small beside the largest coordinate is rounding.
const ROUNDING: f64 = 1e-11;

/// Rounding of a distance, beside the largest coordinate and how far that has come.
const DISTANCE_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Number of impacts that have no end, if the time between them is below that of the shortest flights.
const MAX_CONSECUTIVE_IMPACTS: usize = 256;

/// Corrections of a state with closed contacts; each squares the residual.
const CORRECTIONS: usize = 2;

/// Contacts of a model along a motion.
pub(crate) struct Contacts {
    /// Names of the impacts.
    pub names: Vec<String>,
    /// When the motion began, s.
    start: Option<f64>,
    /// Those that are closed.
    closed: Vec<usize>,
    /// What is added to each distance, so that one that leaves from zero is positive.
    offsets: Vec<f64>,
    /// What is added to the force of each that is closed: rounding of accelerations makes no pull.
    allowances: Vec<f64>,
    /// The impacts where they were last looked at.
    at: Vec<ImpactValues>,
    /// The largest that any coordinate has been.
    size: f64,
    /// When the last impacts were, s.
    recent: VecDeque<(f64, Vec<usize>)>,
    /// False for an impact that ends infinitely many.
    has_restitution: bool,
    /// The work of contacts that move in the last impact, J.
    impact_work: f64,
    /// The impact at which the motion ended, and why.
    overlap: Option<(usize, Overlap)>,
    /// Tangential motion of the contacts with friction.
    tangents: Vec<Tangent>,
    /// True if no contact forces were found between steps, so that the rates have no value.
    has_no_forces: bool,
}

/// Why bodies overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Overlap {
    /// A step ended with a distance below zero.
    Penetrated,
    /// No impulses keep all bodies apart that touch.
    NoImpulse,
    /// No forces satisfy the law of friction (P. Painlevé).
    NoForces,
}

impl Contacts {
    pub fn new(names: Vec<String>) -> Self {
        let count = names.len();
        Self {
            names,
            start: None,
            closed: Vec::new(),
            offsets: vec![0.0; count],
            allowances: vec![0.0; count],
            at: Vec::new(),
            size: 0.0,
            recent: VecDeque::with_capacity(MAX_CONSECUTIVE_IMPACTS),
            has_restitution: true,
            impact_work: 0.0,
            overlap: None,
            tangents: Vec::new(),
            has_no_forces: false,
        }
    }

    /// Adds friction to the contacts at these places.
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
            kind: SurfaceKind::Speed,
        });
        distances.chain(slips).collect()
    }

    /// Returns the number of guards.
    pub fn guard_count(&self) -> usize {
        self.names.len() + self.tangents.len()
    }

    /// Returns the closed contacts.
    pub fn closed(&self) -> &[usize] {
        &self.closed
    }

    /// Sets the contacts that are closed at the start, given the modes of all guards.
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
        for (slot, offset) in out.iter_mut().zip(&self.offsets) {
            *slot += offset;
        }
        let forces = self.forces();
        for (place, force) in self.closed.iter().zip(&forces.normal) {
            out[*place] = force + self.allowances[*place];
        }
        self.write_friction_guards(&forces, &mut out[self.names.len()..]);
    }

    /// Writes the bounds of the guards; those of closed contacts are unknown.
    pub fn bound_guards(&self, own: &mut Evaluator, stretch: &Stretch<'_>, out: &mut [Enclosure]) {
        own.bound_distances(stretch, out);
        for (slot, offset) in out.iter_mut().zip(&self.offsets) {
            *slot = slot.add_enclosure(Enclosure::constant(*offset));
        }
        for place in &self.closed {
            out[*place] = Enclosure::UNKNOWN;
        }
        let slips = &mut out[self.names.len()..];
        for (slot, tangent) in slips.iter_mut().zip(&self.tangents) {
            *slot = match self.closed.contains(&tangent.place) {
                true => Enclosure::UNKNOWN,
                false => Enclosure::constant(1.0),
            };
        }
    }

    /// Adds the accelerations by the forces of closed contacts.
    pub fn add_to_rates(&mut self, own: &mut Evaluator, point: Point<'_>, rates: &mut [f64]) {
        if self.has_no_forces {
            return rates.fill(f64::NAN);
        }
        if self.closed.is_empty() {
            return;
        }
        own.impacts(point, &mut self.at);
        let forces = self.forces();
        let degrees = own.program().degrees_of_freedom();
        self.add_forces(&self.closed, &forces, &mut rates[degrees..]);
    }

    /// Adds the roundings of the accelerations by the forces of closed contacts.
    pub fn add_rate_roundings(&self, accelerations: &mut [f64]) {
        let normal = self.forces().normal;
        for (place, force) in self.closed.iter().zip(normal) {
            for (slot, entry) in accelerations.iter_mut().zip(&self.at[*place].column) {
                *slot += f64::EPSILON * (entry * force).abs();
            }
        }
    }

    /// Returns cause and cure if the motion stopped because bodies overlap at an impact.
    pub fn overlap(&self) -> Option<String> {
        let (place, cause) = self.overlap?;
        let name = &self.names[place];
        Some(match cause {
            Overlap::Penetrated => format!(
                "bodies overlap at the impact `{name}`: they are forced into each other, or impacts \
                 follow each other without end. Check constraints and prescribed motions at this \
                 contact, or use a stiff spring instead of the impact"
            ),
            Overlap::NoImpulse => format!(
                "no impulses separate the bodies at the impact `{name}`, because of other impacts or \
                 constraints. Use a stiff spring instead of one of them"
            ),
            Overlap::NoForces => format!(
                "no contact forces satisfy the law of friction at the impact `{name}`: friction presses the \
                 sliding bodies together faster than the contact can part them (Painlevé's paradox). Lower the \
                 friction, or use a stiff spring and a friction force instead of the impact"
            ),
        })
    }

    /// Closes those of the contacts that touch which then push.
    fn close(&mut self, touching: &[usize], rounding: f64) {
        let accelerations: Vec<f64> = touching.iter().map(|i| self.at[*i].acceleration).collect();
        let forces = solve_complementarity(&self.delassus(touching), &accelerations);
        let pushing = touching
            .iter()
            .zip(forces)
            .filter(|(_, force)| *force > 0.0);
        self.closed = pushing.map(|(place, _)| *place).collect();
        for place in &self.closed {
            self.allowances[*place] = 0.0;
        }
        // They leave without speed: for a while rounding of the state moves them more.
        self.offset_distances(touching, rounding);
    }

    /// Has the distances of those that touch begin above zero, and by so much.
    fn offset_distances(&mut self, touching: &[usize], above: f64) {
        for place in touching {
            let distance = self.at[*place].distance;
            self.offsets[*place] = above.max(-2.0 * distance);
        }
    }

    /// Closes the contacts that touch at rest at the start, and those assumed to be closed, if they push.
    fn start_motion(&mut self, own: &mut Evaluator, point: Point<'_>) {
        self.start = Some(point.t);
        own.impacts(point, &mut self.at);
        let small = ROUNDING * max_magnitude(point.state);
        let touching: Vec<usize> = (0..self.at.len())
            .filter(|place| self.at[*place].distance <= small || self.closed.contains(place))
            .collect();
        let still = touching
            .iter()
            .filter(|place| self.at[**place].rate.abs() <= small || self.closed.contains(place));
        let still: Vec<usize> = still.copied().collect();
        self.offset_distances(&touching, f64::MIN_POSITIVE);
        let degrees = own.program().degrees_of_freedom();
        let rounding = distance_rounding(point.state, degrees, point.t);
        match self.has_friction() {
            false => self.close(&still, rounding),
            true => {
                let started = self.start_resting(own, point, (&still, small), rounding);
                self.note_forces(started);
            }
        }
    }

    /// Notes that the motion ends if there are no contact forces.
    fn note_forces(&mut self, found: Result<(), (usize, Overlap)>) {
        if let Err(cause) = found {
            self.overlap = Some(cause);
            self.has_no_forces = true;
        }
    }

    /// Updates the modes of friction at a point between steps, where inputs may jump.
    pub fn update_friction(&mut self, own: &mut Evaluator, point: Point<'_>) {
        let degrees = own.program().degrees_of_freedom();
        let rounding = distance_rounding(point.state, degrees, point.t);
        let updated = self.update_modes(own, point, rounding);
        self.note_forces(updated);
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

    /// The forces of the closed contacts, in which their distances do not accelerate.
    fn forces(&self) -> ContactForces {
        match self.has_friction() {
            true => self.friction_forces(),
            false => ContactForces {
                normal: self.solve_balance(&self.closed, |impact| impact.acceleration),
                tangential: Vec::new(),
            },
        }
    }

    /// Returns the impulses that stop the closed contacts.
    fn stopping(&self) -> ContactForces {
        match self.has_friction() {
            true => self.stopping_impulses(),
            false => ContactForces {
                normal: self.solve_balance(&self.closed, |impact| impact.rate),
                tangential: Vec::new(),
            },
        }
    }

    /// Adds what normal and tangential impulses at these contacts do.
    fn add_forces(&self, places: &[usize], impulses: &ContactForces, rates: &mut [f64]) {
        self.add_impulses(places, &impulses.normal, rates);
        for (place, impulse) in places.iter().zip(&impulses.tangential) {
            let column = self.at[*place].friction.iter().flat_map(|one| &one.column);
            for (rate, entry) in rates.iter_mut().zip(column) {
                *rate += entry * impulse;
            }
        }
    }

    /// What at these contacts brings a quantity of theirs to zero.
    fn solve_balance(&self, places: &[usize], quantity: impl Fn(&ImpactValues) -> f64) -> Vec<f64> {
        let quantities: Vec<f64> = places
            .iter()
            .map(|place| quantity(&self.at[*place]))
            .collect();
        let rows: Vec<usize> = (0..places.len()).collect();
        solve_rows(&self.delassus(places), &quantities, &rows)
    }

    /// Adds what impulses at these contacts do.
    fn add_impulses(&self, places: &[usize], impulses: &[f64], rates: &mut [f64]) {
        for (place, impulse) in places.iter().zip(impulses) {
            for (rate, entry) in rates.iter_mut().zip(&self.at[*place].column) {
                *rate += entry * impulse;
            }
        }
    }

    /// The most that one of these impulses changes a rate by.
    fn largest_push(&self, places: &[usize], impulses: &ContactForces) -> f64 {
        let pushes = places.iter().zip(&impulses.normal);
        let pushes =
            pushes.map(|(place, impulse)| impulse.abs() * max_magnitude(&self.at[*place].column));
        let along = places.iter().zip(&impulses.tangential);
        let along = along.map(|(place, impulse)| {
            let friction = self.at[*place].friction.as_ref();
            friction.map_or(0.0, |one| impulse.abs() * max_magnitude(&one.column))
        });
        pushes.chain(along).fold(0.0, f64::max)
    }

    /// Delassus' matrix of these contacts.
    fn delassus(&self, places: &[usize]) -> Vec<Vec<f64>> {
        delassus(&self.at, places)
    }
}

/// Returns Delassus' matrix of the impacts at these places.
pub(crate) fn delassus(impacts: &[ImpactValues], places: &[usize]) -> Vec<Vec<f64>> {
    let row = |place: &usize| {
        let entries = &impacts[*place].delassus;
        places.iter().map(|other| entries[*other]).collect()
    };
    places.iter().map(row).collect()
}

/// By how much rounding of state and time changes distances.
fn distance_rounding(state: &[f64], degrees: usize, t: f64) -> f64 {
    let (coordinates, rates) = state[..2 * degrees].split_at(degrees);
    f64::MIN_POSITIVE
        + DISTANCE_ROUNDING * (max_magnitude(coordinates) + t.abs() * max_magnitude(rates))
}
