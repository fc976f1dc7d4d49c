//! Figures of a page: residuals of the test record and the residual force.

use eomgen_analysis::spectrum::PowerSpectrum;
use eomgen_page::{Figure, figure, table};
use eomgen_plot::{FrequencyAxis, Panel, Series, Spectrum, TimeHistory, spectrum, time_history};
use eomgen_records::windows::Window;
use maud::{Markup, html};

use crate::fit::fit_result::Fit;
use crate::fit::residual_spectrum::compute_residual_spectrum;
use crate::fit::residuals::channel_residuals;
use crate::model::problem::EstimationProblem;
use crate::residual_force::figures::draw_profiles as figures_of_force;
use crate::residual_force::types::ResidualForce;

/// Draws the comparison of the equations and the profiles of the residual force.
pub(crate) fn draw_force_section(force: &ResidualForce, after: Option<&ResidualForce>) -> Markup {
    let percent = |part: f64| format!("{:.0} %", 100.0 * part.max(0.0));
    let rows = html! {
        @for ranking in &force.ranking {
            tr {
                td { (force.equations[ranking.equation].name) }
                td { (percent(ranking.fraction_by_state)) }
                td { (percent(ranking.fraction_by_time)) }
            }
        }
    };
    let headings = [
        "a force on",
        "explained fraction of the squares, over rate or position",
        "explained fraction, free in each window",
    ];
    html! {
        (table(&headings, &rows))
        p.note {
            "Force in this equation, with error bars of one standard deviation. "
            "Parts that the records do not show are omitted."
        }
        (drawn(&figures_of_force(force, after)))
    }
}

/// A figure, if anything was drawn.
fn drawn(svg: &str) -> Markup {
    html! { @if !svg.is_empty() { (figure(Figure { svg, caption: "" })) } }
}

/// Draws residuals over time and their spectra, before and after the search.
pub(crate) fn draw_residuals(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    after: Option<&Fit>,
) -> Markup {
    let count = problem.noise.len();
    let times: Vec<f64> = problem
        .test
        .windows
        .iter()
        .filter(|w| w.record == 0)
        .flat_map(|w| w.times.iter().copied())
        .collect();
    let column = |fit: &Fit, channel: usize| -> Vec<f64> {
        let windows = windows_of_first_record(problem, fit);
        let columns =
            windows.map(|(window, residual)| channel_residuals(window, residual, (channel, count)));
        columns
            .flatten()
            .map(|r| r * problem.noise[channel])
            .collect()
    };
    let mut fits: Vec<(&'static str, &Fit)> = vec![("before", before)];
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
        title: "Residuals of the test record".to_owned(),
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
                        ..Series::default()
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    let over_time = time_history(&history).unwrap_or_default();
    let spectra: Vec<Vec<(&str, PowerSpectrum)>> = (0..count)
        .map(|channel| {
            let of = |(name, fit): &(&'static str, &Fit)| (*name, density(problem, fit, channel));
            fits.iter().map(of).collect()
        })
        .collect();
    let plot = Spectrum {
        title: "Spectra of the residuals".to_owned(),
        frequency: FrequencyAxis::Logarithmic,
        panels: named
            .iter()
            .zip(&spectra)
            .map(|((name, unit), series)| Panel {
                title: format!("{name}: spectrum of the residual"),
                quantity: name.clone(),
                unit: format!("({unit})^2/Hz"),
                series: series
                    .iter()
                    .map(|(label, spectrum)| Series {
                        label: (*label).to_owned(),
                        abscissa: &spectrum.frequency,
                        values: &spectrum.density,
                        ..Series::default()
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

/// The windows of the first test record, with their residuals.
fn windows_of_first_record<'a>(
    problem: &'a EstimationProblem<'_>,
    fit: &'a Fit,
) -> impl Iterator<Item = (&'a Window, &'a [f64])> {
    let windows = problem.test.windows.iter().zip(&fit.test.window_residuals);
    let first = windows.filter(|(window, _)| window.record == 0);
    first.map(|(window, residual)| (window, residual.as_slice()))
}

/// The spectrum of a channel's residuals in windows of the first test record, SI, without the density at
/// 0 Hz; empty if windows are too short.
fn density(problem: &EstimationProblem<'_>, fit: &Fit, channel: usize) -> PowerSpectrum {
    let windows: Vec<_> = windows_of_first_record(problem, fit).collect();
    let Some((mut spectrum, _)) = compute_residual_spectrum(&windows, channel, problem.noise.len())
    else {
        return PowerSpectrum::default();
    };
    spectrum.frequency.remove(0);
    spectrum.density.remove(0);
    let square = problem.noise[channel].powi(2);
    spectrum
        .density
        .iter_mut()
        .for_each(|density| *density *= square);
    spectrum
}
