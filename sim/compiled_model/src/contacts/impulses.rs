//! Impacts: touching contacts, jumps of rates, and contacts that close afterwards.

use eomgen_codegen::independence::vectors::{dot, max_magnitude};
use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::complementarity::solve_complementarity;
use super::tangents::ContactForces;
use super::{Contacts, DISTANCE_ROUNDING, MAX_CONSECUTIVE_IMPACTS};

/// A flight shorter than this fraction of the time since the contact was closed last is rest.
const MIN_FLIGHT_TIME_FRACTION: f64 = 1e-8;

/// A rate that an impact leaves negative is wrong if it is this large beside those before.
pub(super) const MAX_UNSOLVED_RATE_FRACTION: f64 = 1e-6;

/// A flight shorter than so many roundings of the time is rest.
const MIN_FLIGHT_TIME_ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// A flight no higher than so many times the rounding of its distance is rest.
const MIN_FLIGHT_ROUNDINGS: f64 = 1000.0;

/// An energy that impulses add is rounding where it is this small beside what they exchange.
pub(super) const ENERGY_GAIN_ROUNDING: f64 = 1e-12;

/// Halvings in the search for a restitution that adds no energy, down to rounding.
pub(super) const RESTITUTION_HALVINGS: usize = 52;

/// Which flights after an impact are none.
pub(super) struct Flight {
    /// Those of each contact that are this short, s.
    pub shortest: Vec<f64>,
    /// Those of each contact that are this low.
    pub lowest: Vec<f64>,
    /// Rates of each distance that are rounding.
    pub rate_roundings: Vec<f64>,
    /// Accelerations of each distance that are rounding, without what contacts push.
    pub acceleration_roundings: Vec<f64>,
    /// Changes of each slip between the hit and the located point.
    pub slip_changes: Vec<f64>,
}

impl Flight {
    /// Returns true if the contact `place` with this rate and acceleration does not fly, if accelerations up to
    /// `even` are rounding.
    pub fn is_none(&self, place: usize, (rate, acceleration): (f64, f64), even: f64) -> bool {
        let is_short = 2.0 * rate <= -acceleration * self.shortest[place];
        let is_low = rate * rate <= -2.0 * acceleration * self.lowest[place];
        let is_together = rate <= self.rate_roundings[place] && acceleration <= even;
        acceleration < 0.0 && (is_short || is_low) || is_together
    }
}

