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
/// entry plus its largest magnitude up to now.
pub(crate) fn find_allowed_change(
    state: &[f64],
    sizes: &[f64],
    tolerance: f64,
    quantity: &mut dyn FnMut(&[f64]) -> f64,
) -> f64 {
    let errors = find_allowed_errors(state, sizes, tolerance);
    let [change] = find_changes(state, &errors, &mut |state| [quantity(state)]);
    change
}

/// Returns the error of each entry of a state at a relative tolerance.
pub(super) fn find_allowed_errors(state: &[f64], sizes: &[f64], tolerance: f64) -> Vec<f64> {
    let entries = state.iter().zip(sizes);
    entries
        .map(|(entry, size)| tolerance * (entry.abs() + size))
        .collect()
}

/// Returns the changes of quantities by these errors of the entries of a state, each the sum over the entries. The smaller
/// change of both signs counts, because a jump of a quantity near the state is no error. Half the error counts as well,
/// because an even function may return to its value at the whole.
pub(super) fn find_changes<const N: usize>(
    state: &[f64],
    errors: &[f64],
    quantities: &mut dyn FnMut(&[f64]) -> [f64; N],
) -> [f64; N] {
    let here = quantities(state);
    let mut moved = state.to_vec();
    let mut sums = [0.0; N];
    for ((place, entry), error) in state.iter().enumerate().zip(errors) {
        let mut changes = [f64::INFINITY; N];
        for error in [*error, -error] {
            let [whole, half] = [error, 0.5 * error].map(|error| {
                moved[place] = entry + error;
                quantities(&moved)
            });
            for (index, change) in changes.iter_mut().enumerate() {
                let [whole, half] = [whole, half].map(|values| (values[index] - here[index]).abs());
                *change = change.min(whole.max(half));
            }
        }
        for (sum, change) in sums.iter_mut().zip(changes) {
            *sum += change;
        }
        moved[place] = *entry;
    }
    sums
}
