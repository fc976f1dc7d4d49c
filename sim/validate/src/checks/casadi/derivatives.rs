//! Comparison of derivatives with finite differences. The time derivatives of the rates are compared with differences
//! of the rates; the second derivatives of the weighted rates, with differences of the Jacobians. Other checks compare
//! the Jacobians with the oracle.

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;

use super::super::interface::arguments;
use super::expected::rate_jacobians;
use crate::differences::{Slope, one_sided_slopes, slopes};
use crate::sampler::Sample;

/// Tolerance of finite differences, relative to the largest addend for a change of the variable by its size. The rates
/// contain a linear solve. Its rounding errors exceed the rounding errors of the addends.
pub const DERIVATIVE_TOLERANCE: f64 = 1e-6;
/// Step sizes of the finite differences, relative to the variable. Long steps suit smooth functions. Short steps suit
/// functions with large higher derivatives, and variables of unknown size because their value is zero.
const STEPS: [f64; 5] = [
    1.0 / 64.0,
    1.0 / 1024.0,
    1.0 / 16384.0,
    1.0 / 262_144.0,
    1.0 / 4_194_304.0,
];

/// Smallest scale of a comparison, as a fraction of the largest addend. Smaller addends may be rounding errors of the
/// largest.
const SMALLEST_ADDEND: f64 = 1e-6;

/// Rates, multiplied by the weights that the harness uses.
pub struct WeightedRates {
    evaluator: Evaluator,
    weights: Vec<f64>,
}

impl WeightedRates {
    pub fn new(program: &Program) -> Self {
        Self {
            evaluator: Evaluator::new(program.clone()),
            weights: arguments(program.states()),
        }
    }

    /// Returns the largest deviation of the time derivatives from differences of the rates; `None` close to a switching
    /// surface.
    pub fn time_deviation(&mut self, parameters: &[f64], sample: &Sample) -> Option<f64> {
        self.evaluator.prepare(parameters);
        let [by_time, ..] = rate_jacobians(&mut self.evaluator, sample);
        let here = self.signs(sample);
        let found = STEPS.into_iter().filter_map(|step| {
            let changes = slopes(step, |length| {
                let moved = Sample {
                    time: sample.time + length,
                    ..sample.clone()
                };
                (self.signs(&moved) == here).then(|| self.rates(&moved))
            })?;
            Some(deviations(by_time.as_slice(), 1.0, &changes, &[]))
        });
        smallest_deviations(found).map(|entries| worst_deviation(&entries))
    }

    /// Returns the largest deviation of the second derivatives from differences of the gradient; `None` close to a
    /// switching surface. A piecewise function of parameters only has no switching surface. At its kink, for example at
    /// the half-width 0 of a dead zone, an entry is a one-sided derivative.
    pub fn deviation(
        &mut self,
        parameters: &[f64],
        sample: &Sample,
        hessian: &DMatrix<f64>,
    ) -> Option<f64> {
        let whole = [&[sample.time], &*sample.state, &sample.inputs, parameters].concat();
        let lengths = (sample.state.len(), sample.inputs.len());
        self.evaluator.prepare(parameters);
        let here = self.signs(sample);
        let addends: Vec<f64> = (self.gradient(sample).iter().zip(&whole))
            .map(|(slope, from)| slope.scale * from.abs())
            .collect();
        let largest = addends.into_iter().fold(0.0, f64::max);
        let least: Vec<f64> = (whole.iter())
            .map(|from| SMALLEST_ADDEND * largest / size(*from))
            .collect();
        let mut worst: Option<f64> = None;
        for (place, from) in whole.iter().enumerate() {
            let size = size(*from);
            let column: Vec<f64> = hessian.column(place).iter().copied().collect();
            let mut along = |length: f64| {
                let mut moved = whole.clone();
                moved[place] += length * size;
                let (sample, parameters) = split(&moved, lengths);
                self.evaluator.prepare(parameters);
                (self.signs(&sample) == here).then(|| self.gradient(&sample))
            };
            let compare = |changes: Vec<Slope>| deviations(&column, size, &changes, &least);
            let central = STEPS
                .into_iter()
                .filter_map(|step| slopes(step, &mut along));
            let mut entries = smallest_deviations(central.map(compare))?;
            let is_parameter = place >= whole.len() - parameters.len();
            if is_parameter && worst_deviation(&entries) > DERIVATIVE_TOLERANCE {
                let steps = STEPS.into_iter().flat_map(|step| [step, -step]);
                let one_sided = steps.filter_map(|step| one_sided_slopes(step, &mut along));
                let all = std::iter::once(entries.clone()).chain(one_sided.map(compare));
                entries = smallest_deviations(all).unwrap_or(entries);
            }
            let found = worst_deviation(&entries);
            worst = Some(worst.map_or(found, |worst| worst.max(found)));
        }
        worst
    }

