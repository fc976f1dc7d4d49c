//! Marching: the motion of a model that is linear between its switching surfaces, but for
//! small terms, in steps of one length.
//!
//! A step takes the linear part exactly, by a matrix made once for each regime; terms that are
//! not linear are held over it and corrected at its end (the exponential method of Heun, of
//! second order). Where a surface is crossed within a step, the crossing is found by the cubic
//! through both ends and the step is made in parts. What a propagator from switch to switch
//! does to rounding this does to a small part of any sensor's noise, several times faster, and
//! neighbouring motions come with it. The files: `kernels` (products), `surfaces`, `regime`
//! (matrices of a step), `crossing` (where a step meets a surface), `tangents`.

mod crossing;
mod kernels;
mod regime;
mod surfaces;
mod tangents;

use std::collections::HashMap;

use codegen::affine::system::AffineEvaluator;
use sim::record::HeldInputs;

use crossing::first_crossing;
use regime::Regime;
use surfaces::{Side, Surfaces, dot};
pub use tangents::{Drives, Free, Tangents};

/// The fastest mode turns by so many radians in a step: the cubic through a step's ends then
/// knows where a surface is crossed to a hundredth, and finds it from there.
const TURN: f64 = 1.5;

/// Steps from sample to sample at least: forces that are held over a step follow a motion
/// that the samples show.
const LEAST_STEPS: f64 = 4.0;

/// Steps from sample to sample at most; a model that needs more is not marched.
const MOST_STEPS: f64 = 256.0;

/// Intervals that differ from whole steps by less than this part are whole steps: so do the
/// times of records with rounded or jittering clocks, which err by no more than that.
const JITTER: f64 = 1e-4;

/// Crossings within a step after which the rest of it is made without looking.
const MOST_CROSSINGS: usize = 12;

/// The motion itself is right to this part of its size.
const ROUNDING: f64 = 1e-16;

/// Where a function's rate leads back by less than this part of its size, it does not.
const LEADS_BACK: f64 = 1e-9;

/// Accelerations beyond the linear ones.
pub trait Force {
    /// Writes them at a state.
    fn at(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]);
}

/// A model at fixed parameters, ready to be marched.
pub struct March {
    evaluator: AffineEvaluator,
    surfaces: Surfaces,
    regimes: Vec<Regime>,
    known: HashMap<Vec<Side>, Option<usize>>,
    states: usize,
    /// The length of a step, s.
    step: f64,
}

/// Where a motion stands.
struct Motion {
    t: f64,
    state: Vec<f64>,
    sides: Vec<Side>,
    regime: usize,
    /// A unit constant and the inputs.
    given: Vec<f64>,
    /// What these add to a step.
    base: Vec<f64>,
    /// Functions of the surfaces and their rates.
    watched: Vec<f64>,
    /// Accelerations beyond the linear ones.
    force: Vec<f64>,
    /// A step's end.
    next: Vec<f64>,
}

/// Who goes along.
pub struct Company<'c, 'd> {
    /// Accelerations beyond the linear ones.
    pub force: Option<&'c mut dyn Force>,
    /// Neighbouring motions.
    pub tangents: Option<&'c mut Tangents<'d>>,
}

/// Who is shown the samples: each one's place, the state there and the neighbouring motions.
pub type Show<'s> = dyn FnMut(usize, &[f64], Option<&Tangents<'_>>) + 's;

impl March {
    /// A march of a model at its parameters, for samples so far apart, s; none if it is not
    /// of a kind that can be marched.
    pub fn new(mut evaluator: AffineEvaluator, sample: f64) -> Option<Self> {
        let surfaces = Surfaces::of(&mut evaluator)?;
        let system = evaluator.system(&vec![0.0; evaluator.guard_count()]);
        if !system.phases.is_empty()
            || !evaluator.half_widths_are_right()
            || !evaluator.pivots_are_positive()
        {
            return None;
        }
        let turns = sample * regime::fastest(&mut evaluator, &surfaces) / TURN;
        let steps = turns.ceil().max(LEAST_STEPS);
        (steps <= MOST_STEPS).then(|| Self {
            states: evaluator.states(),
            surfaces,
            regimes: Vec::new(),
            known: HashMap::new(),
            step: sample / steps,
            evaluator,
        })
    }

