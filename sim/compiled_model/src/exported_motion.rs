//! Motions of exported models, with their controllers.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use crate::controllers::{
    ControlLoop, DeclaredController, LoopRecord, Plant, SampledController, limit_steps,
};
use crate::error::Error;
use crate::exported_model::{ExportedCode, ExportedInstance, ExportedModel};
use crate::general_motion::GeneralMotion;
use crate::motion::EarlyStop;
use crate::projection::InitialChange;
use crate::solver_options::{SolverOptions, general_method};

/// Motion of an exported model that continues over several calls. Parameters and inputs may change between calls. The
/// controllers of the model run; the start and each call include the samples at their last time.
pub struct ExportedMotion {
    instance: ExportedInstance,
    options: SolverOptions,
    inputs: HeldInputs,
    /// Motion; `None` before the start and after a failed start.
    motion: Option<GeneralMotion>,
    /// Current time, s.
    t: f64,
    state: Vec<f64>,
    event_count: usize,
    step_count: u64,
    /// Controllers that drive inputs; `None` before the start and without controllers.
    controls: Option<ControlLoop<'static>>,
}

impl ExportedMotion {
    /// Creates a motion that has not started, at the model's own parameters.
    pub fn new(model: ExportedModel, options: SolverOptions) -> Self {
        let program = model.program();
        Self {
            inputs: HeldInputs::zero(program.inputs.len()),
            motion: None,
            t: 0.0,
            state: vec![0.0; program.states()],
            event_count: 0,
            step_count: 0,
            controls: None,
            options,
            instance: ExportedInstance {
                parameters: program.default_parameters(),
                code: ExportedCode::default(),
                model,
            },
        }
    }

    /// Returns the model.
    pub fn model(&self) -> &ExportedModel {
        &self.instance.model
    }

    /// Sets the machine code of the model's programs, from the next start on.
    pub fn set_code(&mut self, code: ExportedCode) {
        self.instance.code = code;
    }

    /// Starts at a time (s) and a state (SI) with the given inputs. Returns the corrections that projected the state
    /// onto the constraints.
    ///
    /// # Errors
    /// No consistent state near the given one, rates there that are not finite, or a controller that cannot start.
    pub fn start(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: HeldInputs,
    ) -> Result<Vec<InitialChange>, Error> {
        self.event_count = 0;
        self.t = t;
        self.state.copy_from_slice(state);
        self.inputs = inputs;
        self.controls = None;
        self.restart()
    }

    /// Continues with other independent parameters, SI. Sticking surfaces and closed contacts are determined again;
    /// controllers keep their states.
    ///
    /// # Errors
    /// See [`ExportedMotion::start`].
    pub fn set_parameters(&mut self, parameters: &[f64]) -> Result<Vec<InitialChange>, Error> {
        self.instance.parameters.copy_from_slice(parameters);
        self.restart()
    }

    fn restart(&mut self) -> Result<Vec<InitialChange>, Error> {
        self.motion = None;
        let controllers =
            DeclaredController::all(self.model().program(), &self.instance.parameters)?;
        let schedules = controllers.iter().map(|own| own.schedule());
        let options = limit_steps(self.options, schedules);
        let settings = options.settings(general_method(self.options.solver));
        let start = (self.t, &self.state[..]);
        let (motion, changes) =
            GeneralMotion::start(&self.instance, start, &self.inputs, &settings)?;
        self.state.copy_from_slice(motion.state());
        self.motion = Some(motion);
        if !controllers.is_empty() {
            self.restart_controls(controllers)?;
            self.advance(self.t)?;
        }
        Ok(changes)
    }

    /// Starts the controllers at the current time, or continues with their memory.
    fn restart_controls(&mut self, controllers: Vec<DeclaredController>) -> Result<(), Error> {
        let program = self.model().program();
        let counts = (program.inputs.len(), program.observables.len());
        let controllers = controllers.into_iter();
        let controllers = controllers.map(|own| Box::new(own) as Box<dyn SampledController>);
        let inputs = self.inputs.clone();
        let mut controls = ControlLoop::new(controllers.collect(), inputs, self.t, counts);
        if let Some(earlier) = &self.controls {
            controls.resume(self.t, &earlier.memory())?;
        }
        self.controls = Some(controls);
        Ok(())
    }

