//! Comparison of bias forces and inverse dynamics with the oracle's mass matrix and forces.

use super::rows::{OutputFindings, relative_deviation, worst_deviation};
use crate::checks::ROW_TOLERANCE;
use crate::oracle::Equations;
use crate::outputs::Outputs;
use crate::random::Random;
use crate::sampler::Sample;

pub(super) fn check_forces(
    rows: &mut OutputFindings,
    equations: &Equations,
    outputs: &mut dyn Outputs,
    sample: &Sample,
    random: &mut Random,
    place: &str,
) {
    let mut compare = |name, accelerations: &[f64], found: Option<Vec<f64>>| {
        let Some(found) = found else { return };
        let expected = equations.missing_forces(accelerations);
        let rows_of_forces = expected.iter();
        let deviations = rows_of_forces.enumerate().map(|(row, expected)| {
            let found = found.get(row).copied().unwrap_or(f64::NAN);
            relative_deviation(found - expected.value, expected.scale)
        });
        rows.include(name, ROW_TOLERANCE, worst_deviation(deviations), place);
    };
    let still = vec![0.0; equations.size()];
    compare("bias_forces", &still, outputs.bias_forces(sample));
    // Accelerations of the same magnitude as in the motion keep the inertia terms comparable with the other terms of
    // each row.
    let accelerations: Vec<f64> = match equations.accelerations() {
        Some(own) => own.iter().map(|a| a * random.away_from_zero()).collect(),
        None => still.iter().map(|_| random.away_from_zero()).collect(),
    };
    let found = outputs.inverse_dynamics(sample, &accelerations);
    compare("inverse_dynamics", &accelerations, found);
}