    /// Runs from `initial` at the first of the samples (s, ascending) to the last; `show` is
    /// given each sample's place, the state there and the neighbouring motions.
    ///
    /// # Errors
    /// Why the motion cannot be followed, in words.
    pub fn run(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        mut company: Company<'_, '_>,
        show: &mut Show<'_>,
    ) -> Result<(), String> {
        let Some(begin) = samples.first() else {
            return Ok(());
        };
        let mut motion = self.start(*begin, initial, inputs, &mut company)?;
        show(0, &motion.state, company.tangents.as_deref());
        for (place, end) in samples.iter().enumerate().skip(1) {
            while motion.t < *end {
                // Times of samples and of inputs may differ by rounding.
                let near = motion.t + 1e-3 * self.step;
                let change = inputs
                    .next_change(near)
                    .filter(|next| *next < *end - 1e-3 * self.step);
                let until = change.unwrap_or(*end);
                let values = inputs.at(0.5 * (motion.t + until));
                self.interval(&mut motion, until, values, &mut company)?;
                motion.t = until;
            }
            if motion.state.iter().any(|x| !x.is_finite()) {
                return Err("the motion grows beyond all bounds".to_owned());
            }
            show(place, &motion.state, company.tangents.as_deref());
        }
        Ok(())
    }

    fn start(
        &mut self,
        t: f64,
        initial: &[f64],
        inputs: &HeldInputs,
        company: &mut Company<'_, '_>,
    ) -> Result<Motion, String> {
        let values = inputs.at(t + 1e-3 * self.step);
        let mut given = vec![1.0];
        given.extend(values);
        let count = self.surfaces.guards.len();
        let mut motion = Motion {
            t,
            state: initial.to_vec(),
            sides: vec![Side::Below; count],
            regime: 0,
            given,
            base: Vec::new(),
            watched: Vec::new(),
            force: vec![0.0; self.states / 2],
            next: Vec::new(),
        };
        motion.regime = self.regime(&motion.sides)?;
        let functions = self.regimes[motion.regime].functions.clone();
        for (side, function) in motion.sides.iter_mut().zip(&functions) {
            if function.at(&motion.state, &motion.given) > 0.0 {
                *side = Side::Above;
            }
        }
        motion.regime = self.regime(&motion.sides)?;
        for (surface, function) in functions.iter().enumerate() {
            if function.at(&motion.state, &motion.given) == 0.0 {
                self.cross(&mut motion, surface, &mut None)?;
                if motion.sides[surface] == Side::Above {
                    self.cross(&mut motion, surface, &mut None)?;
                }
            }
        }
        if let Some(force) = &mut company.force {
            force.at(t, &motion.state, values, &mut motion.force);
        }
        if let Some(tangents) = &mut company.tangents {
            tangents.begin(t, &motion.state, values);
        }
        Ok(motion)
    }

    /// The regime with these sides.
    fn regime(&mut self, sides: &[Side]) -> Result<usize, String> {
        self.known_regime(sides)
            .ok_or_else(|| "a regime cannot be prepared".to_owned())
    }

    fn known_regime(&mut self, sides: &[Side]) -> Option<usize> {
        if let Some(known) = self.known.get(sides) {
            return *known;
        }
        let made = Regime::new(&mut self.evaluator, &self.surfaces, sides, self.step);
        let place = made.map(|regime| {
            self.regimes.push(regime);
            self.regimes.len() - 1
        });
        self.known.insert(sides.to_vec(), place);
        place
    }

