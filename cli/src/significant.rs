//! Format of numbers in printed tables.

/// Formats a value with six significant digits.
pub fn significant(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    match rounded == 0.0 || (1e-4..1e6).contains(&rounded.abs()) {
        // Adding 0.0 removes the sign of -0.
        true => format!("{}", rounded + 0.0),
        false => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_limited_and_exponents_kept() {
        assert_eq!(significant(5.250478701114123e-8), "5.25048e-8");
        assert_eq!(significant(3.0000000001), "3");
        assert_eq!(significant(-1e-300 * 1e-300), "0");
    }
}
