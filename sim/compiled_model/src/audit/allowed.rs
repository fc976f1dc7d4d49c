//! The change of an energy that errors of a solver explain.

use super::auditor::Auditor;
use super::{Energies, EnergyAt};

/// How many times the energy may change by an error that the tolerance allows in every entry of
/// the state, where no estimate of an error is relied on: from step to step, in the short step over
/// a surface, at an impact.
pub(crate) const ERROR_FACTOR: f64 = 30.0;

/// Roundings of an energy that count as none.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// Roundings of a time within which solvers locate a jump of the rates.
const LOCATED: f64 = 16.0 * f64::EPSILON;

/// The work (J) that is uncertain in a step until `t` (s) because times have rounding: a force that jumps in it
/// acts from a time on that is known to that rounding.
pub(super) fn unlocated_work(t: f64, (first, last): (EnergyAt, EnergyAt)) -> f64 {
    LOCATED * t.abs() * first.power.abs().max(last.power.abs())
}

impl Auditor {
    /// The change of the energy that errors at these states explain.
    pub(super) fn allowed(
        &mut self,
        energies: &mut Energies<'_>,
        factor: f64,
        states: &[(f64, &[f64])],
        values: &[f64],
    ) -> f64 {
        let mut largest: f64 = 0.0;
        for (t, state) in states {
            let mut evaluations = 0;
            let energy = &mut |state: &[f64]| {
                evaluations += 1;
                energies(*t, state).energy
            };
            largest = largest.max(allowed_change(state, &self.sizes, self.tolerance, energy));
            self.audit.evaluations += evaluations;
        }
        let rounding = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        factor * largest + ROUNDINGS * rounding
    }
}

/// The change of a quantity of the state that errors explain: the sum over the entries of the
/// changes by the error that the relative tolerance allows in each, beside the entry and the
/// largest that it has been. Of errors of either sign the smaller change counts: a jump of the
/// quantity beside the state is no error.
pub(crate) fn allowed_change(
    state: &[f64],
    sizes: &[f64],
    tolerance: f64,
    quantity: &mut dyn FnMut(&[f64]) -> f64,
) -> f64 {
    let here = quantity(state);
    let mut moved = state.to_vec();
    let mut sum = 0.0;
    for ((place, entry), size) in state.iter().enumerate().zip(sizes) {
        let error = tolerance * (entry.abs() + size);
        let mut change = f64::INFINITY;
        for moved_entry in [entry + error, entry - error] {
            moved[place] = moved_entry;
            change = change.min((quantity(&moved) - here).abs());
        }
        sum += change;
        moved[place] = *entry;
    }
    sum
}
