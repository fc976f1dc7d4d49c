//! Bounds of the energy changes that errors of a solver can cause.

/// Factor on the energy change that an error at the relative tolerance in every state causes. It applies without an
/// error estimate: between steps, in the short step across a surface and at an impact.
pub(crate) const TOLERANCE_ERROR_FACTOR: f64 = 30.0;

/// Uncertainty of the time at which solvers locate a jump of the rates, relative to the time.
const EVENT_TIME_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Returns the uncertainty (J) of the work near a time `t` (s) at which a force jumps. `powers` (W) are the powers
/// nearby. The time of the jump is only known to rounding.
pub(super) fn find_uncertain_work(t: f64, powers: &[f64]) -> f64 {
    let largest = powers
        .iter()
        .fold(0.0, |most: f64, power| most.max(power.abs()));
    EVENT_TIME_ROUNDING * t.abs() * largest
}

/// Returns the change of a quantity that solver errors can cause: the sum of its changes for an error at the relative
/// tolerance in each state. The error is relative to the state plus its largest magnitude so far.
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

/// Returns the error of each state at a relative tolerance.
pub(super) fn find_allowed_errors(state: &[f64], sizes: &[f64], tolerance: f64) -> Vec<f64> {
    let entries = state.iter().zip(sizes);
    entries
        .map(|(entry, size)| tolerance * (entry.abs() + size))
        .collect()
}

/// Returns, for each quantity, the sum of its changes by an error of each state. For each error the smaller change of
/// both signs counts, because a jump of a quantity near the state is no error. Half the error is tried as well, because
/// an even function may return to its value at the whole error.
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
