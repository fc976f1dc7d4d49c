//! Motions of exported models.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use crate::error::Error;
use crate::exported_model::{ExportedCode, ExportedInstance, ExportedModel};
use crate::general_motion::GeneralMotion;
use crate::projection::InitialChange;
use crate::solver_options::{SolverOptions, general_method};

/// A motion of an exported model that continues from call to call. Parameters and inputs may change in between.
pub struct ExportedMotion {
    instance: ExportedInstance,
    options: SolverOptions,
    inputs: HeldInputs,
    /// `None` before the start and after one that failed.
    motion: Option<GeneralMotion>,
    /// Time reached, s.
    t: f64,
    state: Vec<f64>,
    event_count: usize,
    step_count: u64,
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

    /// Starts at a time (s) and a state (SI) with these inputs. Returns the changes of the state that made the constraints
    /// hold.
    ///
    /// # Errors
    /// No consistent state near the given one, or rates there that are not finite.
    pub fn start(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: HeldInputs,
    ) -> Result<Vec<InitialChange>, Error> {
        self.event_count = 0;
        self.t = t;
        self.state.copy_from_slice(state);
        self.inputs = inputs;
        self.restart()
    }

    /// Continues with other independent parameters, SI. Surfaces hold or close anew.
    ///
    /// # Errors
    /// Same as [`ExportedMotion::start`].
    pub fn set_parameters(&mut self, parameters: &[f64]) -> Result<Vec<InitialChange>, Error> {
        self.instance.parameters.copy_from_slice(parameters);
        self.restart()
    }

    fn restart(&mut self) -> Result<Vec<InitialChange>, Error> {
        self.motion = None;
        let settings = self.options.settings(general_method(self.options.solver));
        let start = (self.t, &self.state[..]);
        let (motion, changes) =
            GeneralMotion::start(&self.instance, start, &self.inputs, &settings)?;
        self.state.copy_from_slice(motion.state());
        self.motion = Some(motion);
        Ok(changes)
    }

    /// Changes the inputs from the time reached on. They may jump there if they give the inputs before that time, too.
    ///
    /// # Errors
    /// A motion that cannot follow the jump.
    pub fn set_inputs(&mut self, inputs: HeldInputs) -> Result<(), Error> {
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
    /// A motion that has not started, and [`Error::Stopped`] if the solver stops early, at the time that it reached.
    pub fn advance(&mut self, until: f64) -> Result<(), Error> {
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
                None => return Ok(()),
                Some((_, Some((solver, _)))) => {
                    let next = (solver, &self.options);
                    motion.change_solver(&self.instance, &self.inputs, next)?;
                }
                Some((stop, None)) => return Err(stop.into()),
            }
        }
    }

    /// Returns the time reached, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Returns the state at that time, SI.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Returns the inputs.
    pub fn inputs(&self) -> &HeldInputs {
        &self.inputs
    }

    /// Returns the number of events since the start.
    pub fn event_count(&self) -> usize {
        self.event_count
    }

    /// Returns the number of steps so far, including rejected ones.
    pub fn step_count(&self) -> u64 {
        self.step_count
    }

    /// Writes the observables at the time reached to `out`; NaN if the motion has not started. During sticking they use
    /// the friction force that holds the motion.
    pub fn write_observables(&self, out: &mut [f64]) {
        match &self.motion {
            Some(motion) => motion.write_observables(out),
            None => out.fill(f64::NAN),
        }
    }
}
