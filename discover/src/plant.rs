//! A model as something that can be run: its derived program, its exact propagator where it
//! is linear between its switches, and the measured quantities among its outputs. What is
//! estimated with it is decided elsewhere.

use std::cell::RefCell;
use std::sync::Arc;

use codegen::evaluator::{Evaluator, MachineCode, Point};
use codegen::program::Program;
use codegen::variant::Variant;
use model_spec::model::{Model, ParameterValue};
use model_spec::source::Source;
use sim::exact::{PiecewiseLinear, Propagator};
use sim::record::HeldInputs;
use sim::solve::{Settings, System, simulate};

use crate::dataset::{Channel, Quantity, Record};

/// Relative error of one step of the general solver: far below any sensor's noise.
const TOLERANCE: f64 = 1e-7;

/// The most steps of the general solver in one window.
const MOST_STEPS: u64 = 400_000;

/// Switches per simulated second beyond which a trial motion is given up, 1/s.
const FASTEST_SWITCHING: f64 = 1e5;

/// Samples on which the number of marching steps is tried.
const TRIED_SAMPLES: usize = 100;

/// Marching steps from sample to sample are tried up to two to this power.
const MOST_DOUBLINGS: u32 = 7;

/// The error of marching, in noises: what is marched is compared with noise.
const MARCHING_ERROR: f64 = 0.2;

/// A derived model with its measured outputs.
pub struct Plant {
    /// The checked model.
    pub model: Model,
    /// The order of each field.
    pub orders: Vec<usize>,
    /// The names of the independent parameters, in the order of their values.
    pub parameters: Vec<String>,
    /// The values the specification gives them, SI.
    pub values: Vec<f64>,
    /// The names of the states.
    pub states: Vec<String>,
    program: Program,
    code: Option<Arc<dyn MachineCode>>,
    exact: Option<PiecewiseLinear>,
    outputs: Vec<Output>,
    channels: Vec<String>,
    /// Steps from sample to sample, where the motion is marched; none where a solver decides.
    steps: Option<usize>,
}

/// Where a channel's quantity is found.
#[derive(Clone, Copy)]
enum Output {
    State(usize),
    Observable(usize),
}

impl Plant {
    /// Derives the model of a specification's text.
    ///
    /// # Errors
    /// What is wrong with the text, in words.
    pub fn of(
        text: &str,
        name: &str,
        order: Option<usize>,
        channels: &[Channel],
    ) -> Result<Self, String> {
        let checked = model_spec::check(Source::new(name, text)).map_err(|d| d.render(false))?;
        let model = checked.model;
        let orders = model.orders(order).map_err(|error| error.to_string())?;
        let variant = Variant::derive(&model, &orders).map_err(|d| d.render(false))?;
        let exact = PiecewiseLinear::of(&model, &orders).ok();
        let program = variant.program;
        let independent =
            |p: &&model_spec::model::Parameter| matches!(p.value, ParameterValue::Number(_));
        let parameters = model
            .parameters
            .iter()
            .filter(independent)
            .map(|p| p.name.clone());
        let outputs = channels.iter().map(|channel| match channel.quantity {
            Quantity::Observable(place) => Output::Observable(place),
            Quantity::Coordinate(place) => Output::State(place),
            Quantity::Rate(place) => Output::State(program.degrees_of_freedom() + place),
        });
        Ok(Self {
            outputs: outputs.collect(),
            channels: channels
                .iter()
                .map(|channel| channel.name.clone())
                .collect(),
            parameters: parameters.collect(),
            values: program.default_parameters(),
            states: model.state_names(&orders),
            code: jit::code(&program),
            steps: None,
            model,
            orders,
            program,
            exact,
        })
    }

    /// The place of an independent parameter among the values.
    pub fn place(&self, parameter: &str) -> Option<usize> {
        self.parameters.iter().position(|name| name == parameter)
    }

    /// Sets an independent parameter among the values, SI.
    pub fn set(&self, values: &mut [f64], parameter: &str, value: f64) {
        if let Some(place) = self.place(parameter) {
            values[place] = value;
        }
    }

