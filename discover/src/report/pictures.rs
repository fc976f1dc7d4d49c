//! Pictures for a page: residuals of the test record, and the residual force.

use eomgen_analysis::spectrum::{PowerSpectrum, periodogram};
use eomgen_page::{Figure, figure, table};
use eomgen_plot::{FrequencyAxis, Panel, Series, Spectrum, TimeHistory, spectrum, time_history};
use maud::{Markup, html};

use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;
use crate::residual_force::figures::figures as figures_of_force;
use crate::residual_force::types::ResidualForce;

/// How the equations compare, and what the force in one of them is like.
pub(crate) fn force_section(force: &ResidualForce, after: Option<&ResidualForce>) -> Markup {
    let percent = |part: f64| format!("{:.0} %", 100.0 * part.max(0.0));
    let rows = html! {
        @for ranking in &force.ranking {
            tr {
                td { (force.equations[ranking.equation].name) }
                td { (percent(ranking.by_state)) }
                td { (percent(ranking.by_time)) }
            }
        }
    };
    let headings = [
        "a force on",
        "explains of the squares over rate or place",
        "if free in every window",
    ];
    html! {
        (table(&headings, &rows))
        p.note {
            "A force that was put into this equation, its bars one standard deviation to either side. "
            "What records do not show is left out."
        }
        (drawn(&figures_of_force(force, after)))
    }
}

/// A figure, if anything was drawn.
fn drawn(svg: &str) -> Markup {
    html! { @if !svg.is_empty() { (figure(Figure { svg, caption: "" })) } }
}

/// Residuals over time and their spectra, before and after.
pub(crate) fn figures(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    after: Option<&Fit>,
) -> Markup {
    let count = problem.noise.len();
    let times: Vec<f64> = problem
        .test
        .list
        .iter()
        .filter(|w| w.record == 0)
        .flat_map(|w| w.times.iter().copied())
        .collect();
    let column = |fit: &Fit, channel: usize| -> Vec<f64> {
        let windows = problem
            .test
            .list
            .iter()
            .zip(&fit.test.residuals)
            .filter(|(w, _)| w.record == 0);
        let mut values = Vec::new();
        for (window, residual) in windows {
            let own = residual
                .iter()
                .skip(channel)
                .step_by(count)
                .map(|r| r * problem.noise[channel]);
            let begin = values.len();
            values.extend(own);
            values.resize(begin + window.times.len(), f64::NAN);
        }
        values
    };
    let mut fits = vec![("before", before)];
    fits.extend(after.map(|after| ("after", after)));
    let columns: Vec<Vec<(&str, Vec<f64>)>> = (0..count)
        .map(|channel| {
            fits.iter()
                .map(|(name, fit)| (*name, column(fit, channel)))
                .collect()
        })
        .collect();
    let named: Vec<(String, String)> = problem
        .dataset
        .channels
        .iter()
        .map(|c| (c.name.clone(), c.unit.clone()))
        .collect();
    let history = TimeHistory {
        title: "Differences on the test record".to_owned(),
        panels: named
            .iter()
            .zip(&columns)
            .map(|((name, unit), series)| Panel {
                title: format!("{name}: simulated minus measured"),
                quantity: name.clone(),
                unit: unit.clone(),
                series: series
                    .iter()
                    .map(|(label, values)| Series {
                        label: (*label).to_owned(),
                        abscissa: &times,
                        values,
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    let over_time = time_history(&history).unwrap_or_default();
    let step = eomgen_records::samples::typical_step(&times);
    let spectra: Vec<Vec<(&str, PowerSpectrum)>> = columns
        .iter()
        .map(|series| {
            series
                .iter()
                .map(|(label, values)| (*label, density(values, step)))
                .collect()
        })
        .collect();
    let plot = Spectrum {
        title: "Spectra of the differences".to_owned(),
        frequency: FrequencyAxis::Logarithmic,
        panels: named
            .iter()
            .zip(&spectra)
            .map(|((name, unit), series)| Panel {
                title: format!("{name}: spectrum of the difference"),
                quantity: name.clone(),
                unit: format!("({unit})^2/Hz"),
                series: series
                    .iter()
                    .map(|(label, spectrum)| Series {
                        label: (*label).to_owned(),
                        abscissa: &spectrum.frequency,
                        values: &spectrum.density,
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    html! {
        (drawn(&over_time))
        (drawn(&spectrum(&plot).unwrap_or_default()))
    }
}

/// The power spectral density of a residual, missing samples as 0, without the one at 0 Hz; empty
/// if the record is too short for any.
fn density(values: &[f64], step: f64) -> PowerSpectrum {
    let signal = (values.iter()).map(|v| if v.is_finite() { *v } else { 0.0 });
    match periodogram(&signal.collect::<Vec<f64>>(), step) {
        Ok(mut spectrum) => {
            spectrum.frequency.remove(0);
            spectrum.density.remove(0);
            spectrum
        }
        Err(_) => PowerSpectrum::default(),
    }
}
