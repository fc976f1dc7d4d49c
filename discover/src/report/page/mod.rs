//! HTML page of a result: verdict, measured and simulated motion before and after the search, found
//! and rejected effects, nuisances, changes of the specification, and origin.
//!
//! The files: `verdict` (first sentence), `gap_table` (gap of each channel), `found_effects`
//! (effects and steps), `alternatives` (rejected effects), `nuisances` (declared and estimated
//! values), `origin` (files and hashes).

mod alternatives;
mod found_effects;
mod gap_table;
mod nuisances;
mod origin;
mod verdict;

#[cfg(test)]
mod tests;

use eomgen_page::{ScriptedDocument, document, prose, scripted_document, section};
use maud::{Markup, html};

use crate::report::playback::Playback;
use crate::report::quantity::format_readable;
use crate::report::result::{CommonResult, Comparison, Discovery};

impl Comparison {
    /// Returns the page as a self-contained HTML document.
    pub fn to_html(&self) -> String {
        let compared = &self.compared;
        write_document(
            compared,
            "Comparison of model and measurement",
            &html! {
                (verdict::write_comparison_verdict(self))
                (write_figures(compared))
                (write_location(compared))
            },
        )
    }
}

impl Discovery {
    /// Returns the page as a self-contained HTML document.
    pub fn to_html(&self) -> String {
        let compared = &self.compared;
        write_document(
            compared,
            "Search for missing effects of the model",
            &html! {
                (verdict::write_discovery_verdict(self))
                (found_effects::list_effects(&self.effects, &self.experiments))
                (compared.pictures.experiments)
                (write_playback(compared))
                (write_figures(compared))
                (found_effects::list_steps(self))
                (alternatives::list_rejected(&self.rejected))
                (alternatives::list_untestable(&self.untestable, &self.experiments))
                (write_location(compared))
                (found_effects::show_change(&self.original, &self.extended))
            },
        )
    }
}

/// Returns a document with a header, a body and the origin. `kind`: kind of the report.
fn write_document(compared: &CommonResult, kind: &str, body: &Markup) -> String {
    let title = compared.title.as_str();
    let origin = &compared.origin;
    let body = html! {
        header {
            h1 { (title) }
            p.note { (kind) ", " span.word { (origin.date) } }
        }
        main { (body) }
        footer { (origin::list_files(origin)) }
    };
    match &compared.pictures.playback {
        Playback::Computed { data, .. } => scripted_document(&ScriptedDocument {
            title,
            style: &Playback::load_style(),
            body: &body,
            data,
            script: &Playback::load_script(),
        }),
        Playback::Unavailable(_) | Playback::NotNeeded => document(title, &body),
    }
}

/// Writes the interactive figure of the result.
fn write_playback(compared: &CommonResult) -> Markup {
    match &compared.pictures.playback {
        Playback::Computed { body, .. } => section("Interactive simulation", body),
        Playback::Unavailable(why) => html! {
            p.note { "There is no interactive simulation: " (prose(why)) "." }
        },
        Playback::NotNeeded => html! {},
    }
}

/// Writes the figures of the gap.
fn write_figures(compared: &CommonResult) -> Markup {
    html! {
        (section("Measured and simulated", &html! {
            (compared.pictures.overlay)
            (compared.pictures.residuals)
        }))
        (section("Residuals", &gap_table::write_gap_table(compared)))
    }
}

/// Writes the location of the gap and the refitted parameters.
fn write_location(compared: &CommonResult) -> Markup {
    let force = compared.pictures.force.as_ref();
    let has_location = !compared.location.is_empty();
    html! {
        @if has_location || force.is_some() {
            (section("Location of the difference", &html! {
                @if has_location { p { (prose(&format_readable(&compared.location))) } }
                @if let Some(force) = force { (force) }
            }))
        }
        (nuisances::list_nuisances(compared))
        @if !compared.notes.is_empty() {
            (section("Notes", &html! {
                ul { @for note in &compared.notes { li { (prose(&format_readable(note))) } } }
            }))
        }
    }
}
