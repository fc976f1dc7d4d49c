//! Controls: a slider and a number field for each quantity.

use eomgen_page::play::Slider;
use maud::{Markup, html};

use super::quantities::Quantities;

pub(super) fn panel(quantities: &Quantities<'_>) -> Markup {
    html! {
        section.panel.controls aria-label="Controls" {
            (group("Inputs", "input", &quantities.inputs, true))
            (group("Parameters", "parameter", &quantities.parameters, true))
            (group("Initial state", "initial", &quantities.initial, true))
            p { button #defaults type="button" { "As specified" } }
        }
    }
}

fn group(heading: &str, kind: &str, all: &[Slider<'_>], is_open: bool) -> Markup {
    if all.is_empty() {
        return html! {};
    }
    html! {
        details open[is_open] {
            summary { (heading) }
            @for slider in all { (slider.control(kind)) }
        }
    }
}
