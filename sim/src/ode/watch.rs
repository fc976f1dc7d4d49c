//! A system during a simulation: sides of its switching surfaces, number of evaluations, and rates that are not
//! finite.

use std::cell::{Cell, RefCell};
use std::cmp::Ordering;

use eomgen_codegen::program::evaluator::Enclosure;

use super::events::SurfaceMode;
use super::point::Point;
use super::root_band::{GuardHistory, RootBand, has_band};
use super::settings::UNMOVED_SIZE_FRACTION;
use super::system::{Interior, ObservedStep, System};

/// Smallest distance to a surface, in roundings, of a state whose projection must stay on one side: later
/// projections move the state by rounding.
const MIN_DISTANCE_ROUNDINGS: f64 = 16.0;

/// Side of every switching surface: -1, 1, or 0 if a step begins on it.
pub type Regime = Vec<f64>;

/// A system with the bookkeeping of a simulation.
pub struct WatchedSystem<'a, S: System + ?Sized> {
    system: &'a S,
    record: WatchState,
}

/// Regime of the current step, and errors of its trial steps.
#[derive(Default)]
pub struct WatchState {
    regime: RefCell<Regime>,
    horizon: Cell<f64>,
    not_finite: Cell<Option<usize>>,
    indefinite: Cell<Option<usize>>,
    evaluations: Cell<u64>,
    /// True while rates are evaluated on the actual side of each state.
    has_released_sides: Cell<bool>,
    /// Last nonzero side of every surface.
    last_sides: RefCell<Regime>,
    /// Bands around surfaces close to the current point near which the rates grow as a root.
    bands: RefCell<Vec<RootBand>>,
    /// History of each switching function.
    histories: RefCell<Vec<GuardHistory>>,
}

impl<'a, S: System + ?Sized> WatchedSystem<'a, S> {
    /// Wraps `system` for a simulation from time `t` and state `y`.
    pub fn new(system: &'a S, (t, y): (f64, &[f64])) -> Self {
        let record = WatchState {
            regime: RefCell::new(vec![0.0; system.guard_count()]),
            horizon: Cell::new(f64::INFINITY),
            not_finite: Cell::new(None),
            indefinite: Cell::new(None),
            evaluations: Cell::new(0),
            has_released_sides: Cell::new(true),
            last_sides: RefCell::new(vec![0.0; system.guard_count()]),
            bands: RefCell::default(),
            histories: RefCell::new(
                (0..system.guard_count())
                    .map(|_| GuardHistory::new())
                    .collect(),
            ),
        };
        let watched = Self { system, record };
        watched.enter_regime(t, y);
        watched.fix_sides(true);
        watched
    }

    /// Continues with a record that [`WatchedSystem::pause`] returned.
    pub fn resume(system: &'a S, record: WatchState) -> Self {
        record.evaluations.set(0);
        let watched = Self { system, record };
        watched.fix_sides(true);
        watched
    }

    /// Releases the system and returns the record.
    pub fn pause(self) -> WatchState {
        self.fix_sides(false);
        self.record
    }

    /// Returns the system.
    pub fn system(&self) -> &S {
        self.system
    }

    /// Sets the sides of the surfaces whose mode in `modes` (one per surface) has a side.
    pub fn assume_sides(&self, modes: &[SurfaceMode]) {
        for (guard, mode) in modes.iter().enumerate() {
            let side = match mode {
                SurfaceMode::Negative => -1.0,
                SurfaceMode::Positive => 1.0,
                _ => continue,
            };
            self.record.regime.borrow_mut()[guard] = side;
            self.record.last_sides.borrow_mut()[guard] = side;
        }
        self.fix_sides(true);
    }

    /// Clears the errors of earlier trials.
    pub fn clear_trial_errors(&self) {
        self.record.not_finite.set(None);
    }

    /// Limits the time of trial evaluations to just before `t`. The right-hand side may jump at a breakpoint,
    /// and a step that ends there uses the rates before the jump.
    pub fn limit_time(&self, t: f64) {
        self.record.horizon.set(t);
    }