    /// The place of a measured channel.
    pub fn channel(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|channel| channel == name)
    }

    fn shows_states_only(&self) -> bool {
        self.outputs
            .iter()
            .all(|output| matches!(output, Output::State(_)))
    }

    /// How many states there are.
    pub fn state_count(&self) -> usize {
        self.states.len()
    }

    /// Whether the exact propagator takes it.
    pub fn is_exact(&self) -> bool {
        self.exact.is_some()
    }

    /// The initial state that the specification gives.
    pub fn initial(&self) -> Vec<f64> {
        let given = self.model.initial_state(&self.orders);
        given.unwrap_or_else(|_| vec![0.0; self.state_count()])
    }

    /// Decides in how many steps a motion that is not exact is marched from sample to sample:
    /// as many as change its outputs by less than a part of the noise, tried on the beginning
    /// of a record. Where there are none, a solver with error control goes on deciding.
    pub fn choose_steps(&mut self, record: &Record, initial: &[f64], noise: &[f64]) {
        if self.exact.is_some() {
            return;
        }
        let times = &record.times[..record.times.len().min(TRIED_SAMPLES)];
        let run = |steps: usize| {
            let mut runner = self.at(&self.values).ok()?;
            let states = runner.march(initial, times, &record.inputs, steps)?;
            Some(runner.shown(times, &states, &record.inputs))
        };
        let mut coarse = run(1);
        let mut found = None;
        for doubling in 1..MOST_DOUBLINGS {
            let steps = 1 << doubling;
            let fine = run(steps);
            let near = |(coarse, fine): (&Vec<f64>, &Vec<f64>)| {
                let pairs = coarse.iter().zip(fine).enumerate();
                pairs.into_iter().all(|(place, (a, b))| {
                    (a - b).abs() < MARCHING_ERROR * noise[place % noise.len()]
                })
            };
            if coarse.as_ref().zip(fine.as_ref()).is_some_and(near) {
                found = Some(steps);
                break;
            }
            coarse = fine;
        }
        self.steps = found;
    }

    /// The model at these values of the independent parameters, ready to run.
    ///
    /// # Errors
    /// Values at which there is no motion, in words.
    pub fn at(&self, values: &[f64]) -> Result<Runner<'_>, String> {
        let mut evaluator = match &self.code {
            Some(code) => Evaluator::with_code(self.program.clone(), code.clone()),
            None => Evaluator::new(self.program.clone()),
        };
        evaluator.prepare(values);
        if !evaluator.pivots_are_positive() {
            return Err("the mass matrix is not positive definite".to_owned());
        }
        let propagator = match &self.exact {
            Some(exact) => match exact.at(values) {
                Ok(mut propagator) => {
                    propagator.max_switch_rate = FASTEST_SWITCHING;
                    Some(propagator)
                }
                Err(error) => return Err(error.to_string()),
            },
            None => None,
        };
        Ok(Runner {
            plant: self,
            evaluator: RefCell::new(evaluator),
            observables: vec![0.0; self.program.observables.len()],
            propagator,
        })
    }
}

/// A model at fixed parameters.
pub struct Runner<'p> {
    plant: &'p Plant,
    evaluator: RefCell<Evaluator>,
    observables: Vec<f64>,
    propagator: Option<Propagator>,
}

/// Outputs of a window: a row per sample, a number per channel; and the state at the end.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// Row by row.
    pub values: Vec<f64>,
    /// The state at the last sample.
    pub last: Vec<f64>,
}