    /// Goes on with constant inputs to a time, s.
    fn interval(
        &mut self,
        motion: &mut Motion,
        until: f64,
        inputs: &[f64],
        company: &mut Company<'_, '_>,
    ) -> Result<(), String> {
        motion.given.truncate(1);
        motion.given.extend(inputs);
        self.prepare(motion);
        if let Some(force) = &mut company.force {
            force.at(motion.t, &motion.state, inputs, &mut motion.force);
        }
        if let Some(tangents) = &mut company.tangents {
            tangents.meet(motion.t, &motion.state, inputs);
        }
        let begin = motion.t;
        let count = ((until - begin) / self.step).ceil().max(1.0);
        let rounded = ((until - begin) / self.step).round();
        let whole = (rounded * self.step - (until - begin)).abs() < JITTER * (until - begin);
        let count = if whole { rounded.max(1.0) } else { count };
        let length = (until - begin) / count;
        for place in 1..=count as usize {
            self.release(motion, begin + (place - 1) as f64 * length, company)?;
            let end = begin + place as f64 * length;
            if !(whole && self.whole_step(motion, end, inputs, company)) {
                self.parts(motion, length, end, inputs, company)?;
            }
        }
        if let Some(tangents) = &mut company.tangents {
            let regime = &self.regimes[motion.regime];
            tangents.catch_up(regime, until, &motion.state, inputs);
        }
        Ok(())
    }

    /// Prepares for steps in the present regime with the present inputs.
    fn prepare(&self, motion: &mut Motion) {
        let regime = &self.regimes[motion.regime];
        motion.base.clear();
        motion.base.resize(regime.step.rows, 0.0);
        regime
            .step_given
            .add_product(&motion.given, &mut motion.base);
        self.watch(motion);
    }

    /// Finds the surfaces' functions and rates where the motion stands.
    fn watch(&self, motion: &mut Motion) {
        let regime = &self.regimes[motion.regime];
        let half = self.states / 2;
        motion.watched.clear();
        let rows = regime.functions.iter();
        motion
            .watched
            .extend(rows.map(|row| row.at(&motion.state, &motion.given)));
        for (row, function) in regime.rates.iter().zip(&regime.functions) {
            let forced = dot(&function.state[half..], &motion.force);
            motion
                .watched
                .push(row.at(&motion.state, &motion.given) + forced);
        }
    }

    /// Lets go what is no longer held.
    fn release(
        &mut self,
        motion: &mut Motion,
        t: f64,
        company: &mut Company<'_, '_>,
    ) -> Result<(), String> {
        let regime = &self.regimes[motion.regime];
        if regime.held.is_empty() {
            return Ok(());
        }
        let mut changed = false;
        for (surface, side) in &regime.held {
            let side = side.at(&motion.state, &motion.given);
            if !(0.0..=1.0).contains(&side) {
                motion.sides[*surface] = if side > 1.0 { Side::Above } else { Side::Below };
                changed = true;
            }
        }
        if changed {
            if let Some(tangents) = &mut company.tangents {
                tangents.catch_up(regime, t, &motion.state, &motion.given[1..]);
            }
            motion.regime = self.regime(&motion.sides)?;
            self.prepare(motion);
        }
        Ok(())
    }

