//! Simulation of an instance: choice of the solver, and errors with the names of states and
//! surfaces. The crate `sim` contains the solvers.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{
    Method, Names, ObservedStep, Settings, SolveError, Surface, Trajectory, UnsupportedSticking,
    simulate_into,
};
use eomgen_sim::piecewise_linear::{ExactError, Propagator, StepObserver};

use crate::audit::{Audit, Auditor, EnergyAndPower};
use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{EarlyStop, Motion, Solver, SolverChoice, StopCause};

/// Default relative tolerance.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Maximum number of explicit steps, if stability limits their length, before [`Solver::Auto`]
/// changes to the implicit solver. That solver needs a few times less time for the trajectory.
const MAX_STIFF_STEPS: u64 = 100_000;

/// Request for a simulation.
#[derive(Clone, Copy, Debug)]
pub struct Request<'r> {
    /// State at the first sample, SI.
    pub initial: &'r [f64],
    /// Times of the samples, s, ascending.
    pub times: &'r [f64],
    /// Inputs of the motion.
    pub inputs: &'r HeldInputs,
    /// Solver of the equations of motion.
    pub solver: Solver,
    /// Relative tolerance; [`Solver::Exact`] ignores it.
    pub tolerance: f64,
    /// Longest step, s; [`Solver::Exact`] ignores it. See [`Settings::max_step`].
    pub max_step: f64,
    /// True to compare the change of the energy with the work; see [`Audit`].
    pub audit: bool,
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
    /// Simulates from the state `initial` (SI) at the first of the times (s, ascending), and
    /// returns the states at all of them.
    ///
    /// # Errors
    /// An invalid request, a solver that does not support the model, and [`Error::Stopped`] if the
    /// solver stops early. [`Instance::simulate_until_stop`] keeps the samples before such a stop.
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

    /// Simulates a request and returns the samples up to the time that the solver reaches. Calls
    /// `progress` with the time reached, s.
    ///
    /// # Errors
    /// An invalid request, a solver that does not support the model, or a solver that stops before
    /// its first step.
    pub fn simulate_until_stop(
        &self,
        request: &Request<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        (request.settings().check()).map_err(|error| Error::Request(error.to_string()))?;
        let asked = |method| Settings {
            method,
            ..request.settings()
        };
        let exact = match request.solver {
            Solver::Rk => {
                return self.simulate_general(
                    request,
                    &asked(Method::DormandPrince853),
                    None,
                    progress,
                );
            }
            Solver::Adams => {
                return self.simulate_general(request, &asked(Method::Adams), None, progress);
            }
            Solver::Radau => {
                return self.simulate_general(request, &asked(Method::Radau), None, progress);
            }
            Solver::Exact | Solver::Auto => self.model.piecewise_linear(),
        };
        let is_free = request.solver == Solver::Auto;
        if request.inputs.is_time_varying() {
            let reason = "the exact solver holds inputs constant between samples, but these inputs are \
                          functions of time";
            return match is_free {
                true => self.simulate_automatically(
                    request,
                    Some(SolverChoice::NotPiecewiseLinear(reason.to_owned())),
                    progress,
                ),
                false => Err(Error::Request(format!("{reason}: use --solver rk"))),
            };
        }
        if let Err(error) = exact {
            if is_free {
                let choice = Some(SolverChoice::NotPiecewiseLinear(error.to_string()));
                return self.simulate_automatically(request, choice, progress);
            }
            return Err(error.into());
        }
        // The evaluator rejects an indefinite mass matrix, as for the other solvers, and names the
        // switching functions.
        let evaluator = RefCell::new(self.evaluator()?);
        let mut trajectory = Trajectory::default();
        let mut auditor = request.audit.then(|| self.auditor(None));
        let ended = self.propagator().and_then(|mut propagator| {
            let auditor = auditor.as_mut().map(|auditor| (auditor, &evaluator));
            propagate(
                &mut propagator,
                &mut trajectory,
                request,
                (progress, auditor),
            )
        });
        let audit = auditor.map(|auditor| auditor.audit().clone());
        let surfaces = DrivenModel::new(&evaluator, request.inputs).surfaces();
        let Err(error) = ended else {
            let choice = is_free.then_some(SolverChoice::PiecewiseLinear);
            let found = (trajectory, surfaces);
            return Ok(new_motion(found, request, Solver::Exact, (choice, audit)));
        };
        let reason = self.format_named((&surfaces, Solver::Exact), |names| {
            error.format_named(names)
        });
        if is_free && may_be_supported_by_general(&error) {
            let choice = Some(SolverChoice::NotSupportedByExact(reason));
            return self.simulate_automatically(request, choice, progress);
        }
        let choice = is_free.then_some(SolverChoice::PiecewiseLinear);
        let t = error.time();
        let cause = self.exact_stop_cause(&error, &surfaces);
        let found = (trajectory, surfaces);
        let so_far = new_motion(found, request, Solver::Exact, (choice, audit));
        with_early_stop(so_far, EarlyStop { t, reason, cause })
    }

    /// Simulates with the explicit solver, and again with the implicit one if the motion is stiff.
    fn simulate_automatically(
        &self,
        request: &Request<'_>,
        choice: Option<SolverChoice>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let explicit = Settings {
            max_steps_if_stiff: MAX_STIFF_STEPS,
            ..request.settings()
        };
        let motion = self.simulate_general(request, &explicit, choice, progress)?;
        let cause = motion.early_stop.as_ref().map(|stopped| &stopped.cause);
        let Some(StopCause::Stiff(what)) = cause else {
            return Ok(motion);
        };
        let implicit = Settings {
            method: Method::Radau,
            ..request.settings()
        };
        let choice = Some(SolverChoice::Stiff(what.clone()));
        self.simulate_general(request, &implicit, choice, progress)
    }

    /// Simulates with a solver that supports any model.
    fn simulate_general(
        &self,
        request: &Request<'_>,
        settings: &Settings,
        choice: Option<SolverChoice>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let is_constrained = !self.model.model().constraints.is_empty();
        if !self.model.model().impacts.is_empty() && settings.method == Method::Adams {
            return Err(Error::Request(
                "the solver adams uses the preceding steps, which impacts of this model invalidate: use \
                 --solver rk or radau"
                    .to_owned(),
            ));
        }
        if let Some(surface) = self.model.first_corner()
            && settings.method == Method::Adams
        {
            return Err(Error::Request(format!(
                "the solver adams uses the preceding steps, which jumps of the rates invalidate, and the \
                 energies of this model jump where `{surface}` is zero: use --solver rk or radau"
            )));
        }
        if is_constrained && settings.method == Method::Adams {
            return Err(Error::Request(
                "the solver adams uses the preceding steps, which the projection onto the constraints \
                 invalidates: use --solver rk or radau"
                    .to_owned(),
            ));
        }
        let sided = self.sided_model()?;
        if sided.is_some_and(|sided| sided.has_discs()) && settings.method == Method::Adams {
            return Err(Error::Request(
                "the solver adams uses the preceding steps, which a stop under friction along v/norm(v) \
                 invalidates: use --solver rk or radau"
                    .to_owned(),
            ));
        }
        // Before the evaluator, whose pivots give a less specific error for dependent constraints.
        let (initial, moved) =
            self.find_consistent_start(request.initial, request.time_span(), request.inputs)?;
        let evaluator = RefCell::new(self.evaluator()?);
        let mut system = self.driven_model(&evaluator, request.inputs)?;
        if settings.method == Method::Adams {
            // The Adams method uses the preceding steps, so it cannot continue from sticking; it
            // reports the time of sticking instead.
            system = system.without_holding();
        }
        let solver = match settings.method {
            Method::DormandPrince853 => Solver::Rk,
            Method::Adams => Solver::Adams,
            Method::Radau => Solver::Radau,
        };
        if settings.method == Method::Radau {
            system = system.with_jacobian(self.jacobian_evaluator()?);
        }
        let auditor = request.audit.then(|| self.auditor(Some(request.tolerance)));
        let system = system.with_auditor(auditor);
        let mut trajectory = Trajectory::default();
        let asked = (initial.as_slice(), request.time_span(), request.times);
        let ended = simulate_into(&mut trajectory, &system, asked, settings, progress);
        let so_far = Motion {
            initial_changes: moved,
            ..new_motion(
                (trajectory, system.surfaces()),
                request,
                solver,
                (choice, system.audit()),
            )
        };
        match ended {
            Ok(()) => Ok(so_far),
            Err(error) => {
                let (t, surfaces) = (SolveError::time(&error), &so_far.surfaces);
                let cause = self.cause(&error, surfaces);
                let ended_at = t.unwrap_or(request.time_span().0);
                let may_be = matches!(cause, StopCause::NotFinite | StopCause::Limit);
                let passed = system.projection().filter(|_| may_be);
                let passed = passed.and_then(|projection| {
                    let state = &so_far.trajectory.final_state;
                    let mut rates = vec![0.0; state.len()];
                    let inputs = &request.inputs.evaluate(ended_at);
                    let point = Point {
                        t: ended_at,
                        state,
                        inputs,
                    };
                    evaluator.borrow_mut().rates(point, &mut rates);
                    let mut watch = projection.singularity_watch.borrow_mut();
                    watch.find_end((ended_at, state), &rates, request.inputs)
                });
                let (t, singular) = match passed {
                    Some((passed, reason)) => (Some(passed), Some(reason)),
                    None => (t, None),
                };
                let reason = match (system.overlap_message(), singular) {
                    (Some(overlap), _) => format!("at t = {ended_at:?} s {overlap}"),
                    _ if system.corner_message().is_some() => {
                        system.corner_message().unwrap_or_default()
                    }
                    (None, Some(reason)) => reason,
                    (None, None) => {
                        self.format_named((surfaces, solver), |names| error.format_named(names))
                    }
                };
                with_early_stop(so_far, EarlyStop { t, reason, cause })
            }
        }
    }

    fn auditor(&self, tolerance: Option<f64>) -> Auditor {
        let driven = self.input_driven_impact().map(|name| {
            format!(
                "the distance or slip of the impact `{name}` depends on inputs, so the contact jumps when they jump"
            )
        });
        Auditor::new(tolerance, self.model().typical_sizes(), driven)
    }

    fn cause(&self, error: &SolveError, surfaces: &[Surface]) -> StopCause {
        match error {
            SolveError::NotFinite { .. } | SolveError::NotPositiveDefinite { .. } => {
                StopCause::NotFinite
            }
            SolveError::Sticking { .. } | SolveError::TooManySwitches { .. } => {
                StopCause::Switching
            }
            SolveError::Stiff { state, within, .. } => {
                let state = &self.model.state_names()[*state];
                StopCause::Stiff(format!(
                    "the model is stiff: `{state}` settles within {within:.1e} s"
                ))
            }
            SolveError::StiffAtSurface { guard, .. } => {
                StopCause::Stiff(match surfaces.get(*guard) {
                    Some(surface) => {
                        format!("stiff near the place where `{}` is zero", surface.formula)
                    }
                    None => "stiff near a switching surface".to_owned(),
                })
            }
            SolveError::Request { .. }
            | SolveError::StepTooSmall { .. }
            | SolveError::TooManySteps { .. } => StopCause::Limit,
        }
    }

    fn exact_stop_cause(&self, error: &ExactError, surfaces: &[Surface]) -> StopCause {
        match error {
            ExactError::Stopped(error) => self.cause(error, surfaces),
            ExactError::Sticking { .. } => StopCause::Switching,
            ExactError::NotFinite | ExactError::NotPositiveDefinite => StopCause::NotFinite,
            _ => StopCause::Limit,
        }
    }

    /// Formats an error of a solver with the names of the states and of these switching functions.
    fn format_named(
        &self,
        (surfaces, solver): (&[Surface], Solver),
        message: impl FnOnce(&Names<'_>) -> String,
    ) -> String {
        let states = self.model.state_names();
        let unfollowed = match solver {
            Solver::Adams => UnsupportedSticking::Adams,
            _ if !self.model.model().impacts.is_empty() => UnsupportedSticking::Impacts,
            _ => UnsupportedSticking::Formula,
        };
        message(&Names {
            states: &states,
            surfaces,
            unsupported_sticking: unfollowed,
        })
    }
}

