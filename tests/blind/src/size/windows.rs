//! Windows of the records, motion of a machine in a window, and sensor readings. Outputs are
//! relative to the noise; channels of a sample are adjacent.

use nalgebra::DVector;

use crate::hidden::Sensors;
use crate::inputs::Drive;
use crate::integrate::Stepper;
use crate::machines::{Machine, Setup};

/// Position of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Index of the record.
    pub record: usize,
    /// Index of the first sample.
    pub first: usize,
    /// Number of samples.
    pub count: usize,
}

/// Returns the windows of all records. A last window shorter than half the length is left out.
pub fn list_spans(setup: &Setup, drives: &[Drive]) -> Vec<Span> {
    let mut list_spans = Vec::new();
    for (record, drive) in drives.iter().enumerate() {
        let samples = drive.input.len();
        let length = setup
            .window
            .map_or(samples, |w| (w / setup.sample).round() as usize);
        for first in (0..samples).step_by(length) {
            let count = length.min(samples - first);
            if count * 2 >= length {
                list_spans.push(Span {
                    record,
                    first,
                    count,
                });
            }
        }
    }
    list_spans
}

/// Returns the states at all samples of a record.
pub fn states(machine: &Machine, setup: &Setup, drive: &Drive) -> Vec<Vec<f64>> {
    window(machine, setup, drive, &drive.start, 0, drive.input.len())
}

/// Returns the states at `count` samples, starting from a state at the first sample.
pub fn window(
    machine: &Machine,
    setup: &Setup,
    drive: &Drive,
    start: &[f64],
    first: usize,
    count: usize,
) -> Vec<Vec<f64>> {
    let mut stepper = Stepper::new(start.len());
    let mut state = start.to_vec();
    let mut states = Vec::with_capacity(count);
    for sample in first..first + count {
        states.push(state.clone());
        let t = sample as f64 * setup.sample;
        stepper.advance(
            machine,
            t,
            setup.sample,
            setup.steps,
            drive.input[sample],
            &mut state,
        );
    }
    states
}

/// Returns the readings of ideal sensors in a window for an initial state.
pub fn simulate_window(
    machine: &Machine,
    setup: &Setup,
    drives: &[Drive],
    start: &[f64],
    span: Span,
) -> DVector<f64> {
    let drive = &drives[span.record];
    let states = window(machine, setup, drive, start, span.first, span.count);
    outputs(machine, setup, &states)
}

/// Returns the outputs for given states.
pub fn outputs(machine: &Machine, setup: &Setup, states: &[Vec<f64>]) -> DVector<f64> {
    let values = states.iter().flat_map(|state| {
        let of = machine.outputs(state);
        let channels = of.into_iter().zip(&setup.channels);
        channels
            .map(|(value, channel)| value / channel.noise)
            .collect::<Vec<_>>()
    });
    DVector::from_iterator(states.len() * setup.channels.len(), values)
}

/// Returns outputs with sensor errors; delays are linearised.
pub fn with_sensor_errors(seen: &DVector<f64>, setup: &Setup, sensors: &Sensors) -> DVector<f64> {
    let channels = setup.channels.len();
    let samples = seen.len() / channels;
    let mut result = seen.clone();
    for sample in 0..samples {
        for (place, channel) in setup.channels.iter().enumerate() {
            let at = |sample: usize| seen[sample * channels + place];
            let (before, after) = (sample.saturating_sub(1), (sample + 1).min(samples - 1));
            let slope = (at(after) - at(before)) / ((after - before) as f64 * setup.sample);
            result[sample * channels + place] += sensors.gain[place] * at(sample)
                + sensors.bias[place] / channel.noise
                - sensors.delay[place] * slope;
        }
    }
    result
}
