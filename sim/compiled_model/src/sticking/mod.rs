//! Sticking on switching surfaces, as under dry friction. On a surface v = 0, sign(v) is replaced
//! by the number between -1 and 1 that keeps v at zero, if there is one (A. F. Filippov; for
//! friction, J. J. Moreau).
//!
//! [`eomgen_sim::sliding_modes`] decides which of several surfaces hold. `sided` is the model with
//! given sides of its surfaces, and `observed_motion` computes observables and rates during sticking.
//! This module follows the surfaces along a motion. A surface holds the motion from its arrival
//! until the force reaches the limit of the surface. At the release, the switching function and
//! its rate are zero up to rounding, which must not determine the side; so the surface is
//! displaced by that rounding until the motion has left it. `discs` does the same for friction in
//! several directions.

mod contact_balance;
mod discs;
mod observed_motion;
mod sided_model;

pub(crate) use observed_motion::ObservedMotion;
pub use observed_motion::StickingMotion;
pub use sided_model::SidedModel;

use eomgen_codegen::program::evaluator::{Enclosure, Evaluator};
use eomgen_sim::friction_discs::DiscArrival;
use eomgen_sim::ode::{SurfaceMode, difference_step};
use eomgen_sim::sliding_modes::{Arrival, Verdict};

use discs::{Disc, DiscState, norm, unit_vector};
use sided_model::CORRECTION_COUNT;

/// Largest distance of a state from a surface that holds it, relative to the largest value of the
/// switching function. Beyond it the state is corrected.
const MAX_DRIFT_FRACTION: f64 = 1e-12;

/// Additional distance, relative to the effect of the surface's own force on its function since
/// the surface holds.
const MAX_FORCE_DRIFT_FRACTION: f64 = 1e-13;

/// Largest distance of other surfaces that count as reached, relative to the change of their
/// functions in the step across a surface.
const NEAR_MOVE_FACTOR: f64 = 4.0;

/// Limit of that distance, relative to the largest value of the function.
const MAX_NEAR_FRACTION: f64 = 1e-9;

/// Largest velocity that turns by more than 90 degrees within a step and counts as zero, relative to the
/// largest velocity. Friction that can hold such a motion stops it at once.
const MAX_SLOW_FRACTION: f64 = 1e-8;

/// Arrival on a surface on which the motion already is.
const ARRIVAL_AT_REST: Arrival = Arrival {
    side: 1.0,
    exceeds_limit: false,
};

/// Surfaces on which a motion is with their arrivals, and discs with theirs.
type Reached<'r> = (&'r [usize], &'r [Arrival], &'r [(usize, DiscArrival)]);

/// State of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SurfaceState {
    /// The sign of the function determines the side.
    Free,
    /// The surface holds the motion, which came from this side, -1 or 1, at this time, s.
    Holding { from: f64, since: f64 },
    /// The surface exerts its largest force to this side, and other surfaces hold the motion.
    Bearing { from: f64, side: f64 },
    /// Closed contacts stop the motion, and the surface exerts no force.
    Unloaded { from: f64 },
    /// The surface has released the motion to this side, but its function is still within
    /// rounding; the surface is displaced by `moved`.
    Leaving { side: f64, moved: f64 },
}

impl SurfaceState {
    fn is_on(self) -> bool {
        matches!(
            self,
            Self::Holding { .. } | Self::Bearing { .. } | Self::Unloaded { .. }
        )
    }

    /// Returns the side from which the motion came, if the surface holds it.
    fn came_from(self) -> Option<f64> {
        match self {
            Self::Holding { from, .. } | Self::Bearing { from, .. } | Self::Unloaded { from } => {
                Some(from)
            }
            Self::Free | Self::Leaving { .. } => None,
        }
    }

    /// Returns the displacement of the surface until the motion has left it.
    fn displacement(self) -> f64 {
        match self {
            Self::Leaving { side, moved } => side * moved,
            Self::Free | Self::Holding { .. } | Self::Bearing { .. } | Self::Unloaded { .. } => 0.0,
        }
    }
}

/// Points at which the sides of the model are right.
enum KnownSides {
    Nothing,
    /// At this time (s) and state.
    At(f64, Vec<f64>),
    /// Everywhere: no surface holds the motion, and all sides are fixed.
    Everywhere,
}

