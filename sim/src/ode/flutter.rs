//! Switching functions that change sign within the tolerance although the rates are continuous at their surface.
//!
//! The flow sign(p)*sqrt(abs(p)) between two chambers keeps the difference p of their pressures near 0, within the
//! tolerance of the pressures. The rates agree there, so that the side does not matter: a step may pass the surface.

use super::system::System;
use super::watch::WatchedSystem;

/// Least distance from a surface, in roundings of its function, within which its side does not matter.
const MIN_NEAR_ROUNDINGS: f64 = 64.0;

/// Ratio of the two distances at which rates on both sides are compared.
const DISTANCE_RATIO: f64 = 16.0;

/// Least growth of a difference of rates that vanishes at the surface; that of a root grows fourfold.
const MIN_GROWTH: f64 = 1.5;

/// Differences below this part of the rates are rounding.
const RATE_ROUNDING: f64 = 1e-12;

impl<S: System + ?Sized> WatchedSystem<'_, S> {
    /// Returns true if changes of the states at `t` by a relative `tolerance` can make `value` of the switching
    /// function `guard` 0.
    pub(super) fn is_at_surface(
        &self,
        (guard, value): (usize, f64),
        (t, y): (f64, &[f64]),
        tolerance: f64,
    ) -> bool {
        value.abs() <= near_roundings(tolerance) * self.guard_roundings(t, y)[guard]
    }

    /// Returns true if the differences of the rates on both sides of a surface near `y` vanish towards it.
    pub(super) fn has_continuous_rates(
        &self,
        guard: usize,
        (t, y): (f64, &[f64]),
        tolerance: f64,
    ) -> bool {
        let Some((entry, rounding)) = self.most_influential_state(guard, t, y) else {
            return false;
        };
        let step = near_roundings(tolerance) * rounding;
        self.fix_sides(false);
        let mut beside = y.to_vec();
        let mut rates = |offset: f64| {
            beside[entry] = y[entry] + offset;
            let mut rates = vec![0.0; y.len()];
            self.rates(t, &beside, &mut rates);
            rates
        };
        let [below, above] = [-step, step].map(&mut rates);
        let [far_below, far_above] = [-step, step].map(|step| rates(DISTANCE_RATIO * step));
        self.fix_sides(true);
        (0..y.len()).all(|row| {
            let near = (above[row] - below[row]).abs();
            let far = (far_above[row] - far_below[row]).abs();
            let size = above[row].abs().max(below[row].abs());
            near <= RATE_ROUNDING * size || far >= MIN_GROWTH * near
        })
    }

    /// Returns the state that moves a switching function most by its rounding, and the change of this state for which
    /// the function changes by the rounding of all states.
    fn most_influential_state(&self, guard: usize, t: f64, y: &[f64]) -> Option<(usize, f64)> {
        let here = self.evaluate_guards(t, y)[guard];
        let mut beside = y.to_vec();
        let mut change = |entry: usize| {
            beside[entry] = y[entry].next_up();
            let change = (self.evaluate_guards(t, &beside)[guard] - here).abs();
            beside[entry] = y[entry];
            change
        };
        let changes: Vec<f64> = (0..y.len()).map(&mut change).collect();
        let entry = (0..y.len()).max_by(|a, b| changes[*a].total_cmp(&changes[*b]))?;
        let spacing = y[entry].next_up() - y[entry];
        let all: f64 = changes.iter().sum();
        (changes[entry] > 0.0).then(|| (entry, spacing * all / changes[entry]))
    }
}

/// Returns a relative tolerance in roundings.
fn near_roundings(tolerance: f64) -> f64 {
    (tolerance / f64::EPSILON).max(MIN_NEAR_ROUNDINGS)
}
