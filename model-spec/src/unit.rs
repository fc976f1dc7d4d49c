//! Units of a specification: `N s/m`, `kg/m^3`, `deg`, `mm`. A unit is a dimension and an exact
//! scale. Grammar: factors separated by spaces or `*` are multiplied. At most one `/` divides
//! by the one factor or the one parenthesis after it and ends the unit, so that ambiguous units
//! such as `N/m s` are rejected.

use num_rational::Ratio;

use crate::dimension::{Dimension, Exponent};
use crate::scale::Scale;

/// Unit as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Text in the specification; for an inferred unit, the text of its dimension.
    pub text: String,
    /// Dimension.
    pub dimension: Dimension,
    /// Factor to the coherent SI unit.
    scale: Scale,
}

/// Error of [`Unit::parse`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    /// Cause.
    pub message: String,
    /// Proposed correction, if known.
    pub help: Option<String>,
    /// The unit in the notation of a specification, if it is written in another common notation.
    pub spelling: Option<String>,
}

/// SI prefixes from pico to tera, with their powers of ten.
const PREFIXES: [(&str, i32); 11] = [
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// Units that accept prefixes: name, power of ten, exponents of kg, m, s, A, K, mol, cd.
const PREFIXED: [(&str, i32, [i32; 7]); 20] = [
    ("m", 0, [0, 1, 0, 0, 0, 0, 0]),
    ("g", -3, [1, 0, 0, 0, 0, 0, 0]),
    ("s", 0, [0, 0, 1, 0, 0, 0, 0]),
    ("A", 0, [0, 0, 0, 1, 0, 0, 0]),
    ("K", 0, [0, 0, 0, 0, 1, 0, 0]),
    ("mol", 0, [0, 0, 0, 0, 0, 1, 0]),
    ("cd", 0, [0, 0, 0, 0, 0, 0, 1]),
    ("rad", 0, [0, 0, 0, 0, 0, 0, 0]),
    ("Hz", 0, [0, 0, -1, 0, 0, 0, 0]),
    ("N", 0, [1, 1, -2, 0, 0, 0, 0]),
    ("J", 0, [1, 2, -2, 0, 0, 0, 0]),
    ("W", 0, [1, 2, -3, 0, 0, 0, 0]),
    ("Pa", 0, [1, -1, -2, 0, 0, 0, 0]),
    ("V", 0, [1, 2, -3, -1, 0, 0, 0]),
    ("C", 0, [0, 0, 1, 1, 0, 0, 0]),
    ("F", 0, [-1, -2, 4, 2, 0, 0, 0]),
    ("ohm", 0, [1, 2, -3, -2, 0, 0, 0]),
    ("Wb", 0, [1, 2, -2, -1, 0, 0, 0]),
    ("T", 0, [1, 0, -2, -1, 0, 0, 0]),
    ("H", 0, [1, 2, -2, -2, 0, 0, 0]),
];

/// Words for units in the singular, and their symbols.
const WORDS: [(&str, &str); 30] = [
    ("deg", "deg"),
    ("degree", "deg"),
    ("°", "deg"),
    ("rad", "rad"),
    ("radian", "rad"),
    ("newton", "N"),
    ("gram", "g"),
    ("metre", "m"),
    ("meter", "m"),
    ("second", "s"),
    ("sec", "s"),
    ("minute", "min"),
    ("hour", "h"),
    ("hr", "h"),
    ("hertz", "Hz"),
    ("joule", "J"),
    ("watt", "W"),
    ("pascal", "Pa"),
    ("volt", "V"),
    ("ampere", "A"),
    ("amp", "A"),
    ("kelvin", "K"),
    ("coulomb", "C"),
    ("farad", "F"),
    ("henry", "H"),
    ("tesla", "T"),
    ("weber", "Wb"),
    ("mole", "mol"),
    ("candela", "cd"),
    ("ω", "ohm"),
];

/// Words for prefixes.
const PREFIX_WORDS: [(&str, &str); 9] = [
    ("kilo", "k"),
    ("milli", "m"),
    ("micro", "u"),
    ("nano", "n"),
    ("pico", "p"),
    ("centi", "c"),
    ("mega", "M"),
    ("giga", "G"),
    ("k", "k"),
];

/// Superscript digits.
const RAISED: [(char, char); 11] = [
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '-'),
];