    /// Changes the inputs from the current time on. Inputs may jump at this time if `inputs` also has their values
    /// before it. Controllers keep the inputs that they drive.
    ///
    /// # Errors
    /// The motion cannot follow the jump.
    pub fn set_inputs(&mut self, inputs: HeldInputs) -> Result<(), Error> {
        let inputs = match &mut self.controls {
            Some(controls) => controls.change_external_inputs(self.t, inputs),
            None => inputs,
        };
        self.follow_inputs(inputs)
    }

    fn follow_inputs(&mut self, inputs: HeldInputs) -> Result<(), Error> {
        self.inputs = inputs;
        let Some(motion) = &mut self.motion else {
            return Ok(());
        };
        let mut log = Trajectory::default();
        let followed = motion.follow_inputs(&self.instance, self.inputs.clone(), &mut log);
        self.event_count += log.events.len();
        self.state.copy_from_slice(motion.state());
        followed
    }

    /// Continues to the time `until` (s). A stiff motion continues with an implicit solver.
    ///
    /// # Errors
    /// A motion that has not started; [`Error::Stopped`] with the last time if the solver stops early.
    pub fn advance(&mut self, until: f64) -> Result<(), Error> {
        let stop = match self.controls.take() {
            None => self.advance_plant(until)?,
            Some(mut controls) => {
                let mut trajectory = Trajectory::default();
                let mut record = LoopRecord::new(&mut trajectory);
                let ended = controls.follow(self, (until, &[]), &mut record, &mut |_| {});
                self.controls = Some(controls);
                ended?
            }
        };
        stop.map_or(Ok(()), |stop| Err(stop.into()))
    }

    /// Continues to the time `until` (s) with the present inputs. Returns the reason of an early stop.
    fn advance_plant(&mut self, until: f64) -> Result<Option<EarlyStop>, Error> {
        let Some(motion) = &mut self.motion else {
            return Err(Error::Request("the motion has not started".to_owned()));
        };
        loop {
            let mut trajectory = Trajectory::default();
            let asked = (until, &[][..]);
            let ended = motion.advance(&self.instance, asked, &mut trajectory, &mut |_| {});
            self.event_count += trajectory.events.len();
            let work = trajectory.statistics;
            self.step_count += work.steps + work.rejected_steps;
            self.t = motion.time();
            self.state.copy_from_slice(motion.state());
            match ended {
                None => return Ok(None),
                Some((_, Some((solver, _)))) => {
                    let next = (solver, &self.options);
                    motion.change_solver(&self.instance, &self.inputs, next)?;
                }
                Some((stop, None)) => return Ok(Some(stop)),
            }
        }
    }

    /// Returns the current time, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Returns the state at the current time, SI.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Returns the inputs.
    pub fn inputs(&self) -> &HeldInputs {
        &self.inputs
    }

    /// Returns true if a controller of the model drives an input.
    pub fn drives(&self, input: usize) -> bool {
        let mut controllers = self.model().program().controllers.iter();
        controllers.any(|own| own.driven.contains(&input))
    }

    /// Returns the number of events since the start.
    pub fn event_count(&self) -> usize {
        self.event_count
    }

    /// Returns the number of steps so far, including rejected ones.
    pub fn step_count(&self) -> u64 {
        self.step_count
    }

    /// Writes the observables at the current time to `out`; NaN if the motion has not started. During sticking they use
    /// the friction force that holds the motion.
    pub fn write_observables(&self, out: &mut [f64]) {
        match &self.motion {
            Some(motion) => motion.write_observables(out),
            None => out.fill(f64::NAN),
        }
    }
}

impl Plant for ExportedMotion {
    fn time(&self) -> f64 {
        self.t
    }

    fn state(&self) -> &[f64] {
        &self.state
    }

    fn write_observables(&mut self, out: &mut [f64]) {
        Self::write_observables(self, out);
    }

    fn change_inputs(&mut self, inputs: HeldInputs, _: &mut Trajectory) -> Result<(), Error> {
        self.follow_inputs(inputs)
    }

    fn continue_until(
        &mut self,
        (until, _): (f64, &[f64]),
        _: &mut Trajectory,
        _: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.advance_plant(until)
    }
}
