//! Energy changes that a solver's errors can explain.

use super::EnergyAndPower;

/// Factor on the energy change of an error at the tolerance in every entry of the state, if no
/// error estimate applies: between steps, in the short step across a surface, at an impact.
pub(crate) const TOLERANCE_ERROR_FACTOR: f64 = 30.0;

/// Number of roundings of a time within which solvers locate a jump of the rates.
const EVENT_TIME_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Returns the uncertain work (J) of a step until `t` (s): the time at which a force jumps is
/// known to rounding only.
pub(super) fn find_uncertain_work(t: f64, (first, last): (EnergyAndPower, EnergyAndPower)) -> f64 {
    EVENT_TIME_ROUNDING * t.abs() * first.power.abs().max(last.power.abs())
}

/// Returns the change of a quantity that solver errors can explain: the sum over the entries of
/// the state of its changes for an error at the relative tolerance. The error is relative to the
/// entry plus its largest magnitude up to now. The smaller change of both signs counts, because a
/// jump of the quantity near the state is no error.
pub(crate) fn find_allowed_change(
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
