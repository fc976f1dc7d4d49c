//! The newcomer's page: one HTML document that walks from a specification to its equations,
//! the emitted source, the certificate, a simulation and what is found in records. Only how these are shown; what they
//! say is handed in.
//!
//! `play` is another page, on which one model can be played with.
//!
//! The tour's page refers to nothing outside itself and has no script but that of the report of the search, in
//! a frame of its own; nothing in a specification becomes markup.

mod play;
mod steps;

#[cfg(test)]
mod tests;

pub use play::playable;

use eomgen_codegen::report::Report;
use eomgen_page::{Figure, document, equations};
use maud::{Markup, html};

/// Everything on the page.
#[derive(Clone, Debug)]
pub struct Tour<'a> {
    /// The model's title.
    pub title: &'a str,
    /// Name and version of the program.
    pub generated_by: &'a str,
    /// What was checked.
    pub specification: Specification<'a>,
    /// What was derived from it.
    pub equations: &'a Report,
    /// What was emitted.
    pub source: Source<'a>,
    /// How it was validated.
    pub checks: Vec<CheckRow<'a>>,
    /// What was simulated.
    pub simulation: Simulation<'a>,
    /// What was hidden, and found.
    pub hidden: Hidden<'a>,
    /// What took how long, in order.
    pub durations: Vec<StepDuration<'a>>,
    /// What to try next.
    pub next: Vec<NextCommand<'a>>,
}

/// A checked specification.
#[derive(Clone, Debug)]
pub struct Specification<'a> {
    /// Where it is, as the user would write it.
    pub path: &'a str,
    /// The whole file.
    pub text: &'a str,
    /// The diagnostics as the terminal shows them, without colours; empty if there are none.
    pub warnings: Vec<&'a str>,
}

/// An emitted model.
#[derive(Clone, Debug)]
pub struct Source<'a> {
    /// Where it was written.
    pub path: &'a str,
    /// The whole file, as formatted by the emitter.
    pub text: &'a str,
}

/// One line of the certificate.
#[derive(Clone, Debug)]
pub struct CheckRow<'a> {
    /// What was checked.
    pub name: &'a str,
    /// The worst deviation, if there is one.
    pub value: Option<f64>,
    /// The largest deviation that passes.
    pub tolerance: f64,
    /// Whether the check was made and passed.
    pub passed: bool,
    /// Whether it could not be made.
    pub skipped: bool,
    /// Where the worst was found, or why it was skipped.
    pub detail: &'a str,
}

/// What was simulated and how it looks.
#[derive(Clone, Debug)]
pub struct Simulation<'a> {
    /// A sentence on what was simulated: span, solver, samples, switches.
    pub summary: &'a str,
    /// Where the samples are.
    pub path: &'a str,
    /// The figures in order.
    pub figures: Vec<Figure<'a>>,
}

/// Something hidden in a machine and found from its records.
#[derive(Clone, Debug)]
pub struct Hidden<'a> {
    /// What was hidden and what was found, in sentences.
    pub summary: &'a str,
    /// The folder of the records and results.
    pub path: &'a str,
    /// The specification with what was found.
    pub extended: &'a str,
    /// The pages of the comparison and of the search, complete HTML documents.
    pub reports: [&'a str; 2],
}

/// How long a step took.
#[derive(Clone, Debug)]
pub struct StepDuration<'a> {
    /// What was done.
    pub step: &'a str,
    /// Wall-clock time, s.
    pub seconds: f64,
}

/// A command with what it does.
#[derive(Clone, Debug)]
pub struct NextCommand<'a> {
    /// The command line.
    pub command: &'a str,
    /// What it does.
    pub does: &'a str,
}

/// A step of the walk: where it can be linked to, its heading, its content.
struct Step {
    anchor: &'static str,
    heading: &'static str,
    content: Markup,
}

impl Tour<'_> {
    /// The page, a complete HTML document.
    pub fn render(&self) -> String {
        let steps = self.steps();
        let body = html! {
            header {
                h1 { (self.title) }
                p.lead {
                    "From a Lagrangian written down once to equations of motion that run: this page "
                    "shows what happened on the way, step by step."
                }
                nav { ol {
                    @for step in &steps { li { a href={ "#" (step.anchor) } { (step.heading) } } }
                } }
            }
            main.steps {
                @for step in &steps {
                    section id=(step.anchor) {
                        h2 { (step.heading) }
                        (step.content)
                    }
                }
            }
            footer { p { "Written by " (self.generated_by) "." } }
        };
        document(self.title, &body)
    }

    fn steps(&self) -> [Step; 8] {
        let step = |anchor, heading, content| Step {
            anchor,
            heading,
            content,
        };
        [
            step(
                "specification",
                "The specification is checked",
                steps::specification(&self.specification),
            ),
            step(
                "equations",
                "The equations are derived",
                equations(self.equations),
            ),
            step("source", "Rust is emitted", steps::source(&self.source)),
            step(
                "certificate",
                "The model is validated",
                steps::certificate(&self.checks),
            ),
            step(
                "simulation",
                "The motion is simulated",
                steps::simulation(&self.simulation),
            ),
            step(
                "hidden",
                "What a model lacks is found",
                steps::hidden(&self.hidden),
            ),
            step(
                "durations",
                "What took how long",
                steps::durations(&self.durations),
            ),
            step("next", "What next", steps::next(&self.next)),
        ]
    }
}
