//! Simulation of an instance: choice of the solver, and errors with the names of states and surfaces. The solvers are
//! in the crate `sim`.

use eomgen_model_spec::argument::Argument;
use std::cell::RefCell;

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, ObservedStep, Settings, Surface, Trajectory, simulate_into};
use eomgen_sim::piecewise_linear::{ExactError, Propagator, StepObserver};

use crate::audit::Auditor;
use crate::controllers::SampledController;
use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::exact_observers::ExactObservers;
use crate::instance::Instance;
use crate::motion::{ControllerStates, EarlyStop, Motion, Solver, SolverChoice, StopCause};
use crate::motion_model::MotionModel;
use crate::observers::{Observers, Results};
use crate::solver_options::{DEFAULT_TOLERANCE, MAX_STIFF_STEPS};
use crate::statistics::{Measurement, Meters};
use crate::stop_reasons::{
    describe_exact_stop, find_exact_stop_cause, may_be_supported_by_general,
};

/// Reason why the exact solver does not support inputs.
pub(crate) const TIME_VARYING_INPUTS_MESSAGE: &str = "the exact solver holds inputs constant between samples, but \
                                                      these inputs are functions of time";

/// Request for a simulation.
#[derive(Clone, Copy, Debug)]
pub struct Request<'r> {
    /// State at the first sample, SI.
    pub initial: &'r [f64],
    /// Times of the samples in ascending order, s.
    pub times: &'r [f64],
    /// Inputs of the motion.
    pub inputs: &'r HeldInputs,
    /// Solver of the equations of motion.
    pub solver: Solver,
    /// Relative tolerance; [`Solver::Exact`] ignores it.
    pub tolerance: f64,
    /// Longest step, s. [`Solver::Exact`] ignores it, and [`Solver::Fixed`] takes steps of this length. See
    /// [`Settings::max_step`].
    pub max_step: f64,
    /// True to audit the energy balance; see [`crate::Audit`].
    pub audit: bool,
}

/// Request with measurements.
#[derive(Clone, Copy)]
pub(crate) struct ObservedRequest<'r> {
    pub request: &'r Request<'r>,
    pub measurements: &'r [Measurement],
}

impl<'r> ObservedRequest<'r> {
    pub fn new(request: &'r Request<'r>) -> Self {
        Self {
            request,
            measurements: &[],
        }
    }
}

impl Request<'_> {
    fn settings(&self) -> Settings {
        Settings {
            max_step: self.max_step,
            ..Settings::with_tolerance(self.tolerance)
        }
    }

    /// Returns the first and the last sample time, s.
    pub fn time_span(&self) -> (f64, f64) {
        let first = self.times.first().copied().unwrap_or(0.0);
        (first, self.times.last().copied().unwrap_or(first))
    }
}

