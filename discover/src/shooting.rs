//! Multiple shooting: what the windows' outputs are at a state for each and at the unknowns,
//! how far they are from what was measured, and how they depend on both. Differences are in
//! standard deviations of the sensors' noise. What to make of it is decided elsewhere.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::plant::{Plant, Runner};
use crate::unknowns::{Unknown, What};
use crate::windows::{Window, Windows};

/// A difference quotient moves the outputs by this part of what the residual is: far above
/// rounding, and over the small folds that impacts leave in the outputs.
const QUOTIENT: f64 = 0.3;

/// A difference quotient is not taken over more than this part of a state's own range.
const LARGEST_QUOTIENT: f64 = 0.03;

/// The sensors' part of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// One gain per channel.
    pub gain: Vec<f64>,
    /// One bias per channel, SI.
    pub bias: Vec<f64>,
    /// One delay per channel, s.
    pub delay: Vec<f64>,
}

/// Windows to be explained by a plant.
#[derive(Clone, Copy)]
pub struct Shooting<'a> {
    /// The plant.
    pub plant: &'a Plant,
    /// The windows.
    pub windows: &'a Windows<'a>,
    /// The noise of each channel, SI.
    pub noise: &'a [f64],
    /// The unknowns.
    pub unknowns: &'a [Unknown],
    /// Samples at a window's ends that delayed sensors may see from outside of it.
    pub margin: usize,
    /// The range of each state, where initial states are estimated.
    pub ranges: Option<&'a [f64]>,
    /// The part of each window that is looked at, from its beginning.
    pub part: f64,
    /// How much the unknowns' priors count beside the residuals: the square of the misfit that
    /// noise does not explain, times the samples over which it is correlated. A misfit says
    /// nothing of a sensor beyond its own size.
    pub prior_weight: f64,
}

/// A window's residuals and derivatives.
pub struct Linear {
    /// Simulated minus measured, in noises: row by row, a number per channel; 0 where nothing
    /// was measured.
    pub residual: DVector<f64>,
    /// By the initial state.
    pub by_state: DMatrix<f64>,
    /// By the unknowns.
    pub by_unknown: DMatrix<f64>,
    /// The state at the window's end.
    pub last: Vec<f64>,
}

/// A window's residuals.
pub struct Residual {
    /// As in [`Linear`].
    pub values: Vec<f64>,
    /// The state at the window's end.
    pub last: Vec<f64>,
}

impl Residual {
    /// The sum of squares.
    pub fn square(&self) -> f64 {
        self.values.iter().map(|r| r * r).sum()
    }
}

impl<'a> Shooting<'a> {
    /// How many channels there are.
    pub fn channels(&self) -> usize {
        self.noise.len()
    }

    /// The plant's parameters at these unknowns.
    pub fn values(&self, theta: &[f64]) -> Vec<f64> {
        let mut values = self.plant.values.clone();
        for (unknown, value) in self.unknowns.iter().zip(theta) {
            match &unknown.what {
                What::Parameter(name) => self.plant.set(&mut values, name, *value),
                What::Inverse(name) => self.plant.set(&mut values, name, 1.0 / value),
                What::Gain(_) | What::Bias(_) | What::Delay(_) => {}
            }
        }
        values
    }

    /// The sensors at these unknowns.
    pub fn sensors(&self, theta: &[f64]) -> Sensors {
        let channels = self.channels();
        let mut sensors = Sensors {
            gain: vec![1.0; channels],
            bias: vec![0.0; channels],
            delay: vec![0.0; channels],
        };
        for sensor in &self.plant.model.sensors {
            // What the specification itself says of a sensor holds until it is estimated.
            if let Some(place) = self.plant.channel(&sensor.channel) {
                sensors.gain[place] = sensor.gain;
                sensors.bias[place] = sensor.bias;
                sensors.delay[place] = sensor.delay;
            }
        }
        for (unknown, value) in self.unknowns.iter().zip(theta) {
            match unknown.what {
                What::Parameter(_) | What::Inverse(_) => {}
                What::Gain(place) => sensors.gain[place] = *value,
                What::Bias(place) => sensors.bias[place] = *value,
                What::Delay(place) => sensors.delay[place] = *value,
            }
        }
        sensors
    }