/// States of all surfaces along a motion.
pub(crate) struct SurfaceStates {
    sided: SidedModel,
    /// False if no surface can hold the motion.
    can_hold: bool,
    /// False while closed contacts exert forces, which the sides that hold the motion do not balance.
    may_hold: bool,
    /// Index of the guard of the first disc.
    first_disc_guard: usize,
    places: Vec<SurfaceState>,
    /// Frictions against the direction of sliding.
    discs: Vec<Disc>,
    /// True if the rates had no jump on a surface at the last arrival; then the sign of its
    /// function determines the side.
    is_jumpless: Vec<bool>,
    sizes: Vec<f64>,
    begin: Option<f64>,
    /// Fixed sides, -1 or 1, of free surfaces, independent of their functions.
    kept: Option<Vec<f64>>,
    known: KnownSides,
}

impl SurfaceStates {
    pub fn new(sided: SidedModel) -> Self {
        let count = sided.surface_count();
        Self {
            can_hold: sided.can_hold_motion(),
            may_hold: sided.can_hold_motion(),
            first_disc_guard: sided.guard_count(),
            places: vec![SurfaceState::Free; count],
            is_jumpless: vec![false; count],
            discs: sided.discs().iter().cloned().map(Disc::new).collect(),
            sizes: vec![0.0; sided.side_count()],
            begin: None,
            kept: None,
            known: KnownSides::Nothing,
            sided,
        }
    }

    /// Lets the motion cross all surfaces.
    pub fn disable_holding(&mut self) {
        (self.can_hold, self.may_hold) = (false, false);
    }

    /// Places the guards of discs behind those of so many contacts.
    pub fn skip_contact_guards(&mut self, count: usize) {
        self.first_disc_guard = self.sided.guard_count() + count;
    }

    /// Sets the closed contacts, whose forces act with those of the surfaces. With `None` forces of closed contacts are
    /// not known, and the motion crosses all surfaces. Returns true if the contacts changed.
    pub fn set_closed_contacts(&mut self, closed: Option<&[usize]>) -> bool {
        let may_hold = self.can_hold && closed.is_some();
        if self.may_hold && !may_hold {
            self.places.fill(SurfaceState::Free);
            self.discs
                .iter_mut()
                .for_each(|disc| disc.state = DiscState::Sliding);
        }
        let closed = closed.unwrap_or_default();
        if self.may_hold == may_hold && self.sided.closed_contacts() == closed {
            return false;
        }
        self.may_hold = may_hold;
        self.sided.set_closed_contacts(closed);
        self.known = KnownSides::Nothing;
        true
    }

    /// Returns the evaluator with the sides at a point, and its inputs: those of the model and the sides.
    pub fn evaluator_with_sides(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
    ) -> (&mut Evaluator, &[f64]) {
        self.find_holding_sides(at, inputs);
        self.sided.evaluator_with_sides()
    }

    /// Decides the effect of all surfaces on which the motion is, after rates jumped or contacts changed.
    pub fn decide_again(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        if !self.may_hold || self.begin.is_none() {
            return;
        }
        self.release_moved(at, inputs);
        let functions = self.sided.evaluate_functions(at, inputs);
        let roundings = self.sided.function_roundings(at, inputs);
        let touches = |surface: &usize| {
            let allowed = roundings[*surface] + MAX_DRIFT_FRACTION * self.sizes[*surface];
            self.places[*surface].is_on() || functions[*surface].abs() <= allowed
        };
        let touching: Vec<usize> = (0..self.places.len()).filter(touches).collect();
        let discs = self.held_discs(at, inputs);
        if touching.is_empty() && discs.is_empty() {
            return;
        }
        let came_from = self.arrival_sides(&functions);
        let arrivals = vec![ARRIVAL_AT_REST; touching.len()];
        self.decide_states(at, inputs, (&touching, &arrivals, &discs), &came_from);
    }

    /// Returns the model with sides, for use with another motion.
    pub fn into_sided_model(self) -> SidedModel {
        self.sided
    }

    /// Returns true if the signs of the functions do not determine the rates.
    pub fn is_active(&self) -> bool {
        self.kept.is_some() || !self.discs.is_empty() || !self.is_free()
    }

