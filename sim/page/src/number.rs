//! Numbers in pages.

use maud::{Markup, html};

use crate::formula::power_of_ten;

/// Returns a number with `digits` digits after the first, with powers of ten in full.
pub fn number(value: f64, digits: usize) -> Markup {
    if !value.is_finite() {
        return html! { (value.to_string()) };
    }
    let text = format!("{value:.digits$e}");
    // Cannot fail: the text was formatted from a number.
    let rounded: f64 = text.parse().unwrap_or(value);
    let magnitude = rounded.abs();
    let element = if magnitude == 0.0 || (1e-3..1e5).contains(&magnitude) {
        power_of_ten(&rounded.to_string(), None)
    } else {
        let shortest = format!("{rounded:e}");
        let (mantissa, exponent) = shortest.split_once('e').unwrap_or((&shortest, "0"));
        power_of_ten(mantissa, Some(exponent))
    };
    html! { math { (element) } }
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
