//! Verdict in words: found effects, closure, and remaining gap in noise floors.

use eomgen_page::prose;
use maud::{Markup, html};

use crate::report::result::{Comparison, Discovery};
use crate::report::summary::Summary;

pub(super) fn write_comparison_verdict(comparison: &Comparison) -> Markup {
    write_summary(&Summary::from_comparison(comparison))
}

pub(super) fn write_discovery_verdict(discovery: &Discovery) -> Markup {
    write_summary(&Summary::from_discovery(discovery))
}

fn write_summary(summary: &Summary) -> Markup {
    html! {
        p.verdict {
            strong { (prose(&summary.headline)) }
            " " (prose(&summary.details))
        }
    }
}
