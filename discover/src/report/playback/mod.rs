//! Interactive figure of a page. It simulates the test record with the emitted module for changed
//! values of the found parameters and draws it over the measurement.
//!
//! `record_excerpt` selects the part of the record on the page, `reproduction_check` checks if a
//! page can simulate it, `controls` creates the sliders, `data` the input of the script.

mod controls;
mod data;
mod record_excerpt;
mod reproduction_check;

use eomgen_page::{play, quantity_symbol};
use maud::{Markup, html};
use serde_json::Value;

use crate::fit::fit_result::Fit;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::report::playback::controls::write_controls;
use crate::report::playback::record_excerpt::RecordExcerpt;
use crate::report::quantity::format_quantity;
use crate::search::search_result::AcceptedEffect;

/// Style of the interactive figure, in addition to that of all pages with computations.
const STYLE: &str = include_str!("playback.css");

/// Script files of the interactive figure.
const SCRIPT: [&str; 3] = [
    include_str!("strips.js"),
    include_str!("playback.js"),
    include_str!("panel.js"),
];

/// Interactive figure, or the reason why there is none.
#[derive(Clone, Debug)]
pub(crate) enum Playback {
    /// HTML of the figure, and the data of its script.
    Computed { body: Markup, data: String },
    /// The page cannot simulate the model, for the given reason.
    Unavailable(String),
    /// No value can be changed.
    NotNeeded,
}

impl Playback {
    /// Creates the figure for a specification with the found effects, given as text.
    pub(crate) fn build(
        problem: &EstimationProblem<'_>,
        (null, best): (&Fit, &Fit),
        accepted: &[AcceptedEffect],
        text: &str,
    ) -> Self {
        let channels = &problem.dataset.channels;
        let model = EstimationModel::derive_equations(text, &problem.path, problem.order, channels);
        let (Ok(model), false) = (model, accepted.is_empty()) else {
            return Self::NotNeeded;
        };
        if model.measured.has_rates() {
            return Self::Unavailable("accelerations are measured".to_owned());
        }
        if problem.dataset.gives_motion() {
            return Self::Unavailable("the motion is given by the records".to_owned());
        }
        if model.specification().prescribed_inputs().next().is_some() {
            return Self::Unavailable(
                "the page holds inputs between samples, and the model has a prescribed motion"
                    .to_owned(),
            );
        }
        let moving = match embed_model(&model) {
            Ok(moving) => moving,
            Err(why) => return Self::Unavailable(why),
        };
        let Some(stretch) = RecordExcerpt::from_fits(problem, null, best) else {
            return Self::Unavailable(
                "the simulation fails at the beginning of the test record".to_owned(),
            );
        };
        if let Err(why) = reproduction_check::check_reproduces_fit(problem, best, &model, &stretch)
        {
            return Self::Unavailable(why);
        }
        let controls = write_controls(problem, best, &model, accepted);
        let data = data::write_json(problem, best, &model, &stretch, moving);
        Self::Computed {
            body: write_body(problem, &stretch, &controls),
            data,
        }
    }

    /// Returns the style sheet of a page with an interactive figure.
    pub(crate) fn load_style() -> String {
        [play::STYLE, STYLE].concat()
    }

    /// Returns the script of a page with an interactive figure.
    pub(crate) fn load_script() -> String {
        play::join_scripts(&SCRIPT)
    }
}

/// Returns the data for the simulation of a model, or the reason why a page cannot simulate it.
fn embed_model(model: &EstimationModel) -> Result<Value, String> {
    let exported = model.export().map_err(|error| error.to_string())?;
    let bytes = exported.to_bytes();
    let moving = play::embed_motion(&bytes, exported.program(), exported.sided_program());
    moving.map_err(|why| why.to_string())
}

fn write_body(
    problem: &EstimationProblem<'_>,
    stretch: &RecordExcerpt,
    controls: &Markup,
) -> Markup {
    let seconds = stretch.times.last().zip(stretch.times.first());
    let seconds = seconds.map_or(0.0, |(last, first)| last - first);
    let channels = problem.dataset.channels.iter();
    let rows = channels.zip(&stretch.rms_before_after);
    html! {
        p.scripted {
            "Move a slider: the extended model is simulated again for "
            @if stretch.is_complete { "the test record" }
            @else { "the beginning of the test record, " (format!("{seconds:.3}")) " s," }
            " with the recorded inputs and the fitted initial state of each window. "
            "This page computes it with the equations of the extended specification."
        }
        noscript {
            p {
                "Without JavaScript the sliders do not act. They and the table show the found values; the figures \
                 below show the motion."
            }
        }
        div.moved {
            (controls)
            table {
                thead { tr {
                    th scope="col" { "RMS residual of" }
                    th scope="col" { span.key.before {} "before" }
                    th scope="col" { span.key.now {} "now" }
                } }
                tbody {
                    @for (channel, [before, after]) in rows {
                        tr {
                            th scope="row" { (quantity_symbol(&channel.name)) }
                            td.number data-left="before" { (format_quantity(*before, 3, &channel.unit)) }
                            td.number data-left="now" { (format_quantity(*after, 3, &channel.unit)) }
                        }
                    }
                }
            }
        }
        p #status.scripted role="status" {}
        canvas #strips.scripted role="img" aria-label="Measured and simulated over time, and their differences" {}
        p.note.scripted { span.key.measured {} "measured, with the simulations; below, the differences" }
    }
}
