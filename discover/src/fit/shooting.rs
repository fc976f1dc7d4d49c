//! Multiple shooting (Bock 1983): residuals of the windows for given initial states and unknowns,
//! in standard deviations of the noise. Derivatives are computed in [`crate::fit::sensitivity`].

use crate::ids::{ChannelId, WindowId, WindowRange};
use rayon::prelude::*;

use crate::model::estimation_model::EstimationModel;
use crate::model::output_times::{OutputRate, OutputTimes, compute_lagrange_weight};
use crate::model::problem::EstimationProblem;
use crate::model::simulation::Simulation;
use crate::model::unknowns::{Unknown, UnknownKind, expected_input_delay};
use eomgen_records::windows::{
    MAX_DELAY_SAMPLES, MAX_LEAD_SAMPLES, Window, Windows, compared_samples,
};

/// Values of the sensor unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorValues {
    /// Gain of each channel.
    pub gain: Vec<f64>,
    /// Bias of each channel, SI.
    pub bias: Vec<f64>,
    /// Delay of each channel, s.
    pub delay: Vec<f64>,
}

/// Shooting problem: windows and the model that is fitted to them.
#[derive(Clone, Copy)]
pub struct Shooting<'a> {
    /// Fitted model.
    pub model: &'a EstimationModel,
    /// Windows.
    pub windows: &'a Windows<'a>,
    /// Noise of each channel, SI.
    pub noise: &'a [f64],
    /// Unknowns.
    pub unknowns: &'a [Unknown],
    /// Delay of the inputs if it is not an unknown, s.
    pub input_delay: f64,
    /// Range of each state, if initial states are estimated.
    pub ranges: Option<&'a [f64]>,
    /// Number of computed outputs per sample interval.
    pub output_rate: OutputRate,
    /// Compared fraction of each window, from its beginning.
    pub fraction: f64,
    /// Weight of the priors of the unknowns relative to the residuals: the squared ratio of misfit
    /// to noise, times the correlation length in samples. It prevents sensor estimates from
    /// absorbing a misfit.
    pub prior_weight: f64,
}

/// Residuals of a window.
pub struct Residual {
    /// Simulated minus measured outputs, in standard deviations: one row per sample, one number per
    /// channel; 0 for missing measurements.
    pub values: Vec<f64>,
    /// State at the end of the window.
    pub end_state: Vec<f64>,
}

impl Residual {
    /// Returns the sum of squares.
    pub fn sum_of_squares(&self) -> f64 {
        self.values.iter().map(|r| r * r).sum()
    }
}

impl<'a> Shooting<'a> {
    /// Creates the shooting problem of windows and a model.
    pub fn new(
        problem: &'a EstimationProblem<'a>,
        model: &'a EstimationModel,
        windows: &'a Windows<'a>,
        unknowns: &'a [Unknown],
        ranges: &'a [f64],
    ) -> Self {
        Self {
            model,
            windows,
            noise: &problem.noise,
            unknowns,
            input_delay: expected_input_delay(&problem.dataset.inputs, model.specification()),
            ranges: problem.estimates_initial_states().then_some(ranges),
            output_rate: problem.output_rate,
            fraction: 1.0,
            prior_weight: 1.0,
        }
    }

    /// Returns the number of channels.
    pub fn channel_count(&self) -> usize {
        self.noise.len()
    }

    /// Returns the parameters of the model for given unknowns.
    pub fn parameter_values(&self, theta: &[f64]) -> Vec<f64> {
        let mut values = self.model.values.clone();
        for (unknown, value) in self.unknowns.iter().zip(theta) {
            match &unknown.kind {
                UnknownKind::Parameter(name) => self.model.set_value(&mut values, name, *value),
                UnknownKind::InverseParameter(name) => {
                    self.model.set_value(&mut values, name, 1.0 / value)
                }
                UnknownKind::Gain(_)
                | UnknownKind::Bias(_)
                | UnknownKind::Delay(_)
                | UnknownKind::InputDelay => {}
            }
        }
        values
    }

