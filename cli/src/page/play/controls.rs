//! Controls of a page: a slider and a number field for each quantity, and the signal form of each input.

use eomgen_page::play::Slider;
use maud::{Markup, html};

use super::quantities::{Quantities, Signal};

/// Default amplitude of a sine or a step, as a fraction of half the input's range.
const CHANGE_FRACTION: f64 = 0.2;

/// Smallest and largest period of a sine, as multiples of the default period.
const PERIOD_RANGE: (f64, f64) = (0.05, 5.0);

/// Default, smallest and largest duration of a step, s.
const RISE_S: (f64, f64, f64) = (0.5, 0.05, 5.0);

/// Amplitude of an input that is a sine when the page opens, as a fraction of half its range.
const FIRST_CHANGE_FRACTION: f64 = 0.5;

/// Amplitude and period of a prescribed motion that is a sine when the page opens. They avoid unrealistically large
/// accelerations.
const FIRST_MOTION_FRACTION: f64 = 0.1;
const FIRST_MOTION_PERIODS: f64 = 5.0;

/// Returns the controls. If `is_driven`, the first input is a sine when the page opens. `period` is the default period
/// of sines, in s.
pub(super) fn panel(quantities: &Quantities<'_>, is_driven: bool, period: f64) -> Markup {
    let inputs = quantities.inputs.iter().enumerate();
    let inputs: Vec<Markup> = inputs
        .map(|(place, input)| signal(input, is_driven && place == 0, period))
        .collect();
    html! {
        section.panel.controls aria-label="Controls" {
            (group("Inputs", &inputs))
            (group("Parameters", &controls("parameter", &quantities.parameters)))
            (group("Initial state", &controls("initial", &quantities.initial)))
            p.scripted { button #defaults type="button" { "As specified" } }
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

/// Returns the controls of an input: its value and its signal form (constant, sine or step) with the numbers of this
/// form. If `is_sine`, the input is a sine when the page opens. `period` is the default period of a sine, in s.
fn signal(signal: &Signal<'_>, is_sine: bool, period: f64) -> Markup {
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
    let (shortest, longest) = (PERIOD_RANGE.0 * period, PERIOD_RANGE.1 * period);
    let (fraction, period) = match (is_sine, rates.is_empty()) {
        (true, true) => (FIRST_CHANGE_FRACTION, period),
        (true, false) => (FIRST_MOTION_FRACTION, FIRST_MOTION_PERIODS * period),
        (false, _) => (CHANGE_FRACTION, period),
    };
    let change = extra("change", &value.unit, (fraction * half, -half, half));
    let period = extra("period", "s", (period, shortest, longest));
    let form = format!("form-{}", value.place);
    html! {
        div data-signal data-place=(value.place) data-rates=(rates.join(" ")) {
            (value.control("value"))
            div.form {
                label for=(form) { "signal" }
                select id=(form) {
                    option value="constant" selected[!is_sine] { "constant" }
                    option value="sine" selected[is_sine] { "sine" }
                    option value="step" { "step after 1 s" }
                }
            }
            div data-forms="sine step" hidden[!is_sine] {
                (change.labelled_control("change", &html! {
                    span data-forms="sine" hidden[!is_sine] { "amplitude" }
                    span data-forms="step" hidden { "height" }
                }))
            }
            div data-forms="sine" hidden[!is_sine] {
                (period.labelled_control("period", &html! { "period" }))
            }
            div data-forms="step" hidden {
                (extra("rise time", "s", RISE_S).labelled_control("rise", &html! { "rise time" }))
            }
        }
    }
}
