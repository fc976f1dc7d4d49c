//! Figures of a page: residuals of the test record and the residual force.

use eomgen_analysis::spectrum::PowerSpectrum;
use eomgen_page::{Figure, figure, quantity_symbol, table};
use eomgen_plot::{
    FigureWidth, FrequencyAxis, Panel, PlotError, Series, SeriesRole, Spectrum, TimeHistory,
    scaled_unit, spectrum_at, time_history_at,
};
use eomgen_records::windows::Window;
use maud::{Markup, html};

use crate::fit::fit_result::Fit;
use crate::fit::residual_spectrum::compute_residual_spectrum;
use crate::fit::residuals::channel_residuals;
use crate::model::problem::EstimationProblem;
use crate::report::location::describe_record;
use crate::residual_force::figures::draw_profiles as figures_of_force;
use crate::residual_force::types::ResidualForce;

/// Draws the comparison of the equations and the profiles of the residual force.
pub(crate) fn draw_force_section(force: &ResidualForce, after: Option<&ResidualForce>) -> Markup {
    let percent = |part: f64| format!("{:.0} %", 100.0 * part.max(0.0));
    let rows = html! {
        @for ranking in &force.ranking {
            tr {
                td { (quantity_symbol(&force.equations[ranking.equation].name)) }
                td { (percent(ranking.fraction_by_state)) }
                td { (percent(ranking.fraction_by_time)) }
            }
        }
    };
    let headings = [
        "force on",
        "explained fraction, by a force that depends on speed or position",
        "explained fraction, by a force that depends on time",
    ];
    html! {
        p { "A force in one of these equations explains this fraction of the squared residual:" }
        (table(&headings, &rows))
        h3 { "Missing force on " (quantity_symbol(force.profiled_equation_name())) }
        p.note {
            "Force in this equation, with error bars of one standard deviation"
            @if after.is_some() { ", before and after the found effects are added" }
            ". A line connects the values along a rate, a time or a frequency; crosses are "
            "single values. "
            "Values with a standard deviation above half of the largest force are omitted."
            @if after.is_some() {
                " A picture is marked as \"before only\" if this applies to all values after the search."
            }
        }
        (responsive_figure("Estimated from all training records together.", |width| {
            Ok(figures_of_force(force, after, width))
        }))
    }
}

/// Returns a figure for wide and narrow windows with its caption; empty if it cannot be drawn.
pub(crate) fn responsive_figure(
    caption: &str,
    draw: impl Fn(FigureWidth) -> Result<String, PlotError>,
) -> Markup {
    let [svg, narrow] =
        [FigureWidth::Wide, FigureWidth::Narrow].map(|width| draw(width).unwrap_or_default());
    let drawn = Figure {
        svg: &svg,
        narrow: &narrow,
        caption,
    };
    html! { @if !svg.is_empty() { (figure(drawn)) } }
}

