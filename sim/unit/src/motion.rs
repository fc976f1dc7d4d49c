//! Motion of an instance: initialisation, communication steps, and the functions of model exchange.

use std::cell::RefCell;

use eomgen_compiled_model::{ControlLoop, Error, Sample, SampledController, Solver, SolverOptions};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{ExternalMotion, SurfaceMode};

use crate::rejection::{Outcome, invalid, unavailable};
use crate::unit::{BEFORE_START, External, Kind, Mode, Unit};

/// Relative difference of times that count as equal.
const TIME_ROUNDING: f64 = 1e-9;

impl Unit {
    /// Projects the state onto the constraints and starts the motion.
    pub fn end_initialization(&mut self) -> Outcome {
        self.forget_motion();
        self.now.control = None;
        match self.kind {
            Kind::ModelExchange => {
                let inputs = HeldInputs::constant(self.now.inputs.clone());
                let instance = self.instance()?;
                let found = instance.find_consistent_state(&self.now.state, self.now.t, &inputs)?;
                self.now.state = found.0;
                self.now.control = self.controls()?.map(|controls| controls.memory());
            }
            Kind::CoSimulation => self.start_simulation()?,
        }
        if self.rates()?.iter().any(|rate| !rate.is_finite()) {
            return Err(invalid(
                "a rate is not finite at the initial state: check that the mass matrix is positive definite",
            ));
        }
        self.now.earlier_inputs.clone_from(&self.now.inputs);
        self.now.mode = match self.kind {
            Kind::ModelExchange => Mode::Event,
            Kind::CoSimulation => Mode::Step,
        };
        Ok(())
    }

    /// Starts the simulation at the current time and state; controllers continue with their memory.
    fn start_simulation(&mut self) -> Outcome {
        let options = SolverOptions {
            solver: Solver::Auto,
            tolerance: self.now.tolerance,
            ..SolverOptions::default()
        };
        let inputs = HeldInputs::constant(self.now.inputs.clone());
        let instance = self.instance()?;
        let start = (self.now.t, &self.now.state[..]);
        let simulation = match &self.now.control {
            Some(memory) => instance.continue_simulation(start, inputs, options, memory)?,
            None => instance.start_simulation(start, inputs, options)?,
        };
        self.simulation = Some(Box::new(simulation));
        self.read_simulation();
        Ok(())
    }

    /// Updates the instance to the point that the simulation reached.
    fn read_simulation(&mut self) {
        if let Some(simulation) = &self.simulation {
            self.now.t = simulation.time();
            self.now.state.copy_from_slice(simulation.state());
            self.now.control = simulation.control_memory();
            if self.now.control.is_some() {
                self.now.inputs.copy_from_slice(simulation.inputs());
            }
        }
    }

    /// Applies the current inputs to the simulation.
    fn update_simulation(&mut self) -> Outcome {
        let Some(simulation) = &mut self.simulation else {
            return self.start_simulation();
        };
        let followed = simulation.set_inputs(&self.now.inputs);
        self.read_simulation();
        Ok(followed?)
    }

    /// Makes a communication step from a time (s), of a length (s).
    pub fn make_step(&mut self, from: f64, length: f64) -> Outcome {
        let (end, t) = (from + length, self.now.t);
        let slack = TIME_ROUNDING * (t.abs() + length.abs());
        if !(length > 0.0 && end.is_finite()) {
            return Err(invalid(format!(
                "communicationStepSize = {length:?}: the step size must be positive"
            )));
        }
        if from.is_nan() || (from - t).abs() > slack {
            return Err(invalid(format!(
                "currentCommunicationPoint = {from:?}: the last step ended at {t:?}"
            )));
        }
        if let Some(stop) = self.now.stop.filter(|stop| end > stop + slack) {
            return Err(invalid(format!(
                "communicationStepSize = {length:?}: the step exceeds the stop time {stop:?}"
            )));
        }
        self.update_simulation()?;
        self.external = None;
        self.now.surface_modes.clear();
        let Some(simulation) = &mut self.simulation else {
            return Ok(());
        };
        simulation.clear_events();
        let ended = simulation.advance(end.max(t));
        self.read_simulation();
        Ok(ended?)
    }