/// Auditor of a motion by the exact solver, and the evaluator of its energies.
type ExactAudit<'a> = Option<(&'a mut Auditor, &'a RefCell<Evaluator>)>;

fn propagate(
    propagator: &mut Propagator,
    trajectory: &mut Trajectory,
    request: &Request<'_>,
    (progress, auditor): (&mut dyn FnMut(f64), ExactAudit<'_>),
) -> Result<(), ExactError> {
    let asked = (request.initial, request.time_span(), request.times);
    let Some((auditor, evaluator)) = auditor else {
        return propagator.simulate_into(trajectory, asked, request.inputs, progress);
    };
    let mut evaluator = evaluator.borrow_mut();
    let mut observables = vec![0.0; evaluator.program().observables.len()];
    let mut energies = |t: f64, state: &[f64]| {
        let inputs = &request.inputs.evaluate(t);
        evaluator.observables(Point { t, state, inputs }, &mut observables);
        EnergyAndPower::from_observables(&observables)
    };
    let mut observer = |step: &mut ObservedStep<'_>, is_held: bool| match is_held {
        true => auditor.exclude_step(step, &mut energies, STICKING_EXCLUSION),
        false => auditor.audit_step(step, &mut energies),
    };
    let observer = (progress, Some(&mut observer as &mut StepObserver<'_>));
    propagator.simulate_observed(trajectory, asked, request.inputs, observer)
}

/// Reason for excluding steps during which the exact solver holds the motion on a surface.
const STICKING_EXCLUSION: &str =
    "during sticking, the model does not give the power of the force that holds the motion";

fn new_motion(
    (trajectory, surfaces): (Trajectory, Vec<Surface>),
    request: &Request<'_>,
    solver: Solver,
    (choice, audit): (Option<SolverChoice>, Option<Audit>),
) -> Motion {
    Motion {
        trajectory,
        surfaces,
        inputs: request.inputs.clone(),
        solver,
        solver_choice: choice,
        early_stop: None,
        initial_changes: Vec::new(),
        audit,
    }
}

/// Returns the motion up to the stop; an error if the solver stopped before its first step.
fn with_early_stop(mut motion: Motion, why: EarlyStop) -> Result<Motion, Error> {
    // An invalid request may be found after the first sample.
    if motion.trajectory.times.len() <= usize::from(why.t.is_none()) {
        return Err(Error::Stopped {
            t: why.t,
            reason: why.reason,
        });
    }
    motion.early_stop = Some(why);
    Ok(motion)
}

/// Returns true if another solver may follow the motion.
fn may_be_supported_by_general(error: &ExactError) -> bool {
    matches!(
        error,
        ExactError::Sticking { .. } | ExactError::NotConverged
    )
}
