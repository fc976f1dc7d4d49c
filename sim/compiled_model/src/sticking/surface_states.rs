//! States of surfaces along a motion, and the resulting rates, observables and guards.

use eomgen_codegen::program::evaluator::{Enclosure, Evaluator};
use eomgen_sim::contact_friction::ContactMode;
use eomgen_sim::ode::{SurfaceMode, difference_step};

use super::discs::{Disc, DiscState, norm};
use super::sided_model::SidedModel;
use super::surface_state::{SurfaceState, find_allowed};

/// Largest distance of a state from a surface that holds it, relative to the largest value of the switching function.
/// The state is corrected if it is farther than this distance from the surface.
pub(super) const MAX_DRIFT_FRACTION: f64 = 1e-12;

/// Additional distance, relative to the effect of the surface's own force on its function since the surface began to
/// hold the motion.
pub(super) const MAX_FORCE_DRIFT_FRACTION: f64 = 1e-13;

/// Change of a component of a unit vector, for a difference quotient of the rates.
const SIDE_DIFFERENCE: f64 = 1e-6;

/// Points at which the present sides of the model are valid.
pub(super) enum KnownSides {
    Nothing,
    /// One time (s) and state.
    At(f64, Vec<f64>),
    /// All points: no surface holds the motion, and all sides are fixed.
    Everywhere,
}

/// States of surfaces and discs, and the fixed sides.
pub(crate) struct SavedStates {
    places: Vec<SurfaceState>,
    discs: Vec<Disc>,
    kept: Option<Vec<f64>>,
}

/// States of all surfaces along a motion.
pub(crate) struct SurfaceStates {
    pub(super) sided: SidedModel,
    /// True if some surface can hold the motion.
    pub(super) can_hold: bool,
    /// Index of the guard of the first disc.
    pub(super) first_disc_guard: usize,
    pub(super) places: Vec<SurfaceState>,
    /// Friction discs.
    pub(super) discs: Vec<Disc>,
    pub(super) sizes: Vec<f64>,
    /// Relative tolerance of the states.
    pub(super) tolerance: f64,
    pub(super) begin: Option<f64>,
    /// Fixed sides of free surfaces, -1 or 1, which do not depend on the functions.
    pub(super) kept: Option<Vec<f64>>,
    pub(super) known: KnownSides,
    /// True if the states of surfaces were determined since the last call of [`SurfaceStates::take_decided`].
    pub(super) has_decided: bool,
    /// Held rows of surfaces and discs, and closed contacts, for which the implied guards were found.
    held: (Vec<usize>, Vec<(usize, ContactMode)>),
}

impl SurfaceStates {
    pub fn new(sided: SidedModel, tolerance: f64) -> Self {
        let count = sided.surface_count();
        Self {
            can_hold: sided.can_hold_motion(),
            first_disc_guard: sided.guard_count(),
            places: vec![SurfaceState::Free; count],
            discs: sided.discs().iter().cloned().map(Disc::new).collect(),
            sizes: vec![0.0; sided.side_count()],
            tolerance,
            begin: None,
            kept: None,
            known: KnownSides::Nothing,
            has_decided: false,
            held: (Vec::new(), Vec::new()),
            sided,
        }
    }

    /// Lets the motion cross all surfaces.
    pub fn disable_holding(&mut self) {
        self.can_hold = false;
    }

    /// Returns true if a surface can hold the motion.
    pub fn can_hold_motion(&self) -> bool {
        self.can_hold
    }

    /// Returns the guards of the surfaces that can hold the motion, without guards of discs.
    pub fn holding_guards(&self) -> Vec<usize> {
        let surfaces = 0..self.places.len();
        surfaces
            .map(|surface| self.sided.guard_index(surface))
            .collect()
    }

    /// Places the guards of discs after `count` guards of contacts.
    pub fn skip_contact_guards(&mut self, count: usize) {
        self.first_disc_guard = self.sided.guard_count() + count;
    }

    /// Sets the closed contacts with their modes; their forces act together with those of the surfaces. Returns true if
    /// they changed.
    pub fn set_closed_contacts(&mut self, closed: &[(usize, ContactMode)]) -> bool {
        if self.sided.closed_contacts() == closed {
            return false;
        }
        self.sided.set_closed_contacts(closed);
        self.known = KnownSides::Nothing;
        true
    }

    /// Returns true if the states of surfaces were determined since the last call of [`SurfaceStates::take_decided`].
    pub fn has_decided(&self) -> bool {
        self.has_decided
    }

    /// Returns true if the states of surfaces were determined since the last call of this function.
    pub fn take_decided(&mut self) -> bool {
        std::mem::take(&mut self.has_decided)
    }

    /// Returns the evaluator with the sides at a point, and its inputs: those of the model, followed by the sides.
    pub fn evaluator_with_sides(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
    ) -> (&mut Evaluator, &[f64]) {
        self.find_holding_sides(at, inputs);
        self.sided.evaluator_with_sides()
    }

    /// Returns the model with sides, for use with another motion.
    pub fn into_sided_model(self) -> SidedModel {
        self.sided
    }

