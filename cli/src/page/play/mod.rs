//! Interactive page of a model: sliders, an animated drawing, curves, and the equations. The page is self-contained. It
//! simulates with the emitted WebAssembly modules of the model.
//!
//! `quantities` selects the sliders and their ranges, and `controls` renders them. `first_motion` determines whether an
//! input is a sine when the page opens. `data` contains the data of the script. The script consists of the common
//! script of `eomgen_page::play`, followed by `drawing.js`, `curves.js`, `signals.js` (controls of inputs) and
//! `controls.js`.

mod controls;
mod data;
mod first_motion;
mod quantities;

use eomgen_codegen::report::Report;
use eomgen_compiled_model::{CompiledModel, ExportedModel};
use eomgen_page::{ScriptedDocument, equations, play, quantity_symbol, scripted_document};
use maud::{Markup, html};

use crate::error::Result;
use quantities::Quantities;

/// Style sheet, in addition to the common style sheet.
const STYLE: &str = include_str!("play.css");

/// Scripts, in addition to the common script.
const SCRIPT: [&str; 4] = [
    include_str!("drawing.js"),
    include_str!("curves.js"),
    include_str!("signals.js"),
    include_str!("controls.js"),
];

/// Initial speed of the clock (real time), as a logarithm to the base 10.
const REAL_TIME: f64 = 0.0;

/// Initial speed of the clock with controls for some parameters, as a logarithm to the base 10.
const SLOW_MOTION: f64 = -1.0;

/// Default period of a sine, in s.
const DRIVING_PERIOD_S: f64 = 2.0;

/// Default period of a sine for a fast machine, in periods of its lowest mode. The machine follows such an input
/// without resonance.
const DRIVING_PERIODS: f64 = 5.0;

/// Initial speed of the clock and default period of sines.
#[derive(Clone, Copy, Debug)]
struct Pace {
    /// Speed of the clock, as a logarithm to the base 10.
    speed: f64,
    /// Default period of sines, in s.
    period: f64,
}

impl Pace {
    /// Returns the pace at which the short period `period` (in s) of a machine takes about a second.
    fn of_period(period: f64) -> Self {
        Self {
            speed: (10.0 * period.log10()).round() / 10.0,
            period: rounded(DRIVING_PERIODS * period),
        }
    }
}

/// Rounds a positive number to two significant digits.
fn rounded(value: f64) -> f64 {
    let text = format!("{value:.1e}");
    text.parse().unwrap_or(value)
}

/// Lower end of the speed slider, as a logarithm to the base 10. A fast machine extends it.
const SLOWEST: f64 = -4.0;

/// Interactive part of a page. A page has at most one.
pub struct InteractivePart {
    /// Drawing, curves and controls.
    pub body: Markup,
    /// Data for the script of the page, as JSON.
    pub data: String,
}

impl InteractivePart {
    /// Builds the interactive part of a model with an initial state, with controls for all quantities.
    ///
    /// # Errors
    /// A model that cannot be simulated with its parameters, or a module that cannot be emitted.
    pub fn new(compiled: &CompiledModel, initial: &[f64]) -> Result<Self> {
        let quantities = Quantities::new(compiled, initial)?;
        let pace = match first_motion::invisible_period(compiled, initial) {
            Some(period) => Pace::of_period(period),
            None => Pace {
                speed: REAL_TIME,
                period: DRIVING_PERIOD_S,
            },
        };
        Self::with_quantities(compiled, initial, &quantities, pace)
    }

    /// Builds the interactive part of a model with controls for some of its parameters only. The clock starts at a
    /// tenth of real time.
    ///
    /// # Errors
    /// Same as [`InteractivePart::new`].
    pub fn of_parameters(
        compiled: &CompiledModel,
        initial: &[f64],
        parameters: &[&str],
    ) -> Result<Self> {
        let mut quantities = Quantities::new(compiled, initial)?;
        quantities
            .parameters
            .retain(|slider| parameters.contains(&&*slider.name));
        quantities.initial.clear();
        let pace = Pace {
            speed: SLOW_MOTION,
            period: DRIVING_PERIOD_S,
        };
        Self::with_quantities(compiled, initial, &quantities, pace)
    }

