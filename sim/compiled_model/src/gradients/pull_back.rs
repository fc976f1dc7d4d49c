//! Backward pass along a recorded motion.

use eomgen_sim::ode::{RepeatedStep, SurfaceMode};

use super::derivatives::Derivatives;
use super::mode_evaluator::ModeEvaluator;
use super::recorder::{Part, PartKind};
use super::{RecordedMotion, SampleWeights, TrajectoryGradient};
use crate::error::Error;
use crate::evaluation::prepare_evaluator;

/// Returns the gradient of a number from its derivatives with respect to the samples.
pub(super) fn pull_back(
    recorded: &RecordedMotion<'_>,
    weights: &SampleWeights,
) -> Result<TrajectoryGradient, Error> {
    check_weights(recorded, weights)?;
    let mut pass = BackwardPass::new(recorded)?;
    pass.measure_surfaces()?;
    for place in (0..recorded.recording.parts.len()).rev() {
        let part = &recorded.recording.parts[place];
        match part.kind {
            PartKind::Step => pass.propagate_over_step(place, weights)?,
            PartKind::Crossing | PartKind::Jump => pass.propagate_over_event(place)?,
        }
        let sums = pass.adjoint.iter().chain(&pass.parameters);
        if sums.into_iter().any(|number| !number.is_finite()) {
            return Err(no_gradient(part.start.0, "a derivative is not finite"));
        }
    }
    pass.finish(weights)
}

pub(super) fn no_gradient(t: f64, cause: &str) -> Error {
    Error::Request(format!(
        "no gradient of the trajectory: at t = {t:?} s, {cause}"
    ))
}

fn check_weights(recorded: &RecordedMotion<'_>, weights: &SampleWeights) -> Result<(), Error> {
    let trajectory = &recorded.motion.trajectory;
    let observables = recorded.instance.model().program().observables.len();
    for (what, rows, width) in [
        ("states", &weights.states, recorded.initial.len()),
        ("observables", &weights.observables, observables),
    ] {
        if rows.is_empty() {
            continue;
        }
        if rows.len() != trajectory.times.len() || rows.iter().any(|row| row.len() != width) {
            return Err(Error::Request(format!(
                "expected {} rows of {width} weights for {what}, one row for each sample",
                trajectory.times.len()
            )));
        }
        if rows.iter().flatten().any(|weight| !weight.is_finite()) {
            return Err(Error::Request(format!(
                "a weight of the {what} is not finite"
            )));
        }
    }
    Ok(())
}

/// State of a backward pass that starts at the end of a motion.
pub(super) struct BackwardPass<'r, 'm> {
    pub recorded: &'r RecordedMotion<'m>,
    pub evaluator: ModeEvaluator,
    step: RepeatedStep,
    /// Derivatives with respect to the state at the current time.
    pub adjoint: Vec<f64>,
    pub parameters: Vec<f64>,
    /// Derivatives with respect to the inputs, one row per sample of the inputs.
    pub inputs: Vec<Vec<f64>>,
    /// Derivatives of one stage of a step.
    products: Derivatives,
    /// Number of samples before the current time.
    samples: usize,
    /// Largest magnitudes of the functions of all surfaces, and of their rates.
    pub surface_sizes: Vec<(f64, f64)>,
    /// Largest magnitudes of the rates.
    pub rate_sizes: Vec<f64>,
}

impl<'r, 'm> BackwardPass<'r, 'm> {
    fn new(recorded: &'r RecordedMotion<'m>) -> Result<Self, Error> {
        let instance = &recorded.instance;
        let program = instance.model().gradient_program()?;
        let evaluator = prepare_evaluator(
            &program.program,
            program.machine_code(),
            instance.parameters(),
        );
        let evaluator = ModeEvaluator::new(evaluator)?;
        let products = evaluator.zeros();
        let model_inputs = instance.model().model().inputs.len();
        Ok(Self {
            step: RepeatedStep::new(recorded.initial.len()),
            adjoint: vec![0.0; recorded.initial.len()],
            parameters: products.parameters.clone(),
            inputs: vec![vec![0.0; model_inputs]; recorded.inputs().times().len()],
            samples: recorded.motion.trajectory.times.len(),
            surface_sizes: vec![(0.0, 0.0); evaluator.surface_count()],
            rate_sizes: vec![0.0; recorded.initial.len()],
            products,
            evaluator,
            recorded,
        })
    }

