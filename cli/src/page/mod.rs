//! HTML pages. `play` renders the interactive page of a model. [`Tour`] renders the page of the tour: the moving arm,
//! specification, equations, emitted source, certificate, simulation and discovery.
//!
//! The page of the tour is self-contained. The reports are in separate frames, because each has a script. Text
//! of a specification is escaped.

mod play;
mod steps;

#[cfg(test)]
mod tests;

pub use play::{InteractivePart, interactive_page};

use eomgen_codegen::report::Report;
use eomgen_page::{Figure, equations, prose};
use maud::{Markup, html};

/// Content of the tour's page.
pub struct Tour<'a> {
    /// Title of the model.
    pub title: &'a str,
    /// Result of the discovery in one sentence.
    pub found: &'a str,
    /// Interactive drawing of the arm.
    pub arm: &'a InteractivePart,
    /// Name and version of the program.
    pub generated_by: &'a str,
    pub specification: Specification<'a>,
    /// Symbols of the equations.
    pub symbols: Vec<SymbolRow>,
    /// Definitions of piecewise functions in the equations.
    pub functions: Vec<FunctionNote>,
    pub equations: &'a Report,
    pub source: Source<'a>,
    pub checks: Vec<CheckRow>,
    pub simulation: Simulation<'a>,
    pub hidden: Hidden<'a>,
    /// Durations of the steps, in order.
    pub durations: Vec<StepDuration<'a>>,
    /// Suggested commands.
    pub next: Vec<NextCommand<'a>>,
}

#[derive(Clone, Debug)]
pub struct Specification<'a> {
    /// Path of the file.
    pub path: &'a str,
    /// Sentence about the source of equation numbers.
    pub reference: &'a str,
    pub text: &'a str,
    /// Rendered diagnostics, without colours.
    pub warnings: Vec<&'a str>,
}

#[derive(Clone, Debug)]
pub struct Source<'a> {
    /// Path of the file.
    pub path: &'a str,
    pub text: &'a str,
}

/// Symbol of the equations.
#[derive(Clone, Debug)]
pub struct SymbolRow {
    /// ASCII name.
    pub name: String,
    pub meaning: String,
    /// Value in the unit; `None` for quantities that vary.
    pub value: Option<f64>,
    pub unit: String,
}

/// Definition of a function.
#[derive(Clone, Debug)]
pub struct FunctionNote {
    /// Function with its arguments.
    pub call: String,
    pub definition: &'static str,
}

/// Check of the certificate.
#[derive(Clone, Debug)]
pub struct CheckRow {
    /// Statement that the check confirms.
    pub sentence: String,
    /// Largest deviation, if any.
    pub value: Option<f64>,
    pub tolerance: f64,
    pub passed: bool,
    pub skipped: bool,
    /// Location of the deviation of a failed check, or the reason for skipping a check; empty for a passed check.
    pub detail: String,
}

#[derive(Clone, Debug)]
pub struct Simulation<'a> {
    /// Sentence about time span, solver, samples and switches.
    pub summary: &'a str,
    /// Path of the trajectory file.
    pub path: &'a str,
    pub figures: Vec<Figure<'a>>,
}

/// Discovery of a hidden effect.
#[derive(Clone, Debug)]
pub struct Hidden<'a> {
    /// Names and values of facts about the hidden effect and the result.
    pub facts: Vec<(&'a str, String)>,
    /// Folder of the records and results.
    pub path: &'a str,
    /// Extended specification.
    pub extended: &'a str,
    /// Reports of comparison and discovery, complete HTML documents.
    pub reports: [&'a str; 2],
}

#[derive(Clone, Debug)]
pub struct StepDuration<'a> {
    pub step: &'a str,
    /// Wall-clock time, s.
    pub seconds: f64,
}

/// Suggested command.
#[derive(Clone, Debug)]
pub struct NextCommand<'a> {
    pub command: String,
    pub purpose: &'a str,
}

/// Section of the page.
struct Step {
    anchor: &'static str,
    heading: &'static str,
    content: Markup,
}

impl Tour<'_> {
    /// Renders a complete HTML document.
    pub fn render(&self) -> String {
        let steps = self.steps();
        let body = html! {
            header {
                h1 { (self.title) }
                p.lead {
                    "From the Lagrangian in one file to a running simulation, and from records to the missing term. "
                    strong { (prose(self.found)) }
                }
                (self.arm.body)
                p.note.scripted {
                    "The arm on its reducer, computed on this page with the derived equations. The deflection of the arm "
                    "is drawn enlarged; the short lines are a tooth of the sun and of a planet."
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
        self.arm.document(self.title, &body)
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
                "Checked specification",
                steps::specification(&self.specification),
            ),
            step(
                "equations",
                "Derived equations",
                html! {
                    (steps::symbols(&self.symbols, &self.functions))
                    (equations(self.equations))
                },
            ),
            step("source", "Emitted Rust", steps::source(&self.source)),
            step(
                "certificate",
                "Validation",
                steps::certificate(&self.checks),
            ),
            step(
                "simulation",
                "Simulation",
                steps::simulation(&self.simulation),
            ),
            step(
                "hidden",
                "Discovery of a missing effect",
                steps::hidden(&self.hidden),
            ),
            step("durations", "Durations", steps::durations(&self.durations)),
            step("next", "Next commands", steps::next(&self.next)),
        ]
    }
}
