//! Steps with events: they are made in parts, from event to event.

use super::crossing::find_first_crossing;
use super::release::Release;
use super::remainder::Remainder;
use super::remainder_search::OFFSET_STEPS;
use super::surfaces::{Row, Side, dot};
use super::tangents::{ReachedSurface, add_exponential_series};
use super::types::{ExponentialIntegrator, Motion, Options};

/// Number of events within a step after which the rest of the step is made without event location.
const MAX_EVENTS_PER_STEP: usize = 12;

/// Relative error of a partial step of the motion.
const PART_ROUNDING_FRACTION: f64 = 1e-16;

/// Delay of a release after the holding force reaches its bound, in steps. The motion then leaves the surface
/// by more than rounding.
const RELEASE_DELAY_STEPS: f64 = 1e-6;

/// Event within a step.
enum Event {
    /// The motion reaches a surface at the time `tau` (s) since the start of the part. `slope` is the rate of
    /// the function due to the nonlinear remainder.
    Crossing {
        surface: usize,
        slope: f64,
        tau: f64,
    },
    /// A surface no longer holds the motion.
    Release(Release),
}

impl Event {
    fn tau(&self) -> f64 {
        match self {
            Self::Crossing { tau, .. } | Self::Release(Release { tau, .. }) => *tau,
        }
    }
}

/// Smallest rate of a function towards its surface, relative to the magnitude of its terms, with which the
/// surface holds the motion.
const MIN_RETURN_RATE: f64 = 1e-9;

impl ExponentialIntegrator {
    /// Makes a step in parts, from event to event.
    pub(super) fn make_partial_steps(
        &mut self,
        motion: &mut Motion,
        length: f64,
        end: f64,
        inputs: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let mut rest = length;
        self.advance_neighbours(motion, end - length, options)?;
        for _ in 0..MAX_EVENTS_PER_STEP {
            self.evaluate_events(motion);
            let begin = (motion.event_values.clone(), motion.state.clone());
            let remainder = motion.remainder.clone();
            self.advance_state(motion, rest);
            let before = std::mem::take(&mut motion.event_values);
            if let Some(force) = &mut options.force {
                self.find_remainder(motion, end, &mut **force)?;
            }
            self.evaluate_events(motion);
            let first = self.find_first_event(motion, (&begin, &remainder), rest);
            motion.remainder = remainder;
            let Some(event) = first else {
                return self.end_step(motion, rest, end, inputs, options);
            };
            motion.event_values = before;
            motion.state.copy_from_slice(&begin.1);
            let tau = self.refine_time(motion, &event, rest, &begin.1);
            rest -= tau;
            let t = end - rest;
            self.complete_part(motion, tau, (t, true), inputs, options)?;
            match event {
                Event::Crossing { surface, slope, .. } => {
                    self.cross(motion, t, (surface, slope), options)?;
                }
                Event::Release(release) => {
                    let held = &self.regimes[motion.regime].held[release.place];
                    let released = (held.surface, release.to);
                    self.release_motion(motion, t, &[released], options)?;
                }
            }
            self.crossings += 1;
            if self.crossings > self.most_crossings {
                return Err("events follow each other too fast".to_owned());
            }
            if rest <= 0.0 {
                self.prepare(motion);
                return Ok(());
            }
        }
        self.advance_state(motion, rest);
        self.end_step(motion, rest, end, inputs, options)?;
        // If the events follow each other too fast, the signs of the functions at the end decide the sides.
        let regime = &self.regimes[motion.regime];
        let functions = regime.functions.iter().zip(&motion.remainder.moved);
        for (side, (function, moved)) in motion.sides.iter_mut().zip(functions) {
            if *side != Side::Held {
                *side = Side::from_value(function.evaluate(&motion.state, &motion.given) + moved);
            }
        }
        motion.regime = self.regime(&motion.sides)?;
        let mut rates = vec![0.0; self.regimes[motion.regime].matrix.rows];
        self.rates(motion, &mut rates);
        self.find_remainder_beside(motion, (end, OFFSET_STEPS), &rates, options)?;
        self.prepare(motion);
        Ok(())
    }

    /// Returns the first event in a part of a step of this length, s; the motion is at the end of the part.
    /// `begin` contains the functions of the surfaces with their rates and the state at its start, and the
    /// nonlinear remainder.
    fn find_first_event(
        &self,
        motion: &Motion,
        (begin, remainder): (&(Vec<f64>, Vec<f64>), &Remainder),
        rest: f64,
    ) -> Option<Event> {
        let surfaces = motion.sides.len();
        let crossings = (0..surfaces).filter_map(|surface| {
            let slope = (motion.remainder.moved[surface] - remainder.moved[surface]) / rest;
            let rates = surfaces + surface;
            let end = &motion.event_values;
            let ends = (
                (begin.0[surface], begin.0[rates] + slope),
                (end[surface], end[rates] + slope),
            );
            let tau = find_first_crossing(motion.sides[surface], ends, rest)?;
            Some(Event::Crossing {
                surface,
                slope,
                tau,
            })
        });
        let ends = (
            (&begin.1[..], remainder),
            (&motion.state[..], &motion.remainder),
        );
        let release = self.find_first_release(motion, ends, rest);
        crossings
            .chain(release.map(Event::Release))
            .min_by(|a, b| a.tau().total_cmp(&b.tau()))
    }