    /// Writes the modes of the surfaces that hold or release the motion.
    pub fn write_modes(&self, modes: &mut [SurfaceMode]) {
        for (surface, place) in self.places.iter().enumerate() {
            let slot = &mut modes[self.sided.guard_index(surface)];
            match place {
                SurfaceState::Free => {}
                SurfaceState::Holding { .. }
                | SurfaceState::Bearing { .. }
                | SurfaceState::Unloaded { .. } => {
                    *slot = SurfaceMode::Held;
                }
                SurfaceState::Leaving { side, .. } => *slot = SurfaceMode::from_side(*side),
            }
        }
        let discs = &mut modes[self.first_disc_guard..];
        let holding = discs.iter_mut().zip(&self.discs);
        for (slot, _) in holding.filter(|(_, disc)| disc.is_holding()) {
            *slot = SurfaceMode::Held;
        }
    }

    /// Adds the roundings of the rates by the forces that hold the motion.
    pub fn add_rate_roundings(&self, out: &mut [f64]) {
        for row in self.holding_rows() {
            self.sided.add_rate_rounding(row, out);
        }
    }

    /// Returns true if the motion is on no surface and has left all surfaces.
    pub fn is_free(&self) -> bool {
        self.places.iter().all(|place| *place == SurfaceState::Free)
            && self
                .discs
                .iter()
                .all(|disc| disc.state == DiscState::Sliding)
    }

    /// Returns the formulas of the speeds of the discs, whose guards follow those of the model.
    pub fn disc_formulas(&self) -> Vec<String> {
        self.sided.disc_formulas()
    }

    /// Returns true if the derivatives of the rates grow without bound towards the surface of a guard.
    pub fn is_singular(&self, guard: usize) -> bool {
        let disc = guard.checked_sub(self.first_disc_guard);
        let disc = disc.and_then(|disc| self.discs.get(disc));
        disc.is_some_and(Disc::is_singular)
    }

    pub fn disc_count(&self) -> usize {
        self.discs.len()
    }

    /// Fixes the sides of the guards, -1, 1, or 0 (unknown); `None` restores the signs. Surfaces
    /// without a jump are not fixed, because their rates beyond the surface may lead away from it.
    pub fn fix_sides(&mut self, sides: Option<&[f64]>) {
        self.known = KnownSides::Nothing;
        self.sided.fix_other_sides(sides);
        self.kept = sides.map(|sides| {
            let kept = |surface: usize| match self.is_jumpless[surface] {
                true => 0.0,
                false => sides[self.sided.guard_index(surface)],
            };
            (0..self.places.len()).map(kept).collect()
        });
    }

