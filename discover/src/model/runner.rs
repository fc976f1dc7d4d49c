//! A model at fixed parameters as it runs: marched where it has a linear part, propagated
//! from switch to switch where steps of one length would have to be too short, otherwise by
//! Runge-Kutta steps or a solver with error control. Measured quantities come along, and their
//! derivatives where neighbouring motions do.

use std::cell::RefCell;

use codegen::program::evaluator::{Evaluator, Point};
use eomgen_compiled_model::Driven;
use sim::inputs::HeldInputs;
use sim::ode::{Settings, simulate};
use sim::piecewise_linear::Propagator;

use crate::model::beside::Beside;
use crate::model::plant::{Output, Plant};
use sim::exponential::{Drives, ExponentialIntegrator, Force, Options, Tangents};
use sim::ode::runge_kutta::RungeKutta;

/// Relative error of one step of the general solver: far below any sensor's noise.
const TOLERANCE: f64 = 1e-7;

/// The most steps of the general solver in one window.
const MOST_STEPS: u64 = 400_000;

/// Quantities that are sums over states to this part of their size are linear.
const LINEAR: f64 = 1e-9;

/// Measured quantities as linear functions of the state.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// A row per channel.
    rows: Vec<Vec<f64>>,
    constant: Vec<f64>,
}

impl Shown {
    /// The quantities of a plant at an evaluator's parameters; none if they are not linear in
    /// the state, or depend on more than it.
    pub(crate) fn of(plant: &Plant, evaluator: &mut Evaluator) -> Option<Self> {
        let n = plant.state_count();
        let inputs = plant.model().inputs.len();
        let mut observables = vec![0.0; plant.observables()];
        let mut show = |t: f64, state: &[f64], inputs: &[f64]| -> Vec<f64> {
            if !plant.shows_states_only() {
                evaluator.observables(Point { t, state, inputs }, &mut observables);
            }
            let outputs = plant.outputs.iter();
            outputs
                .map(|output| match *output {
                    Output::State(place) => state[place],
                    Output::Observable(place) => observables[place],
                })
                .collect()
        };
        let constant = show(0.0, &vec![0.0; n], &vec![0.0; inputs]);
        let mut rows = vec![vec![0.0; n]; constant.len()];
        for place in 0..n {
            let mut state = vec![0.0; n];
            state[place] = 1.0;
            let values = show(0.0, &state, &vec![0.0; inputs]);
            for (row, (value, c)) in rows.iter_mut().zip(values.iter().zip(&constant)) {
                row[place] = value - c;
            }
        }
        let shown = Self { rows, constant };
        // Anywhere else, at another time and with other inputs, the sums must hold as well.
        for sign in [1.0, -0.3] {
            let state: Vec<f64> = (0..n).map(|k| sign * (0.7 + (k as f64).sin())).collect();
            let wanted = show(1.7, &state, &vec![0.9; inputs]);
            let mut found = Vec::new();
            shown.add_to(&state, &mut found);
            let pairs = wanted.iter().zip(&found);
            if !pairs
                .into_iter()
                .all(|(a, b)| (a - b).abs() <= LINEAR * (a.abs() + 1e-12))
            {
                return None;
            }
        }
        Some(shown)
    }

    /// Appends the quantities at a state.
    pub fn add_to(&self, state: &[f64], values: &mut Vec<f64>) {
        let pairs = self.rows.iter().zip(&self.constant);
        values.extend(pairs.map(|(row, c)| c + sum(row, state)));
    }

    /// Appends what the quantities of a tangent vector are.
    fn add_tangent(&self, vector: &[f64], values: &mut Vec<f64>) {
        values.extend(self.rows.iter().map(|row| sum(row, vector)));
    }
}

fn sum(row: &[f64], vector: &[f64]) -> f64 {
    row.iter().zip(vector).map(|(a, b)| a * b).sum()
}

/// A model at fixed parameters.
pub struct Runner<'p> {
    plant: &'p Plant,
    evaluator: RefCell<Evaluator>,
    observables: Vec<f64>,
    shown: Option<Shown>,
    pub(crate) march: Option<ExponentialIntegrator>,
    pub(crate) beside: Option<Beside>,
    propagator: Option<Propagator>,
}

