//! Transitions of surfaces: arrivals, releases, and decisions at the intersection of several surfaces.

use eomgen_sim::friction_discs::DiscArrival;
use eomgen_sim::sliding_modes::{Arrival, Verdict};

use super::discs::{Disc, DiscState, norm, unit_vector};
use super::surface_state::{SurfaceState, find_allowed, side_of_arrival};
use super::surface_states::{
    KnownSides, MAX_DRIFT_FRACTION, MAX_FORCE_DRIFT_FRACTION, SurfaceStates,
};

/// Largest distance of other surfaces that count as reached, relative to the change of their functions in the step
/// across a surface.
const NEAR_MOVE_FACTOR: f64 = 4.0;

/// Upper limit of this distance, relative to the largest value of the function.
const MAX_NEAR_FRACTION: f64 = 1e-9;

/// A motion stops if its component along the reference reaches the slowest velocity and its speed is below this
/// multiple of it. The remaining speed is orthogonal to the reference.
const MAX_SLOW_MULTIPLE: f64 = 2.0;

/// Arrival at a surface on which the motion already is.
const ARRIVAL_AT_REST: Arrival = Arrival {
    side: 1.0,
    exceeds_limit: false,
};

/// Surfaces on which a motion is, their arrivals, and discs with their arrivals.
type ReachedSurfaces<'r> = (&'r [usize], &'r [Arrival], &'r [(usize, DiscArrival)]);

impl SurfaceStates {
    /// Determines the effect of all surfaces on which the motion is, after a jump of rates or a change of contacts.
    pub fn decide_again(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        if !self.can_hold || self.begin.is_none() {
            return;
        }
        self.release_left_surfaces(at, inputs);
        let (functions, allowed) = self.evaluate_functions_and_roundings(at, inputs);
        let touches = |surface: &usize| functions[*surface].abs() <= allowed[*surface];
        let touching: Vec<usize> = (0..self.places.len()).filter(touches).collect();
        let mut discs = self.find_held_discs(at, inputs);
        discs.extend(self.find_stopped_discs(&functions, &allowed));
        if touching.is_empty() && discs.is_empty() {
            return;
        }
        let came_from = self.determine_arrival_sides(&functions);
        let arrivals = vec![ARRIVAL_AT_REST; touching.len()];
        self.decide_states(at, inputs, (&touching, &arrivals, &discs), &came_from);
    }

    /// Makes the sides of surfaces that cannot hold the motion follow from the state. Returns the previous sides.
    pub fn release_other_sides(&mut self) -> Vec<(bool, f64)> {
        self.known = KnownSides::Nothing;
        self.sided.release_other_sides()
    }

    /// Restores the sides that `release_other_sides` returned.
    pub fn restore_other_sides(&mut self, sides: Vec<(bool, f64)>) {
        self.known = KnownSides::Nothing;
        self.sided.restore_other_sides(sides);
    }