/// Units outside SI, with a proposed correction.
const OUTSIDE_SI: [(&[&str], &str); 10] = [
    (
        &["rpm", "RPM"],
        "give the speed in rad/s: 1 rpm is 2 pi/60 rad/s",
    ),
    (
        &["in", "inch", "inches"],
        "give the length in mm: 1 in is 25.4 mm",
    ),
    (
        &["ft", "foot", "feet"],
        "give the length in m: 1 ft is 0.3048 m",
    ),
    (
        &["lb", "lbs", "lbm"],
        "give the mass in kg: 1 lb is 0.45359237 kg",
    ),
    (
        &["t", "ton", "tonne"],
        "give the mass in Mg: 1 t is 1 Mg, 1000 kg",
    ),
    (&["lbf"], "give the force in N: 1 lbf is 4.4482216152605 N"),
    (&["psi"], "give the pressure in Pa: 1 psi is 6894.757 Pa"),
    (&["bar"], "give the pressure in kPa: 1 bar is 100 kPa"),
    (
        &["L", "l", "litre", "liter"],
        "give the volume in m^3: 1 l is 0.001 m^3",
    ),
    (&["%", "percent"], "give a fraction: 5 % is 0.05"),
];

/// Largest exponent accepted in a unit.
const MAX_EXPONENT: i32 = 12;

/// Largest length of a unit, in bytes.
const MAX_LENGTH: usize = 64;

impl Unit {
    /// Parses a unit; `""` and `"1"` are dimensionless.
    ///
    /// # Errors
    /// A part of the text is not a unit. The error contains a valid spelling if one is known.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        if text.len() > MAX_LENGTH {
            return Err(UnitError::new("a unit has at most 64 characters", None));
        }
        let (dimension, scale) = parse_quotient(text).map_err(|error| error.with_spelling(text))?;
        Ok(Self {
            text: text.to_owned(),
            dimension,
            scale,
        })
    }

    /// Reads a number with a unit after it, such as `20 kg` or `1s`; `None` for any other text.
    pub fn parse_quantity(text: &str) -> Option<(f64, Self)> {
        let text = text.trim();
        let ends = text.char_indices().rev().map(|(end, _)| end);
        let mut numbers = ends.filter_map(|end| {
            let (number, unit) = text.split_at(end);
            Some((number.trim().parse::<f64>().ok()?, unit.trim()))
        });
        let (number, unit) = numbers.next()?;
        let is_unit = unit.starts_with(|first: char| first.is_alphabetic() || first == '°');
        let unit = Self::parse(unit).ok()?;
        (number.is_finite() && is_unit).then_some((number, unit))
    }

    /// Returns the coherent SI unit of a dimension.
    pub fn coherent(dimension: Dimension) -> Self {
        Self {
            text: dimension.to_string(),
            dimension,
            scale: Scale::ONE,
        }
    }

    /// Returns true if the scale is 1.
    pub fn is_coherent(&self) -> bool {
        self.scale == Scale::ONE
    }

    /// Returns the coherent unit of the rate of a quantity in this unit; `None` if an exponent
    /// overflows.
    pub fn rate_unit(&self) -> Option<Self> {
        let mut unit = Self::coherent(self.dimension.divide(Dimension::TIME)?);
        unit.text = format!("{self}/s");
        Some(unit)
    }

    /// Converts a number in this unit to SI; 3 mm is 3/1000, correctly rounded.
    pub fn to_si(&self, value: f64) -> f64 {
        self.scale.apply(value)
    }

    /// Converts a number in SI to this unit.
    pub fn from_si(&self, value: f64) -> f64 {
        self.scale.remove(value)
    }
}

impl std::fmt::Display for Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.text.is_empty() {
            "1"
        } else {
            &self.text
        })
    }
}

impl UnitError {
    fn new(message: impl Into<String>, help: Option<String>) -> Self {
        Self {
            message: message.into(),
            help,
            spelling: None,
        }
    }

