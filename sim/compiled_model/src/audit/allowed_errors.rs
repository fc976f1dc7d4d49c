//! Energy changes that a solver's errors can explain.

/// Factor on the energy change of an error at the tolerance in every entry of the state, if no
/// error estimate applies: between steps, in the short step across a surface, at an impact.
pub(crate) const TOLERANCE_ERROR_FACTOR: f64 = 30.0;

/// Number of roundings of a time within which solvers locate a jump of the rates.
const EVENT_TIME_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Returns the uncertain work (J) at `t` (s), near which these are the powers (W): the time at which a force jumps is
/// known to rounding only.
pub(super) fn find_uncertain_work(t: f64, powers: &[f64]) -> f64 {
    let largest = powers
        .iter()
        .fold(0.0, |most: f64, power| most.max(power.abs()));
    EVENT_TIME_ROUNDING * t.abs() * largest
}

/// Returns the change of a quantity that solver errors can explain: the sum over the entries of
/// the state of its changes for an error at the relative tolerance. The error is relative to the
/// entry plus its largest magnitude up to now. The smaller change of both signs counts, because a
/// jump of the quantity near the state is no error. Half the error counts as well, because an even function may return
/// to its value at the whole.
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
        for error in [error, -error] {
            let changes = [error, 0.5 * error].map(|error| {
                moved[place] = entry + error;
                (quantity(&moved) - here).abs()
            });
            change = change.min(changes[0].max(changes[1]));
        }
        sum += change;
        moved[place] = *entry;
    }
    sum
}