    /// Determines the states of all surfaces that the motion has reached. `before` is on the near side of a surface;
    /// `t` and `state` are just beyond it.
    pub fn apply_crossing(
        &mut self,
        inputs: &[f64],
        (t_before, before): (f64, &[f64]),
        t: f64,
        state: &mut [f64],
    ) {
        if !self.can_hold {
            return;
        }
        let near = self.sided.evaluate_functions((t_before, before), inputs);
        let beyond = self.sided.evaluate_functions((t, state), inputs);
        let roundings = self.sided.function_roundings((t, state), inputs);
        let mut is_new = false;
        let mut touching = Vec::new();
        let mut arrivals = Vec::new();
        let overcome = self.find_overcome((t, state), inputs);
        let came_from = self.determine_arrival_sides(&near);
        let (left, has_new_force) = self.free_left(t, &beyond);
        is_new |= has_new_force;
        let places = self.places.iter().enumerate();
        for (surface, place) in places.filter(|(surface, _)| !left.contains(surface)) {
            let (from, to) = (near[surface], beyond[surface]);
            let moved = place.displacement();
            let is_crossed = came_from[surface] * (to + moved) < 0.0;
            let near = NEAR_MOVE_FACTOR * (to - from).abs();
            let near = near.min(MAX_NEAR_FRACTION * self.sizes[surface]) + roundings[surface];
            let is_near = to.abs() <= near.max(2.0 * place.displacement().abs());
            is_new |= place.is_moved_by_others((t, to));
            // A surface that the motion has not left yet may hold it again.
            if place.is_on() || is_crossed || is_near {
                is_new |= is_crossed && !place.is_on();
                touching.push(surface);
                arrivals.push(overcome[surface].unwrap_or(Arrival {
                    side: match is_crossed {
                        true => -came_from[surface],
                        false => came_from[surface],
                    },
                    exceeds_limit: false,
                }));
            }
        }
        let discs = self.find_disc_arrivals((t, state), inputs, (&near, &beyond));
        is_new |= discs
            .iter()
            .any(|(disc, arrival)| arrival.exceeds_limit || !self.discs[*disc].is_holding());
        if !is_new && overcome.iter().all(Option::is_none) {
            return;
        }
        let reached = (&touching[..], &arrivals[..], &discs[..]);
        self.decide_states((t, state), inputs, reached, &came_from);
        self.correct_onto_surfaces((t, state), inputs, true);
    }

    /// Frees the surfaces whose motion other surfaces no longer stop, from the functions at a time (s). Returns these
    /// surfaces, and true if the force of one changes its direction.
    fn free_left(&mut self, t: f64, functions: &[f64]) -> (Vec<usize>, bool) {
        let (mut left, mut has_new_force) = (Vec::new(), false);
        for (surface, place) in self.places.iter_mut().enumerate() {
            let SurfaceState::Bearing { side, .. } = *place else {
                continue;
            };
            let function = functions[surface];
            if !place.is_moved_by_others((t, function)) {
                continue;
            }
            has_new_force |= side * function < 0.0;
            left.push(surface);
            *place = SurfaceState::Free;
            if let Some(kept) = &mut self.kept {
                kept[surface] = function.signum();
            }
            self.known = KnownSides::Nothing;
        }
        (left, has_new_force)
    }

    /// Releases the motion from surfaces that it has left by a jump of the rates.
    pub fn release_left_surfaces(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        let (functions, allowed) = self.evaluate_functions_and_roundings(at, inputs);
        for (surface, place) in self.places.iter_mut().enumerate() {
            if functions[surface].abs() > allowed[surface] {
                *place = SurfaceState::Free;
            }
        }
        for disc in &mut self.discs {
            let has_moved = norm(disc.velocity(&functions)) > norm(disc.velocity(&allowed));
            if has_moved && disc.is_holding() {
                disc.state = DiscState::Sliding;
            }
            disc.follow(&functions);
        }
        self.known = KnownSides::Nothing;
    }

    /// Returns the switching functions, and the largest magnitude of each that counts as zero.
    fn evaluate_functions_and_roundings(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let functions = self.sided.evaluate_functions(at, inputs);
        let mut allowed = self.sided.function_roundings(at, inputs);
        for (allowed, size) in allowed.iter_mut().zip(&self.sizes) {
            *allowed += MAX_DRIFT_FRACTION * size;
        }
        for (surface, place) in self.places.iter().enumerate() {
            allowed[surface] += match *place {
                SurfaceState::Holding { since, .. } => {
                    let by_force = self.sided.own_force_rate(surface) * (at.0 - since).abs();
                    MAX_FORCE_DRIFT_FRACTION * by_force
                }
                SurfaceState::Unloaded { since, allowed, .. }
                | SurfaceState::Bearing { since, allowed, .. } => {
                    find_allowed(allowed, at.0 - since)
                }
                _ => 0.0,
            };
        }
        (functions, allowed)
    }

