//! Difference quotients of quantities that jump in time, such as accelerations with dry friction.
//! If the time of a jump moves past a sample, the quantity at this sample changes by the whole
//! jump. Divided by a small step, this change would seem to be very informative about an unknown,
//! although no derivative describes it.

/// Returns the difference quotient of a quantity at a sample without the effect of a jump. It is
/// the smaller one-sided quotient, or 0 if their signs differ, because a jump passes a sample on
/// one side only. `after`, `before`: one-sided quotients.
pub(crate) fn limit_quotient(after: f64, before: f64) -> f64 {
    match after * before > 0.0 {
        true if after.abs() < before.abs() => after,
        true => before,
        // A non-finite change is returned as NaN.
        false if (after * before).is_nan() => f64::NAN,
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::limit_quotient;

    #[test]
    fn jump_on_one_side_is_ignored() {
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
