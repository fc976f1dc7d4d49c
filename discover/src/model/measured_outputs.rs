//! Quantities of a model that are measured by channels.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::program::{Program, ValueId};
use eomgen_compiled_model::StickingMotion;
use eomgen_records::dataset::{Channel, Quantity};

/// Source of the quantity of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// State, by its index.
    State(usize),
    /// Observable, by its index.
    Observable(usize),
    /// Rate of the state with this index.
    Rate(usize),
    /// Derivative of an observable that contains accelerations.
    Acceleration(ObservedAcceleration),
    /// Input, by its index.
    Input(usize),
}

/// Indices of an observed acceleration and of the observable whose time derivative it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ObservedAcceleration {
    /// Index of the derivative among the observables.
    pub index: usize,
    /// Index of the differentiated observable. It contains rates.
    pub observable: usize,
}

/// Measured input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeasuredInput {
    /// Index of the input.
    pub index: usize,
    /// Standard deviation of the noise of its sensor, SI.
    pub noise: f64,
}

/// Buffers for quantities other than states.
pub(crate) struct OutputBuffers {
    observables: Vec<f64>,
    rates: Vec<f64>,
    /// Sticking surfaces of the motion, if any. They are needed because the evaluation uses sign(0)
    /// = 0.
    pub rest: Option<StickingMotion>,
}

/// Measured quantities of a model, one per channel.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredOutputs {
    outputs: Vec<Output>,
    /// Measured inputs, each only once.
    inputs: Vec<MeasuredInput>,
    /// Number of observables of the model.
    observables: usize,
    /// Number of states of the model.
    states: usize,
    degrees_of_freedom: usize,
}

impl MeasuredOutputs {
    /// Creates the measured quantities of a program. `rates`: source of each channel that measures
    /// the derivative of an observable.
    pub fn new(channels: &[Channel], rates: &[Option<Output>], program: &Program) -> Self {
        let degrees_of_freedom = program.degrees_of_freedom();
        let channels_with_rates = channels.iter().zip(rates);
        let outputs = channels_with_rates.map(|(channel, rate)| match channel.quantity {
            Quantity::Observable(observable) => Output::Observable(observable),
            Quantity::Coordinate(coordinate) => Output::State(coordinate),
            Quantity::Rate(coordinate) => Output::State(degrees_of_freedom + coordinate),
            Quantity::Acceleration(coordinate) => Output::Rate(degrees_of_freedom + coordinate),
            Quantity::State(state) => Output::State(2 * degrees_of_freedom + state),
            Quantity::Input(input) => Output::Input(input),
            Quantity::ObservedRate(of) => rate.unwrap_or(Output::Observable(of.observable)),
        });
        Self {
            outputs: outputs.collect(),
            inputs: measured_inputs(channels),
            observables: program.observables.len(),
            states: program.states(),
            degrees_of_freedom,
        }
    }

    /// Returns the program values of the measured observables.
    pub fn observable_values(&self, program: &Program) -> Vec<ValueId> {
        let of = |output: &Output| match output {
            Output::Observable(observable) => Some(program.observable_values[*observable]),
            Output::Acceleration(of) => Some(program.observable_values[of.index]),
            Output::State(_) | Output::Rate(_) | Output::Input(_) => None,
        };
        self.outputs.iter().filter_map(of).collect()
    }

    /// Returns the number of quantities.
    pub fn count(&self) -> usize {
        self.outputs.len()
    }

    /// Returns the source of the quantity of each channel.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// Returns true if accelerations are measured, which jump with forces.
    pub fn has_rates(&self) -> bool {
        (0..self.count()).any(|channel| self.is_rate(channel))
    }

    /// Returns true if a channel measures an acceleration.
    pub fn is_rate(&self, channel: usize) -> bool {
        matches!(
            self.outputs[channel],
            Output::Rate(_) | Output::Acceleration(_)
        )
    }

    /// Returns the measured inputs, which follow from a given motion.
    pub fn inputs(&self) -> &[MeasuredInput] {
        &self.inputs
    }

    /// Creates the work arrays for [`MeasuredOutputs::append`].
    pub fn create_buffers(&self) -> OutputBuffers {
        OutputBuffers {
            observables: vec![0.0; self.observables],
            rates: vec![0.0; if self.has_rates() { self.states } else { 0 }],
            rest: None,
        }
    }

    /// Adds the effect of changed accelerations and rates of first-order states to a row of
    /// quantities. `over`: short time, s, in which these changes move the rates slightly.
    pub fn add_to_accelerations(
        &self,
        evaluator: &mut Evaluator,
        point: Point<'_>,
        (changes, over): (&[f64], f64),
        row: &mut [f64],
    ) {
        let degrees = self.degrees_of_freedom;
        let moves = |output: &Output| matches!(output, Output::Acceleration(_));
        let ends = self.outputs.iter().any(moves).then(|| {
            // d(df/dt)/d(q'') = df/d(q').
            [over, -over].map(|time| {
                let mut state = point.state.to_vec();
                let rates = state[degrees..2 * degrees].iter_mut().zip(changes);
                rates.for_each(|(rate, change)| *rate += time * change);
                let mut observables = vec![0.0; self.observables];
                let state = &state[..];
                evaluator.observables(Point { state, ..point }, &mut observables);
                observables
            })
        });
        for (value, output) in row.iter_mut().zip(&self.outputs) {
            match (output, &ends) {
                (Output::Rate(state), _) => *value += changes[state - degrees],
                (
                    Output::Acceleration(ObservedAcceleration { observable: of, .. }),
                    Some([after, before]),
                ) => {
                    *value += (after[*of] - before[*of]) / (2.0 * over);
                }
                _ => {}
            }
        }
    }

    /// Appends the quantities at a point, SI.
    pub fn append(
        &self,
        evaluator: &mut Evaluator,
        point: Point<'_>,
        buffers: &mut OutputBuffers,
        values: &mut Vec<f64>,
    ) {
        let is_observable =
            |output: &Output| matches!(output, Output::Observable(_) | Output::Acceleration(_));
        if self.outputs.iter().any(is_observable) {
            let rest = buffers.rest.as_mut();
            if !rest.is_some_and(|rest| rest.write_observables(point, &mut buffers.observables)) {
                evaluator.observables(point, &mut buffers.observables);
            }
        }
        if !buffers.rates.is_empty() {
            let rest = buffers.rest.as_mut();
            if !rest.is_some_and(|rest| rest.write_rates(point, &mut buffers.rates)) {
                evaluator.rates(point, &mut buffers.rates);
            }
        }
        values.extend(self.outputs.iter().map(|output| match *output {
            Output::State(state) => point.state[state],
            Output::Observable(observable) => buffers.observables[observable],
            Output::Rate(state) => buffers.rates[state],
            Output::Acceleration(of) => buffers.observables[of.index],
            Output::Input(input) => point.inputs[input],
        }));
    }
}

fn measured_inputs(channels: &[Channel]) -> Vec<MeasuredInput> {
    let mut found: Vec<MeasuredInput> = Vec::new();
    for channel in channels {
        let Quantity::Input(index) = channel.quantity else {
            continue;
        };
        if found.iter().all(|known| known.index != index) {
            found.push(MeasuredInput {
                index,
                noise: channel.noise,
            });
        }
    }
    found
}