impl Runner<'_> {
    /// The states at the samples (s, ascending) of a motion that starts at the first of them.
    ///
    /// # Errors
    /// Why the motion cannot be followed, in words.
    pub fn states(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Vec<Vec<f64>>, String> {
        let (Some(begin), Some(end)) = (samples.first(), samples.last()) else {
            return Ok(Vec::new());
        };
        let span = (*begin, *end);
        if let Some(propagator) = &mut self.propagator {
            let trajectory = propagator.simulate(initial, span, samples, inputs, &mut |_| {});
            if let Ok(trajectory) = trajectory {
                return Ok(trajectory.states);
            }
        }
        if let Some(steps) = self.plant.steps {
            let states = self.march(initial, samples, inputs, steps);
            return states.ok_or_else(|| "the motion grows beyond all bounds".to_owned());
        }
        let settings = Settings {
            max_steps: MOST_STEPS,
            max_switch_rate: FASTEST_SWITCHING,
            ..Settings::with_tolerance(TOLERANCE)
        };
        let driven = Driven {
            evaluator: &self.evaluator,
            inputs,
            states: self.plant.state_count(),
        };
        simulate(&driven, initial, span, samples, &settings, &mut |_| {})
            .map(|trajectory| trajectory.states)
            .map_err(|error| error.to_string())
    }

    /// The states at the samples by classical Runge-Kutta steps, so many from sample to
    /// sample; none if they do not stay finite.
    fn march(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        steps: usize,
    ) -> Option<Vec<Vec<f64>>> {
        let mut state = initial.to_vec();
        let mut states = Vec::with_capacity(samples.len());
        states.push(state.clone());
        let mut slopes = [const { Vec::new() }; 4];
        slopes
            .iter_mut()
            .for_each(|slope| slope.resize(state.len(), 0.0));
        let mut trial = state.clone();
        let evaluator = self.evaluator.get_mut();
        for pair in samples.windows(2) {
            let h = (pair[1] - pair[0]) / steps as f64;
            for step in 0..steps {
                let begin = pair[0] + step as f64 * h;
                // Half a step on, so that rounding of a sample's time does not decide.
                let inputs = inputs.at(begin + 0.5 * h);
                for (stage, at) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
                    trial.copy_from_slice(&state);
                    if stage > 0 {
                        let slope = &slopes[stage - 1];
                        trial
                            .iter_mut()
                            .zip(slope)
                            .for_each(|(x, k)| *x += at * h * k);
                    }
                    let point = Point {
                        t: begin + at * h,
                        state: &trial,
                        inputs,
                    };
                    evaluator.rates(point, &mut slopes[stage]);
                }
                for (place, x) in state.iter_mut().enumerate() {
                    let [a, b, c, d] = [0, 1, 2, 3].map(|stage: usize| slopes[stage][place]);
                    *x += h / 6.0 * (a + 2.0 * (b + c) + d);
                }
            }
            if state.iter().any(|x| !x.is_finite()) {
                return None;
            }
            states.push(state.clone());
        }
        Some(states)
    }

    /// The channels' quantities at states: a row per sample.
    fn shown(&mut self, times: &[f64], states: &[Vec<f64>], inputs: &HeldInputs) -> Vec<f64> {
        let mut values = Vec::with_capacity(times.len() * self.plant.outputs.len());
        for (t, state) in times.iter().zip(states) {
            self.show(*t, state, inputs, &mut values);
        }
        values
    }

    /// The channels' quantities at the samples of a motion that starts at the first of them.
    ///
    /// # Errors
    /// As [`Runner::states`].
    pub fn outputs(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Outputs, String> {
        let states = self.states(initial, samples, inputs)?;
        let values = self.shown(samples, &states, inputs);
        Ok(Outputs {
            values,
            last: states.into_iter().next_back().unwrap_or_default(),
        })
    }

    /// The channels' quantities and their derivatives by each initial state, if the exact
    /// propagator takes the motion: for each sample a row of derivatives per state, one number
    /// per channel. `steps`: over how much of each state a nonlinear observable is
    /// differentiated.
    pub fn tangents(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        steps: &[f64],
    ) -> Option<(Outputs, Vec<f64>)> {
        let span = (*samples.first()?, *samples.last()?);
        let count = initial.len();
        let unit = |place: usize| {
            (0..count)
                .map(|k| f64::from(u8::from(k == place)))
                .collect()
        };
        let directions: Vec<Vec<f64>> = (0..count).map(unit).collect();
        let propagator = self.propagator.as_mut()?;
        let found = propagator
            .neighbours(initial, span, samples, inputs, directions)
            .ok()?;
        let channels = self.plant.outputs.len();
        let mut outputs = Outputs::default();
        let mut derivatives = Vec::with_capacity(samples.len() * count * channels);
        let mut moved = vec![0.0; count];
        for ((t, state), tangents) in samples.iter().zip(&found.states).zip(&found.derivatives) {
            let here = outputs.values.len();
            self.show(*t, state, inputs, &mut outputs.values);
            for (tangent, step) in tangents.iter().zip(steps) {
                let sums = moved.iter_mut().zip(state).zip(tangent);
                sums.for_each(|((slot, x), d)| *slot = x + step * d);
                let there = derivatives.len();
                self.show(*t, &moved, inputs, &mut derivatives);
                for channel in 0..channels {
                    let difference = derivatives[there + channel] - outputs.values[here + channel];
                    derivatives[there + channel] = difference / step;
                }
            }
        }
        outputs.last = found.states.into_iter().next_back().unwrap_or_default();
        Some((outputs, derivatives))
    }

    /// Appends the channels' quantities at a state.
    fn show(&mut self, t: f64, state: &[f64], inputs: &HeldInputs, values: &mut Vec<f64>) {
        if !self.plant.shows_states_only() {
            self.observe(t, state, inputs);
        }
        values.extend(self.plant.outputs.iter().map(|output| match *output {
            Output::State(place) => state[place],
            Output::Observable(place) => self.observables[place],
        }));
    }

    fn observe(&mut self, t: f64, state: &[f64], inputs: &HeldInputs) {
        let point = Point {
            t,
            state,
            inputs: inputs.at(t),
        };
        let evaluator = self.evaluator.get_mut();
        evaluator.observables(point, &mut self.observables);
    }

    /// The accelerations' part of the rates at a state.
    pub fn rates(&mut self, t: f64, state: &[f64], inputs: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; state.len()];
        let point = Point { t, state, inputs };
        self.evaluator.get_mut().rates(point, &mut rates);
        rates
    }
}

/// A model as the general solver sees it.
struct Driven<'a> {
    evaluator: &'a RefCell<Evaluator>,
    inputs: &'a HeldInputs,
    states: usize,
}

impl Driven<'_> {
    fn point<'b>(&'b self, t: f64, state: &'b [f64]) -> Point<'b> {
        Point {
            t,
            state,
            inputs: self.inputs.at(t),
        }
    }
}

impl System for Driven<'_> {
    fn states(&self) -> usize {
        self.states
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let mut evaluator = self.evaluator.borrow_mut();
        evaluator.rates(self.point(t, y), out);
    }

    fn guard_count(&self) -> usize {
        self.evaluator.borrow().guard_count()
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let mut evaluator = self.evaluator.borrow_mut();
        evaluator.guards(self.point(t, y), out);
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.inputs.next_change(t)
    }
}