/// Returns the label of a simulation, followed by its stage if there are two.
pub(crate) fn stage_label(name: &str, role: SeriesRole, has_after: bool) -> String {
    match (role, has_after) {
        (SeriesRole::Before, true) => format!("{name} before"),
        (SeriesRole::After, true) => format!("{name} after"),
        _ => name.to_owned(),
    }
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
        .flat_map(|w| problem.test.file_times(w))
        .collect();
    let column = |fit: &Fit, channel: usize| -> Vec<f64> {
        let windows = list_windows_of_first_record(problem, fit);
        let columns =
            windows.map(|(window, residual)| channel_residuals(window, residual, (channel, count)));
        columns
            .flatten()
            .map(|r| r * problem.noise[channel])
            .collect()
    };
    let mut fits: Vec<(SeriesRole, &Fit)> = vec![(SeriesRole::Before, before)];
    fits.extend(after.map(|after| (SeriesRole::After, after)));
    let columns: Vec<Vec<(SeriesRole, Vec<f64>)>> = (0..count)
        .map(|channel| {
            fits.iter()
                .map(|(role, fit)| (*role, column(fit, channel)))
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
                    .map(|(role, values)| Series {
                        label: stage_label("residual", *role, after.is_some()),
                        abscissa: &times,
                        values,
                        role: *role,
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    let units: Vec<(f64, String)> = named
        .iter()
        .zip(&columns)
        .map(|((_, unit), series)| {
            let values = series.iter().flat_map(|(_, values)| values);
            let finite = values.filter(|value| value.is_finite());
            scaled_unit(
                unit,
                finite.fold(0.0, |most: f64, value| most.max(value.abs())),
            )
        })
        .collect();
    let spectra: Vec<Vec<(SeriesRole, PowerSpectrum)>> = units
        .iter()
        .enumerate()
        .map(|(channel, (scale, _))| {
            let of = |(role, fit): &(SeriesRole, &Fit)| {
                (*role, compute_density(problem, fit, (channel, *scale)))
            };
            fits.iter().map(of).collect()
        })
        .collect();
    let plot = Spectrum {
        title: "Spectra of the residuals".to_owned(),
        frequency: FrequencyAxis::Logarithmic,
        panels: named
            .iter()
            .zip(&units)
            .zip(&spectra)
            .map(|(((name, _), (_, unit)), series)| Panel {
                title: format!("{name}: power spectral density of the residual"),
                quantity: "density".to_owned(),
                unit: format_density_unit(unit),
                series: series
                    .iter()
                    .map(|(role, spectrum)| Series {
                        label: stage_label("residual", *role, after.is_some()),
                        abscissa: &spectrum.frequency,
                        values: &spectrum.density,
                        role: *role,
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    let record = describe_record(&problem.test.records[0]);
    let over_time = format!(
        "Residuals of the compared samples of the {record}. Between the windows nothing is compared."
    );
    let spectra = format!("Mean spectrum of the residuals in the windows of the {record}.");
    html! {
        (responsive_figure(&over_time, |width| time_history_at(&history, width)))
        (responsive_figure(&spectra, |width| spectrum_at(&plot, width)))
    }
}

/// Returns the unit of the spectral density of a quantity with the given unit.
fn format_density_unit(unit: &str) -> String {
    match unit {
        "" => "1/Hz".to_owned(),
        unit if unit.chars().all(char::is_alphabetic) => format!("{unit}²/Hz"),
        unit => format!("({unit})²/Hz"),
    }
}

/// Returns the windows of the first test record with their residuals.
fn list_windows_of_first_record<'a>(
    problem: &'a EstimationProblem<'_>,
    fit: &'a Fit,
) -> impl Iterator<Item = (&'a Window, &'a [f64])> {
    let windows = problem.test.windows.iter().zip(&fit.test.window_residuals);
    let first = windows.filter(|(window, _)| window.record == 0);
    first.map(|(window, residual)| (window, residual.as_slice()))
}

/// Returns the spectrum of the residuals of a channel in the windows of the first test record, in
/// units of `scale`. It does not contain the density at 0 Hz. Empty if the windows are too short.
fn compute_density(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    (channel, scale): (usize, f64),
) -> PowerSpectrum {
    let windows: Vec<_> = list_windows_of_first_record(problem, fit).collect();
    let Some((mut spectrum, _)) = compute_residual_spectrum(&windows, channel, problem.noise.len())
    else {
        return PowerSpectrum::default();
    };
    spectrum.frequency.remove(0);
    spectrum.density.remove(0);
    let square = (problem.noise[channel] / scale).powi(2);
    spectrum
        .density
        .iter_mut()
        .for_each(|density| *density *= square);
    spectrum
}

#[cfg(test)]
mod tests {
    use super::format_density_unit;

    #[test]
    fn density_has_the_square_of_the_scaled_unit() {
        for (unit, expected) in [
            ("mm", "mm²/Hz"),
            ("µm", "µm²/Hz"),
            ("mN·m", "(mN·m)²/Hz"),
            ("rad/s", "(rad/s)²/Hz"),
            ("", "1/Hz"),
        ] {
            assert_eq!(format_density_unit(unit), expected);
        }
    }
}
