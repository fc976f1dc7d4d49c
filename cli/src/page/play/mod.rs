//! Interactive page of a model: sliders, an animated drawing, curves, and the equations. The page is self-contained and
//! computes with the emitted WebAssembly module.
//!
//! `quantities` selects the sliders and their ranges, `controls` renders them, `data` is the input of the script. The
//! script is the common one of `eomgen_page::play`, followed by `drawing.js`, `curves.js` and `controls.js`.

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

/// Style, in addition to the common one.
const STYLE: &str = include_str!("play.css");

/// Script, in addition to the common one.
const SCRIPT: [&str; 3] = [
    include_str!("drawing.js"),
    include_str!("curves.js"),
    include_str!("controls.js"),
];

/// Renders the page of a model with an initial state.
///
/// # Errors
/// Declared parameters without a motion, or a module that cannot be emitted.
pub fn interactive_page(compiled: &CompiledModel, initial: &[f64]) -> Result<String> {
    let instance = compiled.with_declared_parameters()?;
    let module = module(compiled.program())?;
    let quantities = Quantities::new(compiled, initial)?;
    let evaluator = instance.evaluator()?;
    let report = Report::new(compiled.model(), compiled.equations(), &evaluator);
    let data = data::json(compiled, &quantities, initial, &module)?;
    Ok(scripted_document(&ScriptedDocument {
        title: &compiled.model().title,
        style: &[play::STYLE, STYLE].concat(),
        body: &body(compiled, &quantities, &report),
        data: &data,
        script: &play::join_scripts(&SCRIPT),
    }))
}

fn body(compiled: &CompiledModel, quantities: &Quantities<'_>, report: &Report) -> Markup {
    let model = compiled.model();
    html! {
        header {
            h1 { (model.title) }
            p.lead {
                "Move a slider to change the motion. The page computes it with the same "
                "operations as the emitted Rust and C."
            }
        }
        main {
            noscript { p { "Without JavaScript this page shows the equations only." } }
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
            // Screen readers read the first only; the second changes in every frame.
            p #status role="status" {}
            p #note {}
        }
    }
}

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