    /// Returns the discs that hold the motion, and discs whose velocity reached zero between two values of the
    /// functions. A velocity that passed zero at a distance has only turned; it gets a new reference.
    fn find_disc_arrivals(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        (near, beyond): (&[f64], &[f64]),
    ) -> Vec<(usize, DiscArrival)> {
        let mut found = self.find_held_discs((t, state), inputs);
        let roundings = self.sided.function_roundings((t, state), inputs);
        for (index, disc) in self.discs.iter_mut().enumerate() {
            if disc.is_holding() {
                continue;
            }
            let velocity = disc.velocity(beyond);
            let moved = velocity.iter().zip(disc.velocity(near));
            let moved: Vec<f64> = moved.map(|(to, from)| to - from).collect();
            let size = norm(disc.velocity(&self.sizes));
            let most = MAX_NEAR_FRACTION * size;
            let has_passed = disc.guard(beyond) < 0.0;
            let reach = match has_passed {
                true => MAX_SLOW_MULTIPLE * disc.slowest(),
                false => most.min(NEAR_MOVE_FACTOR * norm(&moved)),
            };
            if norm(velocity) <= reach + norm(disc.velocity(&roundings)) {
                found.push((index, disc.arrival()));
            } else if has_passed {
                disc.state = DiscState::Sliding;
                disc.follow(beyond);
                self.known = KnownSides::Nothing;
            }
        }
        found
    }

    /// Returns the discs that do not hold the motion although their velocity is within `allowed`.
    fn find_stopped_discs(&self, functions: &[f64], allowed: &[f64]) -> Vec<(usize, DiscArrival)> {
        let stopped = self.discs.iter().enumerate().filter(|(_, disc)| {
            !disc.is_holding() && norm(disc.velocity(functions)) <= norm(disc.velocity(allowed))
        });
        let arrivals = stopped.map(|(index, disc)| (index, disc.arrival()));
        arrivals.collect()
    }

