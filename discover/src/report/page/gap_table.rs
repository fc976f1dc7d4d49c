//! Gap of each channel before and after the search.

use eomgen_page::{quantity_symbol, table};
use maud::{Markup, html};

use crate::report::quantity::{format_number, format_quantity};
use crate::report::result::{ChannelGap, CommonResult, TrainTest};

pub(super) fn write_gap_table(compared: &CommonResult) -> Markup {
    let has_after = compared.gap.values().any(|gap| gap.after.is_some());
    let rows = html! {
        @for (name, gap) in &compared.gap {
            tr {
                th scope="row" { (quantity_symbol(name)) }
                td.number { (format_quantity(gap.floor, 3, &gap.unit)) }
                (format_before_after(gap, has_after, |on| on.test))
                (format_before_after(gap, has_after, |on| on.train))
            }
        }
    };
    let headings: &[&str] = match has_after {
        true => &[
            "channel",
            "noise floor",
            "held out, before",
            "held out, after",
            "training, before",
            "training, after",
        ],
        false => &["channel", "noise floor", "held out", "training"],
    };
    html! {
        (table(headings, &rows))
        p.note {
            "RMS of simulated minus measured. In parentheses: the residual as a multiple of the noise "
            "floor (1 = a correct model). Held-out records "
            "were not used in the fit."
        }
    }
}

/// Formats the value before the search and, if available, after it.
fn format_before_after(gap: &ChannelGap, has_after: bool, of: fn(TrainTest<f64>) -> f64) -> Markup {
    let cell = |value: f64| {
        html! {
            td.number {
                (format_quantity(value, 3, &gap.unit))
                @if value.is_finite() { " " small { "(" (format_number(value / gap.floor, 3)) ")" } }
            }
        }
    };
    html! {
        (cell(of(gap.before)))
        @if has_after { (cell(gap.after.map_or(f64::NAN, of))) }
    }
}