impl Instance<'_> {
    /// Simulates from the state `initial` (SI) at the first of the times (s, ascending), and returns the states at all
    /// of them.
    ///
    /// # Errors
    /// An invalid request, a solver that does not support the model, and [`Error::Stopped`] if the solver stops early.
    /// [`Instance::simulate_until_stop`] keeps the samples before such a stop.
    pub fn simulate(
        &self,
        initial: &[f64],
        times: &[f64],
        inputs: &HeldInputs,
        solver: Solver,
    ) -> Result<Motion, Error> {
        let request = Request {
            initial,
            times,
            inputs,
            solver,
            tolerance: DEFAULT_TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        };
        self.simulate_until_stop(&request, &mut |_| {})?
            .into_complete()
    }

    /// Simulates a request and returns the samples up to the end or the early stop of the solver. The controllers of
    /// the specification drive their inputs. Calls `progress` with the current time, s.
    ///
    /// # Errors
    /// An invalid request, a solver that does not support the model, or a solver that stops before its first step.
    pub fn simulate_until_stop(
        &self,
        request: &Request<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        self.simulate_observed(ObservedRequest::new(request), progress)
    }

    /// Simulates like [`Instance::simulate_until_stop`] and measures quantities; see [`Motion::measured`].
    ///
    /// # Errors
    /// Measurements with [`Solver::Fixed`]; see also [`Instance::simulate_until_stop`].
    pub fn simulate_measured(
        &self,
        request: &Request<'_>,
        measurements: &[Measurement],
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        if request.solver == Solver::Fixed {
            let message = "the solver fixed computes no states inside its steps, so it cannot compute measures";
            return Err(Error::Request(message.to_owned()));
        }
        let observed = ObservedRequest {
            request,
            measurements,
        };
        self.simulate_observed(observed, progress)
    }

    fn simulate_observed(
        &self,
        observed: ObservedRequest<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let request = observed.request;
        if request.solver == Solver::Fixed || !self.model().model().controllers.is_empty() {
            let mut declared = self.controllers()?;
            let all = declared.iter_mut();
            let mut all: Vec<_> = all.map(|own| own as &mut dyn SampledController).collect();
            return self.simulate_with_controllers(observed, &mut all, progress);
        }
        (request.settings().check()).map_err(|error| Error::Request(error.to_string()))?;
        self.check_held_inputs(request.inputs, request.time_span())?;
        let asked = |method| Settings {
            method,
            ..request.settings()
        };
        let exact = match request.solver {
            Solver::Rk => {
                let settings = asked(Method::DormandPrince853);
                return self.simulate_general(observed, &settings, None, progress);
            }
            Solver::Adams => {
                return self.simulate_general(observed, &asked(Method::Adams), None, progress);
            }
            Solver::Radau => {
                return self.simulate_general(observed, &asked(Method::Radau), None, progress);
            }
            Solver::Exact | Solver::Auto | Solver::Fixed => self.model.piecewise_linear(),
        };
        let is_free = request.solver == Solver::Auto;
        if request.inputs.is_time_varying() {
            let reason = TIME_VARYING_INPUTS_MESSAGE;
            return match is_free {
                true => self.simulate_automatically(
                    observed,
                    Some(SolverChoice::NotPiecewiseLinear(reason.to_owned())),
                    progress,
                ),
                false => Err(Error::Request(format!(
                    "{reason}: use {}",
                    Argument::Solver.with_text("rk")
                ))),
            };
        }
        if let Err(error) = exact {
            if is_free {
                let choice = Some(SolverChoice::NotPiecewiseLinear(error.to_string()));
                return self.simulate_automatically(observed, choice, progress);
            }
            return Err(error.into());
        }
        // The evaluator rejects an indefinite mass matrix, as for the other solvers, and the error names the switching
        // functions.
        let evaluator = RefCell::new(self.evaluator()?);
        let mut trajectory = Trajectory::default();
        let start = (request.time_span().0, request.initial);
        let observers = self.observers(None, request.audit, observed.measurements);
        let observers =
            (!observers.is_empty()).then(|| self.exact_observers(observers, start, request.inputs));
        let mut observers = observers.transpose()?;
        let ended = self.propagator().and_then(|mut propagator| {
            let observers = (progress as &mut dyn FnMut(f64), observers.as_mut());
            propagate(&mut propagator, &mut trajectory, request, observers)
        });
        let results = observers.map_or_else(Results::default, |observers| observers.results());
        let surfaces = DrivenModel::new(&evaluator, request.inputs).surfaces();
        let Err(error) = ended else {
            let choice = is_free.then_some(SolverChoice::PiecewiseLinear);
            let found = (trajectory, surfaces);
            return Ok(new_motion(found, request, Solver::Exact, (choice, results)));
        };
        let reason = describe_exact_stop(self.model().labels(), &surfaces, &error);
        let t = error.time();
        if is_free && may_be_supported_by_general(&error) {
            let choice = Some(SolverChoice::NotSupportedByExact(reason.clone()));
            let motion = self.simulate_automatically(observed, choice, progress);
            let ended_at = match &motion {
                Ok(motion) => motion.early_stop.as_ref().map(|stop| stop.t),
                Err(Error::Stopped { t, .. }) => Some(*t),
                Err(_) => None,
            };
            // If both solvers stop early, the one that came farther gives the reason.
            let is_farther = ended_at.is_none_or(|ended_at| ended_at >= t);
            if is_farther || matches!(error, ExactError::Sticking { .. }) {
                return motion;
            }
        }
        let choice = is_free.then_some(SolverChoice::PiecewiseLinear);
        let cause = find_exact_stop_cause(self.model().labels(), &error, &surfaces);
        let found = (trajectory, surfaces);
        let so_far = new_motion(found, request, Solver::Exact, (choice, results));
        with_early_stop(so_far, EarlyStop { t, reason, cause })
    }

    /// Simulates with the explicit solver, and again with the implicit one if the motion is stiff.
    fn simulate_automatically(
        &self,
        observed: ObservedRequest<'_>,
        choice: Option<SolverChoice>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let request = observed.request;
        let explicit = Settings {
            max_steps_if_stiff: MAX_STIFF_STEPS,
            ..request.settings()
        };
        let motion = self.simulate_general(observed, &explicit, choice, progress)?;
        let cause = motion.early_stop.as_ref().map(|stopped| &stopped.cause);
        let Some(StopCause::Stiff(what)) = cause else {
            return Ok(motion);
        };
        let implicit = Settings {
            method: Method::Radau,
            ..request.settings()
        };
        let choice = Some(SolverChoice::Stiff(what.clone()));
        self.simulate_general(observed, &implicit, choice, progress)
    }

    /// Simulates with a solver that supports any model.
    fn simulate_general(
        &self,
        observed: ObservedRequest<'_>,
        settings: &Settings,
        choice: Option<SolverChoice>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let request = observed.request;
        let tolerance = Some(request.tolerance);
        let observers = self.observers(tolerance, request.audit, observed.measurements);
        if settings.method == Method::Adams {
            self.check_adams()?;
        }
        let mut run = (self as &dyn MotionModel).prepare_general_run(
            (request.initial, request.time_span()),
            request.inputs,
            settings,
        )?;
        run.system.replace_observers(observers);
        let mut trajectory = Trajectory::default();
        let asked = (run.initial.as_slice(), request.time_span(), request.times);
        let ended = simulate_into(&mut trajectory, &run.system, asked, settings, progress);
        let results = run.system.results();
        let so_far = Motion {
            initial_changes: run.initial_changes.clone(),
            friction_choices: run.system.friction_choices(),
            ..new_motion(
                (trajectory, run.surfaces.clone()),
                request,
                run.solver,
                (choice, results),
            )
        };
        match ended {
            Ok(()) => Ok(so_far),
            Err(error) => {
                let reached = (request.time_span().0, &so_far.trajectory.final_state[..]);
                let stop = run.describe_early_stop(self, &error, reached);
                with_early_stop(so_far, stop)
            }
        }
    }

    /// Rejects models in which states or rates jump.
    pub(crate) fn check_adams(&self) -> Result<(), Error> {
        let jumps = if !self.model().model().impacts.is_empty() {
            "impacts of this model invalidate".to_owned()
        } else if let Some(surface) = self.model().first_corner() {
            format!(
                "jumps of the rates invalidate, and the energies of this model jump where `{surface}` is zero"
            )
        } else if !self.model().model().constraints.is_empty() {
            "the projection onto the constraints invalidates".to_owned()
        } else if self.sided_model()?.is_some_and(|sided| sided.has_discs()) {
            "a stop under friction along v/norm(v) invalidates".to_owned()
        } else {
            return Ok(());
        };
        Err(Error::Request(format!(
            "the solver adams uses the preceding steps, which {jumps}: use {} or radau",
            Argument::Solver.with_text("rk")
        )))
    }

    /// Returns the observers of a motion with a relative tolerance; `None` for an exact motion.
    pub(crate) fn observers(
        &self,
        tolerance: Option<f64>,
        audits: bool,
        measurements: &[Measurement],
    ) -> Observers {
        let observables = self.model().program().observables.len();
        Observers {
            auditor: audits.then(|| self.auditor(tolerance)),
            meters: Meters::new(measurements, tolerance, observables),
        }
    }

    fn auditor(&self, tolerance: Option<f64>) -> Auditor {
        let driven = self.find_input_driven_impact().map(|name| {
            format!(
                "the distance or slip of the impact `{name}` depends on inputs, so the contact jumps when they jump"
            )
        });
        Auditor::new(tolerance, self.model().typical_sizes(), driven)
    }
}