    /// Adds the notation of a specification for a unit in another usual notation.
    fn with_spelling(self, text: &str) -> Self {
        let spelling = respell(text).filter(|spelling| parse_quotient(spelling).is_ok());
        match spelling {
            Some(spelling) => Self {
                message: format!("unknown unit `{text}`"),
                help: Some(format!("write {spelling}")),
                spelling: Some(spelling),
            },
            None => self,
        }
    }

    fn out_of_range(text: &str) -> Self {
        Self::new(format!("the unit `{text}` is out of range"), None)
    }
}

impl std::fmt::Display for UnitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for UnitError {}

type Parsed = (Dimension, Scale);

fn parse_quotient(text: &str) -> Result<Parsed, UnitError> {
    let Some(slash) = outer_slash(text) else {
        return parse_product(text.trim());
    };
    let above = parse_product(text[..slash].trim())?;
    let written = text[slash + 1..].trim();
    if written.is_empty() || text[..slash].trim().is_empty() {
        let help = "write a reciprocal as 1/s".to_owned();
        return Err(UnitError::new("`/` needs a unit on both sides", Some(help)));
    }
    if written == "()" {
        return Err(UnitError::new("`()` contains no unit", None));
    }
    let below = match written.strip_prefix('(').and_then(|w| w.strip_suffix(')')) {
        Some(inner) => parse_product(inner.trim())?,
        None => {
            refuse_ambiguous(text[..slash].trim(), written)?;
            parse_product(written)?
        }
    };
    let dimension = above.0.divide(below.0);
    let scale = below
        .1
        .raise(-1)
        .and_then(|inverse| above.1.multiply(inverse));
    dimension
        .zip(scale)
        .ok_or_else(|| UnitError::out_of_range(text))
}

/// Returns the position of the first `/` outside an exponent such as `^(1/2)`.
fn outer_slash(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    for (place, letter) in text.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            '/' if depth == 0 => return Some(place),
            _ => {}
        }
    }
    None
}

fn refuse_ambiguous(above: &str, below: &str) -> Result<(), UnitError> {
    if outer_slash(below).is_some() {
        let help = "write all divisors in one parenthesis: kg/(m s)".to_owned();
        return Err(UnitError::new("a unit has at most one `/`", Some(help)));
    }
    let mut factors = factors(below);
    let (Some(first), Some(_)) = (factors.next(), factors.next()) else {
        return Ok(());
    };
    let rest = below[first.len()..].trim_start_matches(['*', ' ']);
    let first = first.trim();
    let help = format!("write {above}/({below}) or {above} {rest}/{first}");
    Err(UnitError::new(
        "the divisor of `/` is ambiguous",
        Some(help),
    ))
}

fn factors(text: &str) -> impl Iterator<Item = &str> {
    text.split([' ', '*']).filter(|part| !part.is_empty())
}

fn parse_product(text: &str) -> Result<Parsed, UnitError> {
    let mut product = (Dimension::DIMENSIONLESS, Scale::ONE);
    for factor in factors(text) {
        let (dimension, scale) = parse_factor(factor)?;
        product = product
            .0
            .multiply(dimension)
            .zip(product.1.multiply(scale))
            .ok_or_else(|| UnitError::out_of_range(text))?;
    }
    Ok(product)
}

fn parse_factor(text: &str) -> Result<Parsed, UnitError> {
    let (symbol, exponent) = match text.split_once('^') {
        Some((symbol, exponent)) => (symbol, parse_exponent(exponent)?),
        None => (text, Ratio::from_integer(1)),
    };
    let (dimension, scale) = parse_symbol(symbol)?;
    let scale = if exponent.is_integer() {
        scale.raise(exponent.to_integer())
    } else if scale == Scale::ONE {
        Some(scale)
    } else {
        let message = format!("`{text}` has no exact factor to SI");
        let help = format!("raise the unit without a prefix: {dimension}^({exponent})");
        return Err(UnitError::new(message, Some(help)));
    };
    dimension
        .raise(exponent)
        .zip(scale)
        .ok_or_else(|| UnitError::out_of_range(text))
}

