//! Release of a motion from a surface that held it, such as breakaway from dry friction.
//!
//! At the release the surface's function equals its threshold and its rate is zero: the force has just reached
//! the friction limit, and the second derivative points away from the surface. The computed signs of value and
//! rate are rounding errors. If they were used, the motion would alternate between sticking and slipping. The
//! state is therefore projected onto the surface, and `flow` ignores crossings until the distance of the
//! function from its threshold exceeds its rounding error.

use super::propagator::{Departure, Motion, Propagator};

impl Propagator {
    /// Projects the state, after a change from the regime `before`, onto every surface that holds it now or
    /// held it before. The motion departs from the surfaces that held it only before.
    pub(super) fn release_surfaces(&self, motion: &mut Motion, before: usize) {
        let (before, after) = (&self.regimes[before], &self.regimes[motion.regime]);
        for (family, pair) in before.cells.iter().zip(&after.cells).enumerate() {
            if pair.0 == pair.1 {
                continue;
            }
            motion
                .departing
                .retain(|departing| departing.family != family);
            let (rank, departs) = match (pair.0.threshold_rank(), pair.1.threshold_rank()) {
                (_, Some(rank)) => (rank, false),
                (Some(rank), None) => (rank, true),
                (None, None) => continue,
            };
            let function = &after.functions[family];
            if function.is_still() {
                // The function is constant: no change of the state reaches the surface.
                continue;
            }
            if departs {
                motion.departing.push(Departure {
                    family,
                    errors: None,
                });
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