    /// Returns the sensor values for given unknowns.
    pub fn sensor_values(&self, theta: &[f64]) -> SensorValues {
        // A sensor value that is not estimated has its expected value.
        let expected = || self.model.sensors.iter();
        let mut sensors = SensorValues {
            gain: expected().map(|sensor| sensor.gain).collect(),
            bias: expected().map(|sensor| sensor.bias).collect(),
            delay: expected().map(|sensor| sensor.delay).collect(),
        };
        let mut input_delay = self.input_delay;
        for (unknown, value) in self.unknowns.iter().zip(theta) {
            match unknown.kind {
                UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_) => {}
                UnknownKind::InputDelay => input_delay = *value,
                UnknownKind::Gain(channel) => sensors.gain[channel] = *value,
                UnknownKind::Bias(channel) => sensors.bias[channel] = *value,
                UnknownKind::Delay(channel) => sensors.delay[channel] = *value,
            }
        }
        if input_delay != 0.0 {
            // A delayed input delays all outputs, within the time range of the window.
            let times = self
                .windows
                .windows
                .first()
                .map_or(&[][..], |window| &window.times);
            let step = match times {
                [first, .., last] => (last - first) / (times.len() - 1) as f64,
                _ => 0.0,
            };
            for delay in &mut sensors.delay {
                let late = *delay + input_delay;
                *delay = late.clamp(-MAX_LEAD_SAMPLES * step, MAX_DELAY_SAMPLES * step);
            }
        }
        sensors
    }

    /// Computes the residuals of all windows for given initial states; `None` for a failed
    /// simulation.
    pub fn compute_residuals(
        &self,
        theta: &[f64],
        initial_states: &[Vec<f64>],
    ) -> Vec<Option<Residual>> {
        let (values, sensors) = (self.parameter_values(theta), self.sensor_values(theta));
        self.map_windows_in_parallel(|windows| {
            let Ok(mut simulation) = self.model.create_simulation(&values) else {
                return windows.map(|_| None).collect();
            };
            windows
                .map(|window| {
                    let start = &initial_states[window];
                    self.compute_residual(&mut simulation, &sensors, window, start)
                })
                .collect()
        })
    }

    /// Computes the residuals of one window.
    pub fn compute_residual(
        &self,
        simulation: &mut Simulation<'_>,
        sensors: &SensorValues,
        window: WindowId,
        start: &[f64],
    ) -> Option<Residual> {
        let window = &self.windows.windows[window];
        let inputs = self.windows.inputs(window);
        let times = self.output_times(window);
        let outputs = simulation
            .simulate_outputs(start, &times.times, inputs)
            .ok()?;
        let seen = self.apply_sensors(&times, sensors, &outputs.values);
        let values = self.normalise_differences(window, &seen);
        (values.iter().all(|r| r.is_finite())).then_some(Residual {
            values,
            end_state: outputs.end_state,
        })
    }

    /// Returns the output times of the compared part of a window.
    pub fn output_times<'w>(&self, window: &'w Window) -> OutputTimes<'w> {
        let samples = count_samples(window, self.fraction);
        self.output_rate.times(&window.times[..samples])
    }

    /// Returns the sensor outputs for the channel values of a window, one row per sample.
    pub fn apply_sensors(
        &self,
        times: &OutputTimes<'_>,
        sensors: &SensorValues,
        quantities: &[f64],
    ) -> Vec<f64> {
        let channels = self.channel_count();
        let samples = times.samples();
        let mut seen = vec![0.0; samples * channels];
        for channel in ChannelId::first(channels) {
            let column = Column {
                times,
                values: quantities,
                channels,
                channel,
            };
            let (gain, bias) = (sensors.gain[channel], sensors.bias[channel]);
            let delay = sensors.delay[channel];
            for sample in 0..samples {
                let index = times.of_sample(sample);
                let quantity = if delay == 0.0 {
                    column.values[index * channels + channel.index()]
                } else {
                    let at = times.times[index] - delay;
                    interpolate_column(&column, at, index)
                };
                seen[sample * channels + channel.index()] = gain * quantity + bias;
            }
        }
        seen
    }

    /// Returns simulated minus measured outputs, in standard deviations.
    pub(crate) fn normalise_differences(&self, window: &Window, seen: &[f64]) -> Vec<f64> {
        self.map_differences(window, seen, |seen, measured| seen - measured)
    }

    /// Applies a function to simulated and measured outputs, in standard deviations. 0 for samples
    /// that are not compared.
    pub(crate) fn map_differences(
        &self,
        window: &Window,
        seen: &[f64],
        of: impl Fn(f64, f64) -> f64,
    ) -> Vec<f64> {
        let channels = self.channel_count();
        let samples = seen.len() / channels;
        let inside = compared_samples(samples);
        let pairs = seen.iter().zip(&window.measured).enumerate();
        pairs
            .map(|(number, (seen, measured))| {
                if measured.is_nan() || !inside.contains(&(number / channels)) {
                    0.0
                } else {
                    of(*seen, *measured) / self.noise[number % channels]
                }
            })
            .collect()
    }

    /// Distributes consecutive windows over the threads and returns the results in order.
    pub(crate) fn map_windows_in_parallel<T: Send>(
        &self,
        work: impl Fn(WindowRange) -> Vec<T> + Send + Sync,
    ) -> Vec<T> {
        let count = self.windows.windows.len();
        let threads = rayon::current_num_threads().max(1);
        // The parts depend only on the number of threads. The results of a window do not depend on
        // its part.
        let size = count.div_ceil(threads).max(1);
        let parts: Vec<WindowRange> = (0..count.div_ceil(size))
            .map(|part| WindowId::range(part * size..((part + 1) * size).min(count)))
            .collect();
        let answers: Vec<Vec<T>> = parts.into_par_iter().map(work).collect();
        answers.into_iter().flatten().collect()
    }
}

/// Returns the number of samples in a fraction of a window.
pub(crate) fn count_samples(window: &Window, part: f64) -> usize {
    let count = window.times.len();
    ((part * count as f64) as usize).clamp(count.min(8), count)
}

/// Values of one channel along a window.
struct Column<'q> {
    times: &'q OutputTimes<'q>,
    /// Values of all channels, one row per time.
    values: &'q [f64],
    channels: usize,
    channel: ChannelId,
}

/// Returns the value of a channel by cubic interpolation through four neighbouring times.
fn interpolate_column(column: &Column<'_>, at: f64, near: usize) -> f64 {
    let times = &column.times.times;
    let last = times.len() - 1;
    let mut before = near.min(last);
    while before > 0 && times[before] > at {
        before -= 1;
    }
    while before < last && times[before + 1] <= at {
        before += 1;
    }
    let count = times.len().min(4);
    let first = column.times.first_node(before, count);
    let nodes = first..first + count;
    nodes
        .clone()
        .map(|i| {
            let weight = compute_lagrange_weight(times, nodes.clone(), i, at);
            weight * column.values[i * column.channels + column.channel.index()]
        })
        .sum()
}