    /// Returns the time at which the system is evaluated for a trial at `t`.
    fn evaluation_time(&self, t: f64) -> f64 {
        let horizon = self.record.horizon.get();
        if t < horizon { t } else { horizon.next_down() }
    }

    /// Returns the index of a state whose rate was not finite in a trial since the last call of
    /// [`WatchedSystem::clear_trial_errors`].
    pub fn non_finite_state(&self) -> Option<usize> {
        self.record.not_finite.get()
    }

    /// Returns the index of a coordinate without positive inertia in a trial since the last call of
    /// [`WatchedSystem::clear_later_errors`].
    pub fn indefinite_coordinate(&self) -> Option<usize> {
        self.record.indefinite.get()
    }

    /// Clears errors of trials beyond the current point, after the motion has reached this point.
    pub fn clear_later_errors(&self) {
        self.record.indefinite.set(None);
    }

    /// Returns the number of evaluations of the right-hand side.
    pub fn evaluations(&self) -> u64 {
        self.record.evaluations.get()
    }

    /// Computes the rates at `t` and `y` in the current regime, interpolated within [`RootBand`]s. Returns true
    /// if they are finite.
    pub fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) -> bool {
        let t = self.evaluation_time(t);
        match &self.record.bands.borrow()[..] {
            [] => self.evaluate_rates(t, y, out),
            bands => self.interpolate_rates(bands, (t, y), out),
        }
        let not_finite = out.iter().position(|rate| !rate.is_finite());
        if let Some(state) = not_finite {
            self.record.not_finite.set(Some(state));
            if self.record.indefinite.get().is_none() {
                self.record
                    .indefinite
                    .set(self.system.find_indefinite_coordinate(t, y));
            }
        }
        not_finite.is_none()
    }

    /// Computes the rates of the system and counts the evaluation.
    pub(super) fn evaluate_rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.rates(t, y, out);
        self.record
            .evaluations
            .set(self.record.evaluations.get() + 1);
    }

    /// Projects a state onto constraints and invariants; see [`System::project`]. Returns false if
    /// the system has none.
    pub fn project(&self, t: f64, y: &mut [f64]) -> bool {
        let evaluations = self.system.project(self.evaluation_time(t), y);
        self.record
            .evaluations
            .set(self.record.evaluations.get() + evaluations);
        evaluations > 0
    }

    /// Marks the states that the last projection corrects; see [`System::mark_corrected`].
    pub fn mark_corrected(&self, is_corrected: &mut [bool]) {
        self.system.mark_corrected(is_corrected);
    }

    /// Computes the Jacobian of the rates by the state, row by row; see [`System::jacobian`].
    pub fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let bands = self.record.bands.borrow();
        self.interpolate_jacobian(&bands, (self.evaluation_time(t), y), out);
    }

    /// Finds the surfaces at `t` and `y` near which rates grow as a root, for a method with the errors
    /// `allowed` to the states. The rates are interpolated near these surfaces, and their sides are not fixed.
    pub fn update_root_bands(&self, t: f64, y: &[f64], allowed: &[f64]) {
        let histories = &mut self.record.histories.borrow_mut();
        let bands = self.find_root_bands(histories, (t, y), allowed);
        for band in &bands {
            self.record.regime.borrow_mut()[band.guard] = 0.0;
        }
        self.record.bands.replace(bands);
    }

    /// Returns true if the system has switching surfaces.
    pub fn has_guards(&self) -> bool {
        !self.record.regime.borrow().is_empty()
    }

    /// Returns the side of the surface `guard` in the current regime: -1, 1, or 0 if unknown.
    pub fn side(&self, guard: usize) -> f64 {
        self.record
            .regime
            .borrow()
            .get(guard)
            .copied()
            .unwrap_or(0.0)
    }

    /// Returns the sides of all surfaces; see [`WatchedSystem::side`].
    pub fn sides(&self) -> Vec<f64> {
        self.record.regime.borrow().clone()
    }

    /// Returns the switching functions at `t` and `y`.
    pub fn evaluate_guards(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut guards = vec![0.0; self.system.guard_count()];
        self.system.guards(t, y, &mut guards);
        guards
    }

    /// Writes bounds of the switching functions over a segment of a motion; see
    /// [`System::bound_guards`].
    pub fn bound_guards(
        &self,
        (begin, end): (f64, f64),
        state: &[Enclosure],
        out: &mut [Enclosure],
    ) {
        let t = (self.evaluation_time(begin), self.evaluation_time(end));
        self.system.bound_guards(t, state, out);
    }

    /// Returns the change of each switching function due to rounding of `y`.
    pub fn guard_roundings(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let here = self.evaluate_guards(t, y);
        let mut roundings = vec![0.0; here.len()];
        let mut beside = y.to_vec();
        for (place, entry) in y.iter().enumerate() {
            beside[place] = entry.next_up();
            let guards = self.evaluate_guards(t, &beside);
            beside[place] = *entry;
            for (rounding, (guard, here)) in roundings.iter_mut().zip(guards.iter().zip(&here)) {
                *rounding += (guard - here).abs();
            }
        }
        roundings
    }

    /// Returns the switching functions at the end of a step, before the jump at a breakpoint; see
    /// [`WatchedSystem::limit_time`].
    pub fn evaluate_guards_before(&self, t: f64, y: &[f64]) -> Vec<f64> {
        self.evaluate_guards(self.evaluation_time(t), y)
    }

    /// Returns the value of the lowest of the switching functions `guards`; each is positive on its side in the
    /// current regime.
    pub fn lowest_guard(&self, guards: &[usize], t: f64, y: &[f64]) -> f64 {
        let values = self.evaluate_guards_before(t, y);
        let regime = self.record.regime.borrow();
        let values = guards.iter().map(|guard| regime[*guard] * values[*guard]);
        values.fold(f64::INFINITY, f64::min)
    }

    /// Returns true if the rates are singular at a surface; see [`System::is_singular`].
    pub fn is_singular(&self, guard: usize) -> bool {
        self.system.is_singular(guard)
    }

    /// Returns true if switching function `guard` with value `value` is beyond its surface.
    pub fn is_beyond(&self, guard: usize, value: f64) -> bool {
        self.side(guard) * value < 0.0
    }

    /// Sets the regime at `t` and `y`. A function that is exactly 0 keeps its side, unless it is 0 in a
    /// neighbourhood of the point, as max(x, 0) is.
    pub fn enter_regime(&self, t: f64, y: &[f64]) {
        let guards = self.evaluate_guards(t, y);
        self.release_vanishing_functions((t, y), &guards);
        let mut regime = self.record.regime.borrow_mut();
        let mut last = self.record.last_sides.borrow_mut();
        let sides = regime.iter_mut().zip(guards).enumerate();
        for (index, (side, guard)) in sides.filter(|(_, (_, guard))| guard.abs() > 0.0) {
            if has_band(&self.record.bands.borrow(), index) {
                continue;
            }
            last[index] = guard.signum();
            *side = guard.signum();
        }
    }

    /// Releases the sides of the switching functions that are 0 at a point and also at a neighbouring point.
    /// `guards` are their values.
    fn release_vanishing_functions(&self, (t, y): (f64, &[f64]), guards: &[f64]) {
        let has_side = |guard: &usize| guards[*guard] == 0.0 && self.side(*guard) != 0.0;
        let zeros: Vec<usize> = (0..guards.len()).filter(has_side).collect();
        if zeros.is_empty() {
            return;
        }
        let (roundings, later) = (
            self.guard_roundings(t, y),
            self.evaluate_guards(t.next_up(), y),
        );
        for guard in zeros {
            if roundings[guard] == 0.0 && later[guard] == 0.0 {
                self.record.regime.borrow_mut()[guard] = 0.0;
            }
        }
    }

    /// Sets the sides of surfaces on which the motion starts and which it leaves to the same side, whichever
    /// side is assumed for the rates. `step` (s) is short. Without this, the rates at the start would be those
    /// on the surface, which are not the rates of the motion.
    pub fn leave_surfaces(&self, t: f64, y: &[f64], step: f64) {
        let guards = self.evaluate_guards(t, y);
        let starting = guards.iter().enumerate().filter(|(guard, value)| {
            **value == 0.0
                && self.side(*guard) == 0.0
                && !self.system.is_distance(*guard)
                && !self.system.is_singular(*guard)
        });
        let (mut rates, mut beside) = (vec![0.0; y.len()], y.to_vec());
        for (guard, _) in starting {
            let directions = [1.0, -1.0].map(|side| {
                self.record.regime.borrow_mut()[guard] = side;
                self.fix_sides(true);
                self.evaluate_rates(t, y, &mut rates);
                for (entry, (value, rate)) in beside.iter_mut().zip(y.iter().zip(&rates)) {
                    *entry = value + step * rate;
                }
                let there = self.evaluate_guards(t + step, &beside)[guard];
                there.partial_cmp(&0.0)
            });
            let side = match directions {
                _ if self.system.has_energy_jump(guard) => -1.0,
                [Some(Ordering::Greater), Some(Ordering::Greater)] => 1.0,
                [Some(Ordering::Less), Some(Ordering::Less)] => -1.0,
                _ => 0.0,
            };
            self.record.regime.borrow_mut()[guard] = side;
            self.record.last_sides.borrow_mut()[guard] = side;
            self.fix_sides(true);
        }
    }

    /// Applies the jumps of an event between a point just before a surface and one just beyond it.
    pub fn apply_event(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        self.system.apply_event(before, t, y)
    }

    /// Projects a state just beyond surfaces onto the invariants such that no later projection moves it back
    /// over these surfaces. `near` is the state just before the surfaces. The state may change by the errors
    /// `allowed`.
    pub fn project_beyond(
        &self,
        (surfaces, allowed): (&[usize], &[f64]),
        near: &[f64],
        t: f64,
        y: &mut [f64],
    ) {
        self.project_along((surfaces, allowed), (near, 1.0), t, y);
    }

    /// Projects a state on the near side of surfaces onto the invariants such that no later projection moves it
    /// over these surfaces, or over a surface at which the energies jump. The state may change by the errors
    /// `allowed`.
    pub fn project_before(&self, (surfaces, allowed): (&[usize], &[f64]), t: f64, y: &mut [f64]) {
        let guards = 0..self.system.guard_count();
        let surfaces: Vec<usize> = guards
            .filter(|guard| surfaces.contains(guard) || self.system.has_energy_jump(*guard))
            .collect();
        let start = y.to_vec();
        self.project_along((&surfaces, allowed), (&start, -1.0), t, y);
    }

    /// Projects a state. If the projection is not on one side of the surfaces, or does not stay on it, replaces
    /// the state by the nearest state along the rates at `start` whose projection does, within the errors
    /// `allowed`. The side is beyond the surfaces if `direction` is 1, and before them if it is -1.
    fn project_along(
        &self,
        (surfaces, allowed): (&[usize], &[f64]),
        (start, direction): (&[f64], f64),
        t: f64,
        y: &mut [f64],
    ) {
        if surfaces.is_empty() {
            return;
        }
        let is_right = |state: &[f64]| {
            let (guards, roundings) = (
                self.evaluate_guards(t, state),
                self.guard_roundings(t, state),
            );
            let mut surfaces = surfaces.iter();
            surfaces.all(|guard| {
                let value = guards[*guard];
                self.is_beyond(*guard, value) == (direction > 0.0)
                    && value.abs() > MIN_DISTANCE_ROUNDINGS * roundings[*guard]
            })
        };
        let (mut state, mut rates) = (y.to_vec(), Vec::new());
        let mut length = t.next_up() - t;
        loop {
            if !self.project(t, &mut state) {
                return;
            }
            if is_right(&state) {
                return y.copy_from_slice(&state);
            }
            self.system.forget_projection();
            if rates.is_empty() {
                rates = vec![0.0; start.len()];
                self.evaluate_rates(t, start, &mut rates);
            }
            let mut moved = rates.iter().map(|rate| length * rate).zip(allowed);
            if !moved.all(|(moved, allowed)| moved.abs() <= *allowed) {
                return;
            }
            for (entry, (from, rate)) in state.iter_mut().zip(y.iter().zip(&rates)) {
                *entry = from + direction * length * rate;
            }
            length *= 2.0;
        }
    }

    /// Applies the jumps of inputs at `t`; see [`System::apply_breakpoint`]. Returns true if there
    /// are any.
    pub fn apply_breakpoint(&self, t: f64, y: &mut [f64]) -> bool {
        self.system.apply_breakpoint(t, y)
    }

    /// Returns true if the system has a breakpoint at `t`, where steps end.
    pub fn has_breakpoint_at(&self, t: f64) -> bool {
        t == self.record.horizon.get()
    }

    /// Extends the rates of the current regime smoothly beyond its surfaces if `keep` is true; see
    /// [`System::fix_sides`].
    pub fn fix_sides(&self, keep: bool) {
        self.record.has_released_sides.set(!keep);
        let regime = self.record.regime.borrow();
        self.system.fix_sides(keep.then_some(regime.as_slice()));
    }

    /// Fixes sides that were released in an earlier step.
    pub fn restore_sides(&self) {
        if self.record.has_released_sides.get() {
            self.fix_sides(true);
        }
    }

    /// Evaluates rates on the actual side of each state from now on, if those of the current regime were not
    /// finite in a trial. Returns true if so.
    pub fn release_sides(&self) -> bool {
        let releases = self.has_guards() && self.record.not_finite.get().is_some();
        if releases {
            self.fix_sides(false);
        }
        releases
    }

    /// Updates the modes of the surfaces; see [`System::update_modes`].
    pub fn update_modes(&self, t: f64, y: &[f64]) {
        self.system.update_modes(t, y);
    }

    /// Writes the modes of the surfaces in the current regime.
    pub fn write_modes(&self, modes: &mut Vec<SurfaceMode>) {
        modes.clear();
        let sides = self.record.last_sides.borrow();
        modes.extend(sides.iter().map(|side| SurfaceMode::from_side(*side)));
        self.system.write_modes(modes);
    }

    /// Adds the rounding errors of the rates at rest to `out`; see [`System::add_rate_roundings`].
    pub fn add_rate_roundings(&self, length: f64, out: &mut [f64]) {
        self.system.add_rate_roundings(length, out);
    }

    /// Returns true if the system observes steps.
    pub fn is_observing(&self) -> bool {
        self.system.is_observing()
    }

    /// Passes an accepted step to the system; see [`System::observe_step`].
    pub fn observe_step(
        &self,
        start: &Point,
        end: &Point,
        inside: &mut dyn FnMut(f64, Interior) -> Option<Vec<f64>>,
    ) {
        self.system.observe_step(&mut ObservedStep {
            start: (start.t, &start.y),
            end: (self.evaluation_time(end.t), &end.y),
            state_inside: inside,
        });
    }

    /// Returns the index of the state with the highest rate relative to its size.
    pub fn fastest_state(&self, t: f64, y: &[f64]) -> usize {
        let mut rates = vec![0.0; y.len()];
        self.system.rates(t, y, &mut rates);
        let sizes = self.system.typical_sizes();
        let size = |index: usize| y[index].abs().max(UNMOVED_SIZE_FRACTION * sizes[index]);
        let speed = |index: usize| rates[index].abs() / size(index);
        let all = 0..y.len();
        all.max_by(|a, b| speed(*a).total_cmp(&speed(*b)))
            .unwrap_or(0)
    }
}
