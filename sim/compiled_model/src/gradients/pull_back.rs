//! The way back along a recorded motion.

use eomgen_sim::ode::{RepeatedStep, SurfaceMode};

use super::derivatives::Derivatives;
use super::mode_evaluator::ModeEvaluator;
use super::recorder::Part;
use super::{RecordedMotion, SampleWeights, TrajectoryGradient};
use crate::error::Error;
use crate::evaluation::prepare_evaluator;

/// Largest jump of a rate over a surface, relative to its largest magnitude over the motion, that counts as none: at a
/// kink the rates differ only by the change over the location of the event.
const MAX_KINK_JUMP_FRACTION: f64 = 1e-9;

/// Largest relative difference of delays that belong to one surface, written twice.
const MAX_DELAY_DIFFERENCE_FRACTION: f64 = 1e-6;

/// Distance from a surface, in tolerances of its function, that counts as a contact.
const MAX_TOUCH_TOLERANCES: f64 = 10.0;

/// Returns the gradient of a number with these derivatives by the samples.
pub(super) fn pull_back(
    recorded: &RecordedMotion<'_>,
    weights: &SampleWeights,
) -> Result<TrajectoryGradient, Error> {
    check_weights(recorded, weights)?;
    let mut way = WayBack::new(recorded)?;
    way.measure_surfaces()?;
    for place in (0..recorded.recording.parts.len()).rev() {
        let part = &recorded.recording.parts[place];
        match part.is_event {
            true => way.follow_event(place)?,
            false => way.follow_step(place, weights)?,
        }
        let sums = way.adjoint.iter().chain(&way.parameters);
        if sums.into_iter().any(|number| !number.is_finite()) {
            return Err(no_gradient(part.start.0, "a derivative is not finite"));
        }
    }
    way.finish(weights)
}