    fn with_quantities(
        compiled: &CompiledModel,
        initial: &[f64],
        quantities: &Quantities<'_>,
        pace: Pace,
    ) -> Result<Self> {
        let model = ExportedModel::new(&compiled.with_declared_parameters()?)?;
        let bytes = model.to_bytes();
        let moving = play::embed_motion(&bytes, model.program(), model.sided_program())?;
        let is_at_rest = first_motion::is_at_rest(compiled, initial)?;
        let body = html! {
            noscript {
                p {
                    "Without JavaScript nothing moves on this page. The controls show the values of the specification, "
                    "and the equations are below. "
                    code { "eomgen simulate --plot" } " draws the motion as a figure."
                }
            }
            @if is_at_rest { (note_of_rest(quantities)) }
            div.instrument {
                div.seen.scripted {
                    (drawing(&compiled.model().title, pace.speed))
                    (curves(quantities))
                }
                (controls::panel(quantities, is_at_rest, pace.period))
            }
        };
        Ok(Self {
            body,
            data: data::json(compiled, quantities, initial, moving)?,
        })
    }

    /// Renders a document that contains this interactive part; `body` must include its markup.
    pub fn document(&self, title: &str, body: &Markup) -> String {
        scripted_document(&ScriptedDocument {
            title,
            style: &[play::STYLE, STYLE].concat(),
            body,
            data: &self.data,
            script: &play::join_scripts(&SCRIPT),
        })
    }
}

/// Renders the page of a model with an initial state.
///
/// # Errors
/// Same as [`InteractivePart::new`].
pub fn interactive_page(compiled: &CompiledModel, initial: &[f64]) -> Result<String> {
    let instance = compiled.with_declared_parameters()?;
    let evaluator = instance.evaluator()?;
    let report = Report::new(compiled.model(), compiled.equations(), &evaluator);
    let part = InteractivePart::new(compiled, initial)?;
    let model = compiled.model();
    // The title of a model without a title is its name.
    let title = match model.title == model.name {
        true => model.name.replace('_', " "),
        false => model.title.clone(),
    };
    let body = html! {
        header {
            h1 { (title) }
            p.lead {
                "Move a slider to change the motion. The page computes it with the same "
                "operations as the emitted Rust and C."
            }
        }
        main {
            (part.body)
            section.equations-of-motion {
                h2 { "Equations of motion" }
                (equations(&report))
            }
        }
        footer {
            p {
                "Written by eomgen " (env!("CARGO_PKG_VERSION")) " from the specification "
                code { (model.name) } "."
            }
        }
    };
    Ok(part.document(&title, &body))
}

/// Returns a note for a machine that stays at rest without inputs.
fn note_of_rest(quantities: &Quantities<'_>) -> Markup {
    match quantities.inputs.first() {
        Some(signal) => {
            let symbol = quantity_symbol(&signal.value.name);
            html! {
                p.note {
                    "Without inputs this machine stays at rest. Its input " (symbol)
                    " therefore starts as a sine; choose another signal under Inputs."
                }
            }
        }
        None => html! {
            p.note {
                "This machine is at rest. To see it move, change a value under Initial state."
            }
        },
    }
}

fn drawing(title: &str, speed: f64) -> Markup {
    let slowest = SLOWEST.min(speed.floor() - 1.0);
    html! {
        section.panel aria-label="Drawing" {
            canvas #drawing role="img" aria-label={ "Drawing of " (title) ", moving" } {}
            div.transport {
                button #play type="button" { "Play" }
                button #reset type="button" { "Reset" }
                label {
                    "Speed"
                    input #speed type="range" min=(slowest) max="1" step="0.1" value=(speed);
                    output #speed-value for="speed" { "1 ×" }
                }
                output #clock aria-label="Time" { "0.00 s" }
            }
            // Screen readers read only the first line; the second line changes in every frame.
            p #status role="status" {}
            p #note {}
        }
    }
}

/// Maximum number of quantities for which the list is open initially.
const MAX_OPEN_LIST: usize = 16;

fn curves(quantities: &Quantities<'_>) -> Markup {
    let all = &quantities.shown;
    html! {
        section.panel aria-label="Curves" {
            canvas #curves role="img" aria-label="Curves of the chosen quantities over time" {}
            details open[all.len() <= MAX_OPEN_LIST] {
                summary { "Quantities shown as curves" }
                fieldset #shown {
                    legend.hidden { "Quantities shown as curves" }
                    @for shown in all {
                        label {
                            input type="checkbox" value=(shown.place) checked[shown.at_first];
                            (quantity_symbol(&shown.name))
                            span.unit { "[" (shown.unit) "]" }
                        }
                    }
                }
            }
        }
    }
}