/// A motion with neighbouring ones.
#[derive(Clone, Debug, Default)]
pub struct Linearised {
    /// The motion's own outputs.
    pub outputs: Outputs,
    /// The states at the samples.
    pub states: Vec<Vec<f64>>,
    /// For each sample a row of derivatives per initial state, one number per channel.
    pub by_state: Vec<f64>,
    /// The same for each drive.
    pub by_drive: Vec<f64>,
}

/// Outputs of a window: a row per sample, a number per channel; and the state at the end.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// Row by row.
    pub values: Vec<f64>,
    /// The state at the last sample.
    pub last: Vec<f64>,
}

impl<'p> Runner<'p> {
    pub(crate) fn new(plant: &'p Plant, evaluator: Evaluator, shown: Option<Shown>) -> Self {
        Self {
            plant,
            evaluator: RefCell::new(evaluator),
            observables: vec![0.0; plant.observables()],
            shown,
            march: None,
            beside: None,
            propagator: None,
        }
    }

    /// Takes a propagator for the motion, with the fastest switching it may follow, 1/s.
    pub(crate) fn propagate(&mut self, mut propagator: Propagator, fastest: f64) {
        propagator.max_switch_rate = fastest;
        self.propagator = Some(propagator);
    }

    /// Whether neighbouring motions come along.
    pub fn is_marched(&self) -> bool {
        self.march.is_some() && self.shown.is_some()
    }

    /// What it shows, where that is linear in the state.
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// The motion from an initial state with neighbouring ones, if it is marched: of every
    /// initial state, if `by_state`, and of so many differences of the accelerations.
    pub fn linearised(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        by_state: bool,
        (count, drives): (usize, &mut dyn Drives),
    ) -> Option<Linearised> {
        let shown = self.shown.as_ref()?;
        let march = self.march.as_mut()?;
        let n = initial.len();
        let mut tangents = Tangents::new(n, by_state, count, drives);
        let mut found = Linearised::default();
        let free = if by_state { n } else { 0 };
        let options = Options {
            force: self.beside.as_mut().map(|beside| beside as &mut dyn Force),
            tangents: Some(&mut tangents),
        };
        march
            .run(
                initial,
                samples,
                inputs,
                options,
                &mut |_, state, tangents| {
                    shown.add_to(state, &mut found.outputs.values);
                    found.states.push(state.to_vec());
                    let Some(tangents) = tangents else { return };
                    let vectors = tangents.vectors.chunks_exact(tangents.stride);
                    for (place, vector) in vectors.enumerate() {
                        let out = match place < free {
                            true => &mut found.by_state,
                            false => &mut found.by_drive,
                        };
                        shown.add_tangent(&vector[..n], out);
                    }
                },
            )
            .ok()?;
        found.outputs.last = found.states.last().cloned().unwrap_or_default();
        Some(found)
    }

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
        if let Some(march) = &mut self.march {
            let mut states = Vec::with_capacity(samples.len());
            let options = Options {
                force: self.beside.as_mut().map(|beside| beside as &mut dyn Force),
                tangents: None,
            };
            march.run(initial, samples, inputs, options, &mut |_, state, _| {
                states.push(state.to_vec());
            })?;
            return Ok(states);
        }
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
            max_switch_rate: crate::model::plant::FASTEST_SWITCHING,
            ..Settings::with_tolerance(TOLERANCE)
        };
        let driven = Driven::new(&self.evaluator, inputs);
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
        let mut method = RungeKutta::new(state.len());
        let evaluator = self.evaluator.get_mut();
        for pair in samples.windows(2) {
            let h = (pair[1] - pair[0]) / steps as f64;
            for step in 0..steps {
                let begin = pair[0] + step as f64 * h;
                // Half a step on, so that rounding of a sample's time does not decide.
                let inputs = inputs.at(begin + 0.5 * h);
                method.step(&mut state, (begin, h), |_, t, state, rates| {
                    evaluator.rates(Point { t, state, inputs }, rates);
                });
            }
            if state.iter().any(|x| !x.is_finite()) {
                return None;
            }
            states.push(state.clone());
        }
        Some(states)
    }

    /// The channels' quantities at states: a row per sample.
    fn all_shown(&mut self, times: &[f64], states: &[Vec<f64>], inputs: &HeldInputs) -> Vec<f64> {
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
        let values = self.all_shown(samples, &states, inputs);
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
        if let Some(shown) = &self.shown {
            shown.add_to(state, values);
            return;
        }
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
