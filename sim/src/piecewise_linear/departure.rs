//! How a motion is let go by a surface that held it, as a body breaks away from dry friction.
//!
//! There the surface's function stands at its threshold, and its rate is zero: the force has
//! just reached what friction can bear, and what leads off is the second derivative. Value and
//! rate are rounding. Taken at their signs they would lead back onto the surface, off it again,
//! and so on. So the state is put onto the surface, and until the function is farther away than
//! rounding can have brought it, `flow` takes what it does within that for none.

use super::propagator::{Motion, Propagator};

impl Propagator {
    /// After a change from the regime `before`: the motion stands on every surface that holds it
    /// from here on, or did until here, and departs from those that did.
    pub(super) fn let_go(&self, motion: &mut Motion, before: usize) {
        let (before, after) = (&self.regimes[before], &self.regimes[motion.regime]);
        for (family, pair) in before.cells.iter().zip(&after.cells).enumerate() {
            if pair.0 == pair.1 {
                continue;
            }
            motion.departing.retain(|departing| *departing != family);
            let (rank, departs) = match (pair.0.standing_on(), pair.1.standing_on()) {
                (_, Some(rank)) => (rank, false),
                (Some(rank), None) => (rank, true),
                (None, None) => continue,
            };
            let function = &after.functions[family];
            if function.is_still() {
                // It rests: there is no surface that the state could be put onto.
                continue;
            }
            if departs {
                motion.departing.push(family);
            }
            let threshold = self.families[family].threshold(&after.regime.system, rank);
            let row = function.state.as_slice();
            let value: f64 = row.iter().zip(&motion.state).map(|(a, y)| a * y).sum();
            let excess = (value - threshold) / function.state.norm_squared();
            for (state, factor) in motion.state.iter_mut().zip(row) {
                *state -= factor * excess;
            }
        }
    }
}
