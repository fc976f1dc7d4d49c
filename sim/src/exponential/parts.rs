//! Steps through surfaces: made in parts, from one crossing to the next.

use super::crossing::first_crossing;
use super::remainder_at::AHEAD;
use super::surfaces::{Side, dot};
use super::tangents::series;
use super::types::{ExponentialIntegrator, Motion, Options};

/// Crossings within a step after which the rest of it is made without looking.
const MOST_CROSSINGS: usize = 12;

/// The motion itself is right to this part of its size.
const ROUNDING: f64 = 1e-16;

/// Where a function's rate leads back by less than this part of its size, it does not.
const LEADS_BACK: f64 = 1e-9;

impl ExponentialIntegrator {
    /// Makes a step in parts, from surface to surface.
    pub(super) fn parts(
        &mut self,
        motion: &mut Motion,
        length: f64,
        end: f64,
        inputs: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let mut rest = length;
        let surfaces = motion.sides.len();
        self.bring(motion, end - length, options)?;
        for _ in 0..MOST_CROSSINGS {
            self.evaluate_events(motion);
            let begin = (motion.event_values.clone(), motion.state.clone());
            let remainder = motion.remainder.clone();
            self.part(motion, rest);
            let before = std::mem::take(&mut motion.event_values);
            if let Some(force) = &mut options.force {
                let at = (end, &motion.state[..], &motion.given[..]);
                let functions = &self.regimes[motion.regime].functions;
                let surfaces = (&self.surfaces, &functions[..]);
                motion.remainder.find(&mut **force, surfaces, at);
            }
            self.evaluate_events(motion);
            let moved = motion.remainder.moved.iter().zip(&remainder.moved);
            let slopes: Vec<f64> = moved.map(|(there, here)| (there - here) / rest).collect();
            motion.remainder = remainder;
            let first = (0..surfaces)
                .filter_map(|place| {
                    let slope = slopes[place];
                    let rates = surfaces + place;
                    let ends = (
                        (begin.0[place], begin.0[rates] + slope),
                        (
                            motion.event_values[place],
                            motion.event_values[rates] + slope,
                        ),
                    );
                    let tau = first_crossing(motion.sides[place], ends, rest)?;
                    Some((place, tau))
                })
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((surface, tau)) = first else {
                return self.ended(motion, rest, end, inputs, options);
            };
            motion.event_values = before;
            motion.state.copy_from_slice(&begin.1);
            let slope = slopes[surface];
            let tau = self.polished(motion, (surface, slope), tau, rest, &begin.1);
            rest -= tau;
            let t = end - rest;
            self.accompany(motion, tau, (t, true), inputs, options)?;
            self.cross(motion, t, (surface, slope), options)?;
            self.crossings += 1;
            if self.crossings > self.most_crossings {
                return Err("surfaces are crossed too often".to_owned());
            }
            if rest <= 0.0 {
                self.prepare(motion);
                return Ok(());
            }
        }
        self.part(motion, rest);
        self.ended(motion, rest, end, inputs, options)?;
        // Where surfaces follow each other too fast, signs decide.
        let regime = &self.regimes[motion.regime];
        let functions = regime.functions.iter().zip(&motion.remainder.moved);
        for (side, (function, moved)) in motion.sides.iter_mut().zip(functions) {
            if *side != Side::Held {
                *side = Side::of(function.at(&motion.state, &motion.given) + moved);
            }
        }
        motion.regime = self.regime(&motion.sides)?;
        let mut rates = vec![0.0; self.regimes[motion.regime].matrix.rows];
        self.rates(motion, &mut rates);
        self.find_remainder_beside(motion, (end, AHEAD), &rates, options)?;
        self.prepare(motion);
        Ok(())
    }

    /// Moves the state on by a part of a step, s.
    fn part(&self, motion: &mut Motion, tau: f64) {
        let regime = &self.regimes[motion.regime];
        let mut rates = vec![0.0; regime.matrix.rows];
        self.rates(motion, &mut rates);
        series(&regime.matrix, &mut motion.state, &mut rates, tau, ROUNDING);
    }

    /// The rates where the motion stands.
    pub(super) fn rates(&self, motion: &Motion, out: &mut [f64]) {
        let regime = &self.regimes[motion.regime];
        let degrees = self.degrees;
        regime.rates(&motion.state, &motion.given, out);
        let sums = out[degrees..self.states]
            .iter_mut()
            .zip(&motion.remainder.force);
        sums.for_each(|(o, f)| *o += f);
    }

