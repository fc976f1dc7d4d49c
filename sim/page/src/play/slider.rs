//! Sliders with number fields for quantities that the reader of a page can change.

use eomgen_model_spec::model::Parameter;
use maud::{Markup, html};

use crate::formula::quantity_symbol;
use crate::number::to_superscript;
use crate::prose::prose;

const SLIDER_STEPS: f64 = 400.0;

/// Number of significant digits in a number field.
const SHOWN_DIGITS: usize = 6;

/// Smallest nonzero value of a number field, as a fraction of the step of its slider; smaller values are
/// rounding errors.
const ROUNDING_FRACTION: f64 = 1e-9;

/// Quantity that the reader of a page can change.
#[derive(Clone, Debug)]
pub struct Slider<'m> {
    /// Name of the quantity.
    pub name: String,
    /// Unit in the page.
    pub unit: String,
    /// Description of the quantity.
    pub doc: &'m str,
    /// Index among the quantities of its kind.
    pub place: usize,
    /// Size of the unit in SI.
    pub factor: f64,
    /// Value, in the unit.
    pub value: f64,
    /// Lower end, in the unit.
    pub low: f64,
    /// Upper end, in the unit.
    pub high: f64,
}

impl<'m> Slider<'m> {
    /// Creates the slider of a parameter, by default from 0 to twice its `value`, which is in SI.
    pub fn from_parameter(parameter: &'m Parameter, place: usize, value: f64) -> Self {
        let unit = &parameter.unit;
        let value = unit.from_si(value);
        let (low, high) = default_range(value);
        let (min, max) = (parameter.min, parameter.max);
        let low = min.map_or(low, |min| unit.from_si(min));
        let high = max.map_or(high, |max| unit.from_si(max));
        Self {
            name: parameter.name.clone(),
            unit: format_unit(&unit.to_string()),
            doc: &parameter.doc,
            place,
            factor: unit.to_si(1.0),
            value,
            low: low.min(value),
            high: high.max(value),
        }
    }

    /// Returns the HTML elements. The script identifies them by `kind` and index.
    pub fn control(&self, kind: &str) -> Markup {
        self.labelled_control(kind, &quantity_symbol(&self.name))
    }

    /// Returns the HTML elements with words instead of a symbol as their label.
    pub fn labelled_control(&self, kind: &str, label: &Markup) -> Markup {
        let Self {
            name,
            unit,
            doc,
            place,
            value,
            low,
            high,
            factor,
        } = self;

        let id = format!("{kind}-{place}");
        let step = (high / SLIDER_STEPS - low / SLIDER_STEPS).max(f64::MIN_POSITIVE);
        let shown = if value.abs() < ROUNDING_FRACTION * step {
            0.0
        } else {
            rounded(*value)
        };
        let [value, low, high, step] = [shown, *low, *high, step].map(format_number);
        html! {
            div.control data-kind=(kind) data-place=(place) data-factor=(format_number(*factor)) data-name=(name) data-unit=(unit) {
                label.name for=(id) {
                    span { (label) }
                    @if unit != "1" { span.unit { (unit) } }
                }
                input type="number" step="any" value=(value) aria-label={ (name) " in " (unit) };
                input id=(id) type="range" min=(low) max=(high) step=(step) value=(value)
                    aria-label={ (name) " in " (unit) ", slider" };
                @if !doc.is_empty() { small { (prose(doc)) } }
            }
        }
    }
}

/// Rounds a number to the digits of a number field. Until the field changes, the script uses the exact number
/// of the specification.
fn rounded(value: f64) -> f64 {
    let text = format!("{value:.*e}", SHOWN_DIGITS - 1);
    text.parse().unwrap_or(value)
}

/// Returns the range from 0 to twice a value; a range around 0 if the value is 0.
fn default_range(value: f64) -> (f64, f64) {
    let twice = (2.0 * value).clamp(f64::MIN, f64::MAX);
    if value > 0.0 {
        (0.0, twice)
    } else if value < 0.0 {
        (twice, 0.0)
    } else {
        (-1.0, 1.0)
    }
}

fn format_number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e6).contains(&size) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// Formats a unit with the prefix µ and superscript exponents, unless it has a fraction as an exponent.
pub fn format_unit(unit: &str) -> String {
    if unit.contains("^(") {
        return unit.to_owned();
    }
    // A prefix precedes a unit, so a lone `u` is not one.
    let unit = &unit
        .split([' ', '*'])
        .map(|part| match part.strip_prefix('u') {
            Some(rest) if rest.starts_with(char::is_alphabetic) => format!("µ{rest}"),
            _ => part.to_owned(),
        })
        .collect::<Vec<_>>()
        .join(" ");
    let mut raised = false;
    let mut text = String::new();
    for letter in unit.chars() {
        raised = letter == '^' || raised && (letter == '-' || letter.is_ascii_digit());
        match letter {
            '^' => {}
            '-' if raised => text.push('⁻'),
            '0'..='9' if raised => text.push(to_superscript(letter)),
            other => text.push(other),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_raised() {
        for (unit, shown) in [
            ("m/s^2", "m/s²"),
            ("kg m^-10", "kg m⁻¹⁰"),
            ("um", "µm"),
            ("N m", "N m"),
            ("kg*m^2", "kg m²"),
            ("1", "1"),
            ("m^(1/2)", "m^(1/2)"),
        ] {
            assert_eq!(format_unit(unit), shown);
        }
    }

    #[test]
    fn field_has_few_digits() {
        for (value, shown) in [(31.41592653589793, 31.4159), (-2.5e-5, -2.5e-5), (0.0, 0.0)] {
            assert_eq!(rounded(value), shown);
        }
    }

    #[test]
    fn rounding_error_is_shown_as_zero() {
        let slider = |value: f64| Slider {
            name: "phi".to_owned(),
            unit: "rad".to_owned(),
            doc: "",
            place: 0,
            factor: 1.0,
            value,
            low: -3.0,
            high: 3.0,
        };
        let field = |value| slider(value).control("initial").into_string();
        assert!(field(8e-28).contains("value=\"0\""), "{}", field(8e-28));
        assert!(field(8e-8).contains("value=\"8e-8\""), "{}", field(8e-8));
    }

    #[test]
    fn slider_has_finite_range() {
        for value in [0.0, 1.0, -2.0, 1.7e308, -1.7e308, 5e-324] {
            let (low, high) = default_range(value);
            assert!(low <= value && value <= high && low < high, "{value}");
            assert!(low.is_finite() && high.is_finite(), "{value}");
        }
    }
}
