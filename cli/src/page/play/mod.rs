//! The page to play with: sliders for what a model is given, a drawing that moves, curves, and the
//! equations. It computes with the emitted module, which it carries, and refers to nothing outside
//! itself.
//!
//! `quantities` says what can be moved and how far, `controls` is their markup, `data` what the
//! script is told. The script is what all pages that compute have, of `eomgen_page::play`, and here
//! `drawing.js`, `curves.js` and `controls.js`, which the page holds one after the other.

mod controls;
mod data;
mod quantities;

use eomgen_codegen::report::Report;
use eomgen_compiled_model::CompiledModel;
use eomgen_page::{ScriptedDocument, equations, play, scripted_document};
use maud::{Markup, html};

use crate::emission::module;
use crate::error::Result;
use quantities::Quantities;

/// What this page needs besides the style of all that compute.
const STYLE: &str = include_str!("play.css");

/// Its own part of the script.
const SCRIPT: [&str; 3] = [
    include_str!("drawing.js"),
    include_str!("curves.js"),
    include_str!("controls.js"),
];

/// The page of a model.
///
/// # Errors
/// If the declared parameters give no motion, or the module cannot be emitted.
pub fn playable(compiled: &CompiledModel) -> Result<String> {
    let instance = compiled.at_declared()?;
    let module = module(compiled.program())?;
    let quantities = Quantities::of(compiled, instance.initial())?;
    let evaluator = instance.evaluator()?;
    let report = Report::new(compiled.model(), compiled.equations(), &evaluator);
    let data = data::json(compiled, &quantities, instance.initial(), &module)?;
    Ok(scripted_document(&ScriptedDocument {
        title: &compiled.model().title,
        style: &[play::STYLE, STYLE].concat(),
        body: &body(compiled, &quantities, &report),
        data: &data,
        script: &play::script(&SCRIPT),
    }))
}

fn body(compiled: &CompiledModel, quantities: &Quantities<'_>, report: &Report) -> Markup {
    let model = compiled.model();
    html! {
        header {
            h1 { (model.title) }
            p.lead {
                "Move a slider and watch the motion change. It is computed here, by the same "
                "operations as the emitted Rust and C."
            }
        }
        main {
            noscript { p { "Without its script this page shows the equations alone." } }
            div.instrument {
                div.seen {
                    (drawing(&model.title))
                    (curves(quantities))
                }
                (controls::panel(quantities))
            }
            section.equations-of-motion {
                h2 { "Equations of motion" }
                (equations(report))
            }
        }
        footer {
            p {
                "Written by eomgen " (env!("CARGO_PKG_VERSION")) " from the specification "
                code { (model.name) } "."
            }
        }
    }
}

/// The picture with what plays it.
fn drawing(title: &str) -> Markup {
    html! {
        section.panel aria-label="Drawing" {
            canvas #drawing role="img" aria-label={ "Drawing of " (title) ", moving" } {}
            div.transport {
                button #play type="button" { "Play" }
                button #reset type="button" { "Reset" }
                label {
                    "Speed"
                    input #speed type="range" min="-4" max="1" step="0.1" value="0";
                    output #speed-value for="speed" { "1 ×" }
                }
                output #clock aria-label="Time" { "0.00 s" }
            }
            // Of the two only the first is read aloud: the other changes in every frame.
            p #status role="status" {}
            p #note {}
        }
    }
}

/// The strips, and which of them are shown.
fn curves(quantities: &Quantities<'_>) -> Markup {
    html! {
        section.panel aria-label="Curves" {
            canvas #curves role="img" aria-label="Curves of the chosen quantities over time" {}
            fieldset #shown {
                legend.hidden { "Quantities shown as curves" }
                @for shown in &quantities.shown {
                    label {
                        input type="checkbox" value=(shown.place) checked[shown.at_first];
                        (shown.name)
                        span.unit { "[" (shown.unit) "]" }
                    }
                }
            }
        }
    }
}
