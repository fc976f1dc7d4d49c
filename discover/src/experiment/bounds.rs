//! Bounds of an experiment, from the dataset file or else from the recorded motion.

use eomgen_analysis::spectrum::periodogram;
use eomgen_records::samples::{MIN_SAMPLES, typical_step};

use crate::ids::ChannelId;
use crate::interval::Interval;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::ExpectedSensor;
use crate::thresholds;

/// Bounds of an experiment, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Duration, s.
    pub duration: f64,
    /// Time between the samples of the prediction, s.
    pub sample_time: f64,
    /// Number of samples for which each input value is held, because the recorded inputs have a
    /// longer sample time.
    pub samples_per_value: usize,
    /// Bounds of the inputs that have columns in the records and are not fixed.
    pub inputs: Vec<InputBounds>,
    /// Admissible range of each channel.
    pub channels: Vec<Interval>,
    /// Origin of the bounds in words.
    pub sources: String,
}

/// Bounds of one input, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct InputBounds {
    /// Index among the inputs of the model.
    pub index: usize,
    /// Name.
    pub name: String,
    /// Range of the values.
    pub range: Interval,
    /// Maximum rate of change, per s.
    pub rate: f64,
    /// Frequency band of periodic inputs, Hz.
    pub band: Interval,
}

impl Bounds {
    /// Computes the bounds from a dataset. `inputs`: names of the inputs of the model; `sensors`:
    /// expected sensor of each channel.
    pub fn from_dataset(
        problem: &EstimationProblem<'_>,
        inputs: &[String],
        sensors: &[ExpectedSensor],
    ) -> Self {
        let dataset = problem.dataset;
        let said = &dataset.experiment;
        let recorded_step = typical_step(&dataset.train[0].times);
        let played = said.sample.unwrap_or(recorded_step);
        let hold = (played / recorded_step).round().max(1.0);
        let sample = played / hold;
        let lasting = dataset.train.iter().map(|record| {
            let times = &record.times;
            times[times.len() - 1] - times[0]
        });
        let longest = lasting.fold(0.0, f64::max);
        let duration = said
            .duration
            .unwrap_or_else(|| longest.min(thresholds::MAX_EXPERIMENT_SAMPLES * sample));
        let mut from_records: Vec<String> = Vec::new();
        let mut input_bounds = Vec::new();
        for (index, name) in inputs.iter().enumerate() {
            if dataset
                .experiment_units
                .inputs
                .get(index)
                .is_none_or(Option::is_none)
            {
                continue;
            }
            let of = said.inputs.get(index).copied().unwrap_or_default();
            let (recorded, fastest) = find_input_range(problem, index);
            if of.range.is_none() {
                from_records.push(format!("the range of {name}"));
            }
            if of.band.is_none() {
                from_records.push(format!("the band of {name}"));
            }
            let range = of
                .range
                .map_or(recorded, |(low, high)| Interval::new(low, high));
            let slowest = 1.0 / duration;
            let nyquist = 0.5 / played;
            let band = of
                .band
                .map_or(Interval::new(slowest, fastest), |(low, high)| {
                    Interval::new(low, high)
                });
            let low = band.low.clamp(slowest, nyquist);
            let band = Interval::new(low, band.high.clamp(low, nyquist));
            let steepest = std::f64::consts::PI * band.high * (range.high - range.low);
            if range.low < range.high {
                input_bounds.push(InputBounds {
                    index,
                    name: name.clone(),
                    range,
                    rate: of.rate.unwrap_or(steepest),
                    band,
                });
            }
        }
        let channels = ChannelId::first(dataset.channels.len()).zip(&dataset.channels);
        let channels = channels.map(|(id, channel)| {
            let said = said.limits.get(id.index()).copied().flatten();
            said.map_or_else(
                || {
                    from_records.push(format!("the limits of {}", channel.name));
                    find_channel_range(problem, id, &sensors[id.index()])
                },
                |(low, high)| Interval::new(low, high),
            )
        });
        let channels = channels.collect();
        let words = match &from_records[..] {
            [] => "All bounds are from the dataset file.".to_owned(),
            all => format!(
                "The dataset file does not contain these bounds, so they are from the records: {}.",
                all.join(", ")
            ),
        };
        Self {
            duration,
            sample_time: sample,
            samples_per_value: hold as usize,
            inputs: input_bounds,
            channels,
            sources: words,
        }
    }

    /// Returns the reason why the experiment is too short for a record, if it is shorter than half
    /// a window or has too few samples. `None` if it is long enough.
    pub fn explain_too_short(&self, window: Option<f64>) -> Option<String> {
        let least = (0.5 * window.unwrap_or(0.0)).max(MIN_SAMPLES as f64 * self.sample_time);
        (self.duration < least).then(|| {
            format!(
                "an experiment of {} s is too short for a record, which needs {least:.3} s; expected a longer \
                 [experiment] duration",
                self.duration
            )
        })
    }

    /// Returns the sample times, s.
    pub fn sample_times(&self) -> Vec<f64> {
        let count = (self.duration / self.sample_time).round() as usize + 1;
        (0..count).map(|k| self.sample_time * k as f64).collect()
    }
}

/// Returns the range of an input over all records, extended to 0, and the frequency below which
/// nearly all of its power lies.
fn find_input_range(problem: &EstimationProblem<'_>, index: usize) -> (Interval, f64) {
    let records = || problem.dataset.train.iter().chain(&problem.dataset.test);
    let mut range = Interval::ZERO;
    let mut fastest: f64 = 0.0;
    for record in records() {
        let column: Vec<f64> = record.input_columns[index]
            .iter()
            .copied()
            .filter(|value| value.is_finite())
            .collect();
        for value in &column {
            range = Interval::new(range.low.min(*value), range.high.max(*value));
        }
        let times = &record.times;
        let slowest = 4.0 / (times[times.len() - 1] - times[0]);
        let mean = column.iter().sum::<f64>() / column.len().max(1) as f64;
        let swinging: Vec<f64> = column.iter().map(|value| value - mean).collect();
        let own = periodogram(&swinging, typical_step(times)).map_or(0.0, |spectrum| {
            let whole: f64 = spectrum.density.iter().sum();
            let mut sum = 0.0;
            let bins = spectrum.frequency.iter().zip(&spectrum.density);
            let below = bins.take_while(|(_, density)| {
                sum += *density;
                sum < thresholds::RECORDED_POWER_FRACTION * whole
            });
            below.last().map_or(0.0, |(frequency, _)| *frequency)
        });
        fastest = fastest.max(own).max(slowest);
    }
    (range, fastest)
}

/// Returns the range of the quantity of a channel over all records, with a margin.
fn find_channel_range(
    problem: &EstimationProblem<'_>,
    channel: ChannelId,
    sensor: &ExpectedSensor,
) -> Interval {
    let records = problem.dataset.train.iter().chain(&problem.dataset.test);
    let values = records.flat_map(|record| record.channels[channel].iter());
    let values = values.filter(|value| value.is_finite());
    let quantities = values.map(|value| sensor.quantity(*value));
    let both = quantities.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let margin = thresholds::LIMIT_MARGIN_FRACTION * (both.1 - both.0);
    Interval::new(both.0 - margin, both.1 + margin)
}