    /// Returns true if the signs of the functions do not determine the rates.
    pub fn is_active(&self) -> bool {
        self.kept.is_some() || !self.discs.is_empty() || !self.is_free()
    }

    /// Writes the modes of the surfaces with sticking or breakaway.
    pub fn write_modes(&self, modes: &mut [SurfaceMode]) {
        for (surface, place) in self.places.iter().enumerate() {
            let slot = &mut modes[self.sided.guard_index(surface)];
            match place {
                SurfaceState::Leaving { side, .. } => *slot = SurfaceMode::from_side(*side),
                place if place.is_on() => *slot = SurfaceMode::Held,
                _ => {}
            }
        }
        let discs = &mut modes[self.first_disc_guard..];
        let holding = discs.iter_mut().zip(&self.discs);
        for (slot, _) in holding.filter(|(_, disc)| disc.is_holding()) {
            *slot = SurfaceMode::Held;
        }
    }

    /// Sets the surfaces and discs that hold the motion at the start, from the modes of all guards.
    pub fn assume_modes(&mut self, modes: &[SurfaceMode]) {
        if !self.can_hold {
            return;
        }
        for (surface, place) in self.places.iter_mut().enumerate() {
            if modes[self.sided.guard_index(surface)] == SurfaceMode::Held {
                // The first evaluation of the motion determines whether the surface exerts a force.
                *place = SurfaceState::Unloaded {
                    from: 1.0,
                    since: 0.0,
                    allowed: [0.0; 2],
                };
            }
        }
        let discs = self.discs.iter_mut().zip(&modes[self.first_disc_guard..]);
        for (disc, _) in discs.filter(|(_, mode)| **mode == SurfaceMode::Held) {
            disc.state = DiscState::Holding { since: 0.0 };
        }
    }

