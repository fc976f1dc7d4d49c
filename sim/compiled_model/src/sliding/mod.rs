//! Sticking on switching surfaces, as under dry friction. On a surface v = 0, sign(v) is replaced
//! by the number between -1 and 1 that keeps v at zero, if there is one (A. F. Filippov; for
//! friction, J. J. Moreau).
//!
//! [`eomgen_sim::sliding_modes`] decides which of several surfaces hold. `sided` is the model with
//! given sides of its surfaces, and `observed` computes observables and rates during sticking.
//! This module follows the surfaces along a motion. A surface holds the motion from its arrival
//! until the force reaches the limit of the surface. At the release, the switching function and
//! its rate are zero up to rounding, which must not determine the side; so the surface is
//! displaced by that rounding until the motion has left it.

mod observed;
mod sided;

pub(crate) use observed::Observed;
pub use observed::Rest;
pub use sided::Sided;

use eomgen_sim::ode::difference_step;
use eomgen_sim::sliding_modes::{Arrival, Verdict};
use sided::CORRECTIONS;

/// Largest distance of a state from a surface that holds it, relative to the largest value of the
/// switching function. Beyond it the state is corrected.
const DRIFT: f64 = 1e-12;

/// Additional distance, relative to the effect of the surface's own force on its function since
/// the surface holds.
const DRIFT_OF_A_FORCE: f64 = 1e-13;

/// Largest distance of other surfaces that count as reached, relative to the change of their
/// functions in the step across a surface.
const NEAR: f64 = 4.0;

/// Limit of that distance, relative to the largest value of the function.
const NEAREST: f64 = 1e-9;

/// Arrival on a surface on which the motion already is.
const STILL: Arrival = Arrival {
    side: 1.0,
    is_overcome: false,
};

/// State of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// The sign of the function determines the side.
    Free,
    /// The surface holds the motion, which came from this side, -1 or 1, at this time, s.
    Holding { from: f64, since: f64 },
    /// The surface exerts its largest force to this side, and other surfaces hold the motion.
    Bearing { from: f64, side: f64 },
    /// The surface has released the motion to this side, but its function is still within
    /// rounding; the surface is displaced by `moved`.
    Leaving { side: f64, moved: f64 },
}

impl Place {
    fn is_on(self) -> bool {
        matches!(self, Self::Holding { .. } | Self::Bearing { .. })
    }

    /// Returns the displacement of the surface until the motion has left it.
    fn moved(self) -> f64 {
        match self {
            Self::Leaving { side, moved } => side * moved,
            Self::Free | Self::Holding { .. } | Self::Bearing { .. } => 0.0,
        }
    }
}

/// States of all surfaces along a motion.
pub(crate) struct Sliding {
    sided: Sided,
    places: Vec<Place>,
    /// True if the rates had no jump on a surface at the last arrival; then the sign of its
    /// function determines the side.
    is_jumpless: Vec<bool>,
    sizes: Vec<f64>,
    begin: Option<f64>,
    /// Fixed sides, -1 or 1, of free surfaces, independent of their functions.
    kept: Option<Vec<f64>>,
    /// Point at which the sides that hold were last computed.
    found_at: Option<(f64, Vec<f64>)>,
    /// Surfaces that began or ceased to hold, not yet reported.
    changes: Vec<(usize, bool)>,
}

impl Sliding {
    pub fn new(sided: Sided) -> Self {
        let count = sided.count();
        Self {
            places: vec![Place::Free; count],
            is_jumpless: vec![false; count],
            sizes: vec![0.0; count],
            begin: None,
            kept: None,
            found_at: None,
            changes: Vec::new(),
            sided,
        }
    }

    /// Returns the model with sides, for use with another motion.
    pub fn into_sided(self) -> Sided {
        self.sided
    }

    /// Returns true if the signs of the functions do not determine the rates.
    pub fn is_active(&self) -> bool {
        self.kept.is_some() || !self.is_free()
    }

    /// Returns true if the motion is on no surface and has left all surfaces.
    pub fn is_free(&self) -> bool {
        self.places.iter().all(|place| *place == Place::Free)
    }

    /// Fixes the sides of the guards, -1, 1, or 0 (unknown); `None` restores the signs. Surfaces
    /// without a jump are not fixed, because their rates beyond the surface may lead away from it.
    pub fn keep_sides(&mut self, sides: Option<&[f64]>) {
        self.found_at = None;
        self.kept = sides.map(|sides| {
            let kept = |surface: usize| match self.is_jumpless[surface] {
                true => 0.0,
                false => sides[self.sided.guard(surface)],
            };
            (0..self.places.len()).map(kept).collect()
        });
    }