fn propagate(
    propagator: &mut Propagator,
    trajectory: &mut Trajectory,
    request: &Request<'_>,
    (progress, observers): (&mut dyn FnMut(f64), Option<&mut ExactObservers>),
) -> Result<(), ExactError> {
    let asked = (request.initial, request.time_span(), request.times);
    let Some(observers) = observers else {
        return propagator.simulate_into(trajectory, asked, request.inputs, progress);
    };
    let mut observer = |step: &mut ObservedStep<'_>, is_held: bool| {
        observers.observe_step(step, is_held, request.inputs);
    };
    let observer = (progress, Some(&mut observer as &mut StepObserver<'_>));
    propagator.simulate_observed(trajectory, asked, request.inputs, observer)
}

pub(crate) fn new_motion(
    (trajectory, surfaces): (Trajectory, Vec<Surface>),
    request: &Request<'_>,
    solver: Solver,
    (choice, results): (Option<SolverChoice>, Results),
) -> Motion {
    Motion {
        trajectory,
        surfaces,
        inputs: request.inputs.clone(),
        solver,
        solver_choice: choice,
        early_stop: None,
        initial_changes: Vec::new(),
        audit: results.audit,
        measured: results.measured,
        controller_states: ControllerStates::default(),
        friction_choices: Vec::new(),
    }
}

/// Returns the motion up to the stop, or an error if the solver stopped before its first step.
pub(crate) fn with_early_stop(mut motion: Motion, why: EarlyStop) -> Result<Motion, Error> {
    // An invalid request may be detected after the first sample.
    if motion.trajectory.times.len() <= usize::from(why.t.is_none()) {
        return Err(Error::Stopped {
            t: why.t,
            reason: why.reason,
        });
    }
    motion.early_stop = Some(why);
    Ok(motion)
}
