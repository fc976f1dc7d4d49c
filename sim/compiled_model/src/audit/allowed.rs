//! The change of an energy that errors of a solver explain.

use super::EnergyAt;

/// How many times the energy may change by an error that the tolerance allows in every entry of
/// the state, where no estimate of an error is relied on: from step to step, in the short step over
/// a surface, at an impact.
pub(crate) const ERROR_FACTOR: f64 = 30.0;

/// Roundings of a time within which solvers locate a jump of the rates.
const LOCATED: f64 = 16.0 * f64::EPSILON;

/// The work (J) that is uncertain in a step until `t` (s) because times have rounding: a force that jumps in it
/// acts from a time on that is known to that rounding.
pub(super) fn unlocated_work(t: f64, (first, last): (EnergyAt, EnergyAt)) -> f64 {
    LOCATED * t.abs() * first.power.abs().max(last.power.abs())
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