    /// Adds the rounding errors of the rates by the forces that hold the motion.
    pub fn add_rate_roundings(&self, out: &mut [f64]) {
        for row in self.list_holding_rows() {
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

    /// Returns true if the derivatives of the rates grow beyond all bounds towards the surface of a guard.
    pub fn is_singular(&self, guard: usize) -> bool {
        let disc = guard.checked_sub(self.first_disc_guard);
        let disc = disc.and_then(|disc| self.discs.get(disc));
        disc.is_some_and(Disc::is_singular)
    }

    pub fn disc_count(&self) -> usize {
        self.discs.len()
    }

    /// Fixes the sides of the guards: -1, 1, or 0 (unknown). With `None` the signs of the functions determine the
    /// sides.
    pub fn fix_sides(&mut self, sides: Option<&[f64]>) {
        self.known = KnownSides::Nothing;
        self.sided.fix_other_sides(sides);
        self.kept = sides.map(|sides| {
            let kept = |surface: usize| sides[self.sided.guard_index(surface)];
            (0..self.places.len()).map(kept).collect()
        });
    }

    /// Returns true if three conditions hold: no surface holds the motion, the sides at a point equal the fixed ones,
    /// and velocities determine their unit vectors.
    pub fn has_own_sides(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> bool {
        let kept = self.kept.clone().unwrap_or_default();
        if !self.is_free() || !self.sided.has_own_sides(at, inputs, &kept) {
            return false;
        }
        let functions = match self.discs.is_empty() {
            true => Vec::new(),
            false => self.sided.evaluate_functions(at, inputs),
        };
        let mut discs = self.discs.iter();
        discs.all(|disc| disc.has_own_direction(&functions))
    }

    /// Writes the rates, if [`SurfaceStates::is_active`].
    pub fn write_rates(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        self.find_holding_sides(at, inputs);
        self.sided.write_rates(at, inputs, out);
    }

    /// Writes the observables, if [`SurfaceStates::is_active`].
    pub fn write_observables(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        self.find_holding_sides(at, inputs);
        self.sided.write_observables(at, out);
    }

    /// Computes the derivatives of the rates with respect to the state by finite differences, if
    /// [`SurfaceStates::is_active`]. Sides and sticking remain unchanged. Unit vectors are differentiated exactly,
    /// because they turn within their velocity.
    pub fn write_jacobian(
        &mut self,
        (t, state): (f64, &[f64]),
        (inputs, typical_sizes): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let (sides, held) = (
            self.find_current_sides((t, state), inputs),
            self.list_holding_rows(),
        );
        self.known = KnownSides::Nothing;
        let count = state.len();
        let mut rates = |state: &[f64], sides: &[f64], out: &mut [f64]| {
            self.sided
                .find_holding_sides((t, state), inputs, sides, &held);
            self.sided.write_rates((t, state), inputs, out);
        };
        let (mut base, mut moved_rates) = (vec![0.0; count], vec![0.0; count]);
        rates(state, &sides, &mut base);
        let sliding = self.discs.iter().filter(|disc| !disc.is_holding());
        let turning: Vec<usize> = sliding.flat_map(|disc| disc.rows.clone()).collect();
        let mut by_sides = Vec::with_capacity(turning.len());
        for row in &turning {
            let mut turned = sides.clone();
            turned[*row] += SIDE_DIFFERENCE;
            rates(state, &turned, &mut moved_rates);
            let changes = moved_rates.iter().zip(&base);
            by_sides.push(
                changes
                    .map(|(a, b)| (a - b) / SIDE_DIFFERENCE)
                    .collect::<Vec<f64>>(),
            );
        }
        let mut moved = state.to_vec();
        let mut steps = vec![0.0; count];
        for column in 0..count {
            moved[column] = state[column] + difference_step(state[column], typical_sizes[column]);
            rates(&moved, &sides, &mut moved_rates);
            steps[column] = moved[column] - state[column];
            for row in 0..count {
                out[row * count + column] = (moved_rates[row] - base[row]) / steps[column];
            }
            moved[column] = state[column];
        }
        if turning.is_empty() {
            return;
        }
        let functions = self.sided.evaluate_functions((t, state), inputs);
        for (column, step) in steps.iter().enumerate() {
            moved[column] = state[column] + step;
            let there = self.sided.evaluate_functions((t, &moved), inputs);
            moved[column] = state[column];
            let change = there.iter().zip(&functions);
            let change: Vec<f64> = change.map(|(a, b)| (a - b) / step).collect();
            let sliding = self.discs.iter().filter(|disc| !disc.is_holding());
            let turned = sliding.flat_map(|disc| {
                disc.change_of_sides(&functions, self.kept.is_some(), disc.velocity(&change))
            });
            for (turned, by_side) in turned.zip(&by_sides) {
                for (row, effect) in by_side.iter().enumerate() {
                    out[row * count + column] += effect * turned;
                }
            }
        }
    }

    /// Replaces the guards `out` of surfaces with sticking or breakaway; the first call starts the motion. The
    /// guard of a surface that holds the motion changes its sign when its force reaches a limit. If contacts or other
    /// surfaces stop the motion at a surface, its guard changes its sign when they move it.
    pub fn write_guards(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        if !self.can_hold {
            return;
        }
        if self.begin.is_none() {
            self.start_motion(at, inputs);
        }
        self.write_disc_guards(at, inputs, out);
        self.update_implied_guards();
        for guard in &self.sided.implied_guards {
            out[*guard] = 0.0;
        }
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
                SurfaceState::Unloaded {
                    from,
                    since,
                    allowed,
                }
                | SurfaceState::Bearing {
                    from,
                    since,
                    allowed,
                    ..
                } => *slot = from * (find_allowed(allowed, at.0 - since) - slot.abs()),
                SurfaceState::Leaving { side, moved } => *slot += side * moved,
            }
        }
    }

    /// Finds the guards that vanish with the functions of the surfaces and discs that hold the motion.
    fn update_implied_guards(&mut self) {
        let surfaces = 0..self.places.len();
        let surfaces = surfaces.filter(|surface| self.places[*surface].is_on());
        let discs = self.discs.iter().filter(|disc| disc.is_holding());
        let rows = surfaces.chain(discs.flat_map(|disc| disc.rows.clone()));
        let held = (rows.collect(), self.sided.closed_contacts().to_vec());
        if held != self.held {
            self.sided.find_implied_guards(&held.0);
            self.held = held;
        }
    }

    /// Returns true if surfaces that hold the motion, together with closed contacts, keep the distance of a contact
    /// constant.
    pub fn keeps_distance(&mut self, contact: usize) -> bool {
        self.update_implied_guards();
        self.sided.implied_contacts.contains(&contact)
    }

    /// Returns the states of surfaces and discs, for [`SurfaceStates::restore`].
    pub fn save(&self) -> SavedStates {
        SavedStates {
            places: self.places.clone(),
            discs: self.discs.clone(),
            kept: self.kept.clone(),
        }
    }

    /// Restores states of surfaces and discs.
    pub fn restore(&mut self, saved: SavedStates) {
        let SavedStates {
            places,
            discs,
            kept,
        } = saved;
        (self.places, self.discs, self.kept) = (places, discs, kept);
        self.known = KnownSides::Nothing;
    }

    /// Replaces the bounds of guards in the same way as [`SurfaceStates::write_guards`]. The bounds for surfaces that
    /// hold the motion are unknown.
    pub fn bound_guards(&self, out: &mut [Enclosure]) {
        for guard in &self.sided.implied_guards {
            out[*guard] = Enclosure::UNKNOWN;
        }
        for (surface, place) in self.places.iter().enumerate() {
            let slot = &mut out[self.sided.guard_index(surface)];
            match *place {
                SurfaceState::Free => {}
                SurfaceState::Holding { .. }
                | SurfaceState::Unloaded { .. }
                | SurfaceState::Bearing { .. } => *slot = Enclosure::UNKNOWN,
                SurfaceState::Leaving { side, moved } => {
                    *slot = slot.add_enclosure(Enclosure::constant(side * moved));
                }
            }
        }
        if let Some(discs) = out.get_mut(self.first_disc_guard..) {
            discs.fill(Enclosure::UNKNOWN);
        }
    }

    /// Writes the guards of discs. The guard of a disc that holds the motion becomes negative when its force reaches
    /// the limit.
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
                true => 1.0 - norm(&sides[disc.rows.clone()]),
                false => disc.guard(&functions),
            };
        }
    }
}
