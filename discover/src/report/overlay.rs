//! Figures of measured and simulated motion: one for the first held-out record, one for the part of
//! the training records with the largest residuals of the original model.

use eomgen_plot::{Panel, Series, SeriesRole, TimeHistory, time_history_at};
use eomgen_records::windows::{MAX_DELAY_SAMPLES, MAX_LEAD_SAMPLES, Window, Windows};
use maud::{Markup, html};

use crate::fit::fit_result::Fit;
use crate::fit::residuals::{Residuals, channel_residuals};
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::report::location::describe_record;
use crate::report::location::find_worst_window;
use crate::report::pictures::{responsive_figure, stage_label};

/// Maximum length of the enlarged figure, as a fraction of the record.
const ENLARGED_FRACTION: f64 = 0.1;

/// Minimum number of samples in the enlarged figure.
const MIN_ENLARGED_SAMPLES: usize = 40;

/// Draws both figures for the original model and, if effects were found, for the extended model.
pub(crate) fn draw_overlays(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    after: Option<&Fit>,
) -> Markup {
    let test = list_residuals(before, after, |fit| &fit.test);
    let seen = RecordColumns::from_records(problem, (&problem.test, 0), &test);
    let caption = format!(
        "The {}, which was not used in the fit. {}",
        describe_record(&problem.test.records[0]),
        explain_windows(problem)
    );
    let whole = seen.draw(0..seen.times.len(), &caption);
    let train = list_residuals(before, after, |fit| &fit.train);
    // The figure shows the window that is named in the text about the location of the difference.
    let worst = find_worst_window(problem, before).unwrap_or(WindowId::new(0));
    let record = problem.train.windows[worst].record;
    let trained = RecordColumns::from_records(problem, (&problem.train, record), &train);
    let stretch = trained.choose_samples(&problem.train, &problem.train.windows[worst]);
    let caption = format!(
        "The {}, which was used in the fit.",
        describe_record(&problem.train.records[record])
    );
    html! {
        (whole)
        @if !stretch.is_empty() {
            h3 { (match after { Some(_) => "Largest residual of the original model", None => "Largest residual" }) }
            (trained.draw(stretch, &caption))
        }
    }
}

/// Explains why simulated curves have gaps and do not start at the first measured sample.
fn explain_windows(problem: &EstimationProblem<'_>) -> String {
    match (problem.dataset.window, problem.estimates_initial_states()) {
        (Some(_), true) => {
            format!(
                "The record is divided into windows. Each simulation starts from a state that is fitted to the whole \
                 window, so it need not start on the measurement. The first {MAX_DELAY_SAMPLES} and the last \
                 {MAX_LEAD_SAMPLES} samples of a window allow for delays of sensors and are not compared."
            )
        }
        (Some(_), false) => {
            "The record is divided into windows, which are simulated separately.".to_owned()
        }
        (None, _) => "The simulation starts at the beginning of the record.".to_owned(),
    }
}

/// Returns the residuals of the original and the extended model on one set of records.
fn list_residuals<'f>(
    before: &'f Fit,
    after: Option<&'f Fit>,
    of: fn(&Fit) -> &Residuals,
) -> Vec<(SeriesRole, &'f Residuals)> {
    let after = after.map(|after| (SeriesRole::After, of(after)));
    let before = (SeriesRole::Before, of(before));
    std::iter::once(before).chain(after).collect()
}

/// Measured and simulated columns of one record.
struct RecordColumns {
    times: Vec<f64>,
    channels: Vec<Channel>,
}

/// Columns of one channel; missing samples are NaN.
struct Channel {
    name: String,
    unit: String,
    noise: f64,
    measured: Vec<f64>,
    /// Simulated columns with the role of their model.
    simulated: Vec<(SeriesRole, Vec<f64>)>,
}

