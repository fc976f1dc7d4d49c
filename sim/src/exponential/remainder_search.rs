//! Nonlinear remainder along a motion, including the displacement of surfaces. For example, gear teeth with a
//! transmission error touch when the deflection minus the error reaches the play. If the displacement exceeds
//! the play, the sides of the linear part would give the wrong regime.

use super::remainder::{Force, RegimeDifference, Remainder};
use super::surfaces::Side;
use super::types::{ExponentialIntegrator, Motion, Options};

/// Distance from a crossed surface, in steps, at which the model is evaluated on each side; on the surface
/// itself rounding would decide the side.
pub const OFFSET_STEPS: f64 = 1e-4;

impl ExponentialIntegrator {
    /// Computes the nonlinear remainder at the current state of a motion.
    pub(super) fn find_remainder(
        &mut self,
        motion: &mut Motion,
        t: f64,
        force: &mut dyn Force,
    ) -> Result<(), String> {
        let here = (motion.regime, &motion.sides[..]);
        let at = (t, &motion.state[..], &motion.given[..]);
        self.compute_remainder(here, at, force, &mut motion.remainder)
    }

    /// Computes the nonlinear remainder at any state, relative to a regime with its sides.
    pub(super) fn compute_remainder(
        &mut self,
        (here, sides): (usize, &[Side]),
        (t, state, given): (f64, &[f64], &[f64]),
        force: &mut dyn Force,
        out: &mut Remainder,
    ) -> Result<(), String> {
        let functions = &self.regimes[here].functions;
        let force = (force, &self.prescribed);
        out.find(force, (&self.surfaces, functions), (t, state, given));
        self.convert_to_regime((here, sides), state, given, out)?;
        self.regimes[here].subtract_held(&mut out.force, &mut out.holding_force_change);
        Ok(())
    }

    /// Computes the remainder `steps` steps away from a crossed surface, at a state extrapolated with the given
    /// rates.
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
        self.compute_remainder(here, at, &mut **force, &mut motion.remainder)
    }

    /// Converts accelerations from the regime of the linear part at this state to the regime `here`.
    fn convert_to_regime(
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
        if self.last_linear_sides.0 != self.own {
            let own = self.own.clone();
            self.last_linear_sides = (own.clone(), self.regime(&own)?);
        }
        let pair = (self.last_linear_sides.1, here);
        if self.regime_difference.pair != pair {
            self.regime_difference = RegimeDifference::new(
                &self.regimes[pair.0],
                &self.regimes[pair.1],
                (self.states, self.degrees),
                pair,
            );
        }
        self.regime_difference
            .add(state, given, &mut remainder.force);
        Ok(())
    }
}
