//! A motion with steps made by an external solver, as in FMI model exchange.

use super::events::SurfaceMode;
use super::point::Point;
use super::system::System;
use super::watch::{WatchState, WatchedSystem};

/// Value of a switching function beyond its surface at which its event function changes sign, relative to the
/// largest value so far. Therefore event functions are not 0 after their event.
const HYSTERESIS_FRACTION: f64 = 1e-10;

/// Smallest absolute hysteresis: used before the first value is known, and for distances of impacts.
const MIN_HYSTERESIS: f64 = 1e-20;

/// Growth factor of the time back from a surface in the search for a point on its near side.
const BACKTRACK_GROWTH: f64 = 4.0;

/// Drift from constraints and holding surfaces at the end of a step, relative to the largest value of a state
/// and in tolerances. A larger drift causes an event that corrects the state.
const MAX_DRIFT_TOLERANCES: f64 = 100.0;

/// A motion with steps made by an external solver. Its rates are smooth between events, also beyond a surface.
/// At an event one of the event functions changes sign, and the caller calls [`ExternalMotion::apply_event`].
pub struct ExternalMotion<S> {
    system: S,
    record: WatchState,
    /// Last point at which no surface had been crossed without its event.
    near: Point,
    /// Largest magnitude of each switching function.
    guard_sizes: Vec<f64>,
    /// Largest magnitude of each state.
    sizes: Vec<f64>,
    tolerance: f64,
}

impl<S: System> ExternalMotion<S> {
    /// Starts at a time (s) and a state. A surface on which the state lies holds the motion if it can. Surfaces
    /// that hold in `modes`, one per switching function, hold it also if the state is beside them by rounding.
    /// The tolerance is relative.
    pub fn start(system: S, (t, y): (f64, &[f64]), modes: &[SurfaceMode], tolerance: f64) -> Self {
        system.assume_modes(modes);
        let record = {
            let watched = WatchedSystem::new(&system, (t, y));
            watched.assume_sides(modes);
            watched.pause()
        };
        let mut motion = Self {
            near: Point { t, y: y.to_vec() },
            guard_sizes: vec![0.0; system.guard_count()],
            sizes: system.typical_sizes(),
            system,
            record,
            tolerance,
        };
        motion.update_sizes(t, y);
        motion
    }