    /// Makes a whole step if no surface is crossed within.
    fn whole_step(
        &mut self,
        motion: &mut Motion,
        end: f64,
        inputs: &[f64],
        company: &mut Company<'_, '_>,
    ) -> bool {
        let (n, half) = (self.states, self.states / 2);
        let regime = &self.regimes[motion.regime];
        motion.next.clear();
        motion.next.extend_from_slice(&motion.base);
        regime.step.add_product(&motion.state, &mut motion.next);
        let mut later = [0.0; 32];
        if let Some(force) = &mut company.force {
            regime
                .step_force
                .add_product(&motion.force, &mut motion.next);
            let later = &mut later[..half];
            force.at(end, &motion.next[..n], inputs, later);
            for (new, old) in later.iter().zip(&mut motion.force) {
                *old = 0.5 * (new - *old);
            }
            regime
                .step_force
                .add_product(&motion.force, &mut motion.next);
            // Undone, for the case that the step is made in parts.
            for (new, old) in later.iter().zip(&mut motion.force) {
                *old = new - 2.0 * *old;
            }
        }
        let surfaces = motion.sides.len();
        let (function, rate) = motion.watched.split_at(surfaces);
        let crossed = (0..surfaces).any(|place| {
            let ends = (
                (function[place], rate[place]),
                (motion.next[n + place], motion.next[n + surfaces + place]),
            );
            first_crossing(motion.sides[place], ends, self.step).is_some()
        });
        if crossed {
            return false;
        }
        motion.state.copy_from_slice(&motion.next[..n]);
        if company.force.is_some() {
            motion.force.copy_from_slice(&later[..half]);
        }
        motion
            .watched
            .copy_from_slice(&motion.next[n..n + 2 * surfaces]);
        if company.force.is_some() {
            for place in 0..surfaces {
                let forced = dot(&regime.functions[place].state[half..], &motion.force);
                motion.watched[surfaces + place] += forced;
            }
        }
        if let Some(tangents) = &mut company.tangents {
            tangents.step(regime, end, &motion.state, inputs);
        }
        true
    }

    /// Makes a step in parts, from surface to surface.
    fn parts(
        &mut self,
        motion: &mut Motion,
        length: f64,
        end: f64,
        inputs: &[f64],
        company: &mut Company<'_, '_>,
    ) -> Result<(), String> {
        let mut rest = length;
        let surfaces = motion.sides.len();
        if let Some(tangents) = &mut company.tangents {
            let regime = &self.regimes[motion.regime];
            tangents.catch_up(regime, end - length, &motion.state, inputs);
        }
        for _ in 0..MOST_CROSSINGS {
            self.watch(motion);
            let begin = (motion.watched.clone(), motion.state.clone());
            self.part(motion, rest);
            let before = std::mem::take(&mut motion.watched);
            self.watch(motion);
            let first = (0..surfaces)
                .filter_map(|place| {
                    let ends = (
                        (begin.0[place], begin.0[surfaces + place]),
                        (motion.watched[place], motion.watched[surfaces + place]),
                    );
                    let tau = first_crossing(motion.sides[place], ends, rest)?;
                    Some((place, tau))
                })
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((surface, tau)) = first else {
                return self.ended(motion, rest, end, inputs, company);
            };
            motion.watched = before;
            motion.state.copy_from_slice(&begin.1);
            let tau = self.polished(motion, surface, tau, rest, &begin.1);
            rest -= tau;
            let t = end - rest;
            self.accompany(motion, tau, t, inputs, company);
            self.cross(motion, surface, &mut company.tangents)?;
            if rest <= 0.0 {
                self.prepare(motion);
                return Ok(());
            }
        }
        self.part(motion, rest);
        self.ended(motion, rest, end, inputs, company)?;
        // Where surfaces follow each other too fast, signs decide.
        let regime = &self.regimes[motion.regime];
        for (side, function) in motion.sides.iter_mut().zip(&regime.functions) {
            if *side != Side::Held {
                let above = function.at(&motion.state, &motion.given) > 0.0;
                *side = if above { Side::Above } else { Side::Below };
            }
        }
        motion.regime = self.regime(&motion.sides)?;
        self.prepare(motion);
        Ok(())
    }

    /// Moves the state on by a part of a step, s.
    fn part(&self, motion: &mut Motion, tau: f64) {
        let regime = &self.regimes[motion.regime];
        let mut rates = vec![0.0; regime.matrix.rows];
        self.rates(motion, &mut rates);
        tangents::series(&regime.matrix, &mut motion.state, &mut rates, tau, ROUNDING);
    }