impl Contacts {
    /// Applies an impact in the step across a surface, from a point `before` to `state` just
    /// beyond it at the time `t`, with these inputs. Without an impact contacts change their modes, but not at a corner,
    /// after which they are decided anew. Returns true if contacts are hit.
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
                self.overlap = Some(cause);
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
            .map(|place| self.distance_rounding(place, (t, before.state)))
            .collect();
        // What touches without a speed, as a body that falls together with the one below it, is hit
        // by the jump of the other.
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
        // How long ago the first of them hit.
        let ago = |place: &usize| {
            let (from, to) = (near[*place] + self.offset(*place, before.t), beyond[*place]);
            let to = to + self.offset(*place, t);
            (t - before.t) * (to / (to - from)).clamp(0.0, 1.0)
        };
        let ago = hits.iter().map(ago).fold(0.0, f64::max);
        if self.needs_no_impulse(&touching, ago) {
            // What leaves slowly went below zero by rounding.
            self.offset_by_rounding(&touching, (t, before.state));
            return true;
        }
        self.has_restitution = collapsing.is_empty();
        let slip_changes = self.slip_acceleration_sizes().into_iter();
        let slip_changes = slip_changes.map(|size| ago * size).collect();
        let jumped = self.apply_impulses(own, (t, inputs), state, touching, ago);
        let (touching, rate_roundings) = match jumped {
            Ok(jumped) => jumped,
            Err(cause) => {
                self.overlap = Some((first, cause));
                state.fill(f64::NAN);
                return true;
            }
        };
        let flight = Flight {
            shortest,
            lowest: (0..count)
                .map(|place| MIN_FLIGHT_ROUNDINGS * self.position_rounding(place, before.state))
                .collect(),
            rate_roundings,
            acceleration_roundings: self.acceleration_roundings(own, Point { t, state, inputs }),
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
                    self.overlap = Some(cause);
                    state.fill(f64::NAN);
                    return true;
                }
            }
        }
        self.stop_closed(own, (t, inputs), state);
        true
    }

    /// Stops the remaining motion along closed contacts, and of those that slide on. The energy that it takes is that of
    /// the impact.
    fn stop_closed(&mut self, own: &mut Evaluator, (t, inputs): (f64, &[f64]), state: &mut [f64]) {
        if self.closed.is_empty() {
            return;
        }
        let degrees = own.program().degrees_of_freedom();
        own.impacts(Point { t, state, inputs }, &mut self.at);
        let closing = self.has_friction().then(|| self.closing_impulses());
        let impulses = closing.flatten().unwrap_or_else(|| self.stopping());
        self.add_forces(&self.closed, &impulses, &mut state[degrees..2 * degrees]);
        self.impact_work += self.work_of(&self.closed, &impulses);
    }

    /// Returns true if no contact that touches needs an impulse.
    fn needs_no_impulse(&self, touching: &[usize], ago: f64) -> bool {
        let mut all = touching.iter();
        all.all(|place| self.required_rate_change(*place, ago, 1.0) >= 0.0)
    }

    /// The rate of a contact that hit so long `ago` (s), for which impulses must make up.
    pub(super) fn required_rate_change(&self, place: usize, ago: f64, most: f64) -> f64 {
        let rate = self.hit_rate(place, ago);
        // What already leaves must not be pulled back.
        rate + self.restitution(place).min(most) * rate.min(0.0)
    }

    /// Returns the restitution of a contact in the present impact: 0 if it is closed, or if the impact ends infinitely
    /// many.
    pub(super) fn restitution(&self, place: usize) -> f64 {
        match self.has_restitution && !self.rests(place) {
            true => self.at[place].restitution,
            false => 0.0,
        }
    }

    /// The rate with which a contact hit so long `ago`, s.
    pub(super) fn hit_rate(&self, place: usize, ago: f64) -> f64 {
        let impact = &self.at[place];
        match self.rests(place) {
            true => impact.rate,
            false => impact.rate - ago * impact.acceleration,
        }
    }

    /// The impulses of what touches and hit so long `ago` (s), nothing where none keep the bodies apart.
    /// Newton's law can add energy where contacts of different restitution touch at once, or one that leaves
    /// is hit again. Contacts that leave no room, as two stops without play, allow no restitution. Then none takes more
    /// restitution than the most that is possible. Without restitution, twice the energy changes by -P W P.
    pub(super) fn solve_impulses(&self, touching: &[usize], ago: f64) -> Option<ContactForces> {
        let delassus = self.delassus(touching);
        let with = |most: f64| {
            let stopped = touching.iter();
            let stopped: Vec<f64> = stopped
                .map(|place| self.required_rate_change(*place, ago, most))
                .collect();
            let impulses = solve_complementarity(&delassus, &stopped);
            is_solution(&delassus, &stopped, &impulses).then_some(impulses)
        };
        // Of every impulse the rates before and after, which it moves against.
        let adds_energy = |impulses: &[f64]| {
            let rows = touching.iter().zip(&delassus).zip(impulses);
            let (mut gained, mut exchanged) = (0.0, 0.0);
            for ((place, row), impulse) in rows {
                let (before, pushed) = (2.0 * self.hit_rate(*place, ago), dot(row, impulses));
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

    /// Records the `hits` of an impact and returns the contacts that hit each other without end in a finite time, if
    /// impacts follow each other faster than the `shortest` flights (s). In the limit they move on together (inelastic
    /// collapse; S. McNamara and W. R. Young, Phys. Fluids A 4, 1992).
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

    /// Returns the roundings of the accelerations of the distances, without what contacts push.
    fn acceleration_roundings(&self, own: &mut Evaluator, point: Point<'_>) -> Vec<f64> {
        let degrees = own.program().degrees_of_freedom();
        let mut rates = vec![0.0; point.state.len()];
        own.rates(point, &mut rates);
        let accelerations = &rates[degrees..2 * degrees];
        (0..self.names.len())
            .map(|place| DISTANCE_ROUNDING * self.rate_size(place, accelerations))
            .collect()
    }

    /// Closes those that touch and would not fly in earnest, or that move on together as bodies do
    /// that fall side by side.
    fn close_resting(&mut self, touching: &[usize], flight: &Flight) {
        self.closed.clear();
        self.redundant.clear();
        loop {
            let forces = self.forces();
            let even = |place: usize| {
                flight.acceleration_roundings[place]
                    + DISTANCE_ROUNDING * self.push_size(place, &self.closed, &forces)
            };
            let rests = |place: &&usize| {
                let impact = &self.at[**place];
                let held = self.closed.iter().zip(&forces.normal);
                let pushed: f64 = held
                    .map(|(other, force)| impact.delassus[*other] * force)
                    .sum();
                let acceleration = impact.acceleration + pushed;
                !self.closed.contains(place)
                    && flight.is_none(**place, (impact.rate, acceleration), even(**place))
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

/// Returns true if impulses leave no rate negative.
fn is_solution(delassus: &[Vec<f64>], rates: &[f64], impulses: &[f64]) -> bool {
    let unsolved = MAX_UNSOLVED_RATE_FRACTION * max_magnitude(rates);
    let mut rows = delassus.iter().zip(rates);
    rows.all(|(row, rate)| dot(row, impulses) + rate >= -unsolved)
}