    /// Advances the state by a part of a step, s.
    fn advance_state(&self, motion: &mut Motion, tau: f64) {
        let regime = &self.regimes[motion.regime];
        let mut rates = vec![0.0; regime.matrix.rows];
        self.rates(motion, &mut rates);
        add_exponential_series(
            &regime.matrix,
            &mut motion.state,
            &mut rates,
            tau,
            PART_ROUNDING_FRACTION,
        );
    }

    /// Computes the rates at the current state.
    pub(super) fn rates(&self, motion: &Motion, out: &mut [f64]) {
        let regime = &self.regimes[motion.regime];
        let degrees = self.degrees;
        regime.rates(&motion.state, &motion.given, out);
        let sums = out[degrees..self.states]
            .iter_mut()
            .zip(&motion.remainder.force);
        sums.for_each(|(o, f)| *o += f);
    }

    /// Advances from `begin` to an event, by one Newton step from the estimated time. Returns the time since
    /// `begin`, s.
    fn refine_time(&self, motion: &mut Motion, event: &Event, most: f64, begin: &[f64]) -> f64 {
        let regime = &self.regimes[motion.regime];
        let (row, offset, slope): (&Row, f64, f64) = match event {
            Event::Crossing { surface, slope, .. } => {
                let moved = motion.remainder.moved[*surface];
                (&regime.functions[*surface], moved, *slope)
            }
            Event::Release(release) => {
                let holding_force_change = motion.remainder.holding_force_change.get(release.place);
                let offset = holding_force_change.copied().unwrap_or(0.0);
                let force = regime.held[release.place].force_relative_to(release.to);
                (&force.value, offset, release.slope)
            }
        };
        let tau = event.tau();
        self.advance_state(motion, tau);
        let value = row.evaluate(&motion.state, &motion.given) + offset + slope * tau;
        let mut rates = vec![0.0; regime.matrix.rows];
        self.rates(motion, &mut rates);
        let rate = dot(&row.state, &rates[..self.states]) + slope;
        let late = match event {
            Event::Crossing { .. } => 0.0,
            Event::Release(_) => RELEASE_DELAY_STEPS * self.step,
        };
        let better = (tau - value / rate + late).clamp(0.0, most);
        if !better.is_finite() || better == tau {
            return tau;
        }
        motion.state.copy_from_slice(begin);
        self.advance_state(motion, better);
        better
    }

    /// Completes a part that ends at the end of the step.
    fn end_step(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        end: f64,
        inputs: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        self.complete_part(motion, tau, (end, false), inputs, options)?;
        self.prepare(motion);
        Ok(())
    }

    /// Corrects the nonlinear forces over a part of a step, and advances the tangent vectors. `t` is the end of
    /// the part; `on_surface` is true if a surface was reached there.
    fn complete_part(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        (t, on_surface): (f64, bool),
        inputs: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        if options.force.is_some() {
            self.correct_forces(motion, tau, t, options)?;
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
        tangents.advance_part(regime, tau, (t, &motion.state, inputs));
        Ok(())
    }

    /// Corrects the state at the end of a part for the change of the nonlinear forces, which were held at their
    /// initial values.
    fn correct_forces(
        &mut self,
        motion: &mut Motion,
        tau: f64,
        t: f64,
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let before = motion.remainder.force.clone();
        let mut rates = vec![0.0; self.regimes[motion.regime].matrix.rows];
        self.rates(motion, &mut rates);
        // Evaluates the remainder on the near side of the reached surface.
        self.find_remainder_beside(motion, (t, -OFFSET_STEPS), &rates, options)?;
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

    /// Crosses a surface, or enters the regime held on it if the rates on both sides point towards it. `slope`
    /// is the rate of its function due to the nonlinear remainder.
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
        self.find_remainder_beside(motion, (t, -OFFSET_STEPS), &rates, options)?;
        self.rates(motion, &mut rates);
        let (beyond, outward) = match motion.sides[surface] {
            Side::Above => (Side::Below, -1.0),
            Side::Below | Side::Held => (Side::Above, 1.0),
        };
        let old = motion.sides[surface];
        motion.sides[surface] = beyond;
        motion.regime = self.regime(&motion.sides)?;
        self.find_remainder_beside(motion, (t, OFFSET_STEPS), &rates, options)?;
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
        if there * outward < -MIN_RETURN_RATE * size && here * outward > 0.0 {
            motion.sides[surface] = Side::Held;
            motion.regime = self.regime(&motion.sides)?;
            self.find_remainder_beside(motion, (t, OFFSET_STEPS), &rates, options)?;
            self.rates(motion, &mut after);
        } else if old == Side::Below && here == 0.0 && there <= 0.0 {
            // The motion touches the surface without crossing it.
            motion.sides[surface] = old;
            motion.regime = before;
            self.find_remainder_beside(motion, (t, -OFFSET_STEPS), &rates, options)?;
            return Ok(());
        }
        if let Some(tangents) = &mut options.tangents {
            let gradient = match &mut options.force {
                Some(force) => self.compute_gradient(motion, (surface, t), &mut **force, &rates),
                None => function,
            };
            let by_parameter = self.regimes[before].by_parameter.iter();
            let by_parameter = by_parameter.map(|derivative| {
                derivative.functions[surface].evaluate(&motion.state, &motion.given)
            });
            let reached = ReachedSurface {
                gradient: &gradient,
                by_parameter: &by_parameter.collect::<Vec<f64>>(),
                rate: here,
            };
            tangents.apply_saltation(&reached, &rates, &after);
        }
        Ok(())
    }
}
