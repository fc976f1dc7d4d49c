//! Simulation of a model with fixed parameters. A model with a linear part is simulated by the
//! exponential integrator, or by exact propagation between switches if fixed steps would be too
//! short. Other models are simulated by Runge-Kutta steps or by a solver with error control. A
//! given motion is read from the records. Outputs are computed with the motion, and derivatives
//! with tangent vectors.
//!
//! With constraints, a motion starts at the projection of the requested state onto the constraints.
//! A difference quotient with respect to an initial state then contains the derivative of the
//! projection and is 0 along forbidden directions. Runge-Kutta steps are projected at each sample.
//! Between samples the constraint residual is smaller than the error of a step, which is a small
//! fraction of the noise. Unlike a stabilising term, the projection does not change the eigenvalues
//! of the motion or the maximum step, and measured accelerations contain no residual.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_compiled_model::{DrivenModel, Projection, SidedModel, StickingMotion};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, Settings, SolveError, Trajectory, simulate_into};
use eomgen_sim::piecewise_linear::Propagator;
use nalgebra::DMatrix;

use crate::error::SimulationError;
use crate::model::allowed_directions::{differentiate_projection, find_allowed_directions};
use crate::model::given_motion::GivenMotion;
use crate::model::linear_outputs::LinearOutputs;
use crate::model::longest_step::LongestStep;
use crate::model::measured_outputs::{MeasuredOutputs, OutputBuffers};
use crate::model::nonlinear_remainder::NonlinearRemainder;
use crate::model::stop::StopRequest;
use crate::model::work::WorkLimit;
use crate::thresholds;
use eomgen_sim::exponential::{
    Directions, DrivingAccelerations, ExponentialIntegrator, Force, MovedParameters, Options,
};
use eomgen_sim::ode::runge_kutta::RungeKutta;

/// Simulation of a model with fixed parameters.
pub struct Simulation<'m> {
    measured: &'m MeasuredOutputs,
    /// Typical sizes of the states, for the solver.
    typical_sizes: &'m [f64],
    evaluator: RefCell<Evaluator>,
    buffers: OutputBuffers,
    linear_outputs: Option<LinearOutputs>,
    /// Maximum Runge-Kutta step; `None` if a solver with error control is used.
    longest_step: Option<LongestStep>,
    integrator: Option<ExponentialIntegrator>,
    remainder: Option<NonlinearRemainder>,
    propagator: Option<Propagator>,
    /// Sticking surfaces, such as dry friction, for the solver.
    sided: Option<SidedModel>,
    /// Sticking surfaces for measured accelerations.
    resting: Option<SidedModel>,
    /// Inverse dynamics, if the motion is given.
    given: Option<GivenMotion>,
    /// Projection onto the constraints.
    constraints: Option<Projection>,
    /// Maximum number of steps of the solver with error control in one motion.
    most_steps: u64,
    /// Stop request that ends simulations.
    pub(crate) stop: StopRequest,
    /// Number of evaluations in simulations, and its limit.
    pub(crate) work: WorkLimit,
}

/// Drives of tangent vectors: differences of accelerations.
pub struct TangentDrives<'d> {
    /// Number of drives.
    pub count: usize,
    /// Differences of accelerations along a motion.
    pub drives: &'d mut dyn DrivingAccelerations,
}

/// Motion with tangent vectors.
#[derive(Clone, Debug, Default)]
pub struct LinearisedMotion {
    /// Outputs of the motion.
    pub outputs: Outputs,
    /// States at the samples.
    pub states: Vec<Vec<f64>>,
    /// Derivatives with respect to the initial states: for each sample one row per state, with one
    /// number per channel.
    pub by_state: Vec<f64>,
    /// Derivatives with respect to each parameter, then each drive, in the layout of `by_state`.
    pub by_parameter_and_drive: Vec<f64>,
}

/// Motion and its outputs.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// State at each sample.
    pub states: Vec<Vec<f64>>,
    /// Channel values: one row per sample, one number per channel.
    pub outputs: Vec<f64>,
}

/// Outputs and final state of a window.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    /// Channel values: one row per sample, one number per channel.
    pub values: Vec<f64>,
    /// State at the last sample.
    pub end_state: Vec<f64>,
}