    /// The residuals of every window from these initial states; none where a motion cannot be
    /// followed.
    pub fn residuals(&self, theta: &[f64], starts: &[Vec<f64>]) -> Vec<Option<Residual>> {
        let (values, sensors) = (self.values(theta), self.sensors(theta));
        self.by_threads(|places| {
            let Ok(mut runner) = self.plant.at(&values) else {
                return places.map(|_| None).collect();
            };
            places
                .map(|place| self.residual(&mut runner, &sensors, place, &starts[place]))
                .collect()
        })
    }

    /// One window's residuals.
    pub fn residual(
        &self,
        runner: &mut Runner<'_>,
        sensors: &Sensors,
        place: usize,
        start: &[f64],
    ) -> Option<Residual> {
        let window = &self.windows.list[place];
        let inputs = self.windows.inputs(window);
        let times = &window.times[..samples_in(window, self.part)];
        let outputs = runner.outputs(start, times, inputs).ok()?;
        let seen = self.seen(times, sensors, &outputs.values);
        let values = self.normalised(window, &seen);
        (values.iter().all(|r| r.is_finite())).then_some(Residual {
            values,
            last: outputs.last,
        })
    }

    /// What the sensors show of a window's quantities.
    pub fn seen(&self, times: &[f64], sensors: &Sensors, quantities: &[f64]) -> Vec<f64> {
        let channels = self.channels();
        let samples = times.len();
        let mut seen = vec![0.0; quantities.len()];
        for channel in 0..channels {
            let (gain, bias) = (sensors.gain[channel], sensors.bias[channel]);
            let delay = sensors.delay[channel];
            for sample in 0..samples {
                let quantity = if delay == 0.0 {
                    quantities[sample * channels + channel]
                } else {
                    let at = times[sample] - delay;
                    interpolated(times, quantities, (channels, channel), at, sample)
                };
                seen[sample * channels + channel] = gain * quantity + bias;
            }
        }
        seen
    }

    /// Differences from what was measured, in noises.
    fn normalised(&self, window: &Window, seen: &[f64]) -> Vec<f64> {
        self.differences(window, seen, |seen, measured| seen - measured)
    }

    /// A function of what is seen and measured, in noises; 0 where nothing counts.
    fn differences(&self, window: &Window, seen: &[f64], of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let channels = self.channels();
        let samples = seen.len() / channels;
        let margin = self.margin.min(samples / 4);
        let inside = margin..samples - margin;
        let pairs = seen.iter().zip(&window.measured).enumerate();
        pairs
            .map(|(place, (seen, measured))| {
                if measured.is_nan() || !inside.contains(&(place / channels)) {
                    0.0
                } else {
                    of(*seen, *measured) / self.noise[place % channels]
                }
            })
            .collect()
    }

    /// Residuals and derivatives of every window. `level`: the size of the residuals, in
    /// noises, over which quotients are taken.
    pub fn linear(&self, theta: &[f64], starts: &[Vec<f64>], level: f64) -> Vec<Option<Linear>> {
        self.by_threads(|places| {
            let mut crew = Crew::new(self, theta, level);
            places
                .map(|place| crew.as_mut()?.linear(place, &starts[place]))
                .collect()
        })
    }

    /// Shares the windows out to the threads, neighbours together, and puts the answers in
    /// order.
    fn by_threads<T: Send>(
        &self,
        work: impl Fn(std::ops::Range<usize>) -> Vec<T> + Send + Sync,
    ) -> Vec<T> {
        let count = self.windows.list.len();
        let threads = rayon::current_num_threads().max(1);
        // The parts do not depend on the number of threads' speed, only on their number; what
        // is computed for a window does not depend on its part.
        let size = count.div_ceil(threads).max(1);
        let parts: Vec<_> = (0..count.div_ceil(size))
            .map(|part| part * size..((part + 1) * size).min(count))
            .collect();
        let answers: Vec<Vec<T>> = parts.into_par_iter().map(work).collect();
        answers.into_iter().flatten().collect()
    }
}

/// The plant at the unknowns and at neighbouring values of each parameter.
pub struct Crew<'a> {
    shooting: Shooting<'a>,
    base: Runner<'a>,
    sensors: Sensors,
    /// For each unknown that is a parameter the neighbouring plant and the step.
    neighbours: Vec<Option<(Runner<'a>, f64)>>,
    level: f64,
}