impl RecordColumns {
    /// Returns the columns of a record, simulated with each model.
    fn from_records(
        problem: &EstimationProblem<'_>,
        (set, record): (&Windows<'_>, usize),
        fits: &[(SeriesRole, &Residuals)],
    ) -> Self {
        let windows = || {
            let all = set.windows.iter().enumerate();
            all.filter(|(_, window)| window.record == record)
        };
        let count = problem.noise.len();
        let channels = problem.dataset.channels.iter().zip(&problem.noise);
        let channels = channels.enumerate().map(|(index, (channel, noise))| {
            let measured = |window: &Window| extract_column(&window.measured, index, count);
            let simulated = |fit: &Residuals| -> Vec<f64> {
                let of = |(at, window): (usize, &Window)| {
                    let residuals =
                        channel_residuals(window, &fit.window_residuals[at], (index, count));
                    let pairs = measured(window).into_iter().zip(residuals);
                    pairs
                        .map(|(measured, residual)| measured + noise * residual)
                        .collect::<Vec<f64>>()
                };
                windows().flat_map(of).collect()
            };
            Channel {
                name: channel.name.clone(),
                unit: channel.unit.clone(),
                noise: *noise,
                measured: windows().flat_map(|(_, w)| measured(w)).collect(),
                simulated: fits
                    .iter()
                    .map(|(name, fit)| (*name, simulated(fit)))
                    .collect(),
            }
        });
        Self {
            times: windows()
                .flat_map(|(_, window)| set.file_times(window))
                .collect(),
            channels: channels.collect(),
        }
    }

    /// Returns the samples of a window to be drawn. In a long window, they are centred at the
    /// largest difference of the original model, relative to the noise.
    fn choose_samples(&self, set: &Windows<'_>, window: &Window) -> std::ops::Range<usize> {
        let samples = self.times.len();
        let begin = set.file_times(window).next().unwrap_or_default();
        let first = self.times.partition_point(|t| *t < begin);
        let inside = first..(first + window.times.len()).min(samples);
        let most = ((ENLARGED_FRACTION * samples as f64) as usize)
            .max(MIN_ENLARGED_SAMPLES)
            .min(samples);
        let length = inside.len().clamp(MIN_ENLARGED_SAMPLES.min(samples), most);
        let squared_difference = |sample: usize| {
            let of = |channel: &Channel| {
                let difference = channel.simulated[0].1[sample] - channel.measured[sample];
                (difference / channel.noise).powi(2)
            };
            let squares = self.channels.iter().map(of);
            squares.filter(|square| square.is_finite()).sum::<f64>()
        };
        let middle = match inside.len() > length {
            true => inside
                .clone()
                .max_by(|a, b| squared_difference(*a).total_cmp(&squared_difference(*b)))
                .unwrap_or(first),
            false => first + inside.len() / 2,
        };
        let begin = middle.saturating_sub(length / 2).min(samples - length);
        begin..begin + length
    }

    /// Draws a panel for each channel. The measured curve is below the simulated curves.
    fn draw(&self, samples: std::ops::Range<usize>, caption: &str) -> Markup {
        let times = &self.times[samples.clone()];
        let panel = |channel: &'_ Channel| {
            let measured = (
                SeriesRole::Measured,
                channel.measured[samples.clone()].to_vec(),
            );
            let simulated = channel.simulated.iter();
            let simulated =
                simulated.map(|(role, values)| (*role, values[samples.clone()].to_vec()));
            std::iter::once(measured).chain(simulated).collect()
        };
        let columns: Vec<Vec<(SeriesRole, Vec<f64>)>> = self.channels.iter().map(panel).collect();
        let has_after = self
            .channels
            .iter()
            .any(|channel| channel.simulated.len() > 1);
        let label = |role: SeriesRole| match role {
            SeriesRole::Measured => "measured".to_owned(),
            role => stage_label("simulated", role, has_after),
        };
        let panels = self.channels.iter().zip(&columns);
        let history = TimeHistory {
            title: format!("Measured and simulated. {caption}"),
            panels: panels
                .map(|(channel, columns)| Panel {
                    title: format!("{}: measured and simulated", channel.name),
                    quantity: channel.name.clone(),
                    unit: channel.unit.clone(),
                    series: columns
                        .iter()
                        .map(|(role, values)| Series {
                            label: label(*role),
                            abscissa: times,
                            values,
                            role: *role,
                        })
                        .collect(),
                    references: Vec::new(),
                })
                .collect(),
        };
        responsive_figure(caption, |width| time_history_at(&history, width))
    }
}

/// Returns one channel of samples stored in rows.
fn extract_column(rows: &[f64], channel: usize, channels: usize) -> Vec<f64> {
    rows.iter()
        .skip(channel)
        .step_by(channels)
        .copied()
        .collect()
}
