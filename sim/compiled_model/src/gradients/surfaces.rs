//! Magnitudes of surface functions over a motion, and rejection of motions that touch a surface.

use eomgen_sim::ode::SurfaceMode;

use super::pull_back::{BackwardPass, no_gradient};
use super::recorder::{Part, PartKind};
use crate::error::Error;

/// Largest jump of a rate over a surface that counts as none, relative to its largest magnitude over the motion. At a
/// kink the rates differ only by their change within the accuracy of the event location.
const MAX_KINK_JUMP_FRACTION: f64 = 1e-9;

/// Distance from a surface at which the motion counts as touching it, in tolerances of the switching function.
const MAX_TOUCH_TOLERANCES: f64 = 10.0;

impl<'r> BackwardPass<'r, '_> {
    /// Determines the largest magnitudes of rates and switching functions over the motion. Rejects motions that touch a
    /// surface.
    pub fn measure_surfaces(&mut self) -> Result<(), Error> {
        let recorded = self.recorded;
        let count = self.evaluator.surface_count();
        let (mut values, mut rates) = (vec![0.0; count], vec![0.0; count]);
        let mut state_rates = vec![0.0; self.rate_sizes.len()];
        let mut ends = Vec::new();
        for part in &recorded.recording.parts {
            if let Some(surface) = (part.modes.iter()).position(|mode| *mode == SurfaceMode::Closed)
            {
                let cause = format!("the contact `{}` stays closed", self.formula(surface));
                return Err(no_gradient(part.start.0, &cause));
            }
            self.evaluator.set_modes(&part.modes);
            for (t, state) in [&part.start, &part.end] {
                let given = recorded.inputs().evaluate(self.clip(part, *t));
                let at = (*t, &state[..]);
                self.evaluator.write_rates(at, &given, &mut state_rates)?;
                for (size, rate) in self.rate_sizes.iter_mut().zip(&state_rates) {
                    *size = size.max(rate.abs());
                }
                let out = (&mut values[..], &mut rates[..]);
                self.evaluator.write_surfaces(at, &given, out)?;
                for (size, (value, rate)) in
                    self.surface_sizes.iter_mut().zip(values.iter().zip(&rates))
                {
                    *size = (size.0.max(value.abs()), size.1.max(rate.abs()));
                }
            }
            ends.push(values.clone());
        }
        let allowed = MAX_TOUCH_TOLERANCES * recorded.tolerance;
        for (place, values) in ends.iter().enumerate() {
            let (part, next) = (self.part(place), recorded.recording.parts.get(place + 1));
            let is_step = |part: &Part| part.kind == PartKind::Step;
            if !is_step(part) || !next.is_none_or(is_step) {
                continue;
            }
            for (surface, value) in values.iter().enumerate() {
                let is_free = matches!(
                    part.modes[surface],
                    SurfaceMode::Positive | SurfaceMode::Negative
                );
                let is_near = value.abs() <= allowed * self.surface_sizes[surface].0;
                if is_free && is_near && self.state_jumps(part, surface)? {
                    return Err(self.touches(part.end.0, surface));
                }
            }
        }
        self.check_start()
    }

    /// Rejects motions that start on a surface at which rates or states jump, unless the surface holds the motion.
    fn check_start(&mut self) -> Result<(), Error> {
        let Some(first) = self.recorded.recording.parts.first() else {
            return Ok(());
        };
        let count = self.evaluator.surface_count();
        let (mut values, mut rates) = (vec![0.0; count], vec![0.0; count]);
        let (t, state) = &first.start;
        let given = self.recorded.inputs().evaluate(*t);
        self.evaluator.set_modes(&first.modes);
        self.evaluator
            .write_surfaces((*t, state), &given, (&mut values, &mut rates))?;
        for (surface, mode) in first.modes.iter().enumerate() {
            let is_on = match mode {
                SurfaceMode::Unknown => true,
                SurfaceMode::Positive | SurfaceMode::Negative => values[surface] == 0.0,
                _ => false,
            };
            if is_on && self.state_jumps(first, surface)? {
                return Err(self.touches(first.start.0, surface));
            }
        }
        Ok(())
    }

    pub fn touches(&self, t: f64, surface: usize) -> Error {
        let surface = self.formula(surface);
        no_gradient(
            t,
            &format!(
                "the motion touches the surface `{surface}` = 0, where a neighbouring motion may or may not cross it"
            ),
        )
    }

    pub fn formula(&self, surface: usize) -> &'r str {
        let surface = self.recorded.motion.surfaces.get(surface);
        surface.map_or("", |surface| &surface.formula)
    }

    /// Returns true if the surface belongs to an impact, or if the rates on its two sides differ at the end of a part.
    fn state_jumps(&mut self, part: &Part, surface: usize) -> Result<bool, Error> {
        if self.evaluator.impact_of(surface).is_some() {
            return Ok(true);
        }
        let (t, state) = (part.end.0, &part.end.1[..]);
        let given = self.recorded.inputs().evaluate(self.clip(part, t));
        let mut sides = [(); 2].map(|()| vec![0.0; state.len()]);
        for (side, out) in [0.0, 1.0].into_iter().zip(&mut sides) {
            self.evaluator.set_modes(&part.modes);
            if !self.evaluator.set_side(surface, side) {
                return Ok(false);
            }
            self.evaluator.write_rates((t, state), &given, out)?;
        }
        let [from, to] = sides;
        Ok(!self.is_kink(&from, &to))
    }

    /// Returns true if the rates on both sides of a surface are equal within the accuracy of the event location.
    pub fn is_kink(&self, from: &[f64], to: &[f64]) -> bool {
        let mut pairs = from.iter().zip(to).zip(&self.rate_sizes);
        pairs.all(|((from, to), size)| (to - from).abs() <= MAX_KINK_JUMP_FRACTION * size)
    }
}
