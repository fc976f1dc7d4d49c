//! Numbers of a column, aligned at their decimal points.

use maud::{Markup, html};

use crate::number::{Notation, rounded};

/// Returns numbers with `digits` digits after the first, padded so that the decimal points align; a dash for a
/// missing number. If one number has a power of ten, all have one.
pub fn aligned(values: &[Option<f64>], digits: usize) -> Vec<Markup> {
    let notation = values
        .iter()
        .flatten()
        .fold(Notation::Fixed, |notation, value| {
            match rounded(*value, digits, notation).1 {
                Some(_) => Notation::PowerOfTen,
                None => notation,
            }
        });
    let numbers: Vec<Option<Parts>> = values
        .iter()
        .map(|value| value.map(|value| Parts::new(value, digits, notation)))
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
    fn new(value: f64, digits: usize, notation: Notation) -> Self {
        let (mantissa, exponent) = rounded(value, digits, notation);
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
        let values = [Some(-7427.43), Some(0.5), Some(-187.482), None, Some(3.0)];
        let column = set(&values);
        let whole = |text: &str| {
            format!(
                "<span class=\"aligned\"><span class=\"whole\" style=\"min-width:5ch\">{text}</span>"
            )
        };
        for (text, start) in column.iter().zip(["−7427", "0", "−187", "–", "3"]) {
            assert!(text.starts_with(&whole(start)), "{text}");
        }
        assert!(column[2].contains("</span>.482"), "{}", column[2]);
    }

    #[test]
    fn all_numbers_of_a_column_have_powers_of_ten_or_none() {
        let column = set(&[Some(0.5), Some(-1.87482e8), Some(0.0)]);
        assert!(
            column[0].contains("5</span>·10<sup>−1</sup>"),
            "{}",
            column[0]
        );
        assert!(
            column[1].contains("</span>.87482·10<sup>8</sup>"),
            "{}",
            column[1]
        );
        assert!(!column[2].contains("·10"), "{}", column[2]);
    }

    fn set(values: &[Option<f64>]) -> Vec<String> {
        let column = aligned(values, 5).into_iter();
        column.map(Markup::into_string).collect()
    }
}