    /// Returns true if the simulation is at the current time and state of the instance.
    fn is_simulating(&self) -> bool {
        self.kind == Kind::CoSimulation && !self.is_in(BEFORE_START)
    }

    /// Returns the rates.
    pub fn rates(&mut self) -> Outcome<Vec<f64>> {
        let mut rates = vec![0.0; self.layout.states];
        if self.is_simulating() {
            self.update_simulation()?;
        }
        if let Some(simulation) = &mut self.simulation {
            simulation.write_rates(&mut rates);
            return Ok(rates);
        }
        let (t, state) = (self.now.t, self.now.state.clone());
        self.external()?.rates(t, &state, &mut rates);
        Ok(rates)
    }

    /// Returns the observables.
    pub fn observables(&mut self) -> Outcome<Vec<f64>> {
        let mut observables = vec![0.0; self.layout.observables];
        if self.is_simulating() {
            self.update_simulation()?;
        }
        if let Some(simulation) = &mut self.simulation {
            simulation.write_observables(&mut observables);
            return Ok(observables);
        }
        let (t, state) = (self.now.t, self.now.state.clone());
        let motion = self.external()?;
        motion.with_fixed_sides(|system| system.write_observables((t, &state), &mut observables));
        Ok(observables)
    }

    /// Returns the states of the controllers; their initial values before the start.
    pub fn controller_states(&mut self) -> Outcome<Vec<f64>> {
        if self.is_simulating() {
            self.update_simulation()?;
        }
        if let Some(memory) = &self.now.control {
            return Ok(memory.states.clone());
        }
        let controllers = self.instance()?.controllers()?;
        let states = controllers.iter().map(SampledController::states);
        Ok(states.collect::<Vec<_>>().concat())
    }

    /// Returns the event indicators.
    pub fn indicators(&mut self) -> Outcome<Vec<f64>> {
        let mut indicators = vec![0.0; self.layout.indicators];
        let (t, state) = (self.now.t, self.now.state.clone());
        self.external()?.event_functions(t, &state, &mut indicators);
        Ok(indicators)
    }

    /// Returns the motion for model exchange; starts it at the current point if there is none.
    pub fn external(&mut self) -> Outcome<&mut External> {
        if self.external.is_none() {
            let modes = self.surface_modes();
            let parameters = self.now.parameters.clone();
            self.external = Some(Box::new(self.start_external(&parameters, &modes)?));
        }
        let motion = self.external.as_deref_mut();
        motion.ok_or_else(|| invalid("the FMU has no motion"))
    }

    /// Starts a motion at the current point, with the current parameters and modes of the surfaces.
    pub fn start_external(
        &mut self,
        parameters: &[f64],
        modes: &[SurfaceMode],
    ) -> Outcome<External> {
        let instance = match *parameters == *self.now.parameters {
            true => self.instance()?,
            false => self.instance_at(parameters)?,
        };
        let evaluator = RefCell::new(instance.evaluator()?);
        let inputs = HeldInputs::constant(self.now.inputs.clone());
        let system = instance.driven_model(evaluator, inputs, self.now.tolerance)?;
        let at = (self.now.t, &self.now.state[..]);
        Ok(ExternalMotion::start(system, at, modes, self.now.tolerance))
    }

    /// Returns the modes of the surfaces; empty if the state determines them.
    pub fn surface_modes(&mut self) -> Vec<SurfaceMode> {
        if let Some(motion) = &mut self.external {
            return motion.modes();
        }
        match &self.simulation {
            Some(simulation) => simulation.modes().to_vec(),
            None => self.now.surface_modes.clone(),
        }
    }

    /// Stores the modes of holding surfaces and closed contacts for the next start of the motion.
    pub fn keep_resting_modes(&mut self) {
        let mut modes = self.surface_modes();
        for mode in &mut modes {
            if !matches!(mode, SurfaceMode::Held | SurfaceMode::Closed) {
                *mode = SurfaceMode::Unknown;
            }
        }
        self.now.surface_modes = match self.is_in(BEFORE_START) {
            true => Vec::new(),
            false => modes,
        };
    }

    /// Applies the current inputs to the motion for model exchange.
    pub fn follow_inputs(&mut self) {
        let inputs = HeldInputs::constant(self.now.inputs.clone());
        match &mut self.external {
            Some(motion) if self.now.mode == Mode::Continuous => {
                motion.system_mut().set_inputs(inputs);
            }
            // In event mode, the event applies the jump of the inputs.
            Some(_) if self.now.mode == Mode::Event => {}
            _ => self.external = None,
        }
    }