fn parse_exponent(text: &str) -> Result<Exponent, UnitError> {
    let bare = text
        .strip_prefix('(')
        .and_then(|t| t.strip_suffix(')'))
        .unwrap_or(text);
    let parsed = match bare.split_once('/') {
        Some((numerator, denominator)) => numerator.parse().ok().zip(denominator.parse().ok()),
        None => parse_decimal(bare),
    };
    let bounds = -MAX_EXPONENT..=MAX_EXPONENT;
    parsed
        .filter(|(_, denominator)| *denominator > 0)
        .map(|(numerator, denominator): (i32, i32)| Ratio::new(numerator, denominator))
        .filter(|found| bounds.contains(found.numer()) && *found.denom() <= MAX_EXPONENT)
        .ok_or_else(|| {
            let help = "write an exponent as a whole number up to 12, a fraction or a decimal: m^2, s^-1, m^(1/2), m^1.5";
            let message = format!("`{text}` is not a valid exponent");
            UnitError::new(message, Some(help.to_owned()))
        })
}

/// Parses a number such as `2` or `1.5` to a numerator and a power of ten.
fn parse_decimal(text: &str) -> Option<(i32, i32)> {
    let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
    if text.contains('.') && decimals.is_empty() || decimals.contains(['+', '-']) {
        return None;
    }
    let power = 10_i32.checked_pow(u32::try_from(decimals.len()).ok()?)?;
    let numerator = format!("{whole}{decimals}").parse().ok()?;
    Some((numerator, power))
}

fn parse_symbol(symbol: &str) -> Result<Parsed, UnitError> {
    let whole = match symbol {
        "1" => Some((Dimension::DIMENSIONLESS, Scale::ONE)),
        "deg" => Some((Dimension::DIMENSIONLESS, Scale::DEGREE)),
        "min" => Scale::fraction(60, 1).map(|scale| (Dimension::TIME, scale)),
        "h" => Scale::fraction(3600, 1).map(|scale| (Dimension::TIME, scale)),
        _ => prefixed(symbol, 0),
    };
    let found = whole.or_else(|| parse_prefixed(symbol));
    found.ok_or_else(|| unknown_unit_error(symbol))
}

fn parse_prefixed(symbol: &str) -> Option<Parsed> {
    let mut candidates = PREFIXES.iter();
    candidates.find_map(|(prefix, power)| prefixed(symbol.strip_prefix(prefix)?, *power))
}

/// Splits a word into two units, if possible.
fn split_word(symbol: &str) -> Option<String> {
    let is_unit = |part: &str| prefixed(part, 0).is_some() || parse_prefixed(part).is_some();
    let mut ends = symbol.char_indices().skip(1);
    ends.find_map(|(end, _)| {
        let (one, other) = symbol.split_at(end);
        (is_unit(one) && is_unit(other)).then(|| format!("{one} {other}"))
    })
}

fn prefixed(symbol: &str, prefix_power: i32) -> Option<Parsed> {
    let (_, own_power, exponents) = PREFIXED.iter().find(|(name, ..)| *name == symbol)?;
    let scale = Scale::power_of_ten(prefix_power + own_power)?;
    Some((Dimension::from_exponents(*exponents), scale))
}

fn unknown_unit_error(symbol: &str) -> UnitError {
    let mut outside = OUTSIDE_SI.iter();
    let outside = outside.find(|(words, _)| words.contains(&symbol));
    let help = match (symbol, outside) {
        (_, Some((_, cure))) => (*cure).to_owned(),
        ("Nms", _) => "separate factors by a space: N m s".to_owned(),
        ("Kg", _) => "write kg for the kilogram".to_owned(),
        _ => match split_word(symbol) {
            Some(parted) => format!("separate factors by a space: {parted}"),
            None => "use SI units with prefixes, combined as in N s/m or kg m^2".to_owned(),
        },
    };
    UnitError::new(format!("unknown unit `{symbol}`"), Some(help))
}