/// Outputs of a window and their derivatives with respect to its initial state.
#[derive(Clone, Debug, Default)]
pub struct OutputTangents {
    /// Outputs of the motion.
    pub outputs: Outputs,
    /// Derivatives: for each sample one row per initial state, with one number per channel.
    pub by_state: Vec<f64>,
}

impl<'m> Simulation<'m> {
    /// Creates a simulation by Runge-Kutta steps, or by a solver with error control if no step size
    /// is given.
    pub(crate) fn new(
        (measured, typical_sizes): (&'m MeasuredOutputs, &'m [f64]),
        evaluator: Evaluator,
        linear_outputs: Option<LinearOutputs>,
        longest_step: Option<LongestStep>,
    ) -> Self {
        Self {
            measured,
            typical_sizes,
            evaluator: RefCell::new(evaluator),
            buffers: measured.create_buffers(),
            linear_outputs,
            longest_step,
            integrator: None,
            remainder: None,
            propagator: None,
            sided: None,
            resting: None,
            given: None,
            constraints: None,
            most_steps: thresholds::MAX_SOLVER_STEPS,
            stop: StopRequest::default(),
            work: WorkLimit::default(),
        }
    }

    /// Selects an integrator for the linear part, with a nonlinear remainder.
    pub(crate) fn use_integrator(
        &mut self,
        integrator: ExponentialIntegrator,
        remainder: Option<NonlinearRemainder>,
    ) {
        self.integrator = Some(integrator);
        self.remainder = remainder;
    }

    /// Selects an exact propagator.
    pub(crate) fn use_propagator(&mut self, mut propagator: Propagator) {
        propagator.max_switch_rate = thresholds::MAX_SWITCHES_PER_SECOND;
        self.propagator = Some(propagator);
    }

    /// Adds sticking surfaces. A solver with error control is then used, because fixed steps do not
    /// handle them.
    pub(crate) fn use_sticking(&mut self, sided: SidedModel) {
        self.sided = Some(sided);
        self.longest_step = None;
    }

    /// Adds sticking surfaces for the computation of measured accelerations.
    pub(crate) fn measure_sticking(&mut self, sided: Option<SidedModel>) {
        self.resting = sided.filter(SidedModel::can_hold_motion);
    }

    /// Uses the motion of the records instead of a simulation.
    pub(crate) fn use_given_motion(&mut self, given: GivenMotion) {
        self.given = Some(given);
    }

    /// Adds the constraints of the model.
    pub(crate) fn use_constraints(&mut self, constraints: Option<Projection>) {
        self.constraints = constraints;
    }

    /// Returns the state on the constraints that is nearest to a state at a time (s), in the norm
    /// of the kinetic energy. Without constraints, returns the state itself.
    ///
    /// # Errors
    ///
    /// No near state satisfies the constraints.
    pub fn move_onto_constraints(
        &self,
        state: &[f64],
        t: f64,
        inputs: &HeldInputs,
    ) -> Result<Vec<f64>, SimulationError> {
        let mut found = state.to_vec();
        if let Some(constraints) = &self.constraints {
            let evaluator = &mut self.evaluator.borrow_mut();
            let evaluations = constraints
                .move_onto_constraints(evaluator, (t, &inputs.evaluate(t)), &mut found)
                .ok_or(SimulationError::OffConstraints)?;
            self.work.add(evaluations);
        }
        Ok(found)
    }

    /// Returns independent directions of an initial state, one per column: all states, or with
    /// constraints a basis of the changes that satisfy them, in ranges of the states. `None` if the
    /// state does not satisfy the constraints.
    pub(crate) fn find_initial_directions(
        &self,
        state: &[f64],
        (t, inputs): (f64, &HeldInputs),
        ranges: &[f64],
    ) -> Option<DMatrix<f64>> {
        let derivative = self.differentiate_projection(state, (t, inputs), ranges)?;
        match self.has_constraints() {
            true => find_allowed_directions(&derivative, ranges),
            false => Some(derivative),
        }
    }

