//! Simulations that continue over several calls, for example with a controller, in a co-simulation or in an interactive
//! program.

use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::argument::Argument;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, ObservedStep, Surface, SurfaceMode, Trajectory};
use eomgen_sim::piecewise_linear::{Motion as ExactMotion, Propagator, StepObserver};

use crate::controllers::{ControlLoop, LoopRecord};
use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::event_log::{LoggedEvent, log_events};
use crate::exact_observers::ExactObservers;
use crate::fixed_steps::FixedSteps;
use crate::general_motion::GeneralMotion;
use crate::instance::Instance;
use crate::motion::{EarlyStop, FrictionChoice, Solver, SolverChoice};
use crate::observers::{Observers, Results};
use crate::projection::InitialChange;
use crate::simulation::TIME_VARYING_INPUTS_MESSAGE;
use crate::solver_options::{SolverOptions, general_method};
use crate::statistics::Measurement;
use crate::sticking::ObservedMotion;
use crate::stop_reasons::{
    describe_exact_stop, find_exact_stop_cause, may_be_supported_by_general,
};

/// Simulation that continues over several calls. Inputs may change between calls; they are held until the next change.
/// Without a change the solver keeps its steps, so that many short calls give the same motion as a long one.
///
/// The controllers of the specification run. The start and each call include the samples at their last time, so that a
/// change of an input or of the state at the time of a sample acts after it.
///
/// ```
/// # use eomgen_compiled_model::{CompiledModel, Orders, SolverOptions};
/// let text = r#"
///     [model]
///     name = "mass"
///     [parameters]
///     m = { value = 2.0, unit = "kg" }
///     [coordinates]
///     x = { unit = "m" }
///     [inputs]
///     F = { unit = "N" }
///     [kinetic]
///     mass = "1/2*m*dot(x)^2"
///     [forces]
///     drive = { on = "x", value = "F" }
/// "#;
/// let model = CompiledModel::from_text("mass.toml", text, Orders::Declared)?;
/// let run = model.with_declared_parameters()?;
/// let start = (0.0, run.initial_state());
/// let mut simulation = run.start_simulation(start, run.default_inputs(), SolverOptions::default())?;
/// for step in 1..=4 {
///     let force = -10.0 * (simulation.state()[0] - 1.0) - 4.0 * simulation.state()[1];
///     simulation.set_inputs(&[force])?;
///     simulation.advance(0.1 * f64::from(step))?;
/// }
/// assert!((simulation.time() - 0.4).abs() < 1e-15);
/// # Ok::<(), eomgen_compiled_model::Error>(())
/// ```
pub struct Simulation<'m> {
    instance: Instance<'m>,
    options: SolverOptions,
    inputs: HeldInputs,
    /// Inputs from the current time on.
    present_inputs: Vec<f64>,
    engine: Engine,
    solver_choice: Option<SolverChoice>,
    surfaces: Vec<Surface>,
    initial_changes: Vec<InitialChange>,
    /// Events and jumps since [`Simulation::clear_events`].
    log: Trajectory,
    /// Controllers that drive inputs; `None` without controllers.
    pub(crate) controls: Option<ControlLoop<'m>>,
}

enum Engine {
    Exact {
        propagator: Box<Propagator>,
        motion: Box<ExactMotion>,
        observed: Box<ObservedMotion>,
        observers: Option<Box<ExactObservers>>,
    },
    General(GeneralMotion),
    Fixed(Box<FixedSteps>),
}

