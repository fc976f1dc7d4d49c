//! Controls: a slider and a number field for each quantity, and the form of each input over time.

use eomgen_page::play::Slider;
use maud::{Markup, html};

use super::quantities::{Quantities, Signal};

/// Change of an input in a sine or a step, as a fraction of half its range.
const CHANGE_FRACTION: f64 = 0.2;

/// Default, smallest and largest period of a sine and duration of a step, s.
const PERIOD_S: (f64, f64, f64) = (2.0, 0.1, 10.0);
const RISE_S: (f64, f64, f64) = (0.5, 0.05, 5.0);

pub(super) fn panel(quantities: &Quantities<'_>) -> Markup {
    let inputs: Vec<Markup> = quantities.inputs.iter().map(signal).collect();
    html! {
        section.panel.controls aria-label="Controls" {
            (group("Inputs", &inputs))
            (group("Parameters", &controls("parameter", &quantities.parameters)))
            (group("Initial state", &controls("initial", &quantities.initial)))
            p { button #defaults type="button" { "As specified" } }
        }
    }
}

fn controls(kind: &str, all: &[Slider<'_>]) -> Vec<Markup> {
    all.iter().map(|slider| slider.control(kind)).collect()
}

fn group(heading: &str, controls: &[Markup]) -> Markup {
    if controls.is_empty() {
        return html! {};
    }
    html! {
        details open {
            summary { (heading) }
            @for control in controls { (control) }
        }
    }
}

/// Returns the controls of an input: its value, and the form of its course with the numbers of that form.
fn signal(signal: &Signal<'_>) -> Markup {
    let Signal { value, rates } = signal;
    let rates: Vec<String> = rates.iter().map(ToString::to_string).collect();
    let half = 0.5 * (value.high - value.low);
    let extra = |name: &str, unit: &str, (value, low, high): (f64, f64, f64)| Slider {
        name: format!("{name} of {}", signal.value.name),
        unit: unit.to_owned(),
        doc: "",
        place: signal.value.place,
        factor: 1.0,
        value,
        low,
        high,
    };
    let change = extra("change", &value.unit, (CHANGE_FRACTION * half, -half, half));
    let form = format!("form-{}", value.place);
    html! {
        div data-signal data-place=(value.place) data-rates=(rates.join(" ")) {
            (value.control("value"))
            div.form {
                label for=(form) { "course" }
                select id=(form) {
                    option value="constant" selected { "constant" }
                    option value="sine" { "sine" }
                    option value="step" { "step after 1 s" }
                }
            }
            div data-forms="sine step" hidden {
                (change.labelled_control("change", &html! { "amplitude or height" }))
            }
            div data-forms="sine" hidden {
                (extra("period", "s", PERIOD_S).labelled_control("period", &html! { "period" }))
            }
            div data-forms="step" hidden {
                (extra("rise time", "s", RISE_S).labelled_control("rise", &html! { "rise time" }))
            }
        }
    }
}