    /// Returns the discs that hold the motion, with forces that may exceed their limits.
    fn find_held_discs(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<(usize, DiscArrival)> {
        if !self.discs.iter().any(Disc::is_holding) {
            return Vec::new();
        }
        self.find_holding_sides(at, inputs);
        let sides = self.sided.sides();
        let holding = self.discs.iter().enumerate();
        let holding = holding.filter(|(_, disc)| disc.is_holding());
        let arrivals = holding.map(|(index, disc)| {
            let needed = &sides[disc.rows.clone()];
            let arrival = DiscArrival {
                rows: disc.rows.clone(),
                along: unit_vector(needed, Some(&disc.along)),
                exceeds_limit: norm(needed) > 1.0,
            };
            (index, arrival)
        });
        arrivals.collect()
    }

    /// Returns the sides, -1 or 1, from which the motion came, from the values of the functions. If a function is
    /// exactly zero, its fixed side is used.
    fn determine_arrival_sides(&self, near: &[f64]) -> Vec<f64> {
        let kept = |surface: usize| self.kept.as_ref().map(|kept| kept[surface]);
        let side = |(surface, value): (usize, &f64)| {
            let moved = self.places[surface].displacement();
            match kept(surface).filter(|side| *side != 0.0) {
                Some(side) if value + moved == 0.0 => side,
                _ => (value + moved).signum(),
            }
        };
        let surfaces = near.iter().take(self.places.len());
        surfaces.enumerate().map(side).collect()
    }

    /// Corrects a state that has drifted from the surfaces that hold it. Returns the number of evaluations.
    pub fn correct_state(&mut self, t: f64, inputs: &[f64], state: &mut [f64]) -> u64 {
        self.correct_onto_surfaces((t, state), inputs, false)
    }

    /// Updates the surfaces at a point at which inputs may jump from `earlier`. Releases the motion if an input moves a
    /// surface away or a force exceeds its limit. Call [`Self::release_other_sides`] first, so that the sides of
    /// surfaces that cannot hold the motion are computed from the state.
    pub fn update(&mut self, at: (f64, &[f64]), (earlier, inputs): (&[f64], &[f64])) {
        if !self.can_hold {
            return;
        }
        if self.begin.is_some() && !self.is_free() {
            let functions = self.sided.evaluate_functions(at, inputs);
            let jumps: Vec<bool> = match earlier == inputs {
                true => vec![false; functions.len()],
                false => {
                    let before = self.sided.evaluate_functions(at, earlier);
                    let roundings = self.sided.function_roundings(at, inputs);
                    let moved = functions.iter().zip(&before).map(|(a, b)| (a - b).abs());
                    let allowed = roundings.iter().zip(&self.sizes);
                    let allowed =
                        allowed.map(|(rounding, size)| rounding + MAX_DRIFT_FRACTION * size);
                    moved.zip(allowed).map(|(a, b)| a > b).collect()
                }
            };
            for disc in &mut self.discs {
                if disc.is_holding() && disc.rows.clone().any(|row| jumps[row]) {
                    disc.state = DiscState::Sliding;
                    self.known = KnownSides::Nothing;
                }
            }
            for (surface, place) in self.places.iter_mut().enumerate() {
                let value = functions[surface];
                let has_left = match *place {
                    // Forces may reverse a motion that has hardly left the surface.
                    SurfaceState::Leaving { moved, .. } => value.abs() > 2.0 * moved,
                    _ => jumps[surface],
                };
                if has_left && *place != SurfaceState::Free {
                    *place = SurfaceState::Free;
                    self.known = KnownSides::Nothing;
                }
            }
            self.release_powerless(at, inputs);
            for _ in 0..=self.places.len() {
                let overcome = self.find_overcome(at, inputs);
                let discs = self.find_held_discs(at, inputs);
                let exceeds = discs.iter().any(|(_, arrival)| arrival.exceeds_limit);
                if !exceeds && overcome.iter().all(Option::is_none) {
                    break;
                }
                let on = |surface: &usize| self.places[*surface].is_on();
                let touching: Vec<usize> = (0..self.places.len()).filter(on).collect();
                let arrival = |surface: &usize| overcome[*surface].unwrap_or(ARRIVAL_AT_REST);
                let arrivals: Vec<Arrival> = touching.iter().map(arrival).collect();
                let reached = (&touching[..], &arrivals[..], &discs[..]);
                self.decide_states(at, inputs, reached, &functions);
            }
        }
        let functions = self.sided.evaluate_functions(at, inputs);
        for disc in &mut self.discs {
            disc.follow(&functions);
            self.known = KnownSides::Nothing;
        }
        self.note_sizes(&functions);
        for disc in &mut self.discs {
            let largest = norm(disc.velocity(&self.sizes));
            disc.set_roundings(MAX_DRIFT_FRACTION * largest, self.tolerance * largest);
        }
    }

    /// Records the magnitudes of the functions.
    fn note_sizes(&mut self, functions: &[f64]) {
        for (size, value) in self.sizes.iter_mut().zip(functions) {
            *size = size.max(value.abs());
        }
    }

    /// Releases the motion from surfaces whose force has vanished, for example that of a lifted brake.
    fn release_powerless(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        self.find_holding_sides(at, inputs);
        let is_powerless = |row: usize| self.sided.own_effects.get(row) == Some(&0.0);
        for (surface, place) in self.places.iter_mut().enumerate() {
            if matches!(place, SurfaceState::Holding { .. }) && is_powerless(surface) {
                *place = SurfaceState::Free;
                self.known = KnownSides::Nothing;
            }
        }
        for disc in &mut self.discs {
            if disc.is_holding() && disc.rows.clone().all(is_powerless) {
                disc.state = DiscState::Sliding;
                self.known = KnownSides::Nothing;
            }
        }
    }

    /// Starts a motion. Surfaces on which it is, or that are assumed to hold it, may hold it.
    pub(super) fn start_motion(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        self.begin = Some(at.0);
        self.known = KnownSides::Nothing;
        let functions = self.sided.evaluate_functions(at, inputs);
        self.note_sizes(&functions);
        let roundings = self.sided.function_roundings(at, inputs);
        let touching: Vec<usize> = (0..self.places.len())
            .filter(|surface| {
                let is_near = functions[*surface].abs() <= roundings[*surface];
                is_near || self.places[*surface].is_on()
            })
            .collect();
        self.places.fill(SurfaceState::Free);
        let mut discs = Vec::new();
        for (index, disc) in self.discs.iter_mut().enumerate() {
            let is_assumed = disc.is_holding();
            disc.state = DiscState::Sliding;
            disc.follow(&functions);
            let is_near = norm(disc.velocity(&functions)) <= norm(disc.velocity(&roundings));
            if is_near || is_assumed {
                let arrival = DiscArrival {
                    rows: disc.rows.clone(),
                    along: disc.along.clone(),
                    exceeds_limit: false,
                };
                discs.push((index, arrival));
            }
        }
        if !touching.is_empty() || !discs.is_empty() {
            let arrivals = vec![ARRIVAL_AT_REST; touching.len()];
            let reached = (&touching[..], &arrivals[..], &discs[..]);
            self.decide_states(at, inputs, reached, &functions);
        }
    }

    /// Returns the surfaces whose force exceeds its limit, each with its side.
    pub(super) fn find_overcome(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
    ) -> Vec<Option<Arrival>> {
        self.find_holding_sides(at, inputs);
        let held = self.places.iter().zip(self.sided.sides());
        held.map(|(place, side)| {
            let is_overcome =
                matches!(place, SurfaceState::Holding { .. }) && !(0.0..=1.0).contains(side);
            is_overcome.then_some(Arrival {
                side: (side - 0.5).signum(),
                exceeds_limit: is_overcome,
            })
        })
        .collect()
    }

    /// Determines the states of the surfaces `touching` and of discs on which the motion is. The signs give the sides
    /// from which it came.
    fn decide_states(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
        (touching, arrivals, discs): ReachedSurfaces<'_>,
        came_from: &[f64],
    ) {
        self.known = KnownSides::Nothing;
        self.has_decided = true;
        let mut sides = self.find_current_sides(at, inputs);
        let jumps = self.sided.has_jumps(at, inputs, touching, &sides);
        let (touching, arrivals) = self.free_without_jump((touching, arrivals), &jumps);
        let functions = self.sided.evaluate_functions(at, inputs);
        let (mut touching, arrivals, passing) =
            self.unload_stopped((touching, arrivals), came_from, (at.0, &functions));
        for (surface, side) in &passing {
            sides[*surface] = 0.5 + 0.5 * side;
        }
        let arrived: Vec<DiscArrival> = discs.iter().map(|(_, arrival)| arrival.clone()).collect();
        let asked = (&touching[..], &arrivals[..], &arrived[..]);
        let Some((mut verdicts, vectors)) = self.sided.decide(at, inputs, asked, &sides) else {
            // The signs of the functions determine the sides; if this fails, the solver reports chattering.
            for surface in passing
                .into_iter()
                .map(|(surface, _)| surface)
                .chain(touching)
            {
                self.places[surface] = SurfaceState::Free;
            }
            for (index, arrival) in discs {
                let disc = &mut self.discs[*index];
                disc.state = DiscState::Sliding;
                disc.along.clone_from(&arrival.along);
            }
            return;
        };
        for (surface, side) in passing {
            touching.push(surface);
            verdicts.push(Verdict::Releases(side));
        }
        let mut roundings = self.sided.function_roundings(at, inputs);
        let passed = self.begin.map_or(0.0, |begin| at.0 - begin);
        for (surface, rounding) in roundings.iter_mut().enumerate() {
            // Distance by a rate of rounding size, accumulated over time.
            *rounding += MAX_FORCE_DRIFT_FRACTION * self.sided.own_force_rate(surface) * passed;
        }
        for ((index, _), verdict) in discs.iter().zip(&vectors) {
            let disc = &mut self.discs[*index];
            let rounding = norm(disc.velocity(&roundings));
            disc.enter(verdict, at.0, &functions, rounding);
        }
        for (surface, verdict) in touching.iter().zip(verdicts) {
            let old = self.places[*surface];
            let from = side_of_arrival(old, came_from[*surface]);
            let since = match old {
                SurfaceState::Holding { since, .. } => since,
                _ => at.0,
            };
            let new = match verdict {
                Verdict::Holds(_) => SurfaceState::Holding { from, since },
                Verdict::AtLimit(side) => SurfaceState::Bearing {
                    from,
                    side,
                    since: at.0,
                    allowed: self.find_allowed_errors(*surface),
                },
                Verdict::Releases(side) => {
                    let value = functions[*surface];
                    match side * value > 2.0 * roundings[*surface] {
                        true => SurfaceState::Free,
                        false => SurfaceState::Leaving {
                            side,
                            moved: roundings[*surface].max(-2.0 * side * value),
                        },
                    }
                }
            };
            self.places[*surface] = new;
            if let Some(kept) = &mut self.kept {
                kept[*surface] = verdict.sign().signum();
            }
        }
    }

    /// Sets the state of surfaces whose motion closed contacts stop. Returns the surfaces whose force acts on the
    /// motion, with their arrivals. Also returns the surfaces across which contacts move the motion, with the side.
    fn unload_stopped(
        &mut self,
        (touching, arrivals): (Vec<usize>, Vec<Arrival>),
        came_from: &[f64],
        (t, functions): (f64, &[f64]),
    ) -> (Vec<usize>, Vec<Arrival>, Vec<(usize, f64)>) {
        let reached = touching.into_iter().zip(arrivals);
        let (stopped, others): (Vec<_>, Vec<_>) =
            reached.partition(|(surface, _)| self.sided.is_stopped_by_contacts(*surface));
        let mut passing = Vec::new();
        for (surface, _) in stopped {
            let (place, function) = (self.places[surface], functions[surface]);
            let side = match place.is_moved_by_others((t, function)) {
                true => Some(function.signum()),
                false => self.sided.side_of_contact_motion(surface),
            };
            if let Some(side) = side {
                passing.push((surface, side));
                continue;
            }
            self.places[surface] = SurfaceState::Unloaded {
                from: side_of_arrival(place, came_from[surface]),
                since: t,
                allowed: self.find_allowed_errors(surface),
            };
        }
        let (touching, arrivals) = others.into_iter().unzip();
        (touching, arrivals, passing)
    }

    /// Returns the allowed errors of a surface's function while others stop the motion: constant part, and growth per
    /// second.
    fn find_allowed_errors(&self, surface: usize) -> [f64; 2] {
        let sizes = [self.sizes[surface], self.sided.own_effects[surface]];
        sizes.map(|size| self.tolerance * size)
    }

    /// Frees the surfaces at which the rates do not jump, and returns the others.
    fn free_without_jump(
        &mut self,
        (touching, arrivals): (&[usize], &[Arrival]),
        jumps: &[bool],
    ) -> (Vec<usize>, Vec<Arrival>) {
        let mut left = (Vec::new(), Vec::new());
        for ((surface, arrival), jumps) in touching.iter().zip(arrivals).zip(jumps) {
            if *jumps {
                left.0.push(*surface);
                left.1.push(*arrival);
                continue;
            }
            self.places[*surface] = SurfaceState::Free;
            if let Some(kept) = &mut self.kept {
                kept[*surface] = 0.0;
            }
        }
        left
    }
}
