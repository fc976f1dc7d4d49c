//! The controls as markup: a slider and a number for everything that can be moved.

use eomgen_codegen::symbolic::formula::{Formula, Symbol};
use eomgen_page::formula;
use maud::{Markup, html};

use super::quantities::{Movable, Quantities};

/// In how many steps a slider goes from one end to the other.
const STEPS: f64 = 400.0;

/// All controls.
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

/// The controls of one kind.
fn group(heading: &str, kind: &str, all: &[Movable<'_>], is_open: bool) -> Markup {
    if all.is_empty() {
        return html! {};
    }
    html! {
        details open[is_open] {
            summary { (heading) }
            @for movable in all { (control(kind, movable)) }
        }
    }
}

/// A number with all its digits, short where it is large or small.
fn written(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e6).contains(&size) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

fn control(kind: &str, movable: &Movable<'_>) -> Markup {
    let Movable {
        name,
        unit,
        doc,
        place,
        value,
        low,
        high,
        ..
    } = movable;

    let id = format!("{kind}-{place}");
    let step = (high / STEPS - low / STEPS).max(f64::MIN_POSITIVE);
    let [value, low, high, step] = [*value, *low, *high, step].map(written);
    html! {
        div.control data-kind=(kind) data-place=(place) data-factor=(written(movable.factor)) {
            label.name for=(id) {
                (formula(&Formula::Symbol(Symbol::of_state(name))))
                @if unit != "1" { span.unit { (unit) } }
            }
            input type="number" step="any" value=(value) aria-label={ (name) " in " (unit) };
            input id=(id) type="range" min=(low) max=(high) step=(step) value=(value)
                aria-label={ (name) " in " (unit) ", slider" };
            @if !doc.is_empty() { small { (doc) } }
        }
    }
}