    /// The rates where the motion stands.
    fn rates(&self, motion: &Motion, out: &mut [f64]) {
        let regime = &self.regimes[motion.regime];
        let (n, half) = (self.states, self.states / 2);
        out.fill(0.0);
        for (column, value) in regime.given.column_iter().zip(&motion.given) {
            out.iter_mut()
                .zip(column.iter())
                .for_each(|(o, c)| *o += c * value);
        }
        out[half..n]
            .iter_mut()
            .zip(&motion.force)
            .for_each(|(o, f)| *o += f);
        regime.matrix.add_product(&motion.state, out);
    }

    /// Goes to where a surface is crossed, about `tau` s from `begin`; returns when that is.
    fn polished(
        &self,
        motion: &mut Motion,
        surface: usize,
        tau: f64,
        most: f64,
        begin: &[f64],
    ) -> f64 {
        self.part(motion, tau);
        let regime = &self.regimes[motion.regime];
        let value = regime.functions[surface].at(&motion.state, &motion.given);
        let mut rates = vec![0.0; regime.matrix.rows];
        self.rates(motion, &mut rates);
        let rate = dot(&regime.functions[surface].state, &rates[..self.states]);
        let better = (tau - value / rate).clamp(0.0, most);
        if !better.is_finite() || better == tau {
            return tau;
        }
        motion.state.copy_from_slice(begin);
        self.part(motion, better);
        better
    }

    /// After a part that reached the step's end.
    fn ended(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        end: f64,
        inputs: &[f64],
        company: &mut Company<'_, '_>,
    ) -> Result<(), String> {
        self.accompany(motion, tau, end, inputs, company);
        self.prepare(motion);
        Ok(())
    }

    /// Lets the others follow a part of a step.
    fn accompany(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        t: f64,
        inputs: &[f64],
        company: &mut Company<'_, '_>,
    ) {
        if let Some(force) = &mut company.force {
            force.at(t, &motion.state, inputs, &mut motion.force);
        }
        if let Some(tangents) = &mut company.tangents {
            let regime = &self.regimes[motion.regime];
            tangents.part(regime, tau, (t, &motion.state, inputs));
        }
    }

    /// Goes through a surface, or stays on it where forces on both sides lead back.
    fn cross(
        &mut self,
        motion: &mut Motion,
        surface: usize,
        tangents: &mut Option<&mut Tangents<'_>>,
    ) -> Result<(), String> {
        let before = motion.regime;
        let mut rates = vec![0.0; self.regimes[before].matrix.rows];
        self.rates(motion, &mut rates);
        let (beyond, outward) = match motion.sides[surface] {
            Side::Above => (Side::Below, -1.0),
            Side::Below | Side::Held => (Side::Above, 1.0),
        };
        let old = motion.sides[surface];
        motion.sides[surface] = beyond;
        motion.regime = self.regime(&motion.sides)?;
        let mut after = rates.clone();
        self.rates(motion, &mut after);
        let function = &self.regimes[before].functions[surface].state;
        let size: f64 = function
            .iter()
            .zip(&after)
            .map(|(a, b)| (a * b).abs())
            .sum();
        let (here, there) = (dot(function, &rates), dot(function, &after));
        if there * outward < -LEADS_BACK * size && here * outward > 0.0 {
            motion.sides[surface] = Side::Held;
            match self.known_regime(&motion.sides) {
                Some(held) => motion.regime = held,
                None => motion.sides[surface] = beyond,
            }
            self.rates(motion, &mut after);
        } else if old == Side::Below && here == 0.0 && there <= 0.0 {
            // It only touches.
            motion.sides[surface] = old;
            motion.regime = before;
            return Ok(());
        }
        if let Some(tangents) = tangents {
            tangents.switch(&self.regimes[before].functions[surface], &rates, &after);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