    /// Returns the derivatives of the projection onto the constraints at a state, in ranges of the
    /// states. Without constraints, the identity. `None` if the state does not satisfy the
    /// constraints.
    pub(crate) fn differentiate_projection(
        &self,
        state: &[f64],
        (t, inputs): (f64, &HeldInputs),
        ranges: &[f64],
    ) -> Option<DMatrix<f64>> {
        if !self.has_constraints() {
            return Some(DMatrix::identity(state.len(), state.len()));
        }
        let mut project = |moved: &[f64]| self.move_onto_constraints(moved, t, inputs).ok();
        differentiate_projection(state, ranges, &mut project)
    }

    /// Returns true if the model has constraints.
    pub(crate) fn has_constraints(&self) -> bool {
        self.constraints.is_some()
    }

    /// Limits the number of solver steps and of switches. A motion that exceeds the limit fails.
    pub fn limit_steps(&mut self, most: usize) {
        self.most_steps = most as u64;
        if let Some(integrator) = &mut self.integrator {
            integrator.limit_crossings(most);
        }
    }

    /// Returns true if the exponential integrator is used.
    pub(crate) fn uses_integrator(&self) -> bool {
        self.integrator.is_some()
    }

    /// Returns true if tangent vectors are available.
    pub fn has_tangents(&self) -> bool {
        self.integrator.is_some() && self.linear_outputs.is_some()
    }

    /// Returns true if derivatives with respect to parameters are exact, because the whole model is
    /// linear between switches.
    pub(crate) fn has_exact_derivatives(&self) -> bool {
        self.has_tangents() && self.remainder.is_none()
    }

    /// Returns the outputs if they are linear in the state.
    pub fn linear_outputs(&self) -> Option<&LinearOutputs> {
        self.linear_outputs.as_ref()
    }

    /// Selects the parameters for derivatives; for each of them, the model values on both sides.
    /// `own`: values of the model, whose parameters are all in its linear part.
    pub(crate) fn differentiate_by(&mut self, own: &[f64], moved: Vec<Vec<MovedParameters>>) {
        if let Some(integrator) = &mut self.integrator {
            integrator.set_moved_parameters(own, moved);
        }
    }

    /// Simulates a motion with tangent vectors, if available: for each initial state if `by_state`,
    /// for the given number of parameters, and for the drives.
    pub fn simulate_with_tangents(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        (by_state, by_parameter): (bool, usize),
        driven: TangentDrives<'_>,
    ) -> Option<LinearisedMotion> {
        self.check_may_simulate().ok()?;
        let linear_outputs = self.linear_outputs.as_ref()?;
        let integrator = self.integrator.as_mut()?;
        let n = initial.len();
        let mut tangents = integrator.create_tangents(
            Directions {
                has_state_vectors: by_state,
                parameter_count: by_parameter,
                driven_count: driven.count,
            },
            driven.drives,
        );
        let mut found = LinearisedMotion::default();
        let free = if by_state { n } else { 0 };
        let vectors = free + by_parameter + driven.count;
        self.work.add((samples.len() * (1 + vectors)) as u64);
        let options = Options {
            force: self.remainder.as_mut().map(|force| force as &mut dyn Force),
            tangents: Some(&mut tangents),
        };
        integrator
            .simulate(
                initial,
                samples,
                inputs,
                options,
                &mut |_, state, tangents| {
                    linear_outputs.append(state, &mut found.outputs.values);
                    found.states.push(state.to_vec());
                    let Some(tangents) = tangents else { return };
                    let vectors = tangents.vectors.chunks_exact(tangents.stride);
                    for (number, vector) in vectors.enumerate() {
                        let out = match number < free {
                            true => &mut found.by_state,
                            false => &mut found.by_parameter_and_drive,
                        };
                        linear_outputs.append_derivatives(&vector[..n], out);
                    }
                },
            )
            .ok()?;
        found.outputs.end_state = found.states.last().cloned().unwrap_or_default();
        Some(found)
    }

    /// Returns an error if a stop was requested or the limit on work is reached.
    fn check_may_simulate(&self) -> Result<(), SimulationError> {
        if self.stop.is_requested() {
            return Err(SimulationError::Stopped);
        }
        match self.work.is_exceeded() {
            true => Err(SimulationError::TooMuchWork),
            false => Ok(()),
        }
    }