impl<'m> Instance<'m> {
    /// Starts a simulation at a time (s) and a state (SI), with the controllers of the specification in their initial
    /// states.
    ///
    /// # Errors
    /// An invalid request, no consistent state near the given one, a solver that does not support the model, or a
    /// controller whose first sample fails.
    pub fn start_simulation(
        &self,
        start: (f64, &[f64]),
        inputs: HeldInputs,
        options: SolverOptions,
    ) -> Result<Simulation<'m>, Error> {
        if self.model().model().controllers.is_empty() {
            return self.start_plant(start, inputs, options);
        }
        let controllers = self.boxed_controllers()?;
        let mut simulation = self.prepare_controlled((start, inputs), options, controllers)?;
        simulation.advance(start.0)?;
        Ok(simulation)
    }

    /// Starts a simulation without controllers.
    pub(crate) fn start_plant(
        &self,
        (t, state): (f64, &[f64]),
        inputs: HeldInputs,
        options: SolverOptions,
    ) -> Result<Simulation<'m>, Error> {
        let check = options.settings(Method::default()).check();
        check.map_err(|error| Error::Request(error.to_string()))?;
        self.check_held_inputs(&inputs, (t, t))?;
        if options.solver == Solver::Exact && inputs.is_time_varying() {
            return Err(Error::Request(format!(
                "{TIME_VARYING_INPUTS_MESSAGE}: use {}",
                Argument::Solver.with_text("rk")
            )));
        }
        let choice = (options.solver == Solver::Auto).then(|| self.choose_solver(&inputs));
        let is_exact = match &choice {
            Some(choice) => *choice == SolverChoice::PiecewiseLinear,
            None => options.solver == Solver::Exact,
        };
        let (exact, choice) = match is_exact {
            true => self.try_exact((t, state), &inputs, choice)?,
            false => (None, choice),
        };
        let is_fixed = options.solver == Solver::Fixed;
        let (engine, initial_changes) = match (exact, is_fixed) {
            (Some(engine), _) => (engine, Vec::new()),
            (_, true) => {
                let steps = self.start_fixed((t, state), options.max_step)?;
                (Engine::Fixed(Box::new(steps)), Vec::new())
            }
            _ => {
                if options.solver == Solver::Adams {
                    self.check_adams()?;
                }
                let settings = options.settings(general_method(options.solver));
                let started = GeneralMotion::start(self, (t, state), &inputs, &settings)?;
                (Engine::General(started.0), started.1)
            }
        };
        let surfaces = match &engine {
            Engine::Exact { .. } => self.surfaces(&inputs)?,
            Engine::General(motion) => motion.run().surfaces.clone(),
            Engine::Fixed(_) => Vec::new(),
        };
        Ok(Simulation {
            instance: self.clone(),
            options,
            present_inputs: inputs.evaluate(t).into_owned(),
            inputs,
            engine,
            solver_choice: choice,
            surfaces,
            initial_changes,
            log: Trajectory::default(),
            controls: None,
        })
    }

    /// Returns the reason for or against the exact solver.
    fn choose_solver(&self, inputs: &HeldInputs) -> SolverChoice {
        if inputs.is_time_varying() {
            return SolverChoice::NotPiecewiseLinear(TIME_VARYING_INPUTS_MESSAGE.to_owned());
        }
        match self.model().piecewise_linear() {
            Ok(_) => SolverChoice::PiecewiseLinear,
            Err(error) => SolverChoice::NotPiecewiseLinear(error.to_string()),
        }
    }

    fn surfaces(&self, inputs: &HeldInputs) -> Result<Vec<Surface>, Error> {
        let evaluator = std::cell::RefCell::new(self.evaluator()?);
        Ok(DrivenModel::new(&evaluator, inputs).surfaces())
    }

    /// Starts the exact solver. `choice` is the reason for its choice, or `None` if it was requested. If a chosen exact
    /// solver does not support the motion, returns `None` and the reason; a general solver replaces it.
    fn try_exact(
        &self,
        start: (f64, &[f64]),
        inputs: &HeldInputs,
        choice: Option<SolverChoice>,
    ) -> Result<(Option<Engine>, Option<SolverChoice>), Error> {
        let started = self.propagator().and_then(|mut propagator| {
            let motion = propagator.start(start.0, start.1, inputs)?;
            Ok((propagator, motion))
        });
        match started {
            Ok(started) => Ok((Some(self.exact_engine(start, inputs, started)?), choice)),
            Err(error) if choice.is_some() && may_be_supported_by_general(&error) => {
                let labels = self.model().labels();
                let reason = describe_exact_stop(labels, &self.surfaces(inputs)?, &error);
                Ok((None, Some(SolverChoice::NotSupportedByExact(reason))))
            }
            Err(error) => Err(Error::from(&error)),
        }
    }

    fn exact_engine(
        &self,
        (t, state): (f64, &[f64]),
        inputs: &HeldInputs,
        (propagator, motion): (Propagator, ExactMotion),
    ) -> Result<Engine, Error> {
        let start = Trajectory {
            times: vec![t],
            states: vec![state.to_vec()],
            ..Trajectory::default()
        };
        let holding = self.holding_model()?;
        let observed = ObservedMotion::new(self.evaluator()?, holding, &start, inputs);
        Ok(Engine::Exact {
            propagator: Box::new(propagator),
            motion: Box::new(motion),
            observed: Box::new(observed),
            observers: None,
        })
    }
}