    /// Goes to where a surface, moved with a slope, is crossed, about `tau` s from `begin`;
    /// returns when that is.
    fn polished(
        &self,
        motion: &mut Motion,
        (surface, slope): (usize, f64),
        tau: f64,
        most: f64,
        begin: &[f64],
    ) -> f64 {
        self.part(motion, tau);
        let regime = &self.regimes[motion.regime];
        let moved = motion.remainder.moved[surface] + slope * tau;
        let value = regime.functions[surface].at(&motion.state, &motion.given) + moved;
        let mut rates = vec![0.0; regime.matrix.rows];
        self.rates(motion, &mut rates);
        let rate = dot(&regime.functions[surface].state, &rates[..self.states]) + slope;
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
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        self.accompany(motion, tau, (end, false), inputs, options)?;
        self.prepare(motion);
        Ok(())
    }

    /// Lets the others follow a part of a step, to a time and whether on a surface.
    fn accompany(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        (t, on_surface): (f64, bool),
        inputs: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        if options.force.is_some() {
            self.correct(motion, tau, t, options)?;
        }
        let Some(tangents) = options.tangents.as_deref_mut() else {
            return Ok(());
        };
        if let (Some(force), Some(slopes), false) =
            (&mut options.force, &mut tangents.slopes, on_surface)
        {
            self.differentiate(motion, t, &mut **force, slopes)?;
        }
        let regime = &self.regimes[motion.regime];
        tangents.part(regime, tau, (t, &motion.state, inputs));
        Ok(())
    }

    /// Makes good that forces were held at what they were at the beginning of a part.
    fn correct(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        t: f64,
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let before = motion.remainder.force.clone();
        let mut rates = vec![0.0; self.regimes[motion.regime].matrix.rows];
        self.rates(motion, &mut rates);
        // On this side of a surface that was reached.
        self.find_remainder_beside(motion, (t, -AHEAD), &rates, options)?;
        let degrees = self.degrees;
        for (place, before) in before.iter().enumerate() {
            let change = 0.5 * tau * (motion.remainder.force[place] - before);
            motion.state[degrees + place] += change;
            if place < degrees {
                motion.state[place] += change * tau / 3.0;
            }
        }
        Ok(())
    }

    /// Goes through a surface, moved with a slope, or stays on it where forces on both sides
    /// lead back.
    pub(super) fn cross(
        &mut self,
        motion: &mut Motion,
        t: f64,
        (surface, slope): (usize, f64),
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let before = motion.regime;
        let mut rates = vec![0.0; self.regimes[before].matrix.rows];
        self.rates(motion, &mut rates);
        self.find_remainder_beside(motion, (t, -AHEAD), &rates, options)?;
        self.rates(motion, &mut rates);
        let (beyond, outward) = match motion.sides[surface] {
            Side::Above => (Side::Below, -1.0),
            Side::Below | Side::Held => (Side::Above, 1.0),
        };
        let old = motion.sides[surface];
        motion.sides[surface] = beyond;
        motion.regime = self.regime(&motion.sides)?;
        self.find_remainder_beside(motion, (t, AHEAD), &rates, options)?;
        let mut after = rates.clone();
        self.rates(motion, &mut after);
        let function = self.regimes[before].functions[surface].state.clone();
        let size: f64 = function
            .iter()
            .zip(&after)
            .map(|(a, b)| (a * b).abs())
            .sum();
        let (here, there) = (
            dot(&function, &rates) + slope,
            dot(&function, &after) + slope,
        );
        if there * outward < -LEADS_BACK * size && here * outward > 0.0 {
            motion.sides[surface] = Side::Held;
            match self.known_regime(&motion.sides) {
                Some(held) => motion.regime = held,
                None => motion.sides[surface] = beyond,
            }
            self.find_remainder_beside(motion, (t, AHEAD), &rates, options)?;
            self.rates(motion, &mut after);
        } else if old == Side::Below && here == 0.0 && there <= 0.0 {
            // It only touches.
            motion.sides[surface] = old;
            motion.regime = before;
            self.find_remainder_beside(motion, (t, -AHEAD), &rates, options)?;
            return Ok(());
        }
        if let Some(tangents) = &mut options.tangents {
            let gradient = match &mut options.force {
                Some(force) => self.gradient(motion, (surface, t), &mut **force, &rates),
                None => function,
            };
            tangents.switch((&gradient, here), &rates, &after);
        }
        Ok(())
    }
}
