//! Release of a motion by a surface: the time at which the holding force leaves the interval between the forces
//! on both sides.

use super::crossing::find_first_crossing;
use super::regime::HoldingForce;
use super::remainder::Remainder;
use super::remainder_search::OFFSET_STEPS;
use super::surfaces::{Side, dot};
use super::types::{ExponentialIntegrator, Motion, Options};

/// A state and the nonlinear remainder at this state.
type End<'e> = (&'e [f64], &'e Remainder);

/// Release of a motion by a surface.
#[derive(Clone, Copy)]
pub(super) struct Release {
    /// Index among the surfaces that hold the motion.
    pub place: usize,
    /// Side of the motion after the release.
    pub to: Side,
    /// Time since the start of the step, s.
    pub tau: f64,
    /// Rate at which the nonlinear remainder changes the holding force.
    pub slope: f64,
}

impl ExponentialIntegrator {
    /// Returns the first release within a step of this length, s. The holding forces are approximated by cubics
    /// through both ends.
    pub(super) fn find_first_release(
        &self,
        motion: &Motion,
        (begin, end): (End<'_>, End<'_>),
        length: f64,
    ) -> Option<Release> {
        let held = self.regimes[motion.regime].held.iter().enumerate();
        let releases = held.flat_map(|(place, held)| {
            let holding_force_change = |remainder: &Remainder| {
                remainder
                    .holding_force_change
                    .get(place)
                    .copied()
                    .unwrap_or(0.0)
            };
            let slope = (holding_force_change(end.1) - holding_force_change(begin.1)) / length;
            let at = |(state, remainder): End<'_>, force: &HoldingForce| {
                let value =
                    force.value.evaluate(state, &motion.given) + holding_force_change(remainder);
                let forced = dot(&force.value.state[self.degrees..], &remainder.force);
                (
                    value,
                    force.rate.evaluate(state, &motion.given) + forced + slope,
                )
            };
            [Side::Below, Side::Above].map(|to| {
                let inside = match to {
                    Side::Above => Side::Below,
                    Side::Below | Side::Held => Side::Above,
                };
                let force = held.force_relative_to(to);
                let ends = (at(begin, force), at(end, force));
                let tau = find_first_crossing(inside, ends, length)?;
                Some(Release {
                    place,
                    to,
                    tau,
                    slope,
                })
            })
        });
        releases.flatten().min_by(|a, b| a.tau.total_cmp(&b.tau))
    }

    /// Releases the motion from surfaces to the given sides. The rates do not jump, because the holding force
    /// equals the force on that side.
    pub(super) fn release_motion(
        &mut self,
        motion: &mut Motion,
        t: f64,
        released: &[(usize, Side)],
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        if let Some(tangents) = &mut options.tangents {
            tangents.leave_surface();
        }
        for (surface, side) in released {
            motion.sides[*surface] = *side;
        }
        motion.regime = self.regime(&motion.sides)?;
        let mut rates = vec![0.0; self.regimes[motion.regime].matrix.rows];
        self.rates(motion, &mut rates);
        self.find_remainder_beside(motion, (t, OFFSET_STEPS), &rates, options)
    }

    /// Releases the motion from surfaces that no longer hold it because an input changed.
    pub(super) fn release(
        &mut self,
        motion: &mut Motion,
        t: f64,
        options: &mut Options<'_, '_>,
    ) -> Result<(), String> {
        let holding_force_change = motion.remainder.holding_force_change.iter().copied();
        let holding_force_change = holding_force_change.chain(std::iter::repeat(0.0));
        let held = self.regimes[motion.regime]
            .held
            .iter()
            .zip(holding_force_change);
        let released: Vec<(usize, Side)> = held
            .filter_map(|(held, holding_force_change)| {
                let [low, high] = [&held.above_low, &held.above_high].map(|force| {
                    force.value.evaluate(&motion.state, &motion.given) + holding_force_change
                });
                let side = match (low < 0.0, high > 0.0) {
                    (true, _) => Some(Side::Below),
                    (false, true) => Some(Side::Above),
                    (false, false) => None,
                };
                Some((held.surface, side?))
            })
            .collect();
        if released.is_empty() {
            return Ok(());
        }
        self.advance_neighbours(motion, t, options)?;
        self.release_motion(motion, t, &released, options)?;
        self.prepare(motion);
        Ok(())
    }
}
