//! Which of a model's states and observables the channels measure.

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_compiled_model::Rest;
use eomgen_records::dataset::{Channel, Quantity};

/// Where a channel's quantity is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// A state, by its place.
    State(usize),
    /// An observable, by its place.
    Observable(usize),
    /// The rate of a state, by the state's place.
    Rate(usize),
    /// An input, by its place.
    Input(usize),
}

/// Room for what a model computes beside its states.
pub(crate) struct Buffers {
    observables: Vec<f64>,
    rates: Vec<f64>,
    /// What holds the motion that is looked at, where surfaces may: sign(0) = 0 does not.
    pub rest: Option<Rest>,
}

/// The measured quantities of a model, one per channel.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredOutputs {
    outputs: Vec<Output>,
    /// How many observables the model has.
    observables: usize,
    /// How many states the model has.
    states: usize,
}

impl MeasuredOutputs {
    /// What channels measure of a model.
    pub fn new(channels: &[Channel], program: &Program) -> Self {
        let degrees_of_freedom = program.degrees_of_freedom();
        let outputs = channels.iter().map(|channel| match channel.quantity {
            Quantity::Observable(observable) => Output::Observable(observable),
            Quantity::Coordinate(coordinate) => Output::State(coordinate),
            Quantity::Rate(coordinate) => Output::State(degrees_of_freedom + coordinate),
            Quantity::Acceleration(coordinate) => Output::Rate(degrees_of_freedom + coordinate),
            Quantity::State(state) => Output::State(2 * degrees_of_freedom + state),
            Quantity::Input(input) => Output::Input(input),
        });
        Self {
            outputs: outputs.collect(),
            observables: program.observables.len(),
            states: program.states(),
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

    /// Whether accelerations are measured: they jump where a force does, and a force adds to them at once.
    pub fn has_rates(&self) -> bool {
        let is_rate = |output: &Output| matches!(output, Output::Rate(_));
        self.outputs.iter().any(is_rate)
    }

    /// The inputs that are measured: what a motion takes that records give.
    pub fn inputs(&self) -> Vec<usize> {
        let mut found = Vec::new();
        for output in &self.outputs {
            if let Output::Input(input) = output
                && !found.contains(input)
            {
                found.push(*input);
            }
        }
        found
    }

    /// Room for what [`MeasuredOutputs::append`] computes.
    pub fn buffers(&self) -> Buffers {
        Buffers {
            observables: vec![0.0; self.observables],
            rates: vec![0.0; if self.has_rates() { self.states } else { 0 }],
            rest: None,
        }
    }

    /// Appends the quantities at a point, SI.
    pub fn append(
        &self,
        evaluator: &mut Evaluator,
        point: Point<'_>,
        buffers: &mut Buffers,
        values: &mut Vec<f64>,
    ) {
        let is_observable = |output: &Output| matches!(output, Output::Observable(_));
        if self.outputs.iter().any(is_observable) {
            evaluator.observables(point, &mut buffers.observables);
        }
        if !buffers.rates.is_empty() {
            let rest = buffers.rest.as_mut();
            if !rest.is_some_and(|rest| rest.rates(point, &mut buffers.rates)) {
                evaluator.rates(point, &mut buffers.rates);
            }
        }
        values.extend(self.outputs.iter().map(|output| match *output {
            Output::State(state) => point.state[state],
            Output::Observable(observable) => buffers.observables[observable],
            Output::Rate(state) => buffers.rates[state],
            Output::Input(input) => point.inputs[input],
        }));
    }
}