    /// Writes the rates, if this is active.
    pub fn rates(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        self.hold(at, inputs);
        self.sided.rates(at, inputs, out);
    }

    /// Writes the observables, if this is active.
    pub fn observables(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        self.hold(at, inputs);
        self.sided.observables(at, out);
    }

    /// Computes the derivatives of the rates with respect to the state by finite differences, if
    /// this is active. Sides and sticking remain unchanged.
    pub fn jacobian(
        &mut self,
        (t, state): (f64, &[f64]),
        (inputs, typical_sizes): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let (sides, held) = (self.sides((t, state), inputs), self.holding());
        self.found_at = None;
        let count = state.len();
        let mut rates = |state: &[f64], out: &mut [f64]| {
            self.sided.hold((t, state), inputs, &sides, &held);
            self.sided.rates((t, state), inputs, out);
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
    pub fn guards(&mut self, at: (f64, &[f64]), inputs: &[f64], out: &mut [f64]) {
        if self.begin.is_none() {
            self.begin(at, inputs);
        }
        if self.is_free() {
            return;
        }
        self.hold(at, inputs);
        for (surface, place) in self.places.iter().enumerate() {
            let slot = &mut out[self.sided.guard(surface)];
            let side = self.sided.sides()[surface];
            match *place {
                Place::Free => {}
                Place::Holding { from, .. } => *slot = from * 4.0 * side * (1.0 - side),
                Place::Bearing { from, .. } => *slot = from,
                Place::Leaving { side, moved } => *slot += side * moved,
            }
        }
    }

    /// Decides the state of all surfaces that the motion reached. `before` is on the near side of
    /// a surface, `t` and `state` just beyond it.
    pub fn cross(
        &mut self,
        inputs: &[f64],
        (t_before, before): (f64, &[f64]),
        t: f64,
        state: &mut [f64],
    ) {
        let near = self.sided.functions((t_before, before), inputs);
        let beyond = self.sided.functions((t, state), inputs);
        let roundings = self.sided.roundings((t, state), inputs);
        let mut is_new = false;
        let mut touching = Vec::new();
        let mut arrivals = Vec::new();
        let overcome = self.overcome((t, state), inputs);
        let came_from = self.came_from(&near);
        for (surface, place) in self.places.iter().enumerate() {
            let (from, to) = (near[surface], beyond[surface]);
            let moved = place.moved();
            let is_crossed = came_from[surface] * (to + moved) < 0.0;
            let near = NEAR * (to - from).abs();
            let near = near.min(NEAREST * self.sizes[surface]) + roundings[surface];
            let is_near = to.abs() <= near;
            if place.is_on() || is_crossed || (is_near && *place == Place::Free) {
                is_new |= is_crossed && !place.is_on();
                touching.push(surface);
                arrivals.push(overcome[surface].unwrap_or(Arrival {
                    side: match is_crossed {
                        true => -came_from[surface],
                        false => came_from[surface],
                    },
                    is_overcome: false,
                }));
            }
        }
        if !is_new && overcome.iter().all(Option::is_none) {
            return;
        }
        self.settle((t, state), inputs, (&touching, &arrivals), &came_from);
        self.put_back((t, state), inputs, true);
    }

    /// Returns the sides, -1 or 1, from which the motion came, given the values of the functions.
    /// If a function is exactly zero, its fixed side counts.
    fn came_from(&self, near: &[f64]) -> Vec<f64> {
        let kept = |surface: usize| self.kept.as_ref().map(|kept| kept[surface]);
        let side = |(surface, value): (usize, &f64)| {
            let moved = self.places[surface].moved();
            match kept(surface).filter(|side| *side != 0.0) {
                Some(side) if value + moved == 0.0 => side,
                _ => (value + moved).signum(),
            }
        };
        near.iter().enumerate().map(side).collect()
    }

    /// Corrects a state that drifted from the surfaces that hold it; returns the number of
    /// evaluations.
    pub fn keep(&mut self, t: f64, inputs: &[f64], state: &mut [f64]) -> u64 {
        self.put_back((t, state), inputs, false)
    }

    /// Updates the surfaces at a point, at which inputs may jump from `earlier`: releases the
    /// motion if an input moves a surface away or a force exceeds its limit. Returns the surfaces
    /// that began or ceased to hold since the last call.
    pub fn arrive(
        &mut self,
        at: (f64, &[f64]),
        (earlier, inputs): (&[f64], &[f64]),
    ) -> Vec<(usize, bool)> {
        if self.begin.is_some() && !self.is_free() {
            let functions = self.sided.functions(at, inputs);
            let jumps: Vec<bool> = match earlier == inputs {
                true => vec![false; functions.len()],
                false => {
                    let before = self.sided.functions(at, earlier);
                    let roundings = self.sided.roundings(at, inputs);
                    let moved = functions.iter().zip(&before).map(|(a, b)| (a - b).abs());
                    let allowed = roundings.iter().zip(&self.sizes);
                    let allowed = allowed.map(|(rounding, size)| rounding + DRIFT * size);
                    moved.zip(allowed).map(|(a, b)| a > b).collect()
                }
            };
            for (surface, place) in self.places.iter_mut().enumerate() {
                let value = functions[surface];
                let has_left = match *place {
                    Place::Leaving { side, moved } => side * value > 2.0 * moved,
                    _ => jumps[surface],
                };
                if has_left && *place != Place::Free {
                    if place.is_on() {
                        self.changes.push((self.sided.guard(surface), value > 0.0));
                    }
                    *place = Place::Free;
                    self.found_at = None;
                }
            }
            for _ in 0..=self.places.len() {
                let overcome = self.overcome(at, inputs);
                if overcome.iter().all(Option::is_none) {
                    break;
                }
                let on = |surface: &usize| self.places[*surface].is_on();
                let touching: Vec<usize> = (0..self.places.len()).filter(on).collect();
                let arrival = |surface: &usize| overcome[*surface].unwrap_or(STILL);
                let arrivals: Vec<Arrival> = touching.iter().map(arrival).collect();
                self.settle(at, inputs, (&touching, &arrivals), &functions);
            }
        }
        let functions = self.sided.functions(at, inputs);
        for (size, value) in self.sizes.iter_mut().zip(&functions) {
            *size = size.max(value.abs());
        }
        std::mem::take(&mut self.changes)
    }

    /// Starts a motion: surfaces on which it is may hold it.
    fn begin(&mut self, at: (f64, &[f64]), inputs: &[f64]) {
        self.begin = Some(at.0);
        let functions = self.sided.functions(at, inputs);
        let roundings = self.sided.roundings(at, inputs);
        let touching: Vec<usize> = (0..functions.len())
            .filter(|surface| functions[*surface].abs() <= roundings[*surface])
            .collect();
        if !touching.is_empty() {
            let arrivals = vec![STILL; touching.len()];
            self.settle(at, inputs, (&touching, &arrivals), &functions);
        }
        self.changes.clear();
    }

    /// Returns the surfaces whose force exceeds its limit, with the side.
    fn overcome(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<Option<Arrival>> {
        self.hold(at, inputs);
        let held = self.places.iter().zip(self.sided.sides());
        held.map(|(place, side)| {
            let is_overcome = matches!(place, Place::Holding { .. }) && !(0.0..=1.0).contains(side);
            is_overcome.then_some(Arrival {
                side: (side - 0.5).signum(),
                is_overcome,
            })
        })
        .collect()
    }

    /// Decides the states of the surfaces `touching`, on which the motion is. It came from the
    /// sides with these signs of the functions.
    fn settle(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
        (touching, arrivals): (&[usize], &[Arrival]),
        came_from: &[f64],
    ) {
        self.found_at = None;
        let sides = self.sides(at, inputs);
        let jumps = self.sided.jumps_on(at, inputs, touching, &sides);
        let (touching, arrivals) = self.free_without_jump((touching, arrivals), &jumps);
        let asked = (&touching[..], &arrivals[..]);
        let Some(verdicts) = self.sided.decide(at, inputs, asked, &sides) else {
            // The sign of the function decides, and the solver reports chattering.
            for surface in touching {
                self.places[surface] = Place::Free;
            }
            return;
        };
        let functions = self.sided.functions(at, inputs);
        let mut roundings = self.sided.roundings(at, inputs);
        let passed = self.begin.map_or(0.0, |begin| at.0 - begin);
        for (surface, rounding) in roundings.iter_mut().enumerate() {
            // A rate of rounding, accumulated over time.
            *rounding += DRIFT_OF_A_FORCE * self.sided.own_rate(surface) * passed;
        }
        for (surface, verdict) in touching.iter().zip(verdicts) {
            let old = self.places[*surface];
            let from = match old {
                Place::Holding { from, .. } | Place::Bearing { from, .. } => from,
                _ if came_from[*surface] < 0.0 => -1.0,
                _ => 1.0,
            };
            let since = match old {
                Place::Holding { since, .. } => since,
                _ => at.0,
            };
            let new = match verdict {
                Verdict::Holds(_) => Place::Holding { from, since },
                Verdict::Bears(side) => Place::Bearing { from, side },
                Verdict::LetsGo(side) => {
                    let value = functions[*surface];
                    match side * value > 2.0 * roundings[*surface] {
                        true => Place::Free,
                        false => Place::Leaving {
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
            let guard = self.sided.guard(*surface);
            if old.is_on() && !new.is_on() {
                self.changes.push((guard, verdict.sign() > 0.0));
            } else if new.is_on() && !old.is_on() {
                self.changes.push((guard, from < 0.0));
            }
        }
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
            if self.places[*surface].is_on() {
                let guard = self.sided.guard(*surface);
                self.changes.push((guard, arrival.side > 0.0));
            }
            self.places[*surface] = Place::Free;
            if let Some(kept) = &mut self.kept {
                kept[*surface] = 0.0;
            }
        }
        left
    }

    /// Returns the sides of all surfaces at a point, 0.5 for those that hold. Functions are
    /// evaluated only if needed.
    fn sides(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Vec<f64> {
        let kept = self.kept.clone().unwrap_or_default();
        let mut functions = Vec::new();
        let mut sides = Vec::with_capacity(self.places.len());
        for (surface, place) in self.places.iter().enumerate() {
            let kept = kept.get(surface).filter(|side| **side != 0.0);
            let moved = match (*place, kept) {
                (Place::Holding { .. }, _) => {
                    sides.push(0.5);
                    continue;
                }
                (Place::Bearing { side, .. }, _) | (Place::Leaving { side, .. }, Some(_)) => {
                    sides.push(0.5 + 0.5 * side);
                    continue;
                }
                (Place::Free, Some(side)) => {
                    sides.push(0.5 + 0.5 * side);
                    continue;
                }
                (Place::Free | Place::Leaving { .. }, None) => place.moved(),
            };
            if functions.is_empty() {
                functions = self.sided.functions(at, inputs);
            }
            sides.push(self.sided.side_of(surface, functions[surface] + moved));
        }
        sides
    }

    fn holding(&self) -> Vec<usize> {
        let holds = |surface: &usize| matches!(self.places[*surface], Place::Holding { .. });
        (0..self.places.len()).filter(holds).collect()
    }

    /// Computes the sides that hold the motion at a point.
    fn hold(&mut self, (t, state): (f64, &[f64]), inputs: &[f64]) {
        if let Some((known, at)) = &self.found_at
            && *known == t
            && at == state
        {
            return;
        }
        let (sides, held) = (self.sides((t, state), inputs), self.holding());
        self.sided.hold((t, state), inputs, &sides, &held);
        match &mut self.found_at {
            Some((known, at)) => {
                *known = t;
                at.copy_from_slice(state);
            }
            none => *none = Some((t, state.to_vec())),
        }
    }

    /// Corrects a state onto the surfaces that hold it, if it has drifted or `always`.
    fn put_back(&mut self, (t, state): (f64, &mut [f64]), inputs: &[f64], always: bool) -> u64 {
        let held = self.holding();
        if held.is_empty() {
            return 0;
        }
        let values = self.sided.functions((t, state), inputs);
        let has_strayed = |surface: &usize| {
            let Place::Holding { since, .. } = self.places[*surface] else {
                return false;
            };
            let by_force = self.sided.own_rate(*surface) * (t - since).abs();
            let allowed = DRIFT * self.sizes[*surface] + DRIFT_OF_A_FORCE * by_force;
            values[*surface].abs() > allowed
        };
        if !always && !held.iter().any(has_strayed) {
            return 0;
        }
        self.hold((t, state), inputs);
        self.found_at = None;
        for _ in 0..CORRECTIONS {
            let values = self.sided.functions((t, state), inputs);
            self.sided.put_on(t, state, (&held, &values));
        }
        CORRECTIONS as u64
    }
}
