//! Derivatives of the nonlinear remainder with respect to the state, which tangent vectors need in addition to the
//! matrix of the linear part. They are finite differences, because the model provides only accelerations.

use super::remainder::{Force, Remainder};
use super::slopes::Slopes;
use super::surfaces::Side;
use super::types::{ExponentialIntegrator, Motion, Options};

/// Number of steps between two computations of the derivatives; each switch also causes one. The derivatives
/// vary with the position, which changes little in this time.
const DIFFERENTIATION_INTERVAL: usize = 4;

/// Step of a finite difference, as a fraction of the displacement of the state in a time step.
/// [`VALUE_FRACTION`] applies if it gives a larger step.
const DISPLACEMENT_FRACTION: f64 = 1e-3;
const VALUE_FRACTION: f64 = 1e-8;

/// Smallest step of a finite difference, as a fraction of the typical size of the state; it applies to states
/// at rest at 0.
const TYPICAL_SIZE_FRACTION: f64 = 1e-10;

/// Changes of an acceleration below this fraction of its largest magnitude so far count as rounding.
/// Accelerations are not compared with each other because their units may differ.
const ROUNDING_FRACTION: f64 = 1e-10;

impl ExponentialIntegrator {
    /// Advances the tangent vectors by their pending steps to the current time of the motion.
    pub(super) fn advance_neighbours(
        &mut self,
        motion: &Motion,
        t: f64,
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let Some(tangents) = options.tangents.as_deref_mut() else {
            return Ok(());
        };
        if tangents.is_behind() {
            if let (Some(force), Some(slopes)) = (&mut options.force, &mut tangents.slopes) {
                self.differentiate(motion, t, &mut **force, slopes)?;
            }
            let regime = &self.regimes[motion.regime];
            tangents.advance_pending(regime, t, &motion.state, &motion.given);
        }
        Ok(())
    }

    /// Computes the derivatives at the current state, which must not be on a surface: rounding would decide its
    /// side.
    pub(super) fn differentiate(
        &mut self,
        motion: &Motion,
        t: f64,
        force: &mut dyn Force,
        slopes: &mut Slopes,
    ) -> Result<(), String> {
        let is_due = slopes.call_count.is_multiple_of(DIFFERENTIATION_INTERVAL);
        slopes.call_count += 1;
        if !is_due && slopes.is_known[0] {
            slopes.keep();
            return Ok(());
        }
        let (degrees, forced) = (self.degrees, self.forced);
        let n = degrees + forced;
        let rows = self.regimes[motion.regime].matrix.rows;
        slopes.rates.resize(rows, 0.0);
        self.rates(motion, &mut slopes.rates);
        let accelerations = slopes.rates[degrees..n].iter();
        for (largest, acceleration) in slopes.largest.iter_mut().zip(accelerations) {
            *largest = largest.max(acceleration.abs());
        }
        let (mut base, mut moved) = (
            std::mem::take(&mut slopes.base),
            std::mem::take(&mut slopes.moved),
        );
        slopes.state.clone_from(&motion.state);
        let here = (motion.regime, &motion.sides[..]);
        self.compute_remainder(here, (t, &slopes.state, &motion.given), force, &mut base)?;
        for index in 0..n {
            let x = motion.state[index];
            slopes.state[index] = x + self.choose_difference(index, x, slopes.rates[index]);
            let size = slopes.state[index] - x;
            self.compute_remainder(here, (t, &slopes.state, &motion.given), force, &mut moved)?;
            slopes.state[index] = x;
            if self.sides_differ(motion, index, size, (&base, &moved)) {
                continue;
            }
            let mut matters = false;
            let column = &mut slopes.there[index * forced..(index + 1) * forced];
            let slots = column.iter_mut().zip(&slopes.largest);
            for ((slot, largest), (after, before)) in slots.zip(pair_accelerations(&moved, &base)) {
                matters |= (after - before).abs() > ROUNDING_FRACTION * largest;
                *slot = (after - before) / size;
            }
            if matters && !slopes.active.contains(&index) {
                slopes.active.push(index);
            }
        }
        (slopes.base, slopes.moved) = (base, moved);
        slopes.is_known[1] = true;
        Ok(())
    }

    /// Returns the gradient of a surface's function in the whole model. The rates scale the steps of the
    /// differences.
    pub(super) fn compute_gradient(
        &self,
        motion: &Motion,
        (surface, t): (usize, f64),
        force: &mut dyn Force,
        rates: &[f64],
    ) -> Vec<f64> {
        let mut gradient = self.regimes[motion.regime].functions[surface].state.clone();
        let inputs = &self
            .prescribed
            .model_inputs(&motion.state, &motion.given[1..]);
        let guard = self.surfaces.guards[surface][0];
        let own = self.prescribed.model_state(&motion.state);
        let (mut state, mut values) = (own.to_vec(), Vec::new());
        if !force.write_guards(t, &state, inputs, &mut values) {
            return gradient;
        }
        let here = values[guard];
        for (index, slot) in gradient[..own.len()].iter_mut().enumerate() {
            let x = state[index];
            state[index] = x + self.choose_difference(index, x, rates[index]);
            force.write_guards(t, &state, inputs, &mut values);
            *slot = (values[guard] - here) / (state[index] - x);
            state[index] = x;
        }
        gradient
    }

    /// Returns the step of a finite difference for a state with this rate.
    fn choose_difference(&self, index: usize, x: f64, rate: f64) -> f64 {
        let size = (DISPLACEMENT_FRACTION * (rate * self.step).abs()).max(VALUE_FRACTION * x.abs());
        size.max(TYPICAL_SIZE_FRACTION * self.typical_sizes[index])
    }

    /// Returns true if a surface separates the state of a motion from the same state with one changed entry.
    fn sides_differ(
        &self,
        motion: &Motion,
        index: usize,
        size: f64,
        (base, moved): (&Remainder, &Remainder),
    ) -> bool {
        let functions = self.regimes[motion.regime].functions.iter();
        let both = base.moved.iter().zip(&moved.moved);
        functions.zip(both).any(|(function, (before, after))| {
            let here = function.evaluate(&motion.state, &motion.given);
            let there = here + size * function.state[index];
            Side::from_value(here + before) != Side::from_value(there + after)
        })
    }
}

/// Returns pairs of the accelerations of two remainders.
fn pair_accelerations<'e>(
    a: &'e Remainder,
    b: &'e Remainder,
) -> impl Iterator<Item = (&'e f64, &'e f64)> {
    a.force.iter().zip(&b.force)
}
