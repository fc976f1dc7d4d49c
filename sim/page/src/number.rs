//! Numbers in pages.

use maud::{Markup, html};

use crate::formula::power_of_ten;

/// Returns a number with `digits` digits after the first; powers of ten are written as such.
pub fn number(value: f64, digits: usize) -> Markup {
    if !value.is_finite() {
        return html! { (value.to_string()) };
    }
    let (mantissa, exponent) = rounded(value, digits, Notation::Fixed);
    html! { math { (power_of_ten(&mantissa, exponent.as_deref())) } }
}

/// Notation of a number other than 0.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Notation {
    /// Without a power of ten, unless it is very small or large.
    Fixed,
    /// With a power of ten.
    PowerOfTen,
}

/// Rounds a number to `digits` digits after the first. Returns its digits, and the exponent of ten if there is one,
/// both with minus signs.
pub(crate) fn rounded(value: f64, digits: usize, notation: Notation) -> (String, Option<String>) {
    let signed = |number: &str| number.replace('-', "\u{2212}");
    let text = format!("{value:.digits$e}");
    // Cannot fail: the text was formatted from a number.
    let rounded: f64 = text.parse().unwrap_or(value);
    let magnitude = rounded.abs();
    let is_fixed = matches!(notation, Notation::Fixed) && (1e-3..1e5).contains(&magnitude);
    if magnitude == 0.0 || !magnitude.is_finite() || is_fixed {
        return (signed(&rounded.to_string()), None);
    }
    let shortest = format!("{rounded:e}");
    let (mantissa, exponent) = shortest.split_once('e').unwrap_or((&shortest, "0"));
    (
        signed(mantissa),
        (exponent != "0").then(|| signed(exponent)),
    )
}

/// Returns a digit as a superscript; other characters are unchanged.
pub(crate) fn to_superscript(letter: char) -> char {
    let digit = letter.to_digit(10);
    let raised = digit.and_then(|digit| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit as usize));
    raised.unwrap_or(letter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_powers_of_ten_and_minus_signs() {
        let set = |value: f64, digits: usize| number(value, digits).into_string();
        let element = |number: &str| format!("<math><mn>{number}</mn></math>");
        assert_eq!(set(0.0, 3), element("0"));
        assert_eq!(set(0.025, 5), element("0.025"));
        assert_eq!(set(-1234.56789, 5), element("−1234.57"));
        assert_eq!(
            set(1e-12, 2),
            "<math><msup><mn>10</mn><mn>−12</mn></msup></math>"
        );
        assert_eq!(
            set(2.5e8, 5),
            "<math><mn>2.5</mn><mo>·</mo><msup><mn>10</mn><mn>8</mn></msup></math>"
        );
        assert_eq!(set(f64::INFINITY, 2), "inf");
    }
}
