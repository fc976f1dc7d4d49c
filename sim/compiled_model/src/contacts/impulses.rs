//! Impacts: impulses of touching contacts, jumps of rates, and contacts that close after an impact.

use eomgen_codegen::independence::vectors::{dot, find_max_magnitude};
use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::complementarity::solve_complementarity;
use super::tangents::ContactForces;
use super::{Contacts, DISTANCE_ROUNDING, MAX_CONSECUTIVE_IMPACTS};

/// A flight (time between two impacts) counts as rest below this fraction of the time since the contact was last
/// closed.
const MIN_FLIGHT_TIME_FRACTION: f64 = 1e-8;

/// A rate after an impact that is negative by more than this fraction of the rates before is an error.
pub(super) const MAX_UNSOLVED_RATE_FRACTION: f64 = 1e-6;

/// A flight below this fraction of the time counts as rest.
const MIN_FLIGHT_TIME_ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// A flight counts as rest if its height is below this multiple of the rounding error of the distance.
const MIN_FLIGHT_ROUNDINGS: f64 = 1000.0;

/// An energy gain below this fraction of the energy that the impulses exchange is rounding.
pub(super) const ENERGY_GAIN_ROUNDING: f64 = 1e-12;

/// Number of bisections in the search for a restitution that adds no energy.
pub(super) const RESTITUTION_HALVINGS: usize = 52;

/// Limits of flights after an impact that count as rest.
pub(super) struct FlightLimits {
    /// Longest such flight of each contact, s.
    pub shortest: Vec<f64>,
    /// Greatest height of such a flight of each contact.
    pub lowest: Vec<f64>,
    /// Rounding error of the rate of each distance.
    pub rate_roundings: Vec<f64>,
    /// Rounding error of the acceleration of each distance, without contact forces.
    pub acceleration_roundings: Vec<f64>,
    /// Change of each slip from the hit to the located point.
    pub slip_changes: Vec<f64>,
}

impl FlightLimits {
    /// Returns true if a contact with this rate and acceleration does not separate. Accelerations up to `even` count as
    /// zero.
    pub fn is_rest(&self, place: usize, (rate, acceleration): (f64, f64), even: f64) -> bool {
        let is_short = 2.0 * rate <= -acceleration * self.shortest[place];
        let is_low = rate * rate <= -2.0 * acceleration * self.lowest[place];
        let is_together = rate <= self.rate_roundings[place] && acceleration <= even;
        acceleration < 0.0 && (is_short || is_low) || is_together
    }
}

impl Contacts {
    /// Applies an impact in the step across a surface, from a point `before` to a `state` just beyond it at the time
    /// `t`. Without an impact the contacts change their modes. At a corner the modes are determined afterwards instead.
    /// Returns true if contacts are hit.
    pub fn apply_impact(
        &mut self,
        own: &mut Evaluator,
        before: Point<'_>,
        (t, inputs): (f64, &[f64]),
        state: &mut [f64],
        has_corner: bool,
    ) -> bool {
        self.impact_work = 0.0;
        self.note_closed_until(t);
        let count = self.names.len();
        let (mut near, mut beyond) = (vec![0.0; count], vec![0.0; count]);
        own.distances(Point { t, state, inputs }, &mut beyond);
        let is_hit = |place: &usize, contacts: &Self| {
            !contacts.rests(*place) && beyond[*place] + contacts.offset(*place, t) < 0.0
        };
        let Some(first) = (0..count).find(|place| is_hit(place, self)) else {
            if has_corner {
                return false;
            }
            let located = Point {
                t,
                state: before.state,
                inputs,
            };
            let updated = self.change_modes(own, Point { t, state, inputs }, located);
            if let Err(cause) = updated {
                self.failure = Some(cause);
                state.fill(f64::NAN);
            }
            return false;
        };
        own.distances(before, &mut near);
        own.impacts(Point { t, state, inputs }, &mut self.at);
        let shortest: Vec<f64> = (self.open_since.iter())
            .map(|since| {
                let fraction = MIN_FLIGHT_TIME_FRACTION * (t - since);
                fraction.max(MIN_FLIGHT_TIME_ROUNDINGS * t.abs())
            })
            .collect();
        let roundings: Vec<f64> = (0..count)
            .map(|place| self.compute_distance_rounding(place, (t, before.state)))
            .collect();
        // A contact that touches without speed is hit by the jump of another contact, for example between two bodies
        // that fall together.
        let hits: Vec<usize> = (0..count).filter(|place| is_hit(place, self)).collect();
        let shortest_of_hits = hits.iter().map(|place| shortest[*place]);
        let collapsing = self.find_collapse(t, &hits, shortest_of_hits.fold(0.0, f64::max));
        let touching: Vec<usize> = (0..count)
            .filter(|place| {
                let impact = &self.at[*place];
                let within = roundings[*place].max(-impact.rate * shortest[*place]);
                self.rests(*place)
                    || hits.contains(place)
                    || collapsing.contains(place)
                    || self.touches_held_body(*place)
                    || impact.distance <= within
            })
            .collect();
        // Time since the first of these contacts hit, s.
        let time_since_hit = |place: &usize| {
            let (from, to) = (near[*place] + self.offset(*place, before.t), beyond[*place]);
            let to = to + self.offset(*place, t);
            (t - before.t) * (to / (to - from)).clamp(0.0, 1.0)
        };
        let time_since_hit = hits.iter().map(time_since_hit).fold(0.0, f64::max);
        if self.needs_no_impulse(&touching, time_since_hit) {
            // The distance of a contact that separates slowly became negative by rounding.
            self.offset_by_rounding(&touching, (t, before.state));
            return true;
        }
        self.has_restitution = collapsing.is_empty();
        let slip_changes = self.compute_slip_acceleration_sizes().into_iter();
        let slip_changes = slip_changes.map(|size| time_since_hit * size).collect();
        let jumped = self.apply_impulses(own, (t, inputs), state, touching, time_since_hit);
        let (touching, rate_roundings) = match jumped {
            Ok(jumped) => jumped,
            Err(cause) => {
                self.failure = Some((first, cause));
                state.fill(f64::NAN);
                return true;
            }
        };
        let flight = FlightLimits {
            shortest,
            lowest: (0..count)
                .map(|place| {
                    MIN_FLIGHT_ROUNDINGS * self.compute_position_rounding(place, before.state)
                })
                .collect(),
            rate_roundings,
            acceleration_roundings: self
                .compute_acceleration_roundings(own, Point { t, state, inputs }),
            slip_changes,
        };
        match self.has_friction() {
            false => {
                self.close_resting(&touching, &flight);
                self.note_redundant(own, Point { t, state, inputs }, &[]);
            }
            true => {
                let point = Point { t, state, inputs };
                if let Err(cause) = self.close_resting_with_friction(own, point, &touching, &flight)
                {
                    self.failure = Some(cause);
                    state.fill(f64::NAN);
                    return true;
                }
            }
        }
        self.stop_closed(own, (t, inputs), state);
        true
    }

