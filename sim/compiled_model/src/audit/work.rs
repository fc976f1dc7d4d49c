//! Work of a step: quadrature of the power.

use eomgen_sim::ode::{Interior, ObservedStep};

use super::auditor::Auditor;
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
    /// Integrates the power over a step by Simpson's rule; returns false if the interior is
    /// unknown.
    pub(super) fn integrate_simpson(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut Energies<'_>,
        (first, last): (EnergyAndPower, EnergyAndPower),
    ) -> (f64, bool) {
        let (begin, end) = (step.start.0, step.end.0);
        let middle = 0.5 * (begin + end);
        let mean = 0.5 * (first.power + last.power);
        match (step.state_inside)(middle, Interior::Interpolated) {
            Some(state) => {
                let power = self.evaluate(energies, (middle, &state)).power;
                ((mean + 2.0 * power) / 3.0 * (end - begin), true)
            }
            None => (mean * (end - begin), false),
        }
    }

    /// Integrates the power over a step and halves panels until the change is small compared with
    /// `allowed`. Returns the work and its uncertainty, J; the latter is nonzero if the interior
    /// is unknown.
    pub(super) fn integrate_work(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut Energies<'_>,
        (first, last): (EnergyAndPower, EnergyAndPower),
        (interior, most_panels, allowed): (Interior, usize, f64),
    ) -> (f64, f64) {
        let (begin, length) = (step.start.0, step.end.0 - step.start.0);
        let mut gauss = |(from, width): (f64, f64)| {
            let mut sum = 0.0;
            for (node, weight) in GAUSS_NODES_AND_WEIGHTS {
                let t = begin + length * (from + width * node);
                let state = (step.state_inside)(t, interior)?;
                self.audit.evaluations += 1;
                sum += weight * width * length * energies(t, &state).power;
            }
            Some(sum)
        };
        let Some(whole) = gauss((0.0, 1.0)) else {
            let spread = (last.power - first.power).abs();
            let mean = 0.5 * (first.power + last.power);
            return (mean * length, 0.5 * spread * length);
        };
        let (mut work, mut panels) = (0.0, 1);
        let mut open = vec![((0.0, 1.0), whole)];
        while let Some(((from, width), whole)) = open.pop() {
            let half = 0.5 * width;
            let halves = [(from, half), (from + half, half)];
            let [Some(left), Some(right)] = halves.map(&mut gauss) else {
                work += whole;
                continue;
            };
            let error = (left + right - whole).abs();
            panels += 1;
            if error <= MAX_QUADRATURE_ERROR_FRACTION * allowed * width || panels >= most_panels {
                work += left + right;
            } else {
                open.extend([(halves[0], left), (halves[1], right)]);
            }
        }
        (work, 0.0)
    }
}
