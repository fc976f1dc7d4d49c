//! Formatted quantities with significant digits according to the uncertainty, in a readable
//! multiple of the unit.

use eomgen_plot::scaled_unit;

/// Maximum number of digits after the first one.
const MAX_DIGITS: i32 = 6;

/// Magnitudes that are formatted in the unit without a prefix.
const UNSCALED_MAGNITUDES: std::ops::Range<f64> = 0.1..1e4;

/// Magnitudes that are formatted without a power of ten, for units without prefixes.
const UNSCALED_WITHOUT_PREFIX: std::ops::Range<f64> = 1e-3..1e5;

/// Formats a value with its standard deviation: `12.03 ± 0.02 N`. The deviation has one digit, or
/// two if the first is 1. An unknown deviation is omitted.
pub(crate) fn format_estimate(value: f64, sd: f64, unit: &str) -> String {
    if !(sd.is_finite() && sd > 0.0) {
        return format_quantity(value, 4, unit);
    }
    if !value.is_finite() {
        return "not known".to_owned();
    }
    let base = unit;
    let (scale, unit) = choose_multiple(value.abs().max(sd), base);
    let (value, sd) = (value / scale, sd / scale);
    let last = compute_exponent(sd) - i32::from(compute_first_digit(sd) == 1);
    if last < compute_exponent(value.abs().max(sd)) - MAX_DIGITS {
        // Digits beyond this number are not readable.
        return format_quantity(value * scale, MAX_DIGITS, base);
    }
    let (value, sd) = (round_to_place(value, last), round_to_place(sd, last));
    join_unit(&format!("{value} ± {sd}"), &unit, true)
}

/// Formats a value with a given number of digits and a unit: `5.73 mm`.
pub(crate) fn format_quantity(value: f64, digits: i32, unit: &str) -> String {
    if !value.is_finite() {
        return "not known".to_owned();
    }
    let (scale, unit) = choose_multiple(value.abs(), unit);
    let value = value / scale;
    let text = round_to_place(value, compute_exponent(value.abs()) - digits + 1);
    join_unit(&text, &unit, false)
}

/// Formats a number with a given number of digits: `57300`, `1.02`.
pub(crate) fn format_number(value: f64, digits: i32) -> String {
    if !value.is_finite() {
        return "not known".to_owned();
    }
    round_to_place(value, compute_exponent(value.abs()) - digits + 1)
}

/// Formats a number with one decimal place.
pub(crate) fn format_tenths(value: f64) -> String {
    round_to_place(value, -1)
}

/// Formats a fraction in percent. A fraction below 1 is never rounded up to 100 %.
pub(crate) fn format_percent(part: f64) -> String {
    match 100.0 * part {
        p if !p.is_finite() => "an unknown part".to_owned(),
        p if p >= 99.95 => "all".to_owned(),
        p if p >= 99.0 => format!("{p:.1} %"),
        p => format!("{p:.0} %"),
    }
}

/// Returns the factor and the multiple of the unit in which a magnitude is formatted.
fn choose_multiple(magnitude: f64, unit: &str) -> (f64, String) {
    let (_, own) = scaled_unit(unit, 1.0);
    if magnitude == 0.0 || UNSCALED_MAGNITUDES.contains(&magnitude) {
        return (1.0, own);
    }
    let (scale, scaled) = scaled_unit(unit, magnitude);
    let has_prefix = !scaled.starts_with("10");
    if !has_prefix && UNSCALED_WITHOUT_PREFIX.contains(&magnitude) {
        return (1.0, own);
    }
    (scale, scaled)
}

/// Joins a number and its unit; a unit that begins with a power of ten is multiplied.
fn join_unit(number: &str, unit: &str, is_pair: bool) -> String {
    match (unit.is_empty(), unit.starts_with("10"), is_pair) {
        (true, ..) => number.to_owned(),
        (false, false, _) => format!("{number} {unit}"),
        (false, true, true) => format!("({number})·{unit}"),
        (false, true, false) => format!("{number}·{unit}"),
    }
}

/// Returns the power of ten of the first digit.
fn compute_exponent(magnitude: f64) -> i32 {
    let floor = magnitude.log10().floor();
    // The magnitude 0 and non-finite magnitudes are formatted like 1.
    if floor.is_finite() { floor as i32 } else { 0 }
}

