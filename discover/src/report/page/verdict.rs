//! Verdict in words: found effects, closed gap, and remaining gap in noise floors.

use maud::{Markup, html};

use crate::report::result::{Comparison, Discovery};
use crate::report::summary::Summary;

pub(super) fn of_comparison(comparison: &Comparison) -> Markup {
    shown(&Summary::of_comparison(comparison))
}

pub(super) fn of_discovery(discovery: &Discovery) -> Markup {
    shown(&Summary::of_discovery(discovery))
}

fn shown(summary: &Summary) -> Markup {
    html! {
        p.verdict {
            strong { (summary.first) }
            " " (summary.rest)
        }
    }
}
