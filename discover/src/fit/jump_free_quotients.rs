//! Difference quotients of quantities that jump in time, such as accelerations under dry friction. A
//! jump whose time moves past a sample changes the quantity there by its whole height, which no
//! derivative describes: divided by a small step it would be the largest information on an unknown.

/// Returns the quotient of a quantity at a sample from its changes to both sides of a point: the
/// smaller of both one-sided quotients, 0 if their signs differ. A jump passes a sample on one side
/// only. `after`, `before`: changes over the steps, both divided by their steps.
pub(crate) fn limit_quotient(after: f64, before: f64) -> f64 {
    match after * before > 0.0 {
        true if after.abs() < before.abs() => after,
        true => before,
        // A change that is not finite stays visible.
        false if (after * before).is_nan() => f64::NAN,
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::limit_quotient;

    #[test]
    fn a_jump_on_one_side_is_left_out() {
        for (slope, jump, step) in [(2.0, 50.0, 1e-3), (-3.0, 50.0, 1e-3), (4.0, -1.0, 1e-6)] {
            let jumped = slope + jump / step;
            let expected = if slope * jump > 0.0 { slope } else { 0.0 };
            assert_eq!(limit_quotient(jumped, slope), expected);
            assert_eq!(limit_quotient(slope, jumped), expected);
            assert_eq!(limit_quotient(slope, slope), slope);
        }
        assert!(limit_quotient(f64::NAN, 1.0).is_nan());
    }
}