    /// Stops the remaining motion at closed contacts, including the slips of contacts that slide on. The energy loss
    /// counts as that of the impact.
    fn stop_closed(&mut self, own: &mut Evaluator, (t, inputs): (f64, &[f64]), state: &mut [f64]) {
        if self.closed.is_empty() {
            return;
        }
        let degrees = own.program().degrees_of_freedom();
        own.impacts(Point { t, state, inputs }, &mut self.at);
        let closing = self.has_friction().then(|| self.compute_closing_impulses());
        let impulses = closing
            .flatten()
            .unwrap_or_else(|| self.solve_normal_stopping_impulses());
        self.add_forces(&self.closed, &impulses, &mut state[degrees..2 * degrees]);
        self.impact_work += self.compute_work(&self.closed, &impulses);
    }

    /// Returns true if no touching contact needs an impulse.
    fn needs_no_impulse(&self, touching: &[usize], time_since_hit: f64) -> bool {
        let mut all = touching.iter();
        all.all(|place| self.compute_required_rate_change(*place, time_since_hit, 1.0) >= 0.0)
    }

    /// Returns the change of rate that impulses must supply at a contact that was hit `time_since_hit` s before.
    pub(super) fn compute_required_rate_change(
        &self,
        place: usize,
        time_since_hit: f64,
        most: f64,
    ) -> f64 {
        let rate = self.compute_hit_rate(place, time_since_hit);
        // A contact that already separates must not be pulled back.
        rate + self.restitution(place).min(most) * rate.min(0.0)
    }

    /// Returns the restitution of a contact in the present impact: 0 if it is closed or if the impact ends an infinite
    /// sequence.
    pub(super) fn restitution(&self, place: usize) -> f64 {
        match self.has_restitution && !self.rests(place) {
            true => self.at[place].restitution,
            false => 0.0,
        }
    }

    /// Returns the rate with which a contact was hit `time_since_hit` s before.
    pub(super) fn compute_hit_rate(&self, place: usize, time_since_hit: f64) -> f64 {
        let impact = &self.at[place];
        match self.rests(place) {
            true => impact.rate,
            false => impact.rate - time_since_hit * impact.acceleration,
        }
    }

