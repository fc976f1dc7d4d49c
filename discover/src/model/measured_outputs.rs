//! Which of a model's states and observables the channels measure.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_records::dataset::{Channel, Quantity};

/// Where a channel's quantity is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// A state, by its place.
    State(usize),
    /// An observable, by its place.
    Observable(usize),
}

/// The measured quantities of a model, one per channel.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredOutputs {
    outputs: Vec<Output>,
    /// How many observables the model has.
    observables: usize,
}

impl MeasuredOutputs {
    /// What channels measure of a model with so many coordinates, modes among them, and
    /// observables.
    pub fn new(channels: &[Channel], degrees_of_freedom: usize, observables: usize) -> Self {
        let outputs = channels.iter().map(|channel| match channel.quantity {
            Quantity::Observable(observable) => Output::Observable(observable),
            Quantity::Coordinate(coordinate) => Output::State(coordinate),
            Quantity::Rate(coordinate) => Output::State(degrees_of_freedom + coordinate),
        });
        Self {
            outputs: outputs.collect(),
            observables,
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.outputs.len()
    }

    /// Where the quantity of each channel is found.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// A buffer for all observables of the model.
    pub fn observables(&self) -> Vec<f64> {
        vec![0.0; self.observables]
    }

    /// Appends the quantities at a point, SI. `observables`: a buffer for all of them.
    pub fn append(
        &self,
        evaluator: &mut Evaluator,
        point: Point<'_>,
        observables: &mut [f64],
        values: &mut Vec<f64>,
    ) {
        let is_state = |output: &Output| matches!(output, Output::State(_));
        if !self.outputs.iter().all(is_state) {
            evaluator.observables(point, observables);
        }
        values.extend(self.outputs.iter().map(|output| match *output {
            Output::State(state) => point.state[state],
            Output::Observable(observable) => observables[observable],
        }));
    }
}