impl Simulation<'_> {
    /// Returns the current time, s.
    pub fn time(&self) -> f64 {
        match &self.engine {
            Engine::Exact { motion, .. } => motion.time(),
            Engine::General(motion) => motion.time(),
            Engine::Fixed(steps) => steps.reached(),
        }
    }

    /// Returns the time of the current step of [`Solver::Fixed`], s; `None` for other solvers.
    pub(crate) fn step_time(&self) -> Option<f64> {
        match &self.engine {
            Engine::Fixed(steps) => Some(steps.time()),
            _ => None,
        }
    }

    /// Returns the state at the current time, SI.
    pub fn state(&self) -> &[f64] {
        match &self.engine {
            Engine::Exact { motion, .. } => motion.state(),
            Engine::General(motion) => motion.state(),
            Engine::Fixed(steps) => steps.state(),
        }
    }

    /// Returns the inputs from the current time on, SI.
    pub fn inputs(&self) -> &[f64] {
        &self.present_inputs
    }

    /// Returns the solver in use; never [`Solver::Auto`].
    pub fn solver(&self) -> Solver {
        match &self.engine {
            Engine::Exact { .. } => Solver::Exact,
            Engine::General(motion) => motion.run().solver,
            Engine::Fixed(_) => Solver::Fixed,
        }
    }

    /// Returns the reason for the solver in use; `None` if it was requested.
    pub fn solver_choice(&self) -> Option<&SolverChoice> {
        self.solver_choice.as_ref()
    }

    /// Returns the switching surfaces of the events.
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Returns the corrections that projected the initial state, or the state set last, onto the constraints.
    pub fn initial_changes(&self) -> &[InitialChange] {
        &self.initial_changes
    }

    /// Returns the events since the start or the last [`Simulation::clear_events`].
    pub fn events(&self) -> Vec<LoggedEvent<'_>> {
        let degrees = self.instance.model().program().degrees_of_freedom();
        log_events(&self.log, &self.surfaces, degrees)
    }

    /// Deletes the events so far.
    pub fn clear_events(&mut self) {
        self.log.events.clear();
        self.log.jumps.clear();
    }

    /// Writes the observables at the current time to `out`. During sticking they use the friction force that holds the
    /// motion. At a sample they use the inputs after it.
    pub fn write_observables(&mut self, out: &mut [f64]) {
        let t = self.time();
        match &mut self.engine {
            Engine::Exact {
                motion, observed, ..
            } => {
                let point = Point {
                    t,
                    state: motion.state(),
                    inputs: &self.present_inputs,
                };
                observed.observables(point, out);
            }
            Engine::General(motion) => motion.write_observables(out),
            Engine::Fixed(steps) => steps.write_observables(&self.present_inputs, out),
        }
    }

    /// Writes the rates at the current time to `out`. During sticking they use the friction force that holds the
    /// motion.
    pub fn write_rates(&mut self, out: &mut [f64]) {
        let t = self.time();
        match &mut self.engine {
            Engine::Exact {
                motion, observed, ..
            } => {
                let point = Point {
                    t,
                    state: motion.state(),
                    inputs: &self.present_inputs,
                };
                observed.rates(point, out);
            }
            Engine::General(motion) => motion.write_rates(out),
            Engine::Fixed(steps) => steps.write_rates(&self.present_inputs, out),
        }
    }

    /// Returns the modes of the switching surfaces, for a start at the same point. Empty if the solver derives the
    /// modes from the state.
    pub fn modes(&self) -> &[SurfaceMode] {
        match &self.engine {
            Engine::Exact { .. } | Engine::Fixed(_) => &[],
            Engine::General(motion) => motion.modes(),
        }
    }

    /// Continues to the time `until` (s).
    ///
    /// # Errors
    /// A time before the current one; [`Error::Stopped`] with the last time if the solver stops early.
    pub fn advance(&mut self, until: f64) -> Result<(), Error> {
        self.advance_with_progress(until, &mut |_| {})
    }

    /// Continues to the time `until` (s) like [`Simulation::advance`]. Calls `progress` with the current time, s.
    ///
    /// # Errors
    /// Those of [`Simulation::advance`].
    pub fn advance_with_progress(
        &mut self,
        until: f64,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), Error> {
        let mut trajectory = Trajectory::default();
        let ended = self.advance_through((until, &[]), &mut trajectory, progress);
        self.log.events.append(&mut trajectory.events);
        self.log.jumps.append(&mut trajectory.jumps);
        match ended? {
            Some(stop) => Err(stop.into()),
            None => Ok(()),
        }
    }

    /// Continues to the time `until` (s). Adds the states at `samples` (s, ascending, after the current time), the
    /// events and the work to `trajectory`. Calls `progress` with the current time, s. Returns the reason if the solver
    /// stops early.
    ///
    /// # Errors
    /// Times that are not finite, not ascending or before the current time.
    pub fn advance_through(
        &mut self,
        asked: (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.follow(asked, &mut LoopRecord::new(trajectory), progress)
    }

    /// Continues like [`Simulation::advance_through`], with the present inputs.
    pub(crate) fn advance_plant(
        &mut self,
        (until, samples): (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.check_times(until, samples)?;
        if let Engine::Fixed(steps) = &mut self.engine {
            let names = || self.instance.model().state_names();
            let asked = (until, samples);
            let stop = steps.advance(asked, &self.inputs, trajectory, &names, progress)?;
            progress(until);
            return Ok(stop);
        }
        let first = trajectory.times.len();
        loop {
            let rest = &samples[trajectory.times.len() - first..];
            let Some(stop) = self.try_advance((until, rest), trajectory, progress) else {
                return Ok(None);
            };
            match stop {
                (_, Some((solver, choice))) if self.options.solver == Solver::Auto => {
                    let state = self.state().to_vec();
                    self.restart_general(solver, &state)?;
                    self.solver_choice = Some(choice);
                }
                (stop, _) => return Ok(Some(stop)),
            }
        }
    }

    /// Checks that the number of fixed steps to a time (s) is below the limit.
    pub(crate) fn check_step_count(&self, until: f64) -> Result<(), Error> {
        match &self.engine {
            Engine::Fixed(steps) => steps.check_step_count(until),
            Engine::Exact { .. } | Engine::General(_) => Ok(()),
        }
    }

    /// Checks the times that a call requests.
    pub(crate) fn check_times(&self, until: f64, samples: &[f64]) -> Result<(), Error> {
        let now = self.time();
        let ascending = samples.windows(2).all(|pair| pair[0] <= pair[1]);
        let inside = samples.iter().all(|sample| (now..=until).contains(sample));
        match until.is_finite() && until >= now && ascending && inside {
            true => Ok(()),
            false => Err(Error::Request(format!(
                "a simulation that reached {now:?} s cannot continue to {until:?} s with these samples: times must be \
                 finite, ascending and between both times"
            ))),
        }
    }

    /// Continues with the present solver. Returns the reason of an early stop, and another solver that may continue
    /// from this time.
    fn try_advance(
        &mut self,
        (until, samples): (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Option<(EarlyStop, Option<(Solver, SolverChoice)>)> {
        let begin = self.time();
        if begin == until && samples.is_empty() {
            return None;
        }
        let model = self.instance.model();
        match &mut self.engine {
            Engine::Exact {
                propagator,
                motion,
                observed,
                observers,
            } => {
                let asked = (until, samples);
                let inputs = &self.inputs;
                let mut observer = observers.as_mut().map(|observers| {
                    |step: &mut ObservedStep<'_>, is_held: bool| {
                        observers.observe_step(step, is_held, inputs);
                    }
                });
                let observer = observer
                    .as_mut()
                    .map(|observer| observer as &mut StepObserver<'_>);
                let observer = (progress, observer);
                let ended = propagator.continue_motion(motion, asked, inputs, trajectory, observer);
                observed.extend(Point {
                    t: motion.time(),
                    state: motion.state(),
                    inputs: &self.present_inputs,
                });
                let error = ended.err()?;
                let stop = EarlyStop {
                    t: error.time(),
                    reason: describe_exact_stop(model.labels(), &self.surfaces, &error),
                    cause: find_exact_stop_cause(model.labels(), &error, &self.surfaces),
                };
                let reason = || SolverChoice::NotSupportedByExact(stop.reason.clone());
                let next = may_be_supported_by_general(&error).then(|| (Solver::Rk, reason()));
                Some((stop, next))
            }
            Engine::General(motion) => {
                motion.advance(&self.instance, (until, samples), trajectory, progress)
            }
            Engine::Fixed(_) => None,
        }
    }

    /// Continues with a general solver from a state at the current time.
    fn restart_general(
        &mut self,
        solver: Solver,
        state: &[f64],
    ) -> Result<Vec<InitialChange>, Error> {
        let settings = self.options.settings(general_method(solver));
        let start = (self.time(), state);
        let started = GeneralMotion::start(&self.instance, start, &self.inputs, &settings)?;
        let (mut motion, changes) = started;
        let mut observers = self.take_observers();
        observers.continue_with(self.options.tolerance);
        motion.replace_observers(observers);
        self.engine = Engine::General(motion);
        Ok(changes)
    }

    /// Observes the motion from the current time on: with the energy audit if `audits` is true, and with measurements.
    /// Fixed steps are not observed.
    ///
    /// # Errors
    /// A model whose evaluator cannot be prepared.
    pub(crate) fn observe(
        &mut self,
        audits: bool,
        measurements: &[Measurement],
    ) -> Result<(), Error> {
        let tolerance = match &self.engine {
            Engine::Exact { .. } => None,
            Engine::General(_) => Some(self.options.tolerance),
            Engine::Fixed(_) => return Ok(()),
        };
        let new = self.instance.observers(tolerance, audits, measurements);
        if new.is_empty() {
            return Ok(());
        }
        let start = (self.time(), self.state().to_vec());
        match &mut self.engine {
            Engine::Exact { observers, .. } => {
                let start = (start.0, &start.1[..]);
                let exact = self.instance.exact_observers(new, start, &self.inputs)?;
                *observers = Some(Box::new(exact));
            }
            Engine::General(motion) => {
                motion.replace_observers(new);
            }
            Engine::Fixed(_) => {}
        }
        Ok(())
    }

    /// Returns the times at which contact friction admits several motions.
    pub(crate) fn friction_choices(&self) -> Vec<FrictionChoice> {
        match &self.engine {
            Engine::General(motion) => motion.run().system.friction_choices(),
            Engine::Exact { .. } | Engine::Fixed(_) => Vec::new(),
        }
    }

    /// Returns the results of the observers so far.
    pub(crate) fn observed_results(&self) -> Results {
        match &self.engine {
            Engine::Exact { observers, .. } => {
                let observers = observers.as_ref();
                observers.map_or_else(Results::default, |own| own.results())
            }
            Engine::General(motion) => motion.run().system.results(),
            Engine::Fixed(_) => Results::default(),
        }
    }

    fn take_observers(&mut self) -> Observers {
        match &mut self.engine {
            Engine::Exact { observers, .. } => {
                let observers = observers.take();
                observers.map_or_else(Observers::default, |own| own.into_observers())
            }
            Engine::General(motion) => motion.replace_observers(Observers::default()),
            Engine::Fixed(_) => Observers::default(),
        }
    }

    /// Changes the inputs from the current time on. Equal inputs change nothing. An input that a controller drives
    /// keeps its value.
    ///
    /// # Errors
    /// A wrong number of inputs, an input that is not finite, another value of an input that a controller drives, and a
    /// motion that cannot follow the jump.
    pub fn set_inputs(&mut self, inputs: &[f64]) -> Result<(), Error> {
        let names = &self.instance.model().program().inputs;
        if inputs.len() != names.len() {
            let (given, wanted) = (inputs.len(), names.len());
            return Err(Error::Request(format!(
                "{given} inputs are given, but the model has {wanted}"
            )));
        }
        let t = self.time();
        if let Some(place) = inputs.iter().position(|value| !value.is_finite()) {
            return Err(Error::Request(format!(
                "at t = {t:?} s the input `{}` is not finite",
                names[place].name
            )));
        }
        if self.present_inputs == inputs && !self.inputs.is_time_varying() {
            return Ok(());
        }
        if let Some(place) = self.find_driven(inputs) {
            return Err(Error::Request(format!(
                "a controller drives the input `{}`: remove the value, or the output of the controller",
                names[place].name
            )));
        }
        if let Some(controls) = &mut self.controls {
            let all = controls.change_external_inputs(t, HeldInputs::constant(inputs.to_vec()));
            self.present_inputs = inputs.to_vec();
            self.inputs = all;
            return self.follow_input_jump();
        }
        let before = self.inputs.evaluate(t.next_down());
        let rows = [&before[..], inputs].concat();
        let held = HeldInputs::new(vec![t.next_down(), t], rows, inputs.len());
        let Some(held) = held else { return Ok(()) };
        self.present_inputs = inputs.to_vec();
        self.inputs = held;
        self.follow_input_jump()
    }

    /// Changes the inputs from the current time on; the new ones may vary with time. Adds the events of the change to
    /// `trajectory`.
    ///
    /// # Errors
    /// The motion cannot follow the jump.
    pub(crate) fn change_inputs(
        &mut self,
        inputs: HeldInputs,
        trajectory: &mut Trajectory,
    ) -> Result<(), Error> {
        self.present_inputs = inputs.evaluate(self.time()).into_owned();
        self.inputs = inputs;
        let followed = self.follow_input_jump();
        trajectory.events.append(&mut self.log.events);
        trajectory.jumps.append(&mut self.log.jumps);
        followed
    }

    fn follow_input_jump(&mut self) -> Result<(), Error> {
        let begin = self.time();
        let model = self.instance.model();
        match &mut self.engine {
            Engine::Fixed(_) => Ok(()),
            Engine::Exact {
                propagator, motion, ..
            } => {
                let followed = propagator.follow_input_jump(motion, &self.inputs);
                let Err(error) = followed else { return Ok(()) };
                let reason = describe_exact_stop(model.labels(), &self.surfaces, &error);
                let is_free = self.options.solver == Solver::Auto;
                if !(is_free && may_be_supported_by_general(&error)) {
                    let t = Some(begin);
                    return Err(Error::Stopped { t, reason });
                }
                let state = motion.state().to_vec();
                self.solver_choice = Some(SolverChoice::NotSupportedByExact(reason));
                self.restart_general(Solver::Rk, &state)?;
                Ok(())
            }
            Engine::General(motion) => {
                motion.follow_inputs(&self.instance, self.inputs.clone(), &mut self.log)
            }
        }
    }

    /// Continues from another state at the current time, SI. Controllers keep their states.
    ///
    /// # Errors
    /// An invalid state, and a state from which the motion cannot continue.
    pub fn set_state(&mut self, state: &[f64]) -> Result<(), Error> {
        let states = self.instance.model().program().states();
        if state.len() != states || state.iter().any(|entry| !entry.is_finite()) {
            return Err(Error::Request(format!(
                "a state has {states} finite entries"
            )));
        }
        // Sticking surfaces and closed contacts are determined again.
        if let Engine::Fixed(steps) = &mut self.engine {
            steps.set_state(state);
            return Ok(());
        }
        match self.solver() {
            Solver::Exact => {
                let (start, choice) = ((self.time(), state), self.solver_choice.clone());
                let (exact, choice) = self.instance.try_exact(start, &self.inputs, choice)?;
                self.solver_choice = choice;
                match exact {
                    Some(engine) => self.engine = engine,
                    None => self.initial_changes = self.restart_general(Solver::Rk, state)?,
                }
            }
            solver => self.initial_changes = self.restart_general(solver, state)?,
        }
        Ok(())
    }
}