    /// Returns the impulses of touching contacts that were hit `time_since_hit` s before; `None` if no impulses keep the bodies
    /// apart.
    ///
    /// Newton's law can add energy if contacts of different restitution touch at once, or if a separating contact is
    /// hit again. Two stops without play allow no restitution. In these cases the restitution of all contacts is
    /// limited to the largest admissible value. Without restitution, twice the energy changes by -P W P.
    pub(super) fn solve_impulses(
        &self,
        touching: &[usize],
        time_since_hit: f64,
    ) -> Option<ContactForces> {
        let delassus = self.compute_delassus(touching);
        let with = |most: f64| {
            let stopped = touching.iter();
            let stopped: Vec<f64> = stopped
                .map(|place| self.compute_required_rate_change(*place, time_since_hit, most))
                .collect();
            let impulses = solve_complementarity(&delassus, &stopped);
            is_solution(&delassus, &stopped, &impulses).then_some(impulses)
        };
        // For every impulse, the rates before and after it give its work.
        let adds_energy = |impulses: &[f64]| {
            let rows = touching.iter().zip(&delassus).zip(impulses);
            let (mut gained, mut exchanged) = (0.0, 0.0);
            for ((place, row), impulse) in rows {
                let (before, pushed) = (
                    2.0 * self.compute_hit_rate(*place, time_since_hit),
                    dot(row, impulses),
                );
                gained += impulse * (before + pushed);
                exchanged += impulse.abs() * (before.abs() + pushed.abs());
            }
            gained > ENERGY_GAIN_ROUNDING * exchanged
        };
        let smooth = |normal: Vec<f64>| ContactForces {
            normal,
            tangential: Vec::new(),
        };
        let is_possible = |impulses: &Vec<f64>| !adds_energy(impulses);
        if let Some(impulses) = with(1.0).filter(is_possible) {
            return Some(smooth(impulses));
        }
        let (mut most, mut found) = (0.0, with(0.0)?);
        let mut part = 0.5;
        for _ in 0..RESTITUTION_HALVINGS {
            if let Some(trial) = with(most + part).filter(is_possible) {
                (most, found) = (most + part, trial);
            }
            part *= 0.5;
        }
        Some(smooth(found))
    }

    /// Records the `hits` of an impact. If impacts follow each other faster than the `shortest` flights (s), returns
    /// the contacts whose infinite sequence of impacts ends in a finite time. In the limit their bodies move on
    /// together (inelastic collapse; S. McNamara and W. R. Young, Phys. Fluids A 4, 1992).
    fn find_collapse(&mut self, t: f64, hits: &[usize], shortest: f64) -> Vec<usize> {
        if self.recent.len() == MAX_CONSECUTIVE_IMPACTS {
            self.recent.pop_front();
        }
        self.recent.push_back((t, hits.to_vec()));
        let is_endless = self.recent.len() == MAX_CONSECUTIVE_IMPACTS
            && t - self.recent[0].0 < MAX_CONSECUTIVE_IMPACTS as f64 * shortest;
        if !is_endless {
            return Vec::new();
        }
        let mut places: Vec<usize> = self.recent.drain(..).flat_map(|(_, hits)| hits).collect();
        places.sort_unstable();
        places.dedup();
        places
    }

    /// Returns the rounding errors of the accelerations of the distances, without contact forces.
    fn compute_acceleration_roundings(&self, own: &mut Evaluator, point: Point<'_>) -> Vec<f64> {
        let degrees = own.program().degrees_of_freedom();
        let mut rates = vec![0.0; point.state.len()];
        own.rates(point, &mut rates);
        let accelerations = &rates[degrees..2 * degrees];
        (0..self.names.len())
            .map(|place| DISTANCE_ROUNDING * self.compute_rate_size(place, accelerations))
            .collect()
    }

    /// Closes the touching contacts that do not separate, or whose bodies move on together as two bodies that fall side
    /// by side.
    fn close_resting(&mut self, touching: &[usize], flight: &FlightLimits) {
        self.closed.clear();
        self.redundant.clear();
        loop {
            let forces = self.compute_forces();
            let even = |place: usize| {
                flight.acceleration_roundings[place]
                    + DISTANCE_ROUNDING * self.compute_push_size(place, &self.closed, &forces)
            };
            let rests = |place: &&usize| {
                let impact = &self.at[**place];
                let held = self.closed.iter().zip(&forces.normal);
                let pushed: f64 = held
                    .map(|(other, force)| impact.delassus[*other] * force)
                    .sum();
                let acceleration = impact.acceleration + pushed;
                !self.closed.contains(place)
                    && flight.is_rest(**place, (impact.rate, acceleration), even(**place))
                    && !self.is_blocked_by(&self.closed, **place)
            };
            let Some(next) = touching.iter().find(rests) else {
                break;
            };
            let even = even(*next);
            self.closed.push(*next);
            self.allowances[*next] = even / self.at[*next].delassus[*next];
        }
        self.offset_distances(touching);
    }
}

/// Returns true if no rate is negative after the given impulses.
fn is_solution(delassus: &[Vec<f64>], rates: &[f64], impulses: &[f64]) -> bool {
    let unsolved = MAX_UNSOLVED_RATE_FRACTION * find_max_magnitude(rates);
    let mut rows = delassus.iter().zip(rates);
    rows.all(|(row, rate)| dot(row, impulses) + rate >= -unsolved)
}
