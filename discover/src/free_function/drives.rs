//! Differences between the accelerations of similar models along a reference motion.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;

use crate::free_function::reference_motion::{ReferenceMotion, ReferenceRecord};
use crate::free_function::segments::Drive;
use crate::model::estimation_model::EstimationModel;
use crate::thresholds;

/// A model that is evaluated along a reference motion.
pub(crate) struct DrivenModel {
    evaluator: Evaluator,
    /// Index in this model of each state of the reference motion.
    indices: Vec<usize>,
    /// Indices of the first-order states that the reference motion does not have.
    added: Vec<usize>,
    degrees_of_freedom: usize,
    /// Accelerations and rates of the first-order states of the reference motion, at both ends of
    /// each step: columns `2 step` and `2 step + 1`.
    accelerations: Vec<DMatrix<f64>>,
    /// Values of the channels, without sensor errors, at the samples of each record.
    outputs: Vec<DMatrix<f64>>,
}

impl DrivenModel {
    /// Creates the model of the reference motion with other parameter values.
    pub fn new(model: &EstimationModel, values: &[f64]) -> Self {
        Self {
            evaluator: model.create_evaluator(values),
            indices: (0..model.state_count()).collect(),
            added: Vec::new(),
            degrees_of_freedom: model.degrees_of_freedom(),
            accelerations: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Creates a model that has the states of the reference model and additional first-order
    /// states; `None` if other states differ.
    pub fn with_added_states(
        reference: &EstimationModel,
        model: &EstimationModel,
        values: &[f64],
    ) -> Option<Self> {
        let index = |name: &String| model.states.iter().position(|state| state == name);
        let indices: Option<Vec<usize>> = reference.states.iter().map(index).collect();
        let indices = indices?;
        let degrees = model.degrees_of_freedom();
        let added: Vec<usize> = (0..model.state_count())
            .filter(|state| !indices.contains(state))
            .collect();
        (degrees == reference.degrees_of_freedom()).then(|| Self {
            evaluator: model.create_evaluator(values),
            indices,
            added,
            degrees_of_freedom: degrees,
            accelerations: Vec::new(),
            outputs: Vec::new(),
        })
    }

    /// Stores the accelerations and channel values along the reference motion.
    pub fn with_reference_motion(
        mut self,
        motion: &ReferenceMotion,
        model: &EstimationModel,
    ) -> Self {
        self.outputs = self.measure_outputs(motion, model);
        self.accelerations = motion
            .records
            .iter()
            .map(|record| self.compute_accelerations(record))
            .collect();
        self
    }

    /// Returns the stored channel values.
    pub fn outputs(&self) -> &[DMatrix<f64>] {
        &self.outputs
    }

    /// Returns the channel values at the samples of each record. `model`: a model with the states
    /// of the reference motion.
    pub fn measure_outputs(
        &mut self,
        motion: &ReferenceMotion,
        model: &EstimationModel,
    ) -> Vec<DMatrix<f64>> {
        let mut buffers = model.measured.create_buffers();
        let records = motion.records.iter().map(|record| {
            let channels = model.measured.count();
            let mut found = DMatrix::zeros(record.times.len(), channels);
            for sample in 0..record.times.len() {
                let point = Point {
                    t: record.times[sample],
                    state: &record.states[sample],
                    inputs: &record.inputs[sample][0],
                };
                let mut values = Vec::with_capacity(channels);
                let evaluator = &mut self.evaluator;
                model
                    .measured
                    .append(evaluator, point, &mut buffers, &mut values);
                for (channel, value) in values.into_iter().enumerate() {
                    found[(sample, channel)] = value;
                }
            }
            found
        });
        records.collect()
    }

    /// Returns the accelerations and the rates of the first-order states of the reference motion at
    /// both ends of each step. Added states start at 0 and follow their own rates.
    fn compute_accelerations(&mut self, record: &ReferenceRecord) -> DMatrix<f64> {
        let states = self.evaluator.program().states();
        let first = self.degrees_of_freedom;
        let slots: Vec<usize> = self.indices[first..].to_vec();
        let mut found = DMatrix::zeros(slots.len(), 2 * record.steps.len());
        let mut state = vec![0.0; states];
        let mut rates = vec![0.0; states];
        for step in 0..record.steps.len() {
            for is_end in [false, true] {
                if is_end && !self.added.is_empty() {
                    self.advance_added(record, step, &mut state, &mut rates);
                }
                let point = record.end_point(step, is_end);
                for (index, value) in self.indices.iter().zip(point.state) {
                    state[*index] = *value;
                }
                let own = Point {
                    state: &state,
                    ..point
                };
                self.evaluator.rates(own, &mut rates);
                let column = 2 * step + usize::from(is_end);
                for (row, slot) in slots.iter().enumerate() {
                    found[(row, column)] = rates[*slot];
                }
            }
        }
        found
    }

    /// Integrates the added states over a step. The rate of each added state is linearised in this
    /// state along the mean of the reference motion.
    fn advance_added(
        &mut self,
        record: &ReferenceRecord,
        step: usize,
        state: &mut [f64],
        rates: &mut [f64],
    ) {
        let (begin, end) = (record.end_point(step, false), record.end_point(step, true));
        let length = end.t - begin.t;
        let pairs = begin.state.iter().zip(end.state);
        for (index, (a, b)) in self.indices.iter().zip(pairs) {
            state[*index] = 0.5 * (a + b);
        }
        let t = 0.5 * (begin.t + end.t);
        let pairs = begin.inputs.iter().zip(end.inputs);
        let inputs: Vec<f64> = pairs.map(|(a, b)| 0.5 * (a + b)).collect();
        let inputs = &inputs[..];
        for k in 0..self.added.len() {
            let index = self.added[k];
            let old = state[index];
            self.evaluator.rates(Point { t, state, inputs }, rates);
            let rate = rates[index];
            let change = (rate * length).abs().max(old.abs());
            let change = thresholds::ADDED_STATE_QUOTIENT * change.max(f64::MIN_POSITIVE.sqrt());
            state[index] = old + change;
            self.evaluator.rates(Point { t, state, inputs }, rates);
            let slope = (rates[index] - rate) / change * length;
            // Mean of exp(s) for s from 0 to `slope`.
            let mean = match slope.abs() < 1e-6 {
                true => 1.0 + 0.5 * slope,
                false => slope.exp_m1() / slope,
            };
            state[index] = old + mean * rate * length;
        }
    }
}

/// Returns the accelerations of a changed model minus those of the reference model, averaged over
/// each step and multiplied by a factor.
pub(crate) fn average_drive(
    motion: &ReferenceMotion,
    base: &DrivenModel,
    moved: &mut DrivenModel,
    factor: f64,
) -> Drive {
    let records = motion.records.iter().zip(&base.accelerations);
    let drive = records.map(|(record, base)| {
        let moved = moved.compute_accelerations(record);
        DMatrix::from_fn(moved.nrows(), record.steps.len(), |row, step| {
            let at = |column: usize| moved[(row, column)] - base[(row, column)];
            0.5 * factor * (at(2 * step) + at(2 * step + 1))
        })
    });
    drive.collect()
}

/// Returns true if a drive is finite and not 0.
pub(crate) fn is_visible(drive: &Drive) -> bool {
    let mut sum = 0.0;
    for value in drive.iter().flat_map(|record| record.iter()) {
        sum += value * value;
    }
    sum.is_finite() && sum > 0.0
}