    pub fn part(&self, place: usize) -> &'r Part {
        &self.recorded.recording.parts[place]
    }

    /// Returns the time (s) at which the inputs of a part are evaluated: `t`, limited to times before the next change
    /// of the inputs.
    pub fn clip(&self, part: &Part, t: f64) -> f64 {
        clip_before(self.recorded.inputs().next_change(part.start.0), t)
    }

    /// Propagates the adjoint backwards over a step, including the samples inside it.
    fn propagate_over_step(&mut self, place: usize, weights: &SampleWeights) -> Result<(), Error> {
        let part = self.part(place);
        self.evaluator.set_modes(&part.modes);
        let times = &self.recorded.motion.trajectory.times;
        let (start, end) = (part.start.0, part.end.0);
        let mut at_start = vec![0.0; self.adjoint.len()];
        while self.samples > 0 && times[self.samples - 1] > start {
            let sample = self.samples - 1;
            self.samples = sample;
            let t = times[sample];
            if t >= end {
                let by_state = self.propagate_over_sample(sample, part, &part.end.1, weights)?;
                add(&mut self.adjoint, &by_state);
                continue;
            }
            self.repeat(part, t - start)?;
            let state = self.step.end().to_vec();
            let mut inside = self.propagate_over_sample(sample, part, &state, weights)?;
            if inside.iter().any(|number| *number != 0.0) {
                self.pull_back_step(part, &mut inside)?;
                add(&mut at_start, &inside);
            }
        }
        if self.adjoint.iter().any(|number| *number != 0.0) {
            self.repeat(part, end - start)?;
            let mut adjoint = std::mem::take(&mut self.adjoint);
            self.pull_back_step(part, &mut adjoint)?;
            self.adjoint = adjoint;
        }
        add(&mut self.adjoint, &at_start);
        Ok(())
    }

    /// Repeats the step of a part, with `length` s.
    fn repeat(&mut self, part: &Part, length: f64) -> Result<(), Error> {
        let inputs = self.recorded.inputs();
        let change = self.recorded.inputs().next_change(part.start.0);
        let evaluator = &mut self.evaluator;
        let start = (part.start.0, &part.start.1[..]);
        self.step.compute(start, length, |t, state, out| {
            let t = clip_before(change, t);
            evaluator.write_rates((t, state), &inputs.evaluate(t), out)
        })
    }

    /// Converts the derivatives with respect to the end of the repeated step into derivatives with respect to its
    /// start.
    fn pull_back_step(&mut self, part: &Part, adjoint: &mut [f64]) -> Result<(), Error> {
        let inputs = self.recorded.inputs();
        let change = inputs.next_change(part.start.0);
        let row = &mut self.inputs[inputs.last_sample_index(part.start.0)];
        let (evaluator, products) = (&mut self.evaluator, &mut self.products);
        let parameters = &mut self.parameters;
        self.step.pull_back(adjoint, |t, state, weights, out| {
            let t = clip_before(change, t);
            let given = inputs.evaluate(t);
            evaluator.pull_back_rates((t, state), &given, weights, products)?;
            out.copy_from_slice(&products.state);
            add(parameters, &products.parameters);
            add(row, &products.inputs);
            Ok(())
        })
    }

    /// Adds the derivatives of a sample with respect to parameters and inputs, and returns those with respect to its
    /// state.
    fn propagate_over_sample(
        &mut self,
        sample: usize,
        part: &Part,
        state: &[f64],
        weights: &SampleWeights,
    ) -> Result<Vec<f64>, Error> {
        let given = weights.states.get(sample).cloned();
        let mut by_state = given.unwrap_or_else(|| vec![0.0; state.len()]);
        let Some(weights) = weights.observables.get(sample) else {
            return Ok(by_state);
        };
        if weights.iter().all(|weight| *weight == 0.0) {
            return Ok(by_state);
        }
        let inputs = self.recorded.inputs();
        let t = self.recorded.motion.trajectory.times[sample];
        let values = inputs.evaluate(t);
        self.evaluator.set_modes(&part.modes);
        let sum = self
            .evaluator
            .pull_back_observables((t, state), &values, weights)?;
        add(&mut by_state, &sum.state);
        add(&mut self.parameters, &sum.parameters);
        add(&mut self.inputs[inputs.last_sample_index(t)], &sum.inputs);
        Ok(by_state)
    }

    /// Adds the samples at the start and returns the gradient.
    fn finish(mut self, weights: &SampleWeights) -> Result<TrajectoryGradient, Error> {
        let recorded = self.recorded;
        while let (Some(sample), Some(first)) = (
            self.samples.checked_sub(1),
            recorded.recording.parts.first(),
        ) {
            self.samples = sample;
            let by_state = self.propagate_over_sample(sample, first, &recorded.initial, weights)?;
            add(&mut self.adjoint, &by_state);
        }
        self.propagate_to_requested_start()?;
        self.propagate_over_corrections()?;
        let first = recorded.recording.parts.first();
        let is_held = first.is_some_and(|first| first.modes.contains(&SurfaceMode::Held));
        for row in &mut self.inputs {
            for (place, slot) in row.iter_mut().enumerate() {
                if !recorded.inputs().is_held(place) {
                    *slot = f64::NAN;
                }
            }
        }
        Ok(TrajectoryGradient {
            initial_state: (!is_held).then_some(self.adjoint),
            parameters: self.parameters,
            inputs: self.inputs,
        })
    }
}

fn clip_before(change: Option<f64>, t: f64) -> f64 {
    match change {
        Some(change) if t >= change => change.next_down(),
        _ => t,
    }
}

pub(super) fn add(sums: &mut [f64], parts: &[f64]) {
    add_product(sums, 1.0, parts);
}

/// Adds `factor` times `parts` to `sums`.
pub(super) fn add_product(sums: &mut [f64], factor: f64, parts: &[f64]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        *sum += factor * part;
    }
}