impl<'a> Crew<'a> {
    /// The crew at these unknowns, if there is a motion.
    pub fn new(shooting: &Shooting<'a>, theta: &[f64], level: f64) -> Option<Self> {
        let values = shooting.values(theta);
        let mut neighbours = Vec::with_capacity(theta.len());
        for (place, unknown) in shooting.unknowns.iter().enumerate() {
            if !matches!(unknown.what, What::Parameter(_) | What::Inverse(_)) {
                neighbours.push(None);
                continue;
            }
            let step = quotient_step(unknown, theta[place]);
            let mut moved = theta.to_vec();
            moved[place] += step;
            neighbours.push(Some((
                shooting.plant.at(&shooting.values(&moved)).ok()?,
                step,
            )));
        }
        Some(Self {
            base: shooting.plant.at(&values).ok()?,
            sensors: shooting.sensors(theta),
            neighbours,
            level,
            shooting: *shooting,
        })
    }

    /// The crew at these unknowns, which are not differentiated by.
    pub fn frozen(shooting: &Shooting<'a>, theta: &[f64], level: f64) -> Option<Self> {
        Some(Self {
            base: shooting.plant.at(&shooting.values(theta)).ok()?,
            sensors: shooting.sensors(theta),
            neighbours: Vec::new(),
            level,
            shooting: *shooting,
        })
    }

    /// From here on only this part of a window is looked at, from its beginning.
    pub fn see(&mut self, part: f64) {
        self.shooting.part = part;
    }

    /// The state that a window's motion reaches at a time, s.
    pub fn carried(&mut self, place: usize, start: &[f64], until: f64) -> Option<Vec<f64>> {
        let window = &self.shooting.windows.list[place];
        let inputs = self.shooting.windows.inputs(window);
        let states = self
            .base
            .states(start, &[window.times[0], until], inputs)
            .ok()?;
        states.into_iter().next_back()
    }

    /// A window's residuals alone.
    pub fn residual(&mut self, place: usize, start: &[f64]) -> Option<Residual> {
        let shooting = self.shooting;
        shooting.residual(&mut self.base, &self.sensors, place, start)
    }

    /// A window's residuals and derivatives.
    pub fn linear(&mut self, place: usize, start: &[f64]) -> Option<Linear> {
        let shooting = self.shooting;
        let window = &shooting.windows.list[place];
        let inputs = shooting.windows.inputs(window);
        let times = &window.times[..samples_in(window, shooting.part)];
        let steps: Vec<f64> = (shooting.ranges.unwrap_or_default().iter())
            .map(|range| LARGEST_QUOTIENT * range)
            .collect();
        let tangents = match shooting.ranges {
            Some(_) => self.base.tangents(start, times, inputs, &steps),
            None => None,
        };
        let (outputs, derivatives) = match tangents {
            Some((outputs, derivatives)) => (outputs, Some(derivatives)),
            None => (self.base.outputs(start, times, inputs).ok()?, None),
        };
        let seen = shooting.seen(times, &self.sensors, &outputs.values);
        let residual = DVector::from_vec(shooting.normalised(window, &seen));
        if residual.iter().any(|r| !r.is_finite()) {
            return None;
        }
        let by_state = match derivatives {
            Some(derivatives) => self.by_tangents(window, times, start.len(), &derivatives),
            None => self.by_state(place, start, &residual)?,
        };
        let mut by_unknown = DMatrix::zeros(residual.len(), self.neighbours.len());
        for (column, neighbour) in self.neighbours.iter_mut().enumerate() {
            let unknown = &shooting.unknowns[column];
            let (moved, step) = match neighbour {
                Some((runner, step)) => {
                    let moved = runner.outputs(start, times, inputs).ok()?;
                    (shooting.seen(times, &self.sensors, &moved.values), *step)
                }
                None => {
                    let (sensors, step) = moved_sensors(&self.sensors, unknown);
                    (shooting.seen(times, &sensors, &outputs.values), step)
                }
            };
            let moved = shooting.normalised(window, &moved);
            for (row, (after, before)) in moved.iter().zip(residual.iter()).enumerate() {
                by_unknown[(row, column)] = (after - before) / step;
            }
        }
        let finite = by_unknown.iter().all(|entry: &f64| entry.is_finite());
        finite.then_some(Linear {
            residual,
            by_state,
            by_unknown,
            last: outputs.last,
        })
    }

