//! HTML page of a result: verdict, measured and simulated motion before and after, found and
//! rejected effects, nuisances, changes of the specification, and origin.
//!
//! The files: `verdict` (first sentence), `gap` (gap of each channel), `found` (effects and steps),
//! `alternatives` (rejected effects), `nuisances` (declared and estimated values), `origin` (files
//! and hashes).

mod alternatives;
mod found;
mod gap;
mod nuisances;
mod origin;
mod verdict;

#[cfg(test)]
mod tests;

use eomgen_page::{ScriptedDocument, document, scripted_document, section};
use maud::{Markup, html};

use crate::report::playback::Playback;
use crate::report::quantity::readable;
use crate::report::result::{Compared, Comparison, Discovery};

impl Comparison {
    /// Returns the page as a self-contained HTML document.
    pub fn page(&self) -> String {
        let compared = &self.compared;
        whole(
            compared,
            &html! {
                (verdict::of_comparison(self))
                (opening(compared))
                (closing(compared))
            },
        )
    }
}

impl Discovery {
    /// Returns the page as a self-contained HTML document.
    pub fn page(&self) -> String {
        let compared = &self.compared;
        whole(
            compared,
            &html! {
                (verdict::of_discovery(self))
                (found::effects(&self.effects, &self.experiments))
                (compared.pictures.experiments)
                (playback(compared))
                (opening(compared))
                (found::steps(self))
                (alternatives::rejected(&self.rejected))
                (alternatives::not_testable(&self.not_testable, &self.experiments))
                (closing(compared))
                (found::change(&self.original, &self.extended))
            },
        )
    }
}

/// A document around a body.
fn whole(compared: &Compared, body: &Markup) -> String {
    let title = match compared.title.as_str() {
        "" => "Model and measurement",
        title => title,
    };
    let origin = &compared.origin;
    let body = html! {
        header {
            h1 { (title) }
            p.note { "Comparison of model and measurement, " (origin.date) }
        }
        main { (body) }
        footer { (origin::files(origin)) }
    };
    match &compared.pictures.playback {
        Playback::Computed { data, .. } => scripted_document(&ScriptedDocument {
            title,
            style: &Playback::style(),
            body: &body,
            data,
            script: &Playback::script(),
        }),
        Playback::Still(_) | Playback::None => document(title, &body),
    }
}

/// What was found, to be moved.
fn playback(compared: &Compared) -> Markup {
    match &compared.pictures.playback {
        Playback::Computed { body, .. } => section("Interactive simulation", body),
        Playback::Still(why) => html! {
            p.note { "There is no interactive simulation: " (why) "." }
        },
        Playback::None => html! {},
    }
}

/// What is seen of the gap.
fn opening(compared: &Compared) -> Markup {
    html! {
        (section("Measured and simulated", &html! {
            (compared.pictures.overlay)
            (compared.pictures.residuals)
        }))
        (section("Residuals", &gap::table_of(compared)))
    }
}

/// Where the gap is, and what was fitted beside.
fn closing(compared: &Compared) -> Markup {
    let force = compared.pictures.force.as_ref();
    let has_location = !compared.location.is_empty();
    html! {
        @if has_location || force.is_some() {
            (section("Location of the difference", &html! {
                @if has_location { p { (readable(&compared.location)) } }
                @if let Some((equation, force)) = force {
                    h3 { "Missing force on " code { (equation) } }
                    (force)
                }
            }))
        }
        (nuisances::fitted(compared))
        @if !compared.notes.is_empty() {
            (section("Notes", &html! {
                ul { @for note in &compared.notes { li { (readable(note)) } } }
            }))
        }
    }
}