    fn rates(&mut self, sample: &Sample) -> Vec<Slope> {
        let mut rates = vec![f64::NAN; sample.state.len()];
        self.evaluator.rates(point(sample), &mut rates);
        let scale = rates
            .iter()
            .fold(0.0, |scale: f64, rate| scale.max(rate.abs()));
        let rates = rates.into_iter().map(|value| Slope { value, scale });
        rates.collect()
    }

    /// Returns the weighted sums of the columns of the Jacobians.
    fn gradient(&mut self, sample: &Sample) -> Vec<Slope> {
        let jacobians = rate_jacobians(&mut self.evaluator, sample);
        let columns = jacobians.iter().flat_map(|jacobian| jacobian.column_iter());
        let sums = columns.map(|column| {
            let addends = column
                .iter()
                .zip(&self.weights)
                .map(|(rate, weight)| rate * weight);
            let scale = addends
                .clone()
                .fold(0.0, |scale: f64, addend| scale.max(addend.abs()));
            Slope {
                value: addends.sum(),
                scale,
            }
        });
        sums.collect()
    }

    fn signs(&mut self, sample: &Sample) -> Vec<bool> {
        let mut guards = vec![f64::NAN; self.evaluator.guard_count()];
        self.evaluator.guards(point(sample), &mut guards);
        guards.into_iter().map(|guard| guard > 0.0).collect()
    }
}

/// Splits a vector of time, state, inputs and parameters into the sample and the parameters.
fn split(whole: &[f64], (states, inputs): (usize, usize)) -> (Sample, &[f64]) {
    let (state, rest) = whole[1..].split_at(states);
    let (inputs, parameters) = rest.split_at(inputs);
    let sample = Sample {
        time: whole[0],
        state: state.to_vec(),
        inputs: inputs.to_vec(),
    };
    (sample, parameters)
}

fn size(value: f64) -> f64 {
    if value == 0.0 { 1.0 } else { value.abs() }
}

/// Returns the deviations of the derivatives by a variable of typical size `size`. `least` are the smallest scales.
fn deviations(derivatives: &[f64], size: f64, changes: &[Slope], least: &[f64]) -> Vec<f64> {
    let pairs = derivatives.iter().zip(changes).enumerate();
    pairs
        .map(|(place, (derivative, change))| {
            let expected = derivative * size;
            let difference = (expected - change.value).abs();
            match difference == 0.0 {
                true => 0.0,
                false => {
                    let least = least.get(place).copied().unwrap_or(0.0);
                    difference / change.scale.max(expected.abs()).max(least)
                }
            }
        })
        .collect()
}

/// Returns the smallest deviation of each derivative over all step sizes; `None` without a step.
fn smallest_deviations(found: impl Iterator<Item = Vec<f64>>) -> Option<Vec<f64>> {
    let mut smallest: Option<Vec<f64>> = None;
    for found in found {
        let best = match smallest {
            None => found,
            Some(best) => (best.iter().zip(&found))
                .map(|(best, found)| best.min(*found))
                .collect(),
        };
        let is_close = |deviation: &f64| *deviation < 0.01 * DERIVATIVE_TOLERANCE;
        let is_done = best.iter().all(is_close);
        smallest = Some(best);
        if is_done {
            break;
        }
    }
    smallest
}

/// Returns the largest deviation; infinity if one is NaN.
fn worst_deviation(deviations: &[f64]) -> f64 {
    let is_known = deviations.iter().all(|deviation| !deviation.is_nan());
    let largest = deviations.iter().copied().fold(0.0, f64::max);
    if is_known { largest } else { f64::INFINITY }
}

fn point(sample: &Sample) -> Point<'_> {
    Point {
        t: sample.time,
        state: &sample.state,
        inputs: &sample.inputs,
    }
}