    /// Enters event mode; inputs that change in this mode jump.
    pub fn enter_event_mode(&mut self) {
        if self.now.mode != Mode::Event {
            self.now.earlier_inputs.clone_from(&self.now.inputs);
        }
        self.now.mode = Mode::Event;
    }

    /// Returns the controllers of a motion for model exchange at the current time; `None` without controllers.
    fn controls(&mut self) -> Outcome<Option<ControlLoop<'static>>> {
        if self.compiled.model().controllers.is_empty() {
            return Ok(None);
        }
        let inputs = HeldInputs::constant(self.now.inputs.clone());
        let now = (self.now.t, inputs);
        let controls = self
            .instance()?
            .control_loop(now, self.now.control.as_ref());
        Ok(Some(controls?))
    }

    /// Takes the samples that are due in event mode, with the inputs before it. Returns the controllers.
    pub fn take_samples(&mut self) -> Outcome<Option<ControlLoop<'static>>> {
        let Some(mut controls) = self.controls()? else {
            return Ok(None);
        };
        let t = self.now.t;
        let late = |instant: &f64| t - instant > TIME_ROUNDING * t.abs();
        if let Some(instant) = controls.next_instant().filter(late) {
            return Err(invalid(format!(
                "t = {t:?}: the importer has passed the time event at {instant:?} s, at which a controller is sampled or \
                 its outputs act"
            )));
        }
        let inputs = self.now.earlier_inputs.clone();
        let held = HeldInputs::constant(inputs.clone());
        self.external()?.system_mut().set_inputs(held);
        let observables = self.observables()?;
        let at = Sample {
            t,
            state: &self.now.state,
            inputs: &inputs,
            observables: &observables,
        };
        controls.take_samples(t, &at).map_err(Error::from)?;
        self.now.control = Some(controls.memory());
        Ok(Some(controls))
    }

    /// Applies the events at the current point: surfaces, samples of controllers, then jumps of inputs. Returns true if
    /// the state changed, and the time (s) of the next sample or output action.
    pub fn apply_event(&mut self) -> Outcome<(bool, Option<f64>)> {
        let (mut is_changed, mut next) = (false, None);
        if self.now.control.is_some() {
            is_changed = self.apply_motion_event(self.now.earlier_inputs.clone())?;
        }
        if let Some(mut controls) = self.take_samples()? {
            let inputs = controls.apply_outputs(self.now.t);
            self.now.inputs.copy_from_slice(inputs);
            self.now.control = Some(controls.memory());
            next = controls.next_instant();
        }
        is_changed |= self.apply_motion_event(self.now.inputs.clone())?;
        Ok((is_changed, next))
    }

    /// Applies the events of the motion at the current point, with a jump to these inputs. Returns true if the state
    /// changed.
    fn apply_motion_event(&mut self, inputs: Vec<f64>) -> Outcome<bool> {
        let (t, mut state) = (self.now.t, self.now.state.clone());
        let count = inputs.len();
        let rows = [&self.now.earlier_inputs[..], &inputs].concat();
        let jump = HeldInputs::new(vec![t.next_down(), t], rows, count);
        let motion = self.external()?;
        if let Some(jump) = jump {
            motion.system_mut().set_inputs(jump);
        }
        let is_changed = motion.apply_event(t, &mut state);
        let held = HeldInputs::constant(inputs.clone());
        motion.system_mut().set_inputs(held);
        if state.iter().any(|entry| !entry.is_finite()) {
            let reason = motion.system().stop_message();
            let reason = reason.unwrap_or_else(|| {
                format!("at t = {t:?} s the state after an event is not finite, so the motion cannot continue")
            });
            return Err(unavailable(reason));
        }
        self.now.state = state;
        self.now.earlier_inputs = inputs;
        Ok(is_changed)
    }

    /// Accepts a step of the importer's solver. Returns true if an event must follow.
    pub fn complete_step(&mut self) -> Outcome<bool> {
        let (t, state) = (self.now.t, self.now.state.clone());
        Ok(self.external()?.complete_step(t, &state))
    }
}