    /// Returns the system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Returns the system, for example to change its inputs.
    pub fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }

    /// Calls `act` with the system while the surfaces keep the sides of the motion.
    pub fn with_fixed_sides<T>(&mut self, act: impl FnOnce(&S) -> T) -> T {
        self.with_watched(|watched| act(watched.system()))
    }

    /// Writes the rates at a time (s) and a state, in the current modes of the surfaces.
    pub fn rates(&mut self, t: f64, y: &[f64], out: &mut [f64]) {
        self.with_watched(|watched| watched.rates(t, y, out));
    }

    /// Writes the event functions, one per switching function.
    pub fn event_functions(&mut self, t: f64, y: &[f64], out: &mut [f64]) {
        let (guards, sides) =
            self.with_watched(|watched| (watched.evaluate_guards(t, y), watched.sides()));
        for (guard, slot) in out.iter_mut().enumerate() {
            let (value, side) = (guards[guard], sides[guard]);
            *slot = match side == 0.0 {
                true => value.abs() - self.hysteresis(guard),
                false => value + side * self.hysteresis(guard),
            };
        }
    }

    /// Returns true if the state is beyond a surface whose event was not applied.
    pub fn is_beyond_surface(&mut self, t: f64, y: &[f64]) -> bool {
        let beyond = self.with_watched(|watched| {
            let guards = watched.evaluate_guards(t, y);
            let values = guards.into_iter().enumerate();
            let beyond = values.filter(|(guard, value)| watched.is_beyond(*guard, *value));
            beyond.collect::<Vec<_>>()
        });
        let mut beyond = beyond.iter();
        beyond.any(|(guard, value)| value.abs() > self.hysteresis(*guard))
    }

    /// Returns the modes of the surfaces.
    pub fn modes(&mut self) -> Vec<SurfaceMode> {
        let mut modes = Vec::new();
        self.with_watched(|watched| watched.write_modes(&mut modes));
        modes
    }

    /// Accepts a step that ends at a time (s) and a state. Returns true if an event must follow, because a mode
    /// changed or the state drifted from constraints or holding surfaces.
    pub fn complete_step(&mut self, t: f64, y: &[f64]) -> bool {
        let before = self.modes();
        let mut projected = y.to_vec();
        let has_passed = self.with_watched(|watched| {
            let guards = watched.evaluate_guards(t, y);
            let mut values = guards.into_iter().enumerate();
            if values.any(|(guard, value)| watched.is_beyond(guard, value)) {
                return true;
            }
            watched.project(t, &mut projected);
            watched.update_modes(t, y);
            watched.fix_sides(true);
            false
        });
        if has_passed {
            return false;
        }
        self.near = Point { t, y: y.to_vec() };
        self.update_sizes(t, y);
        let most = MAX_DRIFT_TOLERANCES * self.tolerance;
        has_drifted(y, &projected, &self.sizes, most) || self.modes() != before
    }

    /// Applies the events at a time (s) and a state, which may be beyond surfaces or have new inputs. Returns
    /// true if the state changed. The state is set to NaN if the motion cannot continue.
    pub fn apply_event(&mut self, t: f64, y: &mut [f64]) -> bool {
        let arrived = y.to_vec();
        let last = self.near.clone();
        let (sizes, tolerance) = (self.sizes.clone(), self.tolerance);
        self.with_watched(|watched| {
            if watched.apply_breakpoint(t, y) {
                watched.enter_regime(t, y);
            }
            let guards = watched.evaluate_guards(t, y);
            let passed: Vec<usize> = (0..guards.len())
                .filter(|guard| watched.is_beyond(*guard, guards[*guard]))
                .collect();
            if !passed.is_empty() {
                let near = find_near_point(watched, (t, y), &passed, last);
                let allowed: Vec<f64> = sizes.iter().map(|size| tolerance * size).collect();
                watched.project_beyond((&passed, &allowed), &near.y, t, y);
                watched.apply_event((near.t, &near.y), t, y);
            }
            let mut projected = y.to_vec();
            watched.project(t, &mut projected);
            if !passed.is_empty() || has_drifted(y, &projected, &sizes, tolerance) {
                y.copy_from_slice(&projected);
            }
            settle_modes(watched, t, y);
        });
        self.near = Point { t, y: y.to_vec() };
        self.update_sizes(t, y);
        arrived != y
    }

    /// Calls `act` while the sides of the surfaces are fixed.
    fn with_watched<T>(&mut self, act: impl FnOnce(&WatchedSystem<'_, S>) -> T) -> T {
        let watched = WatchedSystem::resume(&self.system, std::mem::take(&mut self.record));
        let result = act(&watched);
        self.record = watched.pause();
        result
    }

    fn hysteresis(&self, guard: usize) -> f64 {
        match self.system.is_distance(guard) {
            true => MIN_HYSTERESIS,
            false => (HYSTERESIS_FRACTION * self.guard_sizes[guard]).max(MIN_HYSTERESIS),
        }
    }

    fn update_sizes(&mut self, t: f64, y: &[f64]) {
        let guards = self.with_watched(|watched| watched.evaluate_guards(t, y));
        let functions = self.guard_sizes.iter_mut().zip(&guards);
        for (size, value) in functions.chain(self.sizes.iter_mut().zip(y)) {
            // NaN is not stored: a comparison with NaN is false.
            if value.abs() > *size && value.is_finite() {
                *size = value.abs();
            }
        }
    }
}

/// Updates modes and sides until both agree. A change of side, such as a reversal of friction at an impact,
/// changes the forces of closed contacts.
fn settle_modes<S: System>(watched: &WatchedSystem<'_, S>, t: f64, y: &[f64]) {
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for _ in 0..=watched.sides().len() {
        watched.update_modes(t, y);
        watched.enter_regime(t, y);
        watched.fix_sides(true);
        watched.write_modes(&mut after);
        if after == before {
            break;
        }
        std::mem::swap(&mut before, &mut after);
    }
}

/// Returns true if a state is farther from its projection than a fraction of the sizes of its entries.
fn has_drifted(y: &[f64], projected: &[f64], sizes: &[f64], fraction: f64) -> bool {
    let mut entries = y.iter().zip(projected).zip(sizes);
    entries.any(|((from, to), size)| {
        let distance = (to - from).abs();
        distance.is_nan() || distance > fraction * size
    })
}

/// Returns a point on the near side of the surfaces `passed`, along the rates back from a point beyond them;
/// the `last` point of the motion if no point in between is on the near side.
fn find_near_point<S: System>(
    watched: &WatchedSystem<'_, S>,
    (t, y): (f64, &[f64]),
    passed: &[usize],
    last: Point,
) -> Point {
    let mut rates = vec![0.0; y.len()];
    watched.rates(t, y, &mut rates);
    let mut back = 2.0 * f64::EPSILON * t.abs().max(t - last.t);
    while back > 0.0 && back < t - last.t {
        let entries = y.iter().zip(&rates);
        let candidate = Point {
            t: t - back,
            y: entries.map(|(y, rate)| y - back * rate).collect(),
        };
        if watched.lowest_guard(passed, candidate.t, &candidate.y) >= 0.0 {
            return candidate;
        }
        back *= BACKTRACK_GROWTH;
    }
    last
}
