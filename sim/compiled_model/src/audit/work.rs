//! Work of a step by quadrature of the power.

use std::collections::VecDeque;

use eomgen_sim::ode::{Interior, ObservedStep};

use super::auditor::Auditor;
use super::refinement::Refinement;
use super::{Energies, EnergyAndPower};

/// Allowed error of a quadrature, relative to the allowed change of the energy.
const MAX_QUADRATURE_ERROR_FRACTION: f64 = 0.1;

/// Nodes and weights of Gauss quadrature of order 8 on (0, 1).
const GAUSS_NODES_AND_WEIGHTS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Auditor {
    /// Integrates the power over a step by Simpson's rule; returns false if states inside the step are unknown.
    pub(super) fn integrate_simpson(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut dyn Energies,
        (first, last): (EnergyAndPower, EnergyAndPower),
    ) -> (f64, bool) {
        let (begin, end) = (step.start.0, step.end.0);
        let middle = 0.5 * (begin + end);
        let mean = 0.5 * (first.power + last.power);
        match (step.state_inside)(middle, Interior::Interpolated) {
            Some(state) => {
                self.raise_sizes(&state);
                let power = self.evaluate(energies, (middle, &state)).power;
                ((mean + 2.0 * power) / 3.0 * (end - begin), true)
            }
            None => (mean * (end - begin), false),
        }
    }

    /// Integrates the power over a step and halves panels until the change is small compared with `allowed`. Returns
    /// the work and its uncertainty in J. The uncertainty is nonzero if states inside the step are unknown or if the
    /// panels do not suffice.
    pub(super) fn integrate_work(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut dyn Energies,
        (first, last): (EnergyAndPower, EnergyAndPower),
        (refinement, allowed): (Refinement, f64),
    ) -> (f64, f64) {
        let (begin, length) = (step.start.0, step.end.0 - step.start.0);
        let mut inside = |place: f64| {
            let t = begin + length * place;
            let state = (step.state_inside)(t, refinement.interior)?;
            self.raise_sizes(&state);
            self.audit.evaluations += 1;
            Some(energies.evaluate((t, &state)))
        };
        let Some(whole) = integrate_panel(&mut inside, (0.0, 1.0), length) else {
            let spread = (last.power - first.power).abs();
            let mean = 0.5 * (first.power + last.power);
            return (mean * length, 0.5 * spread * length);
        };
        let most_error = MAX_QUADRATURE_ERROR_FRACTION * allowed;
        let (mut work, mut uncertainty, mut panels) = (0.0, 0.0, 1);
        // The widest panels are halved first. If the panels do not suffice, the remaining ones have equal width, and
        // their changes estimate the error.
        let mut open = VecDeque::from([((0.0, 1.0), whole)]);
        while let Some(((from, width), whole)) = open.pop_front() {
            let half = 0.5 * width;
            let halves = [(from, half), (from + half, half)];
            let [Some(left), Some(right)] =
                halves.map(|panel| integrate_panel(&mut inside, panel, length))
            else {
                work += whole;
                continue;
            };
            panels += 1;
            let change = (left + right - whole).abs();
            let is_accurate = change <= most_error * width;
            let is_balanced = !refinement.balances_panels
                || find_imbalance(&mut inside, (from, width), left + right) <= most_error;
            if is_accurate && is_balanced || panels >= refinement.most_panels {
                work += left + right;
                uncertainty += if is_accurate { 0.0 } else { change };
            } else {
                open.extend([(halves[0], left), (halves[1], right)]);
            }
        }
        (work, uncertainty)
    }
}

/// Integrates the power over a panel of a step of `length` s; `None` if a state is unknown.
fn integrate_panel(
    inside: &mut dyn FnMut(f64) -> Option<EnergyAndPower>,
    (from, width): (f64, f64),
    length: f64,
) -> Option<f64> {
    let mut sum = 0.0;
    for (node, weight) in GAUSS_NODES_AND_WEIGHTS {
        sum += weight * width * length * inside(from + width * node)?.power;
    }
    Some(sum)
}

/// Returns the energy change of a panel that the given work does not explain; 0 if a state is unknown.
fn find_imbalance(
    inside: &mut dyn FnMut(f64) -> Option<EnergyAndPower>,
    (from, width): (f64, f64),
    work: f64,
) -> f64 {
    match [from, from + width].map(inside) {
        [Some(before), Some(after)] => (after.energy - before.energy - work).abs(),
        _ => 0.0,
    }
}
