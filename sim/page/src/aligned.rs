//! Numbers of a column, aligned at their decimal points.

use maud::{Markup, html};

use crate::number::rounded;

/// Returns numbers with `digits` digits after the first, each with a width that aligns the decimal points;
/// a dash for a missing number.
pub fn aligned(values: &[Option<f64>], digits: usize) -> Vec<Markup> {
    let numbers: Vec<Option<Parts>> = values
        .iter()
        .map(|value| value.map(|value| Parts::new(value, digits)))
        .collect();
    let widths = numbers.iter().flatten();
    let whole = widths.map(|number| number.whole.chars().count()).max();
    let whole = whole.unwrap_or(1);
    numbers
        .iter()
        .map(|number| match number {
            Some(number) => number.markup(whole),
            None => html! { span.aligned { span.whole style=(style(whole)) { "–" } } },
        })
        .collect()
}

/// Decimal number in parts.
struct Parts {
    /// Sign and digits before the point.
    whole: String,
    /// Point and digits after it.
    rest: String,
    /// Power of ten.
    exponent: Option<String>,
}

impl Parts {
    fn new(value: f64, digits: usize) -> Self {
        let (mantissa, exponent) = rounded(value, digits);
        let at = mantissa.find('.').unwrap_or(mantissa.len());
        let (whole, rest) = mantissa.split_at(at);
        Self {
            whole: whole.to_owned(),
            rest: rest.to_owned(),
            exponent,
        }
    }

    fn markup(&self, whole: usize) -> Markup {
        html! {
            span.aligned {
                span.whole style=(style(whole)) { (self.whole) }
                (self.rest)
                @if let Some(exponent) = &self.exponent { "·10" sup { (exponent) } }
            }
        }
    }
}

fn style(characters: usize) -> String {
    format!("min-width:{characters}ch")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_at_the_same_distance_from_the_left() {
        let values = [Some(-7427.43), Some(0.5), Some(-1.87482e8), None, Some(3.0)];
        let column: Vec<String> = aligned(&values, 5)
            .into_iter()
            .map(Markup::into_string)
            .collect();
        let whole = |text: &str| {
            format!(
                "<span class=\"aligned\"><span class=\"whole\" style=\"min-width:5ch\">{text}</span>"
            )
        };
        for (text, start) in column.iter().zip(["−7427", "0", "−1", "–", "3"]) {
            assert!(text.starts_with(&whole(start)), "{text}");
        }
        assert!(column[2].contains("·10<sup>8</sup>"), "{}", column[2]);
        assert!(column[2].contains("</span>.87482·10"), "{}", column[2]);
    }
}