    /// The derivative by the initial state from the quantities' own derivatives.
    fn by_tangents(
        &self,
        window: &Window,
        times: &[f64],
        states: usize,
        derivatives: &[f64],
    ) -> DMatrix<f64> {
        let shooting = &self.shooting;
        let channels = shooting.channels();
        let sensors = Sensors {
            bias: vec![0.0; channels],
            ..self.sensors.clone()
        };
        let rows = times.len() * channels;
        let mut matrix = DMatrix::zeros(rows, states);
        let mut column = vec![0.0; rows];
        for state in 0..states {
            for sample in 0..times.len() {
                let from = (sample * states + state) * channels;
                let to = sample * channels;
                column[to..to + channels].copy_from_slice(&derivatives[from..from + channels]);
            }
            let seen = shooting.seen(times, &sensors, &column);
            let differences = shooting.differences(window, &seen, |seen, _| seen);
            matrix.column_mut(state).copy_from_slice(&differences);
        }
        matrix
    }

    /// The derivative by the initial state; no columns where that is given.
    fn by_state(
        &mut self,
        place: usize,
        start: &[f64],
        residual: &DVector<f64>,
    ) -> Option<DMatrix<f64>> {
        let shooting = self.shooting;
        let Some(ranges) = shooting.ranges else {
            return Some(DMatrix::zeros(residual.len(), 0));
        };
        let mut matrix = DMatrix::zeros(residual.len(), start.len());
        let mut moved = start.to_vec();
        for state in 0..start.len() {
            let largest = LARGEST_QUOTIENT * ranges[state];
            let mut step = largest;
            // The step that moves the outputs as wanted is found by trying: what a state does
            // to them differs by orders of magnitude.
            for _ in 0..3 {
                moved[state] = start[state] + step;
                let after = self.residual(place, &moved)?;
                let differences = after.values.iter().zip(residual.iter()).map(|(a, b)| a - b);
                let mut column = matrix.column_mut(state);
                let mut furthest: f64 = 0.0;
                for (slot, difference) in column.iter_mut().zip(differences) {
                    *slot = difference / step;
                    furthest = furthest.max(difference.abs());
                }
                let wanted = QUOTIENT * self.level * 4.0;
                if furthest <= 4.0 * wanted {
                    break;
                }
                step *= wanted / furthest;
            }
            moved[state] = start[state];
        }
        Some(matrix)
    }
}

/// How many samples a part of a window holds.
fn samples_in(window: &Window, part: f64) -> usize {
    let count = window.times.len();
    ((part * count as f64) as usize).clamp(count.min(8), count)
}

/// The step of a parameter's difference quotient; away from a bound that is near.
fn quotient_step(unknown: &Unknown, value: f64) -> f64 {
    let step = 0.01 * unknown.scale;
    if value + step > unknown.bounds.1 {
        -step
    } else {
        step
    }
}

/// The sensors with one unknown moved, and the step.
fn moved_sensors(sensors: &Sensors, unknown: &Unknown) -> (Sensors, f64) {
    let step = 0.1 * unknown.scale;
    let mut moved = sensors.clone();
    match unknown.what {
        What::Gain(place) => moved.gain[place] += step,
        What::Bias(place) => moved.bias[place] += step,
        What::Delay(place) => moved.delay[place] += step,
        What::Parameter(_) | What::Inverse(_) => {}
    }
    (moved, step)
}

/// A channel's quantity at a time near a sample, by the cubic through its four neighbours.
fn interpolated(
    times: &[f64],
    quantities: &[f64],
    (channels, channel): (usize, usize),
    at: f64,
    near: usize,
) -> f64 {
    let last = times.len() - 1;
    let mut left = near.min(last);
    while left > 0 && times[left] > at {
        left -= 1;
    }
    while left < last && times[left + 1] <= at {
        left += 1;
    }
    let count = times.len().min(4);
    let first = left.saturating_sub(1).min(times.len() - count);
    let nodes = first..first + count;
    nodes
        .clone()
        .map(|i| {
            let weight: f64 = (nodes.clone())
                .filter(|j| *j != i)
                .map(|j| (at - times[j]) / (times[i] - times[j]))
                .product();
            weight * quantities[i * channels + channel]
        })
        .sum()
}
