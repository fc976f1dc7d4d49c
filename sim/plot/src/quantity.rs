//! Axis labels with SI prefixes: factor and unit for the largest magnitude on an axis.

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Quantity {
    /// Divisor of SI values.
    pub scale: f64,
    pub label: String,
}

const PREFIXES: [(i32, &str); 10] = [
    (-15, "f"),
    (-12, "p"),
    (-9, "n"),
    (-6, "µ"),
    (-3, "m"),
    (0, ""),
    (3, "k"),
    (6, "M"),
    (9, "G"),
    (12, "T"),
];

/// Units that can have prefixes; true if prefixes above 1 are usual (false for s and rad, for example).
const PREFIXABLE_UNITS: [(&str, bool); 10] = [
    ("m", true),
    ("N", true),
    ("J", true),
    ("W", true),
    ("Hz", true),
    ("Pa", true),
    ("V", true),
    ("A", true),
    ("s", false),
    ("rad", false),
];

impl Quantity {
    /// Creates a label without a prefix, for logarithmic axes.
    pub fn without_prefix(name: &str, unit: &str) -> Self {
        Self {
            scale: 1.0,
            label: format_label(name, &format_unit(unit)),
        }
    }

    /// Creates a label with the prefix for which ticks up to `largest` (SI) are between 1 and 1000.
    pub fn with_prefix(name: &str, unit: &str, largest: f64) -> Self {
        let (scale, unit) = scaled_unit(unit, largest);
        Self {
            scale,
            label: format_label(name, unit.trim_end()),
        }
    }
}

/// Returns the multiple of a unit in which a magnitude is between 1 and 1000, and its notation. The notation is
/// for example `µm`, or `10⁻⁶ kg` for a unit without prefixes; it is empty for a dimensionless number.
pub fn scaled_unit(unit: &str, largest: f64) -> (f64, String) {
    let exponent = engineering_exponent(largest);
    let unit = unit.trim();
    let pretty = format_unit(unit);
    let text = match find_prefix(unit, exponent) {
        Some(prefix) => format!("{prefix}{pretty}"),
        None => format!("10{} {pretty}", format_superscript(exponent)),
    };
    (10f64.powi(exponent), text.trim_end().to_owned())
}

fn format_label(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}

/// Returns the exponent, a multiple of 3, that scales a magnitude to between 1 and 1000; 0 for magnitudes near
/// 0.
fn engineering_exponent(largest: f64) -> i32 {
    if !(1e-100..1e100).contains(&largest) {
        return 0;
    }
    let exponent = (largest.log10() / 3.0 + 1e-12).floor();
    // The exponent is between -34 and 34 after this test.
    exponent as i32 * 3
}

fn find_prefix(unit: &str, exponent: i32) -> Option<&'static str> {
    if exponent == 0 {
        return Some("");
    }
    let end = unit
        .find(|c: char| !c.is_alphabetic())
        .unwrap_or(unit.len());
    let (symbol, rest) = unit.split_at(end);
    let (_, above_one) = PREFIXABLE_UNITS.iter().find(|(name, _)| *name == symbol)?;
    if rest.starts_with('^') || (exponent > 0 && !above_one) {
        return None;
    }
    PREFIXES
        .iter()
        .find(|(power, _)| *power == exponent)
        .map(|(_, prefix)| *prefix)
}

/// Formats a unit, for example `N m/s^2` as `N·m/s²`.
fn format_unit(unit: &str) -> String {
    let mut pretty = String::new();
    let mut raised = false;
    for c in unit.trim().chars() {
        raised = c == '^' || (raised && (c.is_ascii_digit() || c == '-'));
        match c {
            '^' => {}
            ' ' | '*' => pretty.push('·'),
            c if raised => pretty.push(superscript_character(c)),
            c => pretty.push(c),
        }
    }
    if pretty == "1" { String::new() } else { pretty }
}

/// Formats an exponent as superscript digits; empty for 1.
pub(super) fn format_superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(superscript_character)
        .collect()
}

fn superscript_character(c: char) -> char {
    match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_follow_the_largest_magnitude() {
        for (unit, largest, scale, label) in [
            ("m", 3.2e-5, 1e-6, "x_sp [µm]"),
            ("m", 1.0, 1.0, "x_sp [m]"),
            ("m", 0.999, 1e-3, "x_sp [mm]"),
            ("rad", 0.02, 1e-3, "x_sp [mrad]"),
            ("rad", 2e4, 1e3, "x_sp [10³ rad]"),
            ("N m", 4.5e3, 1e3, "x_sp [kN·m]"),
            ("m/s^2", 1e3, 1e3, "x_sp [km/s²]"),
            ("m^2", 1e-6, 1e-6, "x_sp [10⁻⁶ m²]"),
            ("kg", 1e-3, 1e-3, "x_sp [10⁻³ kg]"),
            ("", 2e-9, 1e-9, "x_sp [10⁻⁹]"),
            ("1", 2.0, 1.0, "x_sp"),
            ("1/s", 2.0, 1.0, "x_sp [1/s]"),
            ("W", 1e-40, 1e-42, "x_sp [10⁻⁴² W]"),
            ("m", 0.0, 1.0, "x_sp [m]"),
        ] {
            let quantity = Quantity::with_prefix("x_sp", unit, largest);
            assert_eq!(quantity.label, label, "{largest} {unit}");
            // The tolerance covers one rounding in 10^n and one in the literal.
            assert!(
                (quantity.scale / scale - 1.0).abs() < 1e-14,
                "{largest} {unit}"
            );
        }
    }

    #[test]
    fn plain_quantity_keeps_its_unit() {
        assert_eq!(Quantity::without_prefix("S", "m^2/Hz").label, "S [m²/Hz]");
        assert_eq!(Quantity::without_prefix("S", "s^-1").label, "S [s⁻¹]");
    }
}