    /// Returns true if no surface holds the motion and the sides at a point are the fixed ones.
    pub fn has_own_sides(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> bool {
        let kept = self.kept.clone().unwrap_or_default();
        self.is_free() && self.sided.has_own_sides(at, inputs, &kept)
    }

    /// Writes the rates, if this is active.
    pub fn write_rates(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        self.find_holding_sides(at, inputs);
        self.sided.write_rates(at, inputs, out);
    }

    /// Writes the observables, if this is active.
    pub fn write_observables(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        self.find_holding_sides(at, inputs);
        self.sided.write_observables(at, out);
    }

    /// Computes the derivatives of the rates with respect to the state by finite differences, if
    /// this is active. Sides and sticking remain unchanged.
    pub fn write_jacobian(
        &mut self,
        (t, state): (f64, &[f64]),
        (inputs, typical_sizes): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let (mut sides, held) = (self.current_sides((t, state), inputs), self.holding_rows());
        self.known = KnownSides::Nothing;
        let count = state.len();
        let mut rates = |state: &[f64], out: &mut [f64]| {
            if !self.discs.iter().any(Disc::is_leaving) {
                sides.truncate(self.places.len());
                self.append_disc_sides((t, state), inputs, &mut sides);
            }
            self.sided
                .find_holding_sides((t, state), inputs, &sides, &held);
            self.sided.write_rates((t, state), inputs, out);
        };
        let (mut base, mut moved_rates) = (vec![0.0; count], vec![0.0; count]);
        rates(state, &mut base);
        let mut moved = state.to_vec();
        for column in 0..count {
            moved[column] = state[column] + difference_step(state[column], typical_sizes[column]);
            rates(&moved, &mut moved_rates);
            let step = moved[column] - state[column];
            for row in 0..count {
                out[row * count + column] = (moved_rates[row] - base[row]) / step;
            }
            moved[column] = state[column];
        }
    }

    /// Replaces the guards `out` of surfaces that hold or release the motion; the first call
    /// starts the motion. The guard of a surface that holds changes its sign if its force reaches
    /// a limit.
    pub fn write_guards(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        if !self.may_hold {
            return;
        }
        if self.begin.is_none() {
            self.start_motion(at, inputs);
        }
        self.write_disc_guards(at, inputs, out);
        if self.is_free() {
            return;
        }
        self.find_holding_sides(at, inputs);
        for (surface, place) in self.places.iter().enumerate() {
            let slot = &mut out[self.sided.guard_index(surface)];
            let side = self.sided.sides()[surface];
            match *place {
                SurfaceState::Free => {}
                SurfaceState::Holding { from, .. } => *slot = from * 4.0 * side * (1.0 - side),
                SurfaceState::Bearing { from, .. } | SurfaceState::Unloaded { from } => {
                    *slot = from;
                }
                SurfaceState::Leaving { side, moved } => *slot += side * moved,
            }
        }
    }

    /// Replaces the bounds of guards as [`SurfaceStates::write_guards`] replaces the guards. Those of
    /// surfaces that hold are unknown.
    pub fn bound_guards(&self, out: &mut [Enclosure]) {
        for (surface, place) in self.places.iter().enumerate() {
            let slot = &mut out[self.sided.guard_index(surface)];
            match *place {
                SurfaceState::Free => {}
                SurfaceState::Holding { .. } => *slot = Enclosure::UNKNOWN,
                SurfaceState::Bearing { from, .. } | SurfaceState::Unloaded { from } => {
                    *slot = Enclosure::constant(from);
                }
                SurfaceState::Leaving { side, moved } => {
                    *slot = slot.add_enclosure(Enclosure::constant(side * moved));
                }
            }
        }
        if let Some(discs) = out.get_mut(self.first_disc_guard..) {
            discs.fill(Enclosure::UNKNOWN);
        }
    }

    /// Writes the guards of discs. While a disc holds, its guard becomes negative if its force
    /// reaches the limit.
    fn write_disc_guards(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        if self.discs.is_empty() {
            return;
        }
        self.find_holding_sides(at, inputs);
        let sides = self.sided.sides().to_vec();
        let functions = self.sided.evaluate_functions(at, inputs);
        let slots = &mut out[self.first_disc_guard..];
        for (slot, disc) in slots.iter_mut().zip(&self.discs) {
            *slot = match disc.is_holding() {
                true => 1.0 - norm(&signs(&sides[disc.rows.clone()])),
                false => disc.guard(&functions),
            };
        }
    }

    /// Decides the state of all surfaces that the motion reached. `before` is on the near side of
    /// a surface, `t` and `state` just beyond it.
    pub fn apply_crossing(
        &mut self,
        inputs: &[f64],
        (t_before, before): (f64, &[f64]),
        t: f64,
        state: &mut [f64],
    ) {
        if !self.may_hold {
            return;
        }
        let fixed = self.sided.release_other_sides();
        self.reach_surfaces(inputs, (t_before, before), t, state);
        self.sided.restore_other_sides(fixed);
        self.known = KnownSides::Nothing;
    }

    /// Decides like [`SurfaceStates::apply_crossing`], with the sides of other surfaces at the state.
    fn reach_surfaces(
        &mut self,
        inputs: &[f64],
        (t_before, before): (f64, &[f64]),
        t: f64,
        state: &mut [f64],
    ) {
        let near = self.sided.evaluate_functions((t_before, before), inputs);
        let beyond = self.sided.evaluate_functions((t, state), inputs);
        let roundings = self.sided.function_roundings((t, state), inputs);
        let mut is_new = false;
        let mut touching = Vec::new();
        let mut arrivals = Vec::new();
        let overcome = self.find_overcome((t, state), inputs);
        let came_from = self.arrival_sides(&near);
        for (surface, place) in self.places.iter().enumerate() {
            let (from, to) = (near[surface], beyond[surface]);
            let moved = place.displacement();
            let is_crossed = came_from[surface] * (to + moved) < 0.0;
            let near = NEAR_MOVE_FACTOR * (to - from).abs();
            let near = near.min(MAX_NEAR_FRACTION * self.sizes[surface]) + roundings[surface];
            let is_near = to.abs() <= near;
            if place.is_on() || is_crossed || (is_near && *place == SurfaceState::Free) {
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
        let discs = self.disc_arrivals((t, state), inputs, (&near, &beyond));
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

    /// Releases the motion from surfaces that a jump of the rates moved it away from.
    pub fn release_moved(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        let functions = self.sided.evaluate_functions(at, inputs);
        let roundings = self.sided.function_roundings(at, inputs);
        for (surface, place) in self.places.iter_mut().enumerate() {
            let value = functions[surface];
            let allowed = roundings[surface] + MAX_DRIFT_FRACTION * self.sizes[surface];
            if *place != SurfaceState::Free && value.abs() > allowed {
                *place = SurfaceState::Free;
            }
        }
        self.known = KnownSides::Nothing;
    }

    /// Returns the discs that hold the motion, and those whose velocity came to zero between two
    /// values of the functions. A velocity that passed zero at a distance has turned; it gets a new
    /// reference.
    fn disc_arrivals(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        (near, beyond): (&[f64], &[f64]),
    ) -> Vec<(usize, DiscArrival)> {
        let mut found = self.held_discs((t, state), inputs);
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
                true => MAX_SLOW_FRACTION * size,
                false => most.min(NEAR_MOVE_FACTOR * norm(&moved)),
            };
            if norm(velocity) <= reach + norm(disc.velocity(&roundings)) {
                found.push((
                    index,
                    DiscArrival {
                        rows: disc.rows.clone(),
                        along: disc.along.clone(),
                        exceeds_limit: false,
                    },
                ));
            } else if has_passed {
                disc.state = DiscState::Sliding;
                disc.follow(beyond);
                self.known = KnownSides::Nothing;
            }
        }
        found
    }

    /// Returns the discs that hold the motion; their force may exceed its limit.
    fn held_discs(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<(usize, DiscArrival)> {
        if !self.discs.iter().any(Disc::is_holding) {
            return Vec::new();
        }
        self.find_holding_sides(at, inputs);
        let sides = self.sided.sides();
        let holding = self.discs.iter().enumerate();
        let holding = holding.filter(|(_, disc)| disc.is_holding());
        let arrivals = holding.map(|(index, disc)| {
            let needed = signs(&sides[disc.rows.clone()]);
            let arrival = DiscArrival {
                rows: disc.rows.clone(),
                along: unit_vector(&needed, Some(&disc.along)),
                exceeds_limit: norm(&needed) > 1.0,
            };
            (index, arrival)
        });
        arrivals.collect()
    }

    /// Returns the sides, -1 or 1, from which the motion came, given the values of the functions.
    /// If a function is exactly zero, its fixed side counts.
    fn arrival_sides(&self, near: &[f64]) -> Vec<f64> {
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

    /// Corrects a state that drifted from the surfaces that hold it; returns the number of
    /// evaluations.
    pub fn correct_state(&mut self, t: f64, inputs: &[f64], state: &mut [f64]) -> u64 {
        self.correct_onto_surfaces((t, state), inputs, false)
    }

    /// Updates the surfaces at a point, at which inputs may jump from `earlier`: releases the
    /// motion if an input moves a surface away or a force exceeds its limit.
    pub fn update(&mut self, at: (f64, &[f64]), (earlier, inputs): (&[f64], &[f64])) {
        if !self.may_hold {
            return;
        }
        self.sided.fix_other_sides(None);
        self.known = KnownSides::Nothing;
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
                    SurfaceState::Leaving { side, moved } => side * value > 2.0 * moved,
                    _ => jumps[surface],
                };
                if has_left && *place != SurfaceState::Free {
                    *place = SurfaceState::Free;
                    self.known = KnownSides::Nothing;
                }
            }
            for _ in 0..=self.places.len() {
                let overcome = self.find_overcome(at, inputs);
                let discs = self.held_discs(at, inputs);
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
        for (size, value) in self.sizes.iter_mut().zip(&functions) {
            *size = size.max(value.abs());
        }
        for disc in &mut self.discs {
            disc.floor = MAX_DRIFT_FRACTION * norm(disc.velocity(&self.sizes));
        }
    }

    /// Starts a motion: surfaces on which it is may hold it.
    fn start_motion(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        self.begin = Some(at.0);
        let functions = self.sided.evaluate_functions(at, inputs);
        let roundings = self.sided.function_roundings(at, inputs);
        let touching: Vec<usize> = (0..self.places.len())
            .filter(|surface| functions[*surface].abs() <= roundings[*surface])
            .collect();
        let mut discs = Vec::new();
        for (index, disc) in self.discs.iter_mut().enumerate() {
            disc.follow(&functions);
            if norm(disc.velocity(&functions)) <= norm(disc.velocity(&roundings)) {
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

    /// Returns the surfaces whose force exceeds its limit, with the side.
    fn find_overcome(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<Option<Arrival>> {
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

    /// Decides the states of the surfaces `touching` and of discs, on which the motion is. It came
    /// from the sides with these signs of the functions.
    fn decide_states(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
        (touching, arrivals, discs): Reached<'_>,
        came_from: &[f64],
    ) {
        self.known = KnownSides::Nothing;
        let sides = self.current_sides(at, inputs);
        let jumps = self.sided.has_jumps(at, inputs, touching, &sides);
        let (touching, arrivals) = self.free_without_jump((touching, arrivals), &jumps);
        let (touching, arrivals) = self.unload_stopped((touching, arrivals), came_from);
        let arrived: Vec<DiscArrival> = discs.iter().map(|(_, arrival)| arrival.clone()).collect();
        let asked = (&touching[..], &arrivals[..], &arrived[..]);
        let Some((verdicts, vectors)) = self.sided.decide(at, inputs, asked, &sides) else {
            // The functions decide, and the solver reports chattering.
            for surface in touching {
                self.places[surface] = SurfaceState::Free;
            }
            for (index, arrival) in discs {
                let disc = &mut self.discs[*index];
                disc.state = DiscState::Sliding;
                disc.along.clone_from(&arrival.along);
            }
            return;
        };
        let functions = self.sided.evaluate_functions(at, inputs);
        let mut roundings = self.sided.function_roundings(at, inputs);
        let passed = self.begin.map_or(0.0, |begin| at.0 - begin);
        for (surface, rounding) in roundings.iter_mut().enumerate() {
            // A rate of rounding, accumulated over time.
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
                Verdict::AtLimit(side) => SurfaceState::Bearing { from, side },
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

    /// Enters rest at the surfaces whose motion closed contacts stop, and returns the others.
    fn unload_stopped(
        &mut self,
        (touching, arrivals): (Vec<usize>, Vec<Arrival>),
        came_from: &[f64],
    ) -> (Vec<usize>, Vec<Arrival>) {
        let reached = touching.into_iter().zip(arrivals);
        let (stopped, others): (Vec<_>, Vec<_>) =
            reached.partition(|(surface, _)| self.sided.is_stopped_by_contacts(*surface));
        for (surface, _) in stopped {
            let from = side_of_arrival(self.places[surface], came_from[surface]);
            self.places[surface] = SurfaceState::Unloaded { from };
        }
        others.into_iter().unzip()
    }

    /// Frees the surfaces without a jump of the rates and returns the others.
    fn free_without_jump(
        &mut self,
        (touching, arrivals): (&[usize], &[Arrival]),
        jumps: &[bool],
    ) -> (Vec<usize>, Vec<Arrival>) {
        let mut left = (Vec::new(), Vec::new());
        for ((surface, arrival), jumps) in touching.iter().zip(arrivals).zip(jumps) {
            self.is_jumpless[*surface] = !jumps;
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

    /// Returns the sides of all surfaces at a point, 0.5 for those that hold. Functions are
    /// evaluated only if needed.
    fn current_sides(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<f64> {
        let kept = self.kept.clone().unwrap_or_default();
        let mut functions = Vec::new();
        let mut sides = Vec::with_capacity(self.places.len());
        for (surface, place) in self.places.iter().enumerate() {
            let kept = kept.get(surface).filter(|side| **side != 0.0);
            let moved = match (*place, kept) {
                (SurfaceState::Holding { .. } | SurfaceState::Unloaded { .. }, _) => {
                    sides.push(0.5);
                    continue;
                }
                (SurfaceState::Bearing { side, .. }, _)
                | (SurfaceState::Leaving { side, .. }, Some(_)) => {
                    sides.push(0.5 + 0.5 * side);
                    continue;
                }
                (SurfaceState::Free, Some(side)) => {
                    sides.push(0.5 + 0.5 * side);
                    continue;
                }
                (SurfaceState::Free | SurfaceState::Leaving { .. }, None) => place.displacement(),
            };
            if functions.is_empty() {
                functions = self.sided.evaluate_functions(at, inputs);
            }
            sides.push(
                self.sided
                    .side_at_value(surface, functions[surface] + moved),
            );
        }
        self.append_disc_sides(at, inputs, &mut sides);
        sides
    }

    /// Appends the sides of the components of discs at a point.
    fn append_disc_sides(&mut self, at: (f64, &[f64]), inputs: &[f64], sides: &mut Vec<f64>) {
        let functions = match self.discs.iter().all(Disc::is_holding) {
            true => Vec::new(),
            false => self.sided.evaluate_functions(at, inputs),
        };
        for disc in &self.discs {
            disc.write_sides(&functions, self.kept.is_some(), sides);
        }
    }

    /// Returns the surfaces that hold, and the rows of the discs that hold.
    fn holding_rows(&self) -> Vec<usize> {
        let holds = |surface: &usize| matches!(self.places[*surface], SurfaceState::Holding { .. });
        let discs = self.discs.iter().filter(|disc| disc.is_holding());
        let surfaces = (0..self.places.len()).filter(holds);
        surfaces
            .chain(discs.flat_map(|disc| disc.rows.clone()))
            .collect()
    }

    /// Returns the time since which the surface or the disc of a row holds, s.
    fn held_since(&self, row: usize) -> Option<f64> {
        if let Some(place) = self.places.get(row) {
            return match place {
                SurfaceState::Holding { since, .. } => Some(*since),
                _ => None,
            };
        }
        let disc = self.discs.iter().find(|disc| disc.rows.contains(&row))?;
        match disc.state {
            DiscState::Holding { since } => Some(since),
            _ => None,
        }
    }

    /// Computes the sides that hold the motion at a point.
    fn find_holding_sides(&mut self, (t, state): (f64, &[f64]), inputs: &[f64]) {
        match &self.known {
            KnownSides::Everywhere => {
                self.sided.set_model_inputs(inputs);
                return;
            }
            KnownSides::At(known, at) if *known == t && at == state => return,
            KnownSides::At(..) | KnownSides::Nothing => {}
        }
        let (sides, held) = (self.current_sides((t, state), inputs), self.holding_rows());
        self.sided
            .find_holding_sides((t, state), inputs, &sides, &held);
        if self.are_sides_fixed() {
            self.known = KnownSides::Everywhere;
            return;
        }
        match &mut self.known {
            KnownSides::At(known, at) => {
                *known = t;
                at.copy_from_slice(state);
            }
            known => *known = KnownSides::At(t, state.to_vec()),
        }
    }

    /// Returns true if no side depends on the state.
    fn are_sides_fixed(&self) -> bool {
        let is_fixed = |side: &f64| *side != 0.0;
        let kept = self.kept.as_ref();
        self.discs.is_empty()
            && self.places.iter().all(|place| *place == SurfaceState::Free)
            && kept.is_some_and(|kept| kept.iter().all(is_fixed))
            && self.sided.are_other_sides_fixed()
    }

    /// Corrects a state onto the surfaces that hold it, if it has drifted or `always`.
    fn correct_onto_surfaces(
        &mut self,
        (t, state): (f64, &mut [f64]),
        inputs: &[f64],
        always: bool,
    ) -> u64 {
        let held = self.holding_rows();
        if held.is_empty() {
            return 0;
        }
        let values = self.sided.evaluate_functions((t, state), inputs);
        let has_strayed = |surface: &usize| {
            let Some(since) = self.held_since(*surface) else {
                return false;
            };
            let by_force = self.sided.own_force_rate(*surface) * (t - since).abs();
            let allowed =
                MAX_DRIFT_FRACTION * self.sizes[*surface] + MAX_FORCE_DRIFT_FRACTION * by_force;
            values[*surface].abs() > allowed
        };
        if !always && !held.iter().any(has_strayed) {
            return 0;
        }
        self.find_holding_sides((t, state), inputs);
        self.known = KnownSides::Nothing;
        for _ in 0..CORRECTION_COUNT {
            let values = self.sided.evaluate_functions((t, state), inputs);
            self.sided.move_onto_surfaces(t, state, (&held, &values));
        }
        CORRECTION_COUNT as u64
    }
}

/// Returns the side, -1 or 1, from which a motion came to a surface in this state, given the sign of its function.
fn side_of_arrival(state: SurfaceState, sign: f64) -> f64 {
    let by_sign = if sign < 0.0 { -1.0 } else { 1.0 };
    state.came_from().unwrap_or(by_sign)
}

/// Returns the components -1 to 1 of these sides.
fn signs(sides: &[f64]) -> Vec<f64> {
    sides.iter().map(|side| 2.0 * side - 1.0).collect()
}
