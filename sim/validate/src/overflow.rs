//! Explains a deviation that is not finite if a parameter is too large for the number format.

use crate::certificate::Check;

/// Name of the single-precision check.
const SINGLE_PRECISION: &str = "f32";

/// Adds the name of the largest parameter to the detail of failed checks without a finite deviation, if the square of
/// this parameter overflows. Parameters are in SI.
pub fn name_overflowing_parameter(checks: &mut [Check], parameters: &[(String, f64)]) {
    let sized = parameters
        .iter()
        .map(|(name, value)| (name, value, value.abs()));
    let Some((name, value, size)) = sized.max_by(|a, b| a.2.total_cmp(&b.2)) else {
        return;
    };
    for check in checks {
        let is_single = check.name == SINGLE_PRECISION;
        let (largest, format) = match is_single {
            true => (f64::from(f32::MAX), "single"),
            false => (f64::MAX, "double"),
        };
        let has_failed = !check.passed && check.skipped.is_none() && check.value.is_none();
        if has_failed && size > largest.sqrt() {
            check.detail.push_str(&format!(
                "; `{name}` = {value:e} in SI units is too large: its square exceeds {largest:.1e}, the largest number \
                 in {format} precision; give a smaller value"
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certificate::Worst;

    fn detail(name: &str, deviation: f64, value: f64) -> String {
        let worst = Worst::from_deviation(deviation, "state 1".to_owned());
        let mut checks = [Check::from_deviation(name, worst, 1.0)];
        let parameters = [("k", 2.0), ("m", value)].map(|(name, value)| (name.to_owned(), value));
        name_overflowing_parameter(&mut checks, &parameters);
        let [check] = checks;
        check.detail
    }

    #[test]
    fn parameter_is_named_only_for_a_failure_that_it_explains() {
        let infinite = f64::INFINITY;
        assert!(detail("energy", infinite, -1e300).contains("`m` = -1e300"));
        assert!(detail("f32", infinite, 1e20).contains("single precision"));
        for (name, deviation, value) in [
            ("energy", infinite, 1e20),
            ("f32", infinite, 1e10),
            ("energy", 2.0, 1e300),
            ("energy", 0.5, 1e300),
        ] {
            assert_eq!(detail(name, deviation, value), "state 1", "{name} {value}");
        }
    }
}
