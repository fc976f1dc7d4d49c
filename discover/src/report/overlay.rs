//! What was measured and what is simulated, over each other, on the first held-out record: the whole
//! of it, and the stretch where the model as it was is furthest off.

use eomgen_page::{Figure, figure};
use eomgen_plot::{Panel, Series, TimeHistory, time_history};
use eomgen_records::windows::{Window, judged};
use maud::{Markup, html};

use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;

/// The part of a record that is drawn once more, larger.
const STRETCH: f64 = 0.1;

/// The fewest samples of that part.
const FEWEST: usize = 40;

/// Both figures, of the model as it was and, where something was found, with that.
pub(crate) fn overlay(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    after: Option<&Fit>,
) -> Markup {
    let seen = Seen::of(problem, before, after);
    let stretch = seen.stretch();
    let whole = seen.drawn(
        0..seen.times.len(),
        "Measured and simulated on the test record",
    );
    html! {
        (whole)
        @if stretch.len() < seen.times.len() && !stretch.is_empty() {
            h3 { "Where the model as it was is furthest off" }
            (seen.drawn(stretch, "Measured and simulated where the model as it was is furthest off"))
        }
    }
}

/// The columns of one record, sample by sample.
struct Seen {
    times: Vec<f64>,
    channels: Vec<Channel>,
}

/// The columns of one channel, with missing samples as NaN.
struct Channel {
    name: String,
    unit: String,
    noise: f64,
    measured: Vec<f64>,
    /// By the name of the model.
    simulated: Vec<(&'static str, Vec<f64>)>,
}

impl Seen {
    fn of(problem: &EstimationProblem<'_>, before: &Fit, after: Option<&Fit>) -> Self {
        let windows = || {
            let all = problem.test.list.iter().enumerate();
            all.filter(|(_, window)| window.record == 0)
        };
        let count = problem.noise.len();
        let mut fits = vec![("before", before)];
        fits.extend(after.map(|after| ("after", after)));
        let channels = problem.dataset.channels.iter().zip(&problem.noise);
        let channels = channels.enumerate().map(|(place, (channel, noise))| {
            let measured = |window: &Window| column(&window.measured, place, count);
            let simulated = |fit: &Fit| -> Vec<f64> {
                let of = |(at, window): (usize, &Window)| {
                    simulated(window, &fit.test.residuals[at], (place, count, *noise))
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
                .flat_map(|(_, window)| window.times.iter().copied())
                .collect(),
            channels: channels.collect(),
        }
    }

    /// The samples around the largest difference of the first model, in noises.
    fn stretch(&self) -> std::ops::Range<usize> {
        let samples = self.times.len();
        let length = ((STRETCH * samples as f64) as usize)
            .max(FEWEST)
            .min(samples);
        let off = |sample: usize| {
            let of = |channel: &Channel| {
                let difference = channel.simulated[0].1[sample] - channel.measured[sample];
                (difference / channel.noise).powi(2)
            };
            let squares = self.channels.iter().map(of);
            squares.filter(|square| square.is_finite()).sum::<f64>()
        };
        let worst = (0..samples).max_by(|a, b| off(*a).total_cmp(&off(*b)));
        let first = worst.unwrap_or(0).saturating_sub(length / 2);
        let first = first.min(samples - length);
        first..first + length
    }

    /// A panel for each channel.
    fn drawn(&self, samples: std::ops::Range<usize>, title: &str) -> Markup {
        let times = &self.times[samples.clone()];
        let panel = |channel: &'_ Channel| {
            let series = |label: &str, values: &'_ [f64]| (label.to_owned(), values.to_vec());
            let mut all = Vec::new();
            for (name, values) in &channel.simulated {
                let label = format!("simulated {name}");
                all.push(series(&label, &values[samples.clone()]));
            }
            all.push(series("measured", &channel.measured[samples.clone()]));
            all
        };
        let columns: Vec<Vec<(String, Vec<f64>)>> = self.channels.iter().map(panel).collect();
        let panels = self.channels.iter().zip(&columns);
        let history = TimeHistory {
            title: title.to_owned(),
            panels: panels
                .map(|(channel, columns)| Panel {
                    title: format!("{}: measured and simulated", channel.name),
                    quantity: channel.name.clone(),
                    unit: channel.unit.clone(),
                    series: columns
                        .iter()
                        .map(|(label, values)| Series {
                            label: label.clone(),
                            abscissa: times,
                            values,
                        })
                        .collect(),
                    references: Vec::new(),
                })
                .collect(),
        };
        let svg = time_history(&history).unwrap_or_default();
        html! { @if !svg.is_empty() { (figure(Figure { svg: &svg, caption: "" })) } }
    }
}

/// One channel of rows.
fn column(rows: &[f64], channel: usize, channels: usize) -> Vec<f64> {
    rows.iter()
        .skip(channel)
        .step_by(channels)
        .copied()
        .collect()
}

/// What is simulated of a channel in a window: measured and residual together. Nothing where they
/// are not compared, or the motion cannot be followed.
fn simulated(
    window: &Window,
    residual: &[f64],
    (channel, channels, noise): (usize, usize, f64),
) -> Vec<f64> {
    let samples = window.times.len();
    let inside = judged(samples);
    let value = |sample: usize| {
        let number = sample * channels + channel;
        let residual = residual.get(number).filter(|_| inside.contains(&sample));
        residual.map_or(f64::NAN, |residual| {
            window.measured[number] + noise * residual
        })
    };
    (0..samples).map(value).collect()
}