/// Converts a unit from another common notation, such as `m/s**2`, `kg.m²` or `newton`, to the notation of a
/// specification. Returns `None` if the text does not change.
fn respell(text: &str) -> Option<String> {
    let letters: Vec<char> = text.replace("**", "^").chars().collect();
    let (mut spelled, mut word) = (String::new(), String::new());
    for (place, letter) in letters.iter().enumerate() {
        let before = place.checked_sub(1).map(|before| letters[before]);
        let next = letters.get(place + 1);
        let raised = RAISED.iter().find(|(raised, _)| raised == letter);
        let is_raised = before.is_some_and(|before| RAISED.iter().any(|(r, _)| *r == before));
        if letter.is_alphabetic() || *letter == '°' {
            word.push(*letter);
            continue;
        }
        let follows_word = !word.is_empty();
        spelled += &symbol_of(&std::mem::take(&mut word));
        match (letter, raised) {
            (_, Some((_, digit))) => {
                spelled += if is_raised { "" } else { "^" };
                spelled.push(*digit);
            }
            ('·' | '⋅' | '×', _) => spelled.push(' '),
            ('.', _) if next.is_some_and(|next| next.is_alphabetic()) => spelled.push(' '),
            ('0'..='9', _) if follows_word => {
                spelled.push('^');
                spelled.push(*letter);
            }
            ('-', _) if follows_word && next.is_some_and(char::is_ascii_digit) => spelled += "^-",
            _ => spelled.push(*letter),
        }
    }
    spelled += &symbol_of(&word);
    (spelled != text).then_some(spelled)
}