    /// Returns the states at the samples (s, ascending) of a motion that starts at the first
    /// sample.
    ///
    /// # Errors
    ///
    /// The reason why the simulation failed.
    pub fn simulate_states(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Vec<Vec<f64>>, SimulationError> {
        let (Some(begin), Some(end)) = (samples.first(), samples.last()) else {
            return Ok(Vec::new());
        };
        let span = (*begin, *end);
        self.check_may_simulate()?;
        if let Some(given) = &self.given {
            let state = |t: &f64| Some(given.state_of_row(inputs.last_sample(*t))?.to_vec());
            let states: Option<Vec<Vec<f64>>> = samples.iter().map(state).collect();
            return states.ok_or(SimulationError::StateNotRecorded);
        }
        if let Some(integrator) = &mut self.integrator {
            let mut states = Vec::with_capacity(samples.len());
            self.work.add(samples.len() as u64);
            let options = Options {
                force: self.remainder.as_mut().map(|force| force as &mut dyn Force),
                tangents: None,
            };
            let run = integrator.simulate(initial, samples, inputs, options, &mut |_, state, _| {
                states.push(state.to_vec());
            });
            return run.map(|()| states).map_err(SimulationError::Integrator);
        }
        if let Some(propagator) = &mut self.propagator {
            let trajectory = propagator.simulate(initial, span, samples, inputs, &mut |_| {});
            if let Ok(trajectory) = trajectory {
                self.work.add(trajectory.statistics.steps);
                return Ok(trajectory.states);
            }
        }
        let initial = &self.move_onto_constraints(initial, *begin, inputs)?;
        if let Some(longest_step) = self.longest_step {
            return self.integrate_by_runge_kutta(initial, samples, inputs, longest_step);
        }
        self.integrate_with_error_control(initial, samples, inputs)
    }

    /// Returns the states at the samples by solvers with error control. If the explicit solver
    /// needs many steps per sample, the implicit solver is tried.
    fn integrate_with_error_control(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Vec<Vec<f64>>, SimulationError> {
        let few = thresholds::MAX_EXPLICIT_STEPS_PER_SAMPLE * samples.len() as u64;
        for (method, most_steps, is_last) in [
            (Method::DormandPrince853, few, few >= self.most_steps),
            (Method::Radau, few, false),
            (Method::DormandPrince853, self.most_steps, true),
        ] {
            let settings = Settings {
                method,
                max_steps: most_steps.min(self.most_steps).min(self.work.left()).max(1),
                max_switch_rate: thresholds::MAX_SWITCHES_PER_SECOND,
                ..Settings::with_tolerance(thresholds::SOLVER_TOLERANCE)
            };
            let driven = DrivenModel::new(&self.evaluator, inputs)
                .with_typical_sizes(self.typical_sizes)
                .with_projection(self.constraints.take())
                .with_sides(self.sided.take(), settings.tolerance);
            let mut trajectory = Trajectory::default();
            let (span, requested) = ((samples[0], samples[samples.len() - 1]), samples);
            let request = (initial, span, requested);
            let ended = simulate_into(&mut trajectory, &driven, request, &settings, &mut |_| {});
            (self.sided, self.constraints) = driven.into_parts();
            self.work.add(trajectory.statistics.evaluations);
            match ended {
                Ok(()) => return Ok(trajectory.states),
                Err(SolveError::TooManySteps { .. }) if !is_last => {}
                // If the implicit solver fails, the explicit solver continues with more steps.
                Err(_) if method == Method::Radau => {}
                Err(error) => return Err(SimulationError::Solver(error)),
            }
            self.check_may_simulate()?;
        }
        Err(SimulationError::Diverged)
    }

    /// Returns the states at the samples by classical Runge-Kutta steps up to the maximum step.
    /// Held inputs are read once per step.
    fn integrate_by_runge_kutta(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        longest_step: LongestStep,
    ) -> Result<Vec<Vec<f64>>, SimulationError> {
        let mut state = initial.to_vec();
        let mut states = Vec::with_capacity(samples.len());
        states.push(state.clone());
        let mut method = RungeKutta::new(state.len());
        for pair in samples.windows(2) {
            let evaluator = self.evaluator.get_mut();
            let steps = longest_step.count_steps(pair[1] - pair[0]);
            let h = (pair[1] - pair[0]) / steps as f64;
            self.work.add(4 * steps as u64);
            for step in 0..steps {
                let begin = pair[0] + step as f64 * h;
                // The time of the held sample is half a step later, so that rounding cannot select
                // the previous sample.
                let held = inputs.last_sample(begin + 0.5 * h);
                method.step(&mut state, (begin, h), |_, t, state, rates| {
                    let inputs = &inputs.evaluate_with_held(t, held);
                    evaluator.rates(Point { t, state, inputs }, rates);
                });
            }
            if state.iter().any(|x| !x.is_finite()) {
                return Err(SimulationError::Diverged);
            }
            if self.constraints.is_some() {
                state = self.move_onto_constraints(&state, pair[1], inputs)?;
            }
            states.push(state.clone());
        }
        Ok(states)
    }

    /// Returns the channel values at the samples of a motion that starts at the first sample.
    ///
    /// # Errors
    ///
    /// Errors of [`Simulation::simulate_states`].
    pub fn simulate_outputs(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Outputs, SimulationError> {
        let Motion { states, outputs } = self.simulate_motion(initial, samples, inputs)?;
        Ok(Outputs {
            values: outputs,
            end_state: states.into_iter().next_back().unwrap_or_default(),
        })
    }

    /// Returns the states and channel values at the samples of a motion that starts at the first
    /// sample.
    ///
    /// # Errors
    ///
    /// Errors of [`Simulation::simulate_states`].
    pub fn simulate_motion(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
    ) -> Result<Motion, SimulationError> {
        let states = self.simulate_states(initial, samples, inputs)?;
        let mut outputs = Vec::with_capacity(samples.len() * self.measured.count());
        self.attach_sticking((samples, &states), inputs);
        for (t, state) in samples.iter().zip(&states) {
            self.append_outputs(*t, state, inputs, &mut outputs);
        }
        self.detach_sticking();
        Ok(Motion { states, outputs })
    }

    /// Returns the channel values and their derivatives with respect to each initial state, if the
    /// exact propagator is used. Layout: for each sample one row per state, with one number per
    /// channel. `steps`: change of each state for difference quotients of nonlinear observables.
    pub fn propagate_with_tangents(
        &mut self,
        initial: &[f64],
        samples: &[f64],
        inputs: &HeldInputs,
        steps: &[f64],
    ) -> Option<OutputTangents> {
        self.check_may_simulate().ok()?;
        let span = (*samples.first()?, *samples.last()?);
        let count = initial.len();
        let unit = |state: usize| {
            (0..count)
                .map(|k| f64::from(u8::from(k == state)))
                .collect()
        };
        let directions: Vec<Vec<f64>> = (0..count).map(unit).collect();
        let propagator = self.propagator.as_mut()?;
        let found = propagator
            .simulate_with_derivatives(initial, span, samples, inputs, directions)
            .ok()?;
        self.work.add((samples.len() * (1 + count)) as u64);
        let channels = self.measured.count();
        let mut outputs = Outputs::default();
        let mut derivatives = Vec::with_capacity(samples.len() * count * channels);
        let mut moved = vec![0.0; count];
        self.attach_sticking((samples, &found.states), inputs);
        for ((t, state), tangents) in samples.iter().zip(&found.states).zip(&found.derivatives) {
            let here = outputs.values.len();
            self.append_outputs(*t, state, inputs, &mut outputs.values);
            for (tangent, step) in tangents.iter().zip(steps) {
                let sums = moved.iter_mut().zip(state).zip(tangent);
                sums.for_each(|((slot, x), d)| *slot = x + step * d);
                let there = derivatives.len();
                self.append_outputs(*t, &moved, inputs, &mut derivatives);
                for channel in 0..channels {
                    let difference = derivatives[there + channel] - outputs.values[here + channel];
                    derivatives[there + channel] = difference / step;
                }
            }
        }
        self.detach_sticking();
        outputs.end_state = found.states.into_iter().next_back().unwrap_or_default();
        Some(OutputTangents {
            outputs,
            by_state: derivatives,
        })
    }

    /// Determines the sticking surfaces of a motion at the times at which its accelerations are
    /// measured.
    fn attach_sticking(&mut self, motion: (&[f64], &[Vec<f64>]), inputs: &HeldInputs) {
        let sided = self.resting.take();
        self.buffers.rest = sided.map(|sided| StickingMotion::new(sided, motion, inputs));
    }

    /// Removes the sticking surfaces of the motion.
    fn detach_sticking(&mut self) {
        self.resting = self
            .buffers
            .rest
            .take()
            .map(StickingMotion::into_sided_model);
    }

    /// Appends the channel values at a state.
    fn append_outputs(
        &mut self,
        t: f64,
        state: &[f64],
        inputs: &HeldInputs,
        values: &mut Vec<f64>,
    ) {
        if let Some(linear_outputs) = &self.linear_outputs {
            linear_outputs.append(state, values);
            return;
        }
        let inputs = &inputs.evaluate(t);
        let evaluator = self.evaluator.get_mut();
        let required = match &mut self.given {
            None => None,
            Some(given) => match given.solve_inputs(evaluator, t, inputs) {
                Some(required) => Some(required),
                None => {
                    values.resize(values.len() + self.measured.count(), f64::NAN);
                    return;
                }
            },
        };
        let inputs = required.as_deref().unwrap_or(inputs);
        let point = Point { t, state, inputs };
        self.measured
            .append(evaluator, point, &mut self.buffers, values);
    }

    /// Returns the rates of a state.
    pub fn compute_rates(&mut self, t: f64, state: &[f64], inputs: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; state.len()];
        let point = Point { t, state, inputs };
        self.evaluator.get_mut().rates(point, &mut rates);
        rates
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::estimation_model::EstimationModel;
    use crate::model::work::WorkLimit;

    const STAGE: &str = r#"[model]
name = "stage"
[parameters]
p = { value = 1e-6, unit = "m" }
m = { value = 1, unit = "kg" }
T = { value = 1, unit = "N" }
[coordinates]
x = { unit = "m" }
[states]
z = { unit = "m", rate = "dot(x) - abs(dot(x))*z/p" }
[kinetic]
carriage = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "2*T - T*z/p" }
"#;

    fn stage() -> EstimationModel {
        EstimationModel::derive_equations(STAGE, "stage", None, &[]).expect("a model")
    }

    fn samples() -> Vec<f64> {
        (0..=20).map(|k| 5e-3 * f64::from(k)).collect()
    }

    /// Integrates the stage by classical Runge-Kutta steps of 1 us; returns the final position.
    fn integrate_stage() -> f64 {
        let rates = |[_, v, z]: [f64; 3]| [v, 2.0 - z / 1e-6, v - v.abs() * z / 1e-6];
        let h = 1e-6;
        let mut state = [0.0; 3];
        for _ in 0..100_000 {
            let along = |k: [f64; 3], part: f64| [0, 1, 2].map(|i| state[i] + part * h * k[i]);
            let a = rates(state);
            let b = rates(along(a, 0.5));
            let c = rates(along(b, 0.5));
            let d = rates(along(c, 1.0));
            state = [0, 1, 2].map(|i| state[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        }
        state[0]
    }

    #[test]
    fn stiff_bristles_need_few_evaluations() {
        let model = stage();
        let mut simulation = model
            .create_simulation(&model.values)
            .expect("a simulation");
        let inputs = HeldInputs::zero(0);
        let states = simulation.simulate_states(&[0.0; 3], &samples(), &inputs);
        let end = states.expect("states")[20][0];
        let right = integrate_stage();
        assert!((end / right - 1.0).abs() < 1e-5, "{end}, {right}");
        // Without the implicit solver, 1000 evaluations per sample would be needed.
        assert!(model.work.done() < 200 * 20, "{}", model.work.done());
    }

    #[test]
    fn simulations_beyond_the_work_limit_fail() {
        let mut model = stage();
        model.work = WorkLimit::new(100);
        let mut simulation = model
            .create_simulation(&model.values)
            .expect("a simulation");
        let inputs = HeldInputs::zero(0);
        let mut run = || simulation.simulate_states(&[0.0; 3], &samples(), &inputs);
        assert!(run().is_err());
        assert_eq!(run(), Err(SimulationError::TooMuchWork));
        assert!(model.work.check().is_err());
    }
}