fn no_gradient(t: f64, cause: &str) -> Error {
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

/// The way back from the end of a motion, and the derivatives so far.
struct WayBack<'r, 'm> {
    recorded: &'r RecordedMotion<'m>,
    evaluator: ModeEvaluator,
    step: RepeatedStep,
    /// Derivatives by the state at the present time.
    adjoint: Vec<f64>,
    parameters: Vec<f64>,
    /// Derivatives by the inputs, one row for each of their samples.
    inputs: Vec<Vec<f64>>,
    /// Products of one stage.
    products: Derivatives,
    /// Number of samples before the present time.
    samples: usize,
    /// Largest magnitudes of the switching functions and of their rates.
    guard_sizes: Vec<(f64, f64)>,
    /// Largest magnitudes of the rates.
    rate_sizes: Vec<f64>,
}

impl<'r, 'm> WayBack<'r, 'm> {
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
            guard_sizes: vec![(0.0, 0.0); evaluator.guard_count()],
            rate_sizes: vec![0.0; recorded.initial.len()],
            products,
            evaluator,
            recorded,
        })
    }

    fn part(&self, place: usize) -> &'r Part {
        &self.recorded.recording.parts[place]
    }

    /// Measures rates and switching functions over the motion, and rejects motions that touch a surface.
    fn measure_surfaces(&mut self) -> Result<(), Error> {
        let recorded = self.recorded;
        let count = self.evaluator.guard_count();
        let (mut values, mut rates) = (vec![0.0; count], vec![0.0; count]);
        let mut state_rates = vec![0.0; self.rate_sizes.len()];
        let mut ends = Vec::new();
        for part in &recorded.recording.parts {
            self.evaluator.set_modes(&part.modes);
            for (t, state) in [&part.start, &part.end] {
                let given = recorded.inputs().evaluate(self.clip(part, *t));
                let at = (*t, &state[..]);
                self.evaluator.write_rates(at, &given, &mut state_rates)?;
                for (size, rate) in self.rate_sizes.iter_mut().zip(&state_rates) {
                    *size = size.max(rate.abs());
                }
                let out = (&mut values[..], &mut rates[..]);
                self.evaluator.write_guards(at, &given, out)?;
                for (size, (value, rate)) in
                    self.guard_sizes.iter_mut().zip(values.iter().zip(&rates))
                {
                    *size = (size.0.max(value.abs()), size.1.max(rate.abs()));
                }
            }
            ends.push(values.clone());
        }
        let allowed = MAX_TOUCH_TOLERANCES * recorded.tolerance;
        for (place, values) in ends.iter().enumerate() {
            let (part, next) = (self.part(place), recorded.recording.parts.get(place + 1));
            if part.is_event || next.is_some_and(|next| next.is_event) {
                continue;
            }
            for (guard, value) in values.iter().enumerate() {
                let is_free = matches!(
                    part.modes[guard],
                    SurfaceMode::Positive | SurfaceMode::Negative
                );
                let is_near = value.abs() <= allowed * self.guard_sizes[guard].0;
                if is_free && is_near && self.rates_jump(part, guard)? {
                    return Err(self.touches(part.end.0, guard));
                }
            }
        }
        self.check_start()
    }

    /// Rejects motions that start on a surface on which the rates jump, unless it holds them.
    fn check_start(&mut self) -> Result<(), Error> {
        let Some(first) = self.recorded.recording.parts.first() else {
            return Ok(());
        };
        for (guard, mode) in first.modes.iter().enumerate() {
            if *mode == SurfaceMode::Unknown && self.rates_jump(first, guard)? {
                return Err(self.touches(first.start.0, guard));
            }
        }
        Ok(())
    }

    fn touches(&self, t: f64, guard: usize) -> Error {
        let surface = self.formula(guard);
        no_gradient(
            t,
            &format!(
                "the motion touches the surface `{surface}` = 0, where a neighbouring motion may or may not cross it"
            ),
        )
    }

    fn formula(&self, guard: usize) -> &'r str {
        let surface = self.recorded.motion.surfaces.get(guard);
        surface.map_or("", |surface| &surface.formula)
    }

    /// Returns true if the rates differ on the sides of a surface at the end of a part.
    fn rates_jump(&mut self, part: &Part, guard: usize) -> Result<bool, Error> {
        let (t, state) = (part.end.0, &part.end.1[..]);
        let given = self.recorded.inputs().evaluate(self.clip(part, t));
        let mut sides = [(); 2].map(|()| vec![0.0; state.len()]);
        for (side, out) in [0.0, 1.0].into_iter().zip(&mut sides) {
            self.evaluator.set_modes(&part.modes);
            if !self.evaluator.set_side(guard, side) {
                return Ok(false);
            }
            self.evaluator.write_rates((t, state), &given, out)?;
        }
        let [from, to] = sides;
        Ok(!self.is_kink(&from, &to))
    }

    /// Returns true if rates on both sides of a surface are equal up to the change over its location.
    fn is_kink(&self, from: &[f64], to: &[f64]) -> bool {
        let mut pairs = from.iter().zip(to).zip(&self.rate_sizes);
        pairs.all(|((from, to), size)| (to - from).abs() <= MAX_KINK_JUMP_FRACTION * size)
    }

    /// Returns the time (s) of an evaluation during a part: before the next change of the inputs.
    fn clip(&self, part: &Part, t: f64) -> f64 {
        clip_before(self.recorded.inputs().next_change(part.start.0), t)
    }

    /// Follows a step backwards, with the samples inside it.
    fn follow_step(&mut self, place: usize, weights: &SampleWeights) -> Result<(), Error> {
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
                let by_state = self.follow_sample(sample, part, &part.end.1, weights)?;
                add(&mut self.adjoint, &by_state);
                continue;
            }
            self.repeat(part, t - start)?;
            let state = self.step.end().to_vec();
            let mut inside = self.follow_sample(sample, part, &state, weights)?;
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

    /// Computes the step of a part, of `length` s, again.
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

    /// Replaces the derivatives by the end of the repeated step by those by its start.
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

    /// Adds the derivatives of a sample by parameters and inputs, and returns those by its state.
    fn follow_sample(
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

    /// Follows an event backwards, by the transposed saltation matrix.
    fn follow_event(&mut self, place: usize) -> Result<(), Error> {
        let recorded = self.recorded;
        let part = self.part(place);
        let after = recorded.recording.modes_after(place);
        let (near, beyond) = (&part.start, &part.end);
        let given = recorded.inputs().evaluate(self.clip(part, near.0));
        let count = self.evaluator.guard_count();
        let (mut values, mut rates) = (vec![0.0; count], vec![0.0; count]);
        let (mut from, mut to) = (vec![0.0; near.1.len()], vec![0.0; near.1.len()]);
        self.evaluator.set_modes(after);
        self.evaluator
            .write_rates((beyond.0, &beyond.1), &given, &mut to)?;
        self.evaluator.set_modes(&part.modes);
        let at = (near.0, &near.1[..]);
        self.evaluator.write_rates(at, &given, &mut from)?;
        if self.is_kink(&from, &to) {
            return Ok(());
        }
        self.evaluator
            .write_guards(at, &given, (&mut values, &mut rates))?;
        // The jump of the rates, weighted.
        let jump: f64 = (to.iter().zip(&from).zip(&self.adjoint))
            .map(|((to, from), weight)| (to - from) * weight)
            .sum();
        let mut delay: Option<Derivatives> = None;
        for guard in 0..count {
            if part.modes[guard] == after[guard] {
                continue;
            }
            if part.modes[guard] == SurfaceMode::Held {
                return Err(no_gradient(
                    near.0,
                    &format!(
                        "the rates jump where the surface `{}` = 0 releases the motion",
                        self.formula(guard)
                    ),
                ));
            }
            let fastest = self.guard_sizes[guard].1;
            if rates[guard].abs() <= recorded.tolerance.sqrt() * fastest {
                return Err(self.touches(near.0, guard));
            }
            let mut own = self.evaluator.zeros();
            let derivative = self.evaluator.differentiate_guard(at, &given, guard)?;
            own.add(-1.0 / rates[guard], &derivative);
            match &delay {
                None => delay = Some(own),
                Some(first) if are_equal(first, &own) => {}
                Some(_) => {
                    return Err(no_gradient(
                        near.0,
                        "the motion crosses several switching surfaces at once",
                    ));
                }
            }
        }
        let Some(delay) = delay else {
            return Err(no_gradient(
                near.0,
                "the rates jump without a change of a mode",
            ));
        };
        let row = recorded.inputs().last_sample_index(near.0);
        for (sums, parts) in [
            (&mut self.adjoint, &delay.state),
            (&mut self.parameters, &delay.parameters),
            (&mut self.inputs[row], &delay.inputs),
        ] {
            sums.iter_mut()
                .zip(parts)
                .for_each(|(sum, part)| *sum -= jump * part);
        }
        Ok(())
    }

    /// Adds the samples at the start, and returns the gradient.
    fn finish(mut self, weights: &SampleWeights) -> Result<TrajectoryGradient, Error> {
        let recorded = self.recorded;
        while let (Some(sample), Some(first)) = (
            self.samples.checked_sub(1),
            recorded.recording.parts.first(),
        ) {
            self.samples = sample;
            let by_state = self.follow_sample(sample, first, &recorded.initial, weights)?;
            add(&mut self.adjoint, &by_state);
        }
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

fn are_equal(first: &Derivatives, second: &Derivatives) -> bool {
    let pairs = [
        (&first.state, &second.state),
        (&first.inputs, &second.inputs),
        (&first.parameters, &second.parameters),
    ];
    pairs.iter().all(|(first, second)| {
        first.iter().zip(*second).all(|(first, second)| {
            (first - second).abs() <= MAX_DELAY_DIFFERENCE_FRACTION * first.abs()
        })
    })
}

fn add(sums: &mut [f64], parts: &[f64]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        *sum += part;
    }
}
