//! Admissible inputs: each waveform on each input at several amplitudes. The other inputs have
//! their rest values.

use eomgen_sim::inputs::HeldInputs;

use crate::experiment::bounds::{Bounds, InputBounds};
use crate::experiment::waveform::Waveform;
use crate::interval::Interval;
use crate::thresholds;

/// Admissible input.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// Index among the inputs of the model.
    pub input_index: usize,
    /// Name of the input.
    pub name: String,
    /// Waveform.
    pub waveform: Waveform,
    /// Description of the waveform and amplitude.
    pub description: String,
    /// Value at each sample, SI.
    pub values: Vec<f64>,
}

impl Proposal {
    /// Returns all trial inputs at given sample times, s.
    pub fn list_all(bounds: &Bounds, times: &[f64]) -> Vec<Self> {
        let mut family: Vec<Self> = Vec::new();
        let played_at: Vec<f64> = times
            .iter()
            .copied()
            .step_by(bounds.samples_per_value)
            .collect();
        for input in &bounds.inputs {
            for form in Waveform::list_in_band(input.band) {
                let Some(shape) = form.sample(&played_at, bounds.duration) else {
                    continue;
                };
                for size in thresholds::EXPERIMENT_AMPLITUDES {
                    family.push(Self {
                        input_index: input.index,
                        name: input.name.clone(),
                        waveform: form,
                        description: format!(
                            "{}, {:.0} % of its range",
                            form.describe(),
                            100.0 * size
                        ),
                        values: hold_values(
                            &play_shape(&shape, size, input, bounds),
                            bounds.samples_per_value,
                            times.len(),
                        ),
                    });
                }
            }
        }
        family
    }

    /// Returns the values of all `count` inputs of the model with this proposal.
    pub fn build_inputs(&self, bounds: &Bounds, times: &[f64], count: usize) -> HeldInputs {
        let mut row = vec![0.0; count];
        for other in &bounds.inputs {
            row[other.index] = rest_value(other.range);
        }
        let rows = self.values.iter().flat_map(|value| {
            let mut row = row.clone();
            row[self.input_index] = *value;
            row
        });
        HeldInputs::new(times.to_vec(), rows.collect(), count)
            .unwrap_or_else(|| HeldInputs::zero(count))
    }
}

/// Returns the rest value of an input: 0 or the nearest admissible value.
pub fn rest_value(range: Interval) -> f64 {
    range.clamp(0.0)
}

/// Scales a waveform to a fraction of the input range on both sides of the rest value, and limits
/// its rate of change.
fn play_shape(shape: &[f64], size: f64, input: &InputBounds, bounds: &Bounds) -> Vec<f64> {
    let Interval { low, high } = input.range;
    let rest = rest_value(input.range);
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let mut present = rest;
    let most = input.rate * bounds.sample_time * bounds.samples_per_value as f64;
    let value = |form: &f64| {
        let wanted = match form.is_nan() {
            true => rest,
            false => rest + size * (middle + half * form - rest),
        };
        present += (wanted - present).clamp(-most, most);
        present = input.range.clamp(present);
        present
    };
    shape.iter().map(value).collect()
}

/// Repeats each value `times` times; returns `count` values.
fn hold_values(values: &[f64], times: usize, count: usize) -> Vec<f64> {
    let held = values.iter().flat_map(|v| std::iter::repeat_n(*v, times));
    held.take(count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(low: f64, high: f64, rate: f64) -> Bounds {
        Bounds {
            duration: 10.0,
            sample_time: 0.01,
            samples_per_value: 1,
            inputs: vec![InputBounds {
                index: 0,
                name: "u".to_owned(),
                range: Interval::new(low, high),
                rate,
                band: Interval::new(0.1, 5.0),
            }],
            channels: Vec::new(),
            sources: String::new(),
        }
    }

    #[test]
    fn slow_inputs_are_held_between_their_samples() {
        let bounds = Bounds {
            samples_per_value: 5,
            ..bounds(-1.0, 1.0, 1e3)
        };
        let times = bounds.sample_times();
        for proposal in Proposal::list_all(&bounds, &times) {
            assert_eq!(proposal.values.len(), times.len());
            let mut held = proposal.values.chunks(5);
            assert!(held.all(|of| of.iter().all(|value| *value == of[0])));
        }
    }

    #[test]
    fn proposals_stay_within_range_and_rate() {
        for (low, high, rate) in [(-1.0, 2.0, 3.0), (0.0, 5.0, 1e3), (2.0, 4.0, 0.1)] {
            let bounds = bounds(low, high, rate);
            let times = bounds.sample_times();
            let family = Proposal::list_all(&bounds, &times);
            assert!(family.len() > 80, "{}", family.len());
            for proposal in family {
                assert_eq!(proposal.values.len(), times.len());
                let within = |value: &f64| (low..=high).contains(value);
                assert!(
                    proposal.values.iter().all(within),
                    "{}",
                    proposal.description
                );
                let mut steps = proposal.values.windows(2);
                let slow = |pair: &[f64]| (pair[1] - pair[0]).abs() <= rate * 0.01 * (1.0 + 1e-9);
                assert!(steps.all(slow), "{}", proposal.description);
            }
        }
    }
}