/// Returns the symbol of a unit that is written as a word, or the word itself.
fn symbol_of(word: &str) -> String {
    let spelled = word.replace(['µ', 'μ'], "u");
    let lowered = spelled.to_lowercase();
    let of = |word: &str| {
        let one = word.strip_suffix('s').unwrap_or(word);
        let mut words = WORDS.iter();
        let found = words.find(|(known, _)| [word, one].contains(known));
        found.map(|(_, symbol)| *symbol)
    };
    let with_prefix = |(word, prefix): &(&str, &str)| {
        let symbol = of(lowered.strip_prefix(word)?)?;
        Some(format!("{prefix}{symbol}"))
    };
    let whole = of(&lowered).map(str::to_owned);
    whole
        .or_else(|| PREFIX_WORDS.iter().find_map(with_prefix))
        .unwrap_or(spelled)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dimension(text: &str) -> String {
        Unit::parse(text).unwrap().dimension.to_string()
    }

    #[test]
    fn common_units_have_their_dimensions() {
        for (text, expected) in [
            ("", "1"),
            ("1", "1"),
            ("rad", "1"),
            ("deg", "1"),
            ("N s/m", "N s/m"),
            ("kg/m^3", "kg/m^3"),
            ("J", "N m"),
            ("kg m^2", "kg m^2"),
            ("kg*m^2", "kg m^2"),
            ("rad/s", "1/s"),
            ("Hz", "1/s"),
            ("GPa", "Pa"),
            ("N/(m s)", "kg/s^3"),
            ("N m s^2", "kg m^2"),
            ("m s^-2", "m/s^2"),
            ("N/m^(3/2)", "kg/(m^(1/2) s^2)"),
            ("N/m^1.5", "kg/(m^(1/2) s^2)"),
            ("m^-0.50", "1/m^(1/2)"),
            ("m^(2.0)", "m^2"),
            ("N s^.5", "kg m/s^(3/2)"),
        ] {
            assert_eq!(dimension(text), expected, "{text}");
        }
    }

    #[test]
    fn numbers_are_converted_with_one_rounding() {
        let si = |value, text: &str| Unit::parse(text).unwrap().to_si(value);
        assert_eq!(si(3.0, "mm"), 3e-3);
        assert_eq!(si(25.0, "um"), 25e-6);
        assert_eq!(si(200.0, "GPa"), 2e11);
        assert_eq!(si(7.9, "g/cm^3"), 7900.0);
        assert_eq!(si(1.0, "kg/s"), 1.0);
        assert_eq!(si(90.0, "deg"), std::f64::consts::FRAC_PI_2);
        assert_eq!(si(36.0, "km/h"), 10.0);
        assert_eq!(si(1.0, "mm^4"), 1e-12);
    }

    #[test]
    fn coherent_units_have_scale_one() {
        for text in ["", "m", "kg", "N m", "rad", "kg/m^3", "mm km"] {
            assert!(Unit::parse(text).unwrap().is_coherent(), "{text}");
        }
        for text in ["deg", "mm", "g", "min"] {
            assert!(!Unit::parse(text).unwrap().is_coherent(), "{text}");
        }
    }

    #[test]
    fn invalid_units_are_rejected_with_help() {
        for (text, message, help) in [
            ("N/m s", "ambiguous", "N/(m s) or N s/m"),
            ("kg/m/s", "at most one `/`", "kg/(m s)"),
            ("Nm", "unknown unit `Nm`", "space: N m"),
            ("mNm", "unknown unit `mNm`", "space: mN m"),
            ("Nms", "unknown unit `Nms`", "space: N m s"),
            ("furlong", "unknown unit", "SI units"),
            ("rpm", "unknown unit", "rad/s"),
            ("µm", "unknown unit", "um"),
            ("m^x", "not a valid exponent", "m^2"),
            ("m^99", "not a valid exponent", "up to 12"),
            ("m^1.", "not a valid exponent", "m^1.5"),
            ("m^1.-5", "not a valid exponent", "m^1.5"),
            ("m^0.33", "not a valid exponent", "m^(1/2)"),
            ("m^(3/0)", "not a valid exponent", "m^(1/2)"),
            ("m^1.00000000000000000000", "not a valid exponent", "m^1.5"),
            ("N/mm^1.5", "`mm^1.5` has no exact factor", "m^(3/2)"),
            ("/s", "needs a unit on both sides", "1/s"),
            ("m/", "needs a unit on both sides", "1/s"),
            ("2 m", "unknown unit `2`", "SI units"),
            ("m^2147483648", "not a valid exponent", "up to 12"),
        ] {
            let error = Unit::parse(text).expect_err(text);
            assert!(error.message.contains(message), "{text}: {error:?}");
            assert!(
                error.help.as_deref().unwrap_or("").contains(help),
                "{text}: {error:?}"
            );
            assert_eq!(error.spelling.is_some(), text == "µm", "{text}: {error:?}");
        }
        assert!(Unit::parse("((((").is_err());
        assert!(Unit::parse("N/()").is_err());
    }

    #[test]
    fn units_in_other_usual_notations_are_rejected_with_theirs() {
        for (text, spelling) in [
            ("m/s**2", "m/s^2"),
            ("m/s2", "m/s^2"),
            ("m/s²", "m/s^2"),
            ("m.s-2", "m s^-2"),
            ("m·s⁻²", "m s^-2"),
            ("kg.m^2", "kg m^2"),
            ("kg*m²", "kg*m^2"),
            ("N·m", "N m"),
            ("degree", "deg"),
            ("degrees/second", "deg/s"),
            ("°/s", "deg/s"),
            ("rad/sec", "rad/s"),
            ("newton", "N"),
            ("Newton", "N"),
            ("kilogram", "kg"),
            ("millimetres", "mm"),
            ("km/hr", "km/h"),
            ("kΩ", "kohm"),
            ("µm", "um"),
        ] {
            let error = Unit::parse(text).expect_err(text);
            assert_eq!(error.spelling.as_deref(), Some(spelling), "{text}");
            let help = error.help.unwrap_or_default();
            assert!(help.contains(spelling), "{text}: {help}");
        }
    }

    #[test]
    fn numbers_with_a_unit_are_read() {
        for (text, number, unit) in [
            ("20 kg", 20.0, "kg"),
            ("1s", 1.0, "s"),
            ("-1e-3 m/s^2", -1e-3, "m/s^2"),
        ] {
            let read = Unit::parse_quantity(text);
            let read = read.map(|(number, unit)| (number, unit.text));
            assert_eq!(read, Some((number, unit.to_owned())), "{text}");
        }
        for text in ["", "20", "kg", "20 kgg", "2 1/s", "2*m", "nan s"] {
            assert!(Unit::parse_quantity(text).is_none(), "{text}");
        }
    }

    #[test]
    fn displayed_dimensions_can_be_parsed() {
        for kg in -1..=1 {
            for m in -4..=4 {
                for s in -4..=2 {
                    let dimension = Dimension::from_mechanical_exponents([kg, m, s, 0]);
                    let read = Unit::parse(&dimension.to_string()).unwrap();
                    assert_eq!(read.dimension, dimension);
                    assert!(read.is_coherent());
                }
            }
        }
    }
}