fn compute_first_digit(magnitude: f64) -> i32 {
    (magnitude / 10f64.powi(compute_exponent(magnitude))) as i32
}

/// Rounds a value to a multiple of 10 to the power `place`.
fn round_to_place(value: f64, place: i32) -> String {
    let text = if place < 0 {
        format!("{value:.*}", place.unsigned_abs() as usize)
    } else {
        let unit = 10f64.powi(place);
        format!("{:.0}", (value / unit).round() * unit)
    };
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|c| ('1'..='9').contains(&c)) => format!("−{digits}"),
        Some(digits) => digits.to_owned(),
        None => text,
    }
}

/// Replaces `+-` and exponents of numbers in a sentence by `±` and powers of ten.
pub(crate) fn format_readable(text: &str) -> String {
    let words = text.split(' ').map(|word| match word {
        "+-" => "±".to_owned(),
        word => parse_number(word).unwrap_or_else(|| word.to_owned()),
    });
    words.collect::<Vec<String>>().join(" ")
}

/// Splits a word into a number with an exponent and its suffix, such as `1.2e-3,`.
fn parse_number(word: &str) -> Option<String> {
    let number = word.trim_end_matches([',', '.', ';', ':', ')']);
    let (mantissa, exponent) = number.split_once('e')?;
    let value: f64 = number.parse().ok()?;
    let power: i32 = exponent.parse().ok()?;
    let rest = &word[number.len()..];
    let digits = mantissa.chars().filter(char::is_ascii_digit).count();
    let digits = i32::try_from(digits).unwrap_or(MAX_DIGITS).min(4);
    if (-3..5).contains(&power) {
        return Some(format_number(value, digits) + rest);
    }
    Some(
        join_unit(
            &format_number(value / 10f64.powi(power), digits),
            &format_power(power),
            false,
        ) + rest,
    )
}

/// Formats a power of ten.
fn format_power(power: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        c => c
            .to_digit(10)
            .and_then(|d| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(d as usize))
            .unwrap_or(c),
    };
    format!(
        "10{}",
        power.to_string().chars().map(raised).collect::<String>()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimate_digits_match_uncertainty() {
        for (value, sd, unit, expected) in [
            (11.986, 0.0192, "N", "11.986 ± 0.019 N"),
            (11.986, 0.0242, "N", "11.99 ± 0.02 N"),
            (188.946, 5.387, "N s/m", "189 ± 5 N·s/m"),
            (2503.73, 4.07, "N m", "2504 ± 4 N·m"),
            (-39.58, 1.66, "N s/m", "−39.6 ± 1.7 N·s/m"),
            (4.97e-2, 1.5e-4, "N m s", "49.70 ± 0.15 mN·m·s"),
            (4.37e-9, 2e-6, "m", "0 ± 2 µm"),
            (1.2e-5, 2e-7, "kg m^2", "(12.0 ± 0.2)·10⁻⁶ kg·m²"),
            (0.9998, 0.0004, "1", "0.9998 ± 0.0004"),
            (0.8, 1e-12, "N m", "0.800000 N·m"),
            (3.0, f64::NAN, "N", "3.000 N"),
            (f64::NAN, 1.0, "N", "not known"),
            (0.0, 0.0, "m", "0.000 m"),
        ] {
            assert_eq!(
                format_estimate(value, sd, unit),
                expected,
                "{value} {sd} {unit}"
            );
        }
    }

    #[test]
    fn numbers_in_sentences_are_readable() {
        assert_eq!(
            format_readable("a force: 31 +- 2.2 N, 5.729e-3 m or 1.2e-9. done e5 x1e5"),
            "a force: 31 ± 2.2 N, 0.005729 m or 1.2·10⁻⁹. done e5 x1e5"
        );
    }

    #[test]
    fn fractions_are_formatted_in_percent() {
        assert_eq!(format_percent(0.954), "95 %");
        assert_eq!(format_percent(0.9949), "99.5 %");
        assert_eq!(format_percent(0.99991), "all");
        assert_eq!(format_tenths(-0.04), "0.0");
        assert_eq!(format_percent(f64::NAN), "an unknown part");
    }
}
