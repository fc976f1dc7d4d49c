//! Motion with a general solver that continues over several calls.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Settings, Simulation, SurfaceMode, System, Trajectory};

use crate::error::Error;
use crate::general_run::GeneralRun;
use crate::motion::{EarlyStop, Solver, SolverChoice, StopCause};
use crate::motion_model::MotionModel;
use crate::observers::Observers;
use crate::projection::InitialChange;
use crate::solver_options::{SolverOptions, general_method};

/// Length (s) of a motion from which the solver estimates its first step; the error estimate corrects the step at once.
const FIRST_LENGTH_S: f64 = 1.0;

/// Motion with a general solver.
pub(crate) struct GeneralMotion {
    run: Box<GeneralRun>,
    simulation: Box<Simulation>,
}

impl GeneralMotion {
    /// Starts at a time (s) and a state, with the first solver of the options.
    ///
    /// # Errors
    /// A model that the solver does not support, or no consistent state near the given one.
    pub fn start(
        model: &dyn MotionModel,
        (t, state): (f64, &[f64]),
        inputs: &HeldInputs,
        settings: &Settings,
    ) -> Result<(Self, Vec<InitialChange>), Error> {
        let span = (t, t + FIRST_LENGTH_S);
        let mut run = model.prepare_general_run((state, span), inputs, settings)?;
        let start = (t, &run.initial[..]);
        let simulation = Simulation::new(&run.system, start, FIRST_LENGTH_S, settings);
        let simulation = simulation.map_err(|error| {
            let stop = run.describe_early_stop(model, &error, (t, &run.initial));
            Error::from(stop)
        })?;
        let changes = std::mem::take(&mut run.initial_changes);
        let (run, simulation) = (Box::new(run), Box::new(simulation));
        Ok((Self { run, simulation }, changes))
    }

    /// Sets the observers of the motion and returns the previous ones.
    pub fn replace_observers(&mut self, observers: Observers) -> Observers {
        self.run.system.replace_observers(observers)
    }

    pub fn run(&self) -> &GeneralRun {
        &self.run
    }

    /// Returns the current time, s.
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    pub fn state(&self) -> &[f64] {
        self.simulation.state()
    }

    pub fn modes(&self) -> &[SurfaceMode] {
        self.simulation.modes()
    }

    pub fn write_observables(&self, out: &mut [f64]) {
        let at = (self.time(), self.state());
        self.run.system.write_observables(at, out);
    }

    pub fn write_rates(&self, out: &mut [f64]) {
        self.run.system.rates(self.time(), self.state(), out);
    }

    /// Continues to a time (s). Adds the states at `samples`, the events and the work to `trajectory`. Returns the
    /// reason of an early stop, and another solver that may continue from this time.
    pub fn advance(
        &mut self,
        model: &dyn MotionModel,
        asked: (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Option<(EarlyStop, Option<(Solver, SolverChoice)>)> {
        let begin = self.time();
        let ended = self
            .simulation
            .advance(&self.run.system, asked, trajectory, progress);
        let error = ended.err()?;
        let stop = self
            .run
            .describe_early_stop(model, &error, (begin, self.state()));
        let next = match &stop.cause {
            StopCause::Stiff(what) if self.run.solver != Solver::Radau => {
                Some((Solver::Radau, SolverChoice::Stiff(what.clone())))
            }
            _ => None,
        };
        Some((stop, next))
    }

    /// Continues with another solver.
    ///
    /// # Errors
    /// See [`GeneralMotion::start`].
    pub fn change_solver(
        &mut self,
        model: &dyn MotionModel,
        inputs: &HeldInputs,
        (solver, options): (Solver, &SolverOptions),
    ) -> Result<(), Error> {
        let settings = options.settings(general_method(solver));
        let start = (self.time(), self.state());
        *self = Self::start(model, start, inputs, &settings)?.0;
        Ok(())
    }

    /// Changes the inputs, which may jump at the current time; adds the events of the jump to `log`.
    ///
    /// # Errors
    /// The motion cannot follow the jump.
    pub fn follow_inputs(
        &mut self,
        model: &dyn MotionModel,
        inputs: HeldInputs,
        log: &mut Trajectory,
    ) -> Result<(), Error> {
        let begin = self.time();
        self.run.system.set_inputs(inputs);
        let followed = self.simulation.follow_input_jump(&self.run.system, log);
        followed.map_err(|error| {
            let stop = self
                .run
                .describe_early_stop(model, &error, (begin, self.state()));
            Error::from(stop)
        })
    }
}
