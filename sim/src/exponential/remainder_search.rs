//! The nonlinear remainder along a motion: what of a model is not linear between its surfaces: accelerations, and how far the surfaces
//! themselves lie beyond the linear part's. Teeth with a transmission error touch where the
//! deflection less the error reaches the play; where that differs from the linear part's place
//! by more than the play, an integration by the linear part's sides would be in the wrong regime.

use super::remainder::{Force, RegimeDifference, Remainder};
use super::surfaces::Side;
use super::types::{ExponentialIntegrator, Motion, Options};

/// Distance from a crossed surface, in steps, at which a model is evaluated on either side: on the
/// surface itself rounding errors decide the side.
pub const OFFSET_STEPS: f64 = 1e-4;

impl ExponentialIntegrator {
    /// Computes the nonlinear remainder at the present state of a motion.
    pub(super) fn find_remainder(
        &mut self,
        motion: &mut Motion,
        t: f64,
        force: &mut dyn Force,
    ) -> Result<(), String> {
        let here = (motion.regime, &motion.sides[..]);
        let at = (t, &motion.state[..], &motion.given[..]);
        self.remainder_at(here, at, force, &mut motion.remainder)
    }

    /// The same at any state, relative to a regime with its sides.
    pub(super) fn remainder_at(
        &mut self,
        (here, sides): (usize, &[Side]),
        (t, state, given): (f64, &[f64], &[f64]),
        force: &mut dyn Force,
        out: &mut Remainder,
    ) -> Result<(), String> {
        let functions = &self.regimes[here].functions;
        let force = (force, &self.prescribed);
        out.find(force, (&self.surfaces, functions), (t, state, given));
        self.relate((here, sides), state, given, out)?;
        self.regimes[here].subtract_held(&mut out.force, &mut out.borne);
        Ok(())
    }

    /// Computes the remainder at a distance of `steps` from a crossed surface, by extrapolation
    /// with the given rates.
    pub(super) fn find_remainder_beside(
        &mut self,
        motion: &mut Motion,
        (t, steps): (f64, f64),
        rates: &[f64],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let Some(force) = &mut options.force else {
            return Ok(());
        };
        if !motion.remainder.moves {
            return self.find_remainder(motion, t, &mut **force);
        }
        let tau = steps * self.step;
        let near = motion.state.iter().zip(rates);
        let near: Vec<f64> = near.map(|(x, rate)| x + tau * rate).collect();
        let here = (motion.regime, &motion.sides[..]);
        let at = (t + tau, &near[..], &motion.given[..]);
        self.remainder_at(here, at, &mut **force, &mut motion.remainder)
    }

    /// Takes accelerations relative to those of a regime on its sides, instead of the regime in
    /// which the linear part would be.
    fn relate(
        &mut self,
        (here, sides): (usize, &[Side]),
        state: &[f64],
        given: &[f64],
        remainder: &mut Remainder,
    ) -> Result<(), String> {
        if !remainder.moves {
            return Ok(());
        }
        let functions = &self.regimes[here].functions;
        self.own.clear();
        self.own.extend_from_slice(sides);
        for ((side, function), moved) in self.own.iter_mut().zip(functions).zip(&remainder.moved) {
            if *moved != 0.0 && *side != Side::Held {
                *side = Side::from_value(function.evaluate(state, given));
            }
        }
        if self.own == sides {
            return Ok(());
        }
        if self.last_own.0 != self.own {
            let own = self.own.clone();
            self.last_own = (own.clone(), self.regime(&own)?);
        }
        let pair = (self.last_own.1, here);
        if self.apart.pair != pair {
            self.apart = RegimeDifference::new(
                &self.regimes[pair.0],
                &self.regimes[pair.1],
                (self.states, self.degrees),
                pair,
            );
        }
        self.apart.add(state, given, &mut remainder.force);
        Ok(())
    }
}
